// Repose: the constitutive passes: trial strain, return to the yield surface, stress. One pass each, so that an
// effect may act between them; all work on the strain channel in place, a pack of particles at a time.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/material.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/base/targets.h"

#include "kernels/base/matrix_arrays.h"
#include "kernels/material/materials.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

template <class T>
REPOSE_INLINE void prefetch_strain(const MaterialInput<T>& in, std::size_t first) {
  HWY_UNROLL(6)
  for (int k = 0; k < 6; ++k) Pack<T>::prefetch(in.strain[k] + (static_cast<std::ptrdiff_t>(first) + in.ahead));
}

template <class T>
void trial(const MaterialInput<T>& in) {
  const Pack<T> dt(in.dt);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    prefetch_strain(in, first);
    Mat3<Pack<T>> step;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) step.m[k / 3][k % 3] = dt * Pack<T>::load_first(in.gradient[k] + first, lanes);
    store_sym3(hencky_trial(load_sym3<T>(in.strain, first, lanes), step), in.strain, first, lanes);
  }
}

template <class Material, class T>
void project(const MaterialInput<T>& in) {
  const auto& constants = *static_cast<const typename Material::template Constants<T>*>(in.constants);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    store_sym3(Material::project(constants, strain), in.strain, first, lanes);
  }
}

template <class Material, class T>
void project_shaped(const MaterialInput<T>& in, const YieldInput<T>& surface) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(in.count)) {
    const auto number = [first = first, lanes = lanes](const T* from)
                            HWY_ATTR { return P::load_first(from + first, lanes); };
    const auto done = Material::project_shaped(load_sym3<T>(in.strain, first, lanes), number(surface.cone),
                                               number(surface.cohesion), number(surface.dilatancy));
    store_sym3(done.strain, in.strain, first, lanes);
    done.plastic.store_first(surface.plastic + first, lanes);
    done.sheared.store_first(surface.sheared + first, lanes);
    done.dilated.store_first(surface.dilated + first, lanes);
  }
}

template <class Material, class T>
void stress(const MaterialInput<T>& in) {
  const auto& constants = *static_cast<const typename Material::template Constants<T>*>(in.constants);
  for (const auto [first, lanes] : packs<T>(in.count)) {
    prefetch_strain(in, first);
    const auto strain = load_sym3<T>(in.strain, first, lanes);
    store_sym3(Material::stress(constants, strain), in.stress, first, lanes);
  }
}

template <class Material, class T>
MaterialKernels<T> material_kernels() {
  MaterialKernels<T> table{};
  table.trial = trial<T>;
  table.stress = stress<Material, T>;
  if constexpr (Material::Parameters::kYields) {
    table.project = project<Material, T>;
    table.project_shaped = project_shaped<Material, T>;
  }
  return table;
}

template <class T>
void fill_precision(Kernels<T>& table) {
  static_assert(std::tuple_size_v<Materials> == Kernels<T>::kMaterials);
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    ((table.material[k] = material_kernels<std::tuple_element_t<k, Materials>, T>()), ...);
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
REPOSE_DEFINE_FILL(material)
}  // namespace repose
#endif
