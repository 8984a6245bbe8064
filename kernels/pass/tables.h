// Repose: how kernels get into tables, one for each instruction set and precision, whatever the family: a
// struct of function pointers, such as Kernels (pass.h) or that of an effect. For .cpp files of kernels alone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <type_traits>

#include "kernels/pass/target.h"

namespace repose {

/// The tables of a family for one instruction set.
template <template <class> class Family>
struct Precisions {
  Family<float> single;
  Family<double> dual;
};

/// All tables of a family, made once.
template <template <class> class Family>
class FamilyTables {
 public:
  using Fill = void (*)(Target, Precisions<Family>&);

  /// Those of a set that the machine lacks stay empty: what fills a table is compiled for it too.
  explicit FamilyTables(std::initializer_list<Fill> fills) {
    for (int k = 0; k < kTargets; ++k) {
      const auto target = static_cast<Target>(k);
      if (!target_supported(target)) continue;
      for (const Fill fill : fills) fill(target, tables_[k]);
    }
  }

  template <class Real>
  const Family<Real>& of(Target target) const {
    const auto& tables = tables_[static_cast<std::size_t>(target)];
    if constexpr (std::is_same_v<Real, float>) {
      return tables.single;
    } else {
      return tables.dual;
    }
  }

 private:
  std::array<Precisions<Family>, kTargets> tables_{};
};

}  // namespace repose

/// Defines repose::fill_NAME from the function `fill` of each instruction set. The choice is an argument, not
/// Highway's process-wide one: two engines in one process may run different sets.
#define REPOSE_DEFINE_FILL(name, Family)                                         \
  HWY_EXPORT(fill);                                                              \
  void fill_##name(Target target, Precisions<Family>& tables) {                  \
    hwy::ChosenTarget chosen;                                                    \
    const std::int64_t bits[kTargets] = {HWY_STATIC_TARGET, HWY_AVX2, HWY_AVX3}; \
    chosen.Update(bits[static_cast<int>(target)]);                               \
    (*(HWY_DISPATCH_TABLE(fill)[chosen.GetIndex()]))(tables);                    \
  }

/// Defines repose::NAME<Real>(target), the tables of a family that one file fills.
#define REPOSE_DEFINE_TABLES(name, Family)                   \
  REPOSE_DEFINE_FILL(name, Family)                           \
  template <class Real>                                      \
  const Family<Real>& name(Target target) {                  \
    static const FamilyTables<Family> tables({fill_##name}); \
    return tables.of<Real>(target);                          \
  }                                                          \
  template const Family<float>& name<float>(Target);         \
  template const Family<double>& name<double>(Target);
