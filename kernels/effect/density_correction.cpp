// Repose: the strain of sand follows the density at which its particles lie, where that is higher.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/effect/density_correction.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/matrix_arrays-inl.h"
#include "kernels/effect/density_correction.h"
#include "kernels/pass/tables.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// What one look may count for: more than a tenth of volume is a stream that closes, or an impact, and pressure
/// that grew with its shear would throw it apart.
constexpr double kMostCrowding = 1.1, kMostShare = 0.1;

/// ln x for 1/2 <= x <= 1.1 to 2e-6, by ln x = 2 artanh((x - 1)/(x + 1)).
template <class T>
REPOSE_INLINE Pack<T> log_of_ratio(Pack<T> x) {
  using P = Pack<T>;
  const P one(T(1)), z = (x - one) / (x + one), square = z * z;
  P sum = fma(square, P(T(1) / 9), P(T(1) / 7));
  sum = fma(square, sum, P(T(1) / 5));
  sum = fma(square, sum, P(T(1) / 3));
  return (z + z) * fma(square, sum, one);
}

/// With theta = -ln(mass around/mass at rest), at least -0.095, and e = vc + tr eps what the particle believes,
///   vc + tr eps <- e + min(0.1, gamma/s) min(0, theta - e),   gamma = dt sqrt(2) |dev sym grad v|,
/// vc first and not below 0. What lies less dense than it believes may lie at a surface, and is left alone.
template <class T>
void compact(const T* mass, const T* const gradient[9], const DensityConstants<T>& law, T dt,
             T* const strain[6], T* gained, std::size_t count) {
  using P = Pack<T>;
  const P zero(T(0)), third(T(1) / 3), half(T(0.5));
  const P most_crowding(static_cast<T>(kMostCrowding)), most_share(static_cast<T>(kMostShare));
  const P at_rest(T(1) / law.mass_at_rest), rate(law.per_shear * dt);
  for (const auto [first, lanes] : packs<T>(count)) {
    const auto slope = [&](int k) HWY_ATTR { return P::load_first(gradient[k] + first, lanes); };
    const P mean = third * (slope(0) + slope(4) + slope(8));
    const P xx = slope(0) - mean, yy = slope(4) - mean, zz = slope(8) - mean;
    const P xy = slope(1) + slope(3), xz = slope(2) + slope(6), yz = slope(5) + slope(7);
    P square = fma(xx, xx, fma(yy, yy, zz * zz));
    square = fma(half, fma(xy, xy, fma(xz, xz, yz * yz)), square);
    const P share = min(most_share, rate * sqrt(square + square));
    const P crowding = max(half, min(most_crowding, P::load_first(mass + first, lanes) * at_rest));
    const P e_xx = P::load_first(strain[0] + first, lanes), e_yy = P::load_first(strain[3] + first, lanes),
            e_zz = P::load_first(strain[5] + first, lanes);
    const P gap = gained == nullptr ? zero : P::load_first(gained + first, lanes);
    const P change = share * min(zero, -log_of_ratio(crowding) - (gap + (e_xx + e_yy + e_zz)));
    const P from_gap = max(change, min(zero, -gap));
    const P each = third * (change - from_gap);
    if (gained != nullptr) (gap + from_gap).store_first(gained + first, lanes);
    (e_xx + each).store_first(strain[0] + first, lanes);
    (e_yy + each).store_first(strain[3] + first, lanes);
    (e_zz + each).store_first(strain[5] + first, lanes);
  }
}

void fill(Precisions<DensityCorrectionKernels>& tables) {
  tables.single = {compact<float>};
  tables.dual = {compact<double>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_TABLES(density_correction_kernels, DensityCorrectionKernels)
}  // namespace repose
#endif
