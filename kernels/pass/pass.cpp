// Repose: the tables of all kernels, and which instruction sets this machine has.
#include "kernels/pass/pass.h"

#include "hwy/targets.h"
#include "kernels/pass/tables.h"

namespace repose {
namespace {

/// Empty where the machine lacks the set: what fills a table is compiled for it too.
KernelTables make_tables(Target target) {
  KernelTables tables{};
  if (!target_supported(target)) return tables;
  fill_scatter(target, tables);
  fill_gather(target, tables);
  fill_material(target, tables);
  fill_particles(target, tables);
  fill_yield(target, tables);
  fill_node_stiffness(target, tables);
  fill_stiffness(target, tables);
  fill_nodes(target, tables);
  fill_vectors(target, tables);
  return tables;
}

KernelTables& tables_of(Target target) {
  static std::array<KernelTables, kTargets> tables{make_tables(Target::kBaseline), make_tables(Target::kAvx2),
                                                   make_tables(Target::kAvx512)};
  return tables[static_cast<std::size_t>(target)];
}

}  // namespace

const char* target_name(Target target) {
  constexpr const char* kNames[kTargets] = {"baseline", "avx2", "avx512"};
  return kNames[static_cast<int>(target)];
}

bool target_supported(Target target) {
  switch (target) {
    case Target::kBaseline:
      return true;
    case Target::kAvx2:
      return (hwy::SupportedTargets() & HWY_AVX2) != 0;
    case Target::kAvx512:
      return (hwy::SupportedTargets() & HWY_AVX3) != 0;
  }
  return false;
}

Target best_target() {
  if (target_supported(Target::kAvx512)) return Target::kAvx512;
  if (target_supported(Target::kAvx2)) return Target::kAvx2;
  return Target::kBaseline;
}

template <class Real>
const Kernels<Real>& kernels(Target target) {
  return tables_of(target).of<Real>();
}
template const Kernels<float>& kernels<float>(Target);
template const Kernels<double>& kernels<double>(Target);

}  // namespace repose
