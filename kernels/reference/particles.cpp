// Repose: see particles.h.
#include "kernels/reference/particles.h"

#include <algorithm>
#include <cmath>

namespace repose::reference {
namespace {

template <class Real>
double trace(const Real* const strain[6], std::size_t p) {
  return double{strain[0][p]} + double{strain[3][p]} + double{strain[5][p]};
}

/// Whether a step turns nothing inside out: of I + dt grad v the determinant, by Sarrus, the sum of the minors
/// and the trace are positive, as they are while no axis, or pair of axes, turns over.
template <class Real>
bool keeps_sides(const Real* const gradient[9], std::size_t p, double dt) {
  double m[9];
  for (int k = 0; k < 9; ++k) m[k] = dt * gradient[k][p] + (k % 4 == 0 ? 1.0 : 0.0);
  const double ratio = m[0] * m[4] * m[8] + m[1] * m[5] * m[6] + m[2] * m[3] * m[7] - m[2] * m[4] * m[6] -
                       m[1] * m[3] * m[8] - m[0] * m[5] * m[7];
  const double minors = m[0] * m[4] - m[1] * m[3] + m[4] * m[8] - m[5] * m[7] + m[0] * m[8] - m[2] * m[6];
  return ratio > 0 && std::isfinite(static_cast<Real>(ratio)) && minors > 0 && m[0] + m[4] + m[8] > 0;
}

}  // namespace

template <class Real>
void advance(const ParticleSpan<Real>& particles, const Real* const velocity[3], const Real* const gradient[9],
             Real cells_per_velocity, Motion<Real>& motion) {
  for (std::size_t p = 0; p < particles.count; ++p) {
    double speed = 0, steepest = 0;
    for (int axis = 0; axis < 3; ++axis) {
      Real& x = particles.position[axis][p];
      x = static_cast<Real>(x + double{cells_per_velocity} * velocity[axis][p]);
      motion.lowest = std::min(motion.lowest, x);
      motion.highest = std::max(motion.highest, x);
      speed += double{particles.velocity[axis][p]} * particles.velocity[axis][p];
    }
    for (int k = 0; k < 9; ++k) steepest += double{gradient[k][p]} * gradient[k][p];
    motion.speed_squared = std::max(motion.speed_squared, static_cast<Real>(speed));
    motion.gradient_squared = std::max(motion.gradient_squared, static_cast<Real>(steepest));
  }
}

template <class Real>
std::size_t first_failed(const Real* const velocity[3], const Real* const gradient[9], std::size_t count,
                         Real dt, Real spacing) {
  for (std::size_t p = 0; p < count; ++p) {
    bool good = keeps_sides(gradient, p, double{dt});
    for (int axis = 0; axis < 3; ++axis) good = good && std::fabs(velocity[axis][p]) <= spacing / dt;
    if (!good) return p;
  }
  return count;
}

template <class Real>
void open_volume(Real* const strain[6], const Real* gained, Real* trace_of_trial, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    trace_of_trial[p] = static_cast<Real>(trace<Real>(strain, p));
    for (const int k : {0, 3, 5}) strain[k][p] = static_cast<Real>(strain[k][p] + double{gained[p]} / 3);
  }
}

template <class Real>
void close_volume(const Real* const strain[6], Real* gained, const Real* trace_of_trial, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    gained[p] = static_cast<Real>(double{gained[p]} + double{trace_of_trial[p]} - trace(strain, p));
  }
}

#define REPOSE_FOR(Real)                                                                                  \
  template void advance(const ParticleSpan<Real>&, const Real* const[3], const Real* const[9], Real,      \
                        Motion<Real>&);                                                                   \
  template std::size_t first_failed(const Real* const[3], const Real* const[9], std::size_t, Real, Real); \
  template void open_volume(Real* const[6], const Real*, Real*, std::size_t);                             \
  template void close_volume(const Real* const[6], Real*, const Real*, std::size_t);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose::reference
