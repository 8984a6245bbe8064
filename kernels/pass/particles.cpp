// Repose: passes over particles that belong to no material and no transfer: moving them, and the acceptance
// check of a step.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/particles.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include <limits>

#include "kernels/base/small_matrix-inl.h"
#include "kernels/pass/fill.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// x += dt v-bar (Klar et al. 2016, eq. 13), in cells.
template <class T>
void advance(const ParticleSpan<T>& particles, const T* const velocity[3], const T* const gradient[9],
             T cells_per_velocity, Motion<T>& motion) {
  using P = Pack<T>;
  P speed(motion.speed_squared), steepest(motion.gradient_squared), low(motion.lowest), high(motion.highest);
  const P scale(cells_per_velocity);
  for (const auto [first, lanes] : packs<T>(particles.count)) {
    const auto filled = first_lanes<T>(lanes);
    P square(T(0)), entries(T(0));
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      const P v = P::load_first(particles.velocity[axis] + first, lanes);
      square = fma(v, v, square);
      const P x = fma(scale, P::load_first(velocity[axis] + first, lanes),
                      P::load_first(particles.position[axis] + first, lanes));
      x.store_first(particles.position[axis] + first, lanes);
      low = min(low, select(filled, x, low));
      high = max(high, select(filled, x, high));
    }
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) {
      const P g = P::load_first(gradient[k] + first, lanes);
      entries = fma(g, g, entries);
    }
    speed = max(speed, square);
    steepest = max(steepest, entries);
  }
  motion = {largest(speed), largest(steepest), smallest(low), largest(high)};
}

template <class T>
std::size_t first_failed(const T* const velocity[3], const T* const gradient[9], std::size_t count, T dt,
                         T spacing) {
  using P = Pack<T>;
  const P step(dt), most(spacing / dt), zero(T(0)), one(T(1));
  for (const auto [first, lanes] : packs<T>(count)) {
    Mat3<P> map;
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) {
      map.m[k / 3][k % 3] = step * P::load_first(gradient[k] + first, lanes) + (k % 4 == 0 ? one : zero);
    }
    // False for a NaN; an infinite entry makes the determinant a NaN or infinite. Where two axes turn over it
    // is positive again; then the sum of the minors, or the trace, is not.
    const auto& m = map.m;
    const P volume_ratio = determinant(map), trace = m[0][0] + m[1][1] + m[2][2];
    const auto minor = [&m](int a, int b) HWY_ATTR { return m[a][a] * m[b][b] - m[a][b] * m[b][a]; };
    const P minors = minor(0, 1) + minor(1, 2) + minor(2, 0);
    auto good = (volume_ratio > zero) & (volume_ratio <= P(std::numeric_limits<T>::max())) & (minors > zero) &
                (trace > zero);
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      good = good & (abs(P::load_first(velocity[axis] + first, lanes)) <= most);
    }
    if (!any_first(!good, lanes)) continue;
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (any_first(!good, lane + 1)) return first + lane;
    }
  }
  return count;
}

template <class T>
void fill_precision(Kernels<T>& table) {
  table.particle.advance = advance<T>;
  table.particle.first_failed = first_failed<T>;
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
REPOSE_DEFINE_FILL(particles, Kernels)
}  // namespace repose
#endif
