// Repose tests: random numbers of a fixed seed, the instruction sets of this machine, and errors in ulp. The
// generator is our own scaling of mt19937_64, because the distributions of the standard library differ between
// libraries and a failure must be the same failure everywhere.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "kernels/pass/pass.h"

namespace repose {

class Samples {
 public:
  explicit Samples(std::uint64_t seed) : engine_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(engine_() >> 11) * 0x1p-53);
  }
  /// Evenly distributed exponents between 10^low and 10^high.
  double power_of_ten(double low, double high) { return std::pow(10.0, uniform(low, high)); }
  double sign() { return (engine_() & 1) != 0 ? 1.0 : -1.0; }
  std::size_t index(std::size_t count) { return engine_() % count; }

  /// A rotation, evenly distributed (Shoemake 1992), by rows.
  std::array<std::array<double, 3>, 3> rotation() {
    const double u = uniform(0, 1), a = uniform(0, 2 * std::numbers::pi), b = uniform(0, 2 * std::numbers::pi);
    const double x = std::sqrt(1 - u) * std::sin(a), y = std::sqrt(1 - u) * std::cos(a);
    const double z = std::sqrt(u) * std::sin(b), w = std::sqrt(u) * std::cos(b);
    return {{{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
             {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
             {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}}};
  }

 private:
  std::mt19937_64 engine_;
};

/// The instruction sets that this machine can run.
inline std::vector<Target> supported_targets() {
  std::vector<Target> targets;
  for (const Target target : {Target::kBaseline, Target::kAvx2, Target::kAvx512}) {
    if (target_supported(target)) targets.push_back(target);
  }
  return targets;
}

/// |value - exact| in units of the last place of Real at `exact`; infinite for a value that is not finite.
template <class Real>
double ulps(Real value, long double exact) {
  using Limits = std::numeric_limits<Real>;
  if (!std::isfinite(value)) return std::numeric_limits<double>::infinity();
  const int exponent = exact == 0 ? Limits::min_exponent : std::ilogb(exact) + 1;
  const long double ulp = std::ldexp(1.0L, std::max(exponent, int{Limits::min_exponent}) - Limits::digits);
  return static_cast<double>(std::fabs(static_cast<long double>(value) - exact) / ulp);
}

/// The value written beyond the end of arrays to see that nothing else is.
template <class Real>
inline constexpr Real kCanary = Real(-12345.5);

}  // namespace repose
