#include "bench/check_case.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>

namespace repose {
namespace {

/// Rounding of a sum of some tens of numbers; kernels are tested more sharply in tests/kernels.
template <class Real>
constexpr double kTolerance = 64.0 * std::numeric_limits<Real>::epsilon();

bool to_be_broken(const std::string& name) {
  const char* word = std::getenv("REPOSE_BENCH_BREAK");
  return word != nullptr && *word != '\0' && name.starts_with(word);
}

/// Largest difference in parts of the largest number; infinite where one is not finite.
template <class Values>
double difference(const Values& values, const Values& expected) {
  double largest = 0.0, most = 0.0;
  for (std::size_t k = 0; k < std::size(expected); ++k) {
    const double apart = std::fabs(double{values[k]} - double{expected[k]});
    if (!std::isfinite(apart)) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, std::fabs(double{expected[k]}));
    most = std::max(most, apart);
  }
  return most == 0.0 ? 0.0 : most / largest;
}

template <class Real>
void falsify(Workpiece<Real>& piece, const std::vector<std::size_t>& written) {
  const auto arrays = piece.arrays();
  for (const std::size_t k : written) {
    for (Real& value : arrays[k]) value *= Real(1.001);
  }
  for (double& value : piece.result) value *= 1.001;
}

}  // namespace

template <class Real>
Verdict check_case(const KernelCase<Real>& what) {
  Chunk<Real> before(what.stencil), tried(what.stencil), expected(what.stencil);
  what.kernel(tried.piece());
  what.reference(expected.piece());
  if (what.forget) {
    for (Chunk<Real>* chunk : {&before, &tried, &expected}) what.forget(chunk->piece());
  }
  const auto was = before.piece().arrays(), is = tried.piece().arrays();
  Verdict verdict;
  for (std::size_t k = 0; k < is.size(); ++k) {
    if (!std::ranges::equal(is[k], was[k])) verdict.written.push_back(k);
  }
  if (to_be_broken(what.name)) falsify(expected.piece(), verdict.written);
  double most = difference(tried.piece().result, expected.piece().result);
  const auto should = expected.piece().arrays();
  for (std::size_t k = 0; k < is.size(); ++k) most = std::max(most, difference(is[k], should[k]));
  if (!(most <= kTolerance<Real>)) {
    char text[96];
    std::snprintf(text, sizeof text, "differs from the reference by %.1e of the largest number", most);
    verdict.trouble = text;
  }
  return verdict;
}
template Verdict check_case(const KernelCase<float>&);
template Verdict check_case(const KernelCase<double>&);

}  // namespace repose
