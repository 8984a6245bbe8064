// Repose: see yield.h.
#include "kernels/reference/yield.h"

#include <algorithm>
#include <cmath>

#include "kernels/reference/symmetric.h"

namespace repose::reference {
namespace {

/// alpha of an angle in radians (docs/math.md, section 25).
double cone_slope(ConeMatching matching, double phi) {
  const double sine = std::sin(phi);
  switch (matching) {
    case ConeMatching::kTriaxialCompression:
      return std::sqrt(2.0 / 3.0) * 2.0 * sine / (3.0 - sine);
    case ConeMatching::kPlaneStrain:
      return std::sqrt(2.0) / 3.0 * sine;
    case ConeMatching::kPlaneStrainAssociated:
      return std::sqrt(2.0) * sine / std::sqrt(9.0 + 3.0 * sine * sine);
    case ConeMatching::kTwoDimensional:
      return sine / std::sqrt(2.0);
  }
  return 0.0;
}

double trace(const Symmetric& a) {
  return a[0] + a[3] + a[5];
}

double norm_of_deviator(const Symmetric& a) {
  return (full(a) - trace(a) / 3.0 * Matrix::Identity()).norm();
}

/// dg of `over` = dg + most / (1 + threshold / (g dg)) for over > 0. What is left over falls, and ever more
/// slowly, as dg grows, so Newton's method comes from 0 to the root without passing it.
double shear_at_rest(double over, double most, double g, double threshold) {
  double dg = 0.0;
  for (int step = 0; step < 500; ++step) {
    const double sum = threshold + g * dg;
    const double left = over - dg - most * g * dg / sum;
    const double next = dg + left / (1.0 + most * g * threshold / (sum * sum));
    if (!(next > dg)) break;
    dg = next;
  }
  return dg;
}

/// The bound m of principal strains (ascending), 2 mu m + lambda sum min(strain, m) = limit: as few are cut as
/// leave the others below it.
double bound_of_strains(const Eigen::Vector3d& strain, double lambda, double mu, double limit) {
  const double one = (limit - lambda * (strain[0] + strain[1])) / (lambda + 2.0 * mu);
  if (one >= strain[1]) return one;
  const double two = (limit - lambda * strain[0]) / (2.0 * lambda + 2.0 * mu);
  if (two >= strain[0]) return two;
  return limit / (3.0 * lambda + 2.0 * mu);
}

/// What yielding makes of principal strains; the three numbers are those of YieldInput.
struct Yielded {
  double plastic = 0.0, sheared = 0.0, dilated = 0.0;
};

Yielded yield(Eigen::Vector3d& strain, double yield_slope, double cohesion, double dilatancy) {
  const Eigen::Vector3d before = strain, deviator = strain.array() - strain.sum() / 3.0;
  const double t = strain.sum(), n = deviator.norm();
  const double apex = yield_slope > 0.0 ? cohesion / yield_slope : cohesion > 0.0 ? HUGE_VAL : 0.0;
  if (n <= cohesion - yield_slope * t && t <= apex) return {};
  const double dg =
      std::clamp((n + yield_slope * t - cohesion) / (1.0 + 3.0 * dilatancy * yield_slope), 0.0, n);
  const Eigen::Vector3d flow = n > 0.0 ? Eigen::Vector3d(deviator / n) : Eigen::Vector3d::Zero();
  strain.array() -= dg * (flow.array() + dilatancy);
  const bool opened = strain.sum() > apex;
  if (opened) strain.setConstant(apex / 3.0);
  const double plastic = (before - strain).norm();
  if (opened) return {plastic, 0.0, 0.0};
  return {plastic, plastic, 3.0 * dilatancy * dg};
}

}  // namespace

template <class Real>
void harden(const Real* q, const HardeningConstants<Real>& law, Real* yield_slope, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    const double forgotten = std::exp(-double{law.h2} * q[p]);
    const double phi = law.h0 + (double{law.h1} * q[p] - law.h3) * forgotten;
    yield_slope[p] = static_cast<Real>(law.per_cone_slope * cone_slope(law.matching, phi));
  }
}

template <class Real>
void strengthen(const Real* const strain[6], const Real* cohesion, const RateConstants<Real>& law, Real dt,
                Real* yield_slope, std::size_t count) {
  for (std::size_t p = 0; p < count; ++p) {
    const Symmetric eps = load(strain, p);
    const double t = trace(eps), over = norm_of_deviator(eps) - cohesion[p] + double{yield_slope[p]} * t;
    if (!(t < 0.0 && over > 0.0)) continue;
    const double g = double{law.inertia} / dt / std::sqrt(-t);
    const double dg = shear_at_rest(over, -double{law.rise} * t, g, law.threshold);
    yield_slope[p] = static_cast<Real>(yield_slope[p] + (over - dg) / -t);
  }
}

template <class Real>
void cut_tension(Real* const strain[6], const HenckyConstants<Real>& elastic, Real limit, Real* trace_of_trial,
                 std::size_t count) {
  const double lambda = elastic.lambda, mu = elastic.mu;
  for (std::size_t p = 0; p < count; ++p) {
    const Symmetric eps = load(strain, p);
    bool pulls = false;
    const Symmetric cut = with_eigenvalues(eps, [&](Eigen::Vector3d& values) {
      pulls = 2.0 * mu * values[2] + lambda * values.sum() > limit;
      if (pulls) values = values.cwiseMin(bound_of_strains(values, lambda, mu, limit));
    });
    if (!pulls) continue;
    trace_of_trial[p] = static_cast<Real>(trace_of_trial[p] - (trace(eps) - trace(cut)));
    store(cut, strain, p);
  }
}

template <class Real>
void return_map_per_particle_drucker_prager(const MaterialInput<Real>& in, const YieldInput<Real>& surface) {
  for (std::size_t p = 0; p < in.count; ++p) {
    Yielded done;
    const Symmetric projected = with_eigenvalues(load(in.strain, p), [&](Eigen::Vector3d& strain) {
      done = yield(strain, surface.yield_slope[p], surface.cohesion[p], surface.dilatancy[p]);
    });
    store(projected, in.strain, p);
    surface.plastic[p] = static_cast<Real>(done.plastic);
    surface.sheared[p] = static_cast<Real>(done.sheared);
    surface.dilated[p] = static_cast<Real>(done.dilated);
  }
}

#define REPOSE_FOR(Real)                                                                               \
  template void harden(const Real*, const HardeningConstants<Real>&, Real*, std::size_t);              \
  template void strengthen(const Real* const[6], const Real*, const RateConstants<Real>&, Real, Real*, \
                           std::size_t);                                                               \
  template void cut_tension(Real* const[6], const HenckyConstants<Real>&, Real, Real*, std::size_t);   \
  template void return_map_per_particle_drucker_prager(const MaterialInput<Real>&, const YieldInput<Real>&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose::reference
