// Repose: the equivalent plastic strain of a step, added to that of all before it.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/plastic_strain.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/effect/plastic_strain.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

template <class T>
void accumulate(const T* const trial[6], const T* const strain[6], T* sum, std::size_t count) {
  using P = Pack<T>;
  for (const auto [first, lanes] : packs<T>(count)) {
    const Sym3<P> a = load_sym3<T>(trial, first, lanes), b = load_sym3<T>(strain, first, lanes);
    const Sym3<P> lost{a.xx - b.xx, a.xy - b.xy, a.xz - b.xz, a.yy - b.yy, a.yz - b.yz, a.zz - b.zz};
    const Sym3<P> flow = plus_identity(lost, -(trace(lost) * P(T(1) / 3)));
    const P step = sqrt(square_norm(flow) * P(T(2) / 3));
    (P::load_first(sum + first, lanes) + step).store_first(sum + first, lanes);
  }
}

void fill(Precisions<PlasticStrainKernels>& tables) {
  tables.single = {accumulate<float>};
  tables.dual = {accumulate<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(plastic_strain_kernels, PlasticStrainKernels)
}  // namespace repose
#endif
