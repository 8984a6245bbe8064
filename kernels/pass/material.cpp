// Repose: the constitutive passes: trial strain, return to the yield surface, stress. One pass each, so that an
// effect may act between them; all work on the strain channel in place, a pack of particles at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/material.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/material/materials.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/own_channels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

template <class T>
REPOSE_INLINE void prefetch_strain(const MaterialInput<T>& in, std::size_t first) {
  HWY_UNROLL(6)
  for (int k = 0; k < 6; ++k) Pack<T>::prefetch(in.strain[k] + (static_cast<std::ptrdiff_t>(first) + in.ahead));
}

template <class Law, class T>
void trial(const MaterialInput<T>& in) {
  const Pack<T> dt(in.dt);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    prefetch_strain(in, first);
    Mat3<Pack<T>> step;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) step.m[k / 3][k % 3] = dt * Pack<T>::load_first(in.gradient[k] + first, lanes);
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    if constexpr (HasOwnTrial<Law>) {
      const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.constants);
      auto own = load_own<Law>(in, first, lanes);
      store_sym3(Law::trial(constants, strain, own.number, step), in.strain, first, lanes);
      store_own<Law>(own, in, first, lanes);
    } else {
      store_sym3(hencky_trial(strain, step), in.strain, first, lanes);
    }
  }
}

template <class Law, class T>
void return_map(const MaterialInput<T>& in) {
  const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.constants);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    if constexpr (kOwn<Law> == 0) {
      store_sym3(Law::return_map(constants, strain), in.strain, first, lanes);
    } else {
      auto own = load_own<Law>(in, first, lanes);
      store_sym3(Law::return_map(constants, strain, own.number), in.strain, first, lanes);
      store_own<Law>(own, in, first, lanes);
    }
  }
}

template <class Law, class T>
void return_map_per_particle(const MaterialInput<T>& in, const YieldInput<T>& surface) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(in.count)) {
    const auto number = [first = first, lanes = lanes](const T* from)
                            HWY_ATTR { return P::load_first(from + first, lanes); };
    const auto done =
        Law::return_map_per_particle(load_sym3<T>(in.strain, first, lanes), number(surface.yield_slope),
                                     number(surface.cohesion), number(surface.dilatancy));
    store_sym3(done.strain, in.strain, first, lanes);
    done.plastic.store_first(surface.plastic + first, lanes);
    done.sheared.store_first(surface.sheared + first, lanes);
    done.dilated.store_first(surface.dilated + first, lanes);
  }
}

template <class Law, class T>
void stress(const MaterialInput<T>& in) {
  const auto& constants = *static_cast<const typename Law::template Constants<T>*>(in.constants);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    prefetch_strain(in, first);
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    if constexpr (kOwn<Law> == 0) {
      store_sym3(Law::stress(constants, strain), in.stress, first, lanes);
    } else {
      store_sym3(Law::stress(constants, strain, load_own<Law>(in, first, lanes).number), in.stress, first,
                 lanes);
    }
  }
}

template <class Law, class T>
void fill_law(MaterialKernels<T>& table) {
  table.trial = trial<Law, T>;
  table.stress = stress<Law, T>;
  if constexpr (Law::Parameters::kYields) table.return_map = return_map<Law, T>;
  if constexpr (Law::Parameters::kHasCone) table.return_map_per_particle = return_map_per_particle<Law, T>;
}

template <class T>
void fill_precision(Kernels<T>& table) {
  static_assert(std::tuple_size_v<Materials> == Kernels<T>::kMaterials);
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (fill_law<std::tuple_element_t<k, Materials>>(table.material[k]), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Materials>>());
}

void fill(KernelTables& tables) {
  fill_precision(tables.single);
  fill_precision(tables.dual);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_FILL(material, Kernels)
}  // namespace repose
#endif
