// Repose tests: tangents of particles as an implicit step keeps them (kernels/pass/pass.h), at random.
#pragma once

#include <random>
#include <vector>

#include "kernels/pass/pass.h"

namespace repose {

/// Tangents of particles at random: U and Q any matrices, A symmetric, or not.
template <class Real>
std::vector<Real> random_tangents(std::size_t count, bool symmetric) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Real> all((count + kTangentGroup) * kTangentValues);
  for (Real& number : all) number = static_cast<Real>(uniform(engine));
  for (std::size_t p = 0; p < count && symmetric; ++p) {
    const auto a = [&](std::size_t i, std::size_t j) -> Real& {
      return all[(p / kTangentGroup * kTangentValues + 18 + 3 * i + j) * kTangentGroup + p % kTangentGroup];
    };
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < i; ++j) a(i, j) = a(j, i);
    }
  }
  return all;
}

}  // namespace repose
