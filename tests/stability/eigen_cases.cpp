// Repose tests: cases 1 to 4 of the battery. They are cases of singular values of F, of which the engine takes
// none: what it decomposes is b = F F^T, symmetric, whose eigenvalues are the squares. So 1e-6 to 1e6 become
// 1e-12 to 1e12, and symmetric matrices of either sign stand for the signs that b cannot have. Errors are in
// roundings of the largest entry, against Eigen in long double.
#include "tests/kernels/exact_matrix.h"
#include "tests/kernels/functions.h"
#include "tests/stability/kernel_cases.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

/// Largest errors of the eigen decomposition as scalars and on every instruction set.
template <class Real>
class EigenErrors {
 public:
  using Matrices = std::vector<Symmetric<Real>>;

  /// Values and reconstruction are measured to the largest entry, or to `floor` where that is more.
  explicit EigenErrors(double floor = std::numeric_limits<Real>::min()) : floor_(floor) {}

  void measure(const Matrices& matrices) {
    std::vector<ExactVector> expected;
    for (const auto& matrix : matrices) {
      expected.push_back(ExactEigen(exact(matrix), Eigen::EigenvaluesOnly).eigenvalues());
    }
    std::vector<Real> results(12 * matrices.size());
    for (const Functions<Real>& functions : all_functions<Real>()) {
      functions.eigen_sym3(matrices[0].data(), results.data(), matrices.size());
      for (std::size_t k = 0; k < matrices.size(); ++k) {
        measure(exact(matrices[k]), &results[12 * k], expected[k], functions.name);
      }
    }
  }

  void report(Case& asked, const std::string& of = "") const {
    const std::string what = (of.empty() ? "" : ", " + of) + std::string(", ") + kPrecision<Real>;
    at_most(asked, "values" + what, values_, 16, "eps");
    at_most(asked, "orthogonality" + what, orthogonality_, 16, "eps");
    at_most(asked, "reconstruction" + what, reconstruction_, 16, "eps");
    // What an error of orthogonality of 16 eps may make of +1; a mirror would have -1.
    at_most(asked, "det U - 1" + what, determinant_, 24, "eps");
  }

 private:
  void measure(const ExactMatrix& matrix, const Real* result, const ExactVector& expected, const char* name) {
    constexpr double kEps = kEpsilon<Real>;
    const double unit = kEps * std::max(largest_entry(matrix), floor_);
    ExactMatrix u;
    for (int k = 0; k < 9; ++k) u(k / 3, k % 3) = result[3 + k];
    ExactVector values(result[0], result[1], result[2]);
    orthogonality_.add(largest_entry(u.transpose() * u - ExactMatrix::Identity()) / kEps, name);
    determinant_.add(static_cast<double>(std::fabs(u.determinant() - 1)) / kEps, name);
    reconstruction_.add(largest_entry(u * values.asDiagonal() * u.transpose() - matrix) / unit, name);
    std::sort(values.begin(), values.end());
    values_.add(static_cast<double>((values - expected).cwiseAbs().maxCoeff()) / unit, name);
  }

  double floor_;
  Worst values_, orthogonality_, reconstruction_, determinant_;
};

using Deformation = ExactMatrix;

/// b of F.
template <class Real>
Symmetric<Real> left_cauchy_green(const Deformation& f) {
  return rounded<Real>(f * f.transpose());
}

/// U diag(stretches) V^T.
Deformation stretched(const ExactVector& stretches, Samples& samples) {
  const ExactMatrix u = exact_rotation(samples);
  return u * stretches.asDiagonal() * exact_rotation(samples).transpose();
}

/// A third of these: b of F, symmetric matrices of either sign, and graded entries, which no rotation of a
/// diagonal gives.
template <class Real>
std::vector<Symmetric<Real>> wide_matrices(std::size_t count, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Symmetric<Real>> matrices(count);
  for (std::size_t k = 0; k < count; ++k) {
    ExactVector values;
    for (int i = 0; i < 3; ++i) values[i] = samples.sign() * samples.power_of_ten(-6, 6);
    if (k % 3 == 0) {
      matrices[k] = left_cauchy_green<Real>(stretched(values, samples));
    } else if (k % 3 == 1) {
      for (int i = 0; i < 3; ++i) values[i] *= std::fabs(values[i]);
      matrices[k] = rounded<Real>(turned(values, samples));
    } else {
      for (Real& entry : matrices[k]) {
        entry = static_cast<Real>(samples.sign() * samples.power_of_ten(-12, 12));
      }
    }
  }
  return matrices;
}

template <class Real>
void wide_eigenvalues_of(Case& asked, std::size_t samples) {
  EigenErrors<Real> errors;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    errors.measure(wide_matrices<Real>(count, 1000 + seed));
  });
  errors.report(asked);
}

/// Identity and rotations, stretches equal but for 1e-7 or less, exactly equal ones, those of rank 2, 1 and 0,
/// and mirrors; each at every scale.
template <class Real>
std::vector<Symmetric<Real>> equal_matrices(std::size_t count, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Symmetric<Real>> matrices;
  while (matrices.size() < count) {
    const long double scale = samples.power_of_ten(-6, 6), gap = samples.sign() * samples.power_of_ten(-18, -7);
    const long double other = samples.uniform(-2, 2);
    for (const ExactVector& stretches :
         {ExactVector(1, 1, 1), ExactVector(1, 1 + gap, 1 - gap), ExactVector(1, 1 + gap, other),
          ExactVector(1, 1, -1), ExactVector(1, other, 0), ExactVector(1, 1, 0), ExactVector(1, 0, 0)}) {
      matrices.push_back(left_cauchy_green<Real>(scale * stretched(stretches, samples)));
      matrices.push_back(rounded<Real>(scale * turned(stretches, samples)));
    }
  }
  for (const Real one : {Real(1), Real(1e-12), Real(1e12)}) {
    matrices.push_back({one, 0, 0, one, 0, one});
    matrices.push_back({0, one, 0, 0, 0, 0});
    matrices.push_back({one, one, one, one, one, one});
    matrices.push_back({0, one, one, 0, one, 0});
    matrices.push_back({one, -one, one, one, -one, one});
  }
  matrices.push_back({0, 0, 0, 0, 0, 0});
  return matrices;
}

/// The way that b of nearly equal stretches takes, without eigenvalues: log(I + e)/2 of e = b - I.
template <class Real>
void small_strains(Case& asked, std::size_t count) {
  Samples samples(2001);
  std::vector<Symmetric<Real>> matrices;
  std::vector<ExactMatrix> expected;
  for (std::size_t k = 0; k < count; ++k) {
    const long double gap = samples.power_of_ten(-18, -7);
    const ExactVector e(gap, samples.uniform(-1, 1) * gap, -gap);
    matrices.push_back(rounded<Real>(turned(e, samples)));
    expected.push_back(of_eigenvalues(exact(matrices.back()), [](long double x) { return std::log1p(x) / 2; }));
  }
  std::vector<Real> results(6 * count);
  Worst error;
  for (const Functions<Real>& functions : all_functions<Real>()) {
    functions.half_log1p(matrices[0].data(), results.data(), count);
    for (std::size_t k = 0; k < count; ++k) {
      const double difference = largest_entry(exact(&results[6 * k]) - expected[k]);
      error.add(difference / (kEpsilon<Real> * largest_entry(expected[k])), functions.name);
    }
  }
  at_most(asked, std::string("strain of stretches 1 +- 1e-7, ") + kPrecision<Real>, error, 16, "eps");
}

template <class Real>
void equal_values_of(Case& asked, std::size_t samples) {
  EigenErrors<Real> errors;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    errors.measure(equal_matrices<Real>(count, 2000 + seed));
  });
  errors.report(asked);
  small_strains<Real>(asked, std::min<std::size_t>(samples / 4, 20011));
}

template <class Real>
void scaled_matrices_of(Case& asked, std::size_t samples) {
  using Limits = std::numeric_limits<Real>;
  const std::vector<double> scales =
      sizeof(Real) == 4 ? std::vector<double>{1e-20, 1e20, 1e38, 4.0 * Limits::min()}
                        : std::vector<double>{1e-40, 1e-20, 1e20, 1e40, 1e307, 4.0 * Limits::min()};
  EigenErrors<Real> errors;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    Samples random(3000 + seed);
    std::vector<Symmetric<Real>> matrices(count);
    for (auto& matrix : matrices) {
      const double scale = scales[random.index(scales.size())];
      for (Real& entry : matrix) entry = static_cast<Real>(scale * random.sign() * random.uniform(0.25, 1));
    }
    errors.measure(matrices);
  });
  errors.report(asked);
}

/// Beneath the smallest normal number nothing need be told apart, but nothing may become larger than that.
template <class Real>
void subnormal_matrices_of(Case& asked, std::size_t samples) {
  using Limits = std::numeric_limits<Real>;
  EigenErrors<Real> errors(Limits::min() / (16 * kEpsilon<Real>));
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    Samples random(3500 + seed);
    std::vector<Symmetric<Real>> matrices(count);
    for (auto& matrix : matrices) {
      const double scale = Limits::min() * random.power_of_ten(-Limits::digits10, 0);
      for (Real& entry : matrix) entry = static_cast<Real>(scale * random.uniform(-1, 1));
    }
    errors.measure(matrices);
  });
  errors.report(asked);
}

/// F that made decompositions hang, or give not a number: of rank 2 with equal columns, and with a subnormal
/// entry (pvfmm, issue 5); of equal columns (numeric, issue 86); of equal rows, times two numbers (svd-js,
/// issue 5); Kahan 1966 and Laeuchli 1961, whose small values b loses; Hilbert's.
std::vector<Deformation> published_deformations() {
  std::vector<Deformation> all(8);
  all[0] << 267.2136, -267.2136, -230.9624, -4383.1704, 4383.1704, -4383.1704, 0, 0, 0;
  all[1] << 7044.7734691220212, 0, 0, 0, -1.284570679187241e-322, 57.264113734770199, 0, 0, 0;
  all[2] << 308.2985565973347, 308.2985565973347, 308.2985565973347, 306.8843430349616, 306.8843430349616,
      306.8843430349616, 306.17723625377505, 306.17723625377505, 306.17723625377505;
  all[3] << -896, -896, 0, -19, -19, 0, 0, 0, 0;
  const long double s = 0.6L, c = 0.8L, tiny = 1e-9L;
  all[4] << 1, -c, -c, 0, s, -s * c, 0, 0, s * s;
  all[5] << 1, 1, 1, tiny, 0, 0, 0, tiny, 0;
  all[6] << 1, 1 / 2.0L, 1 / 3.0L, 1 / 2.0L, 1 / 3.0L, 1 / 4.0L, 1 / 3.0L, 1 / 4.0L, 1 / 5.0L;
  all[7] = ExactMatrix::Identity();  // svdlibc, issue 3
  return all;
}

/// Demmel and Veselic 1992, where QR loses the two small values, at a scale that a float holds; Wilkinson's
/// W3+; entries far apart, where formulas cancel.
std::vector<ExactMatrix> published_symmetric() {
  std::vector<ExactMatrix> all(3);
  all[0] << 1e20L, 1e9L, 1e-1L, 1e9L, 1, 1e-11L, 1e-1L, 1e-11L, 1e-20L;
  all[1] << 1, 1, 0, 1, 0, 1, 0, 1, 1;
  all[2] << 1e12L, 1e-3L, 1e-3L, 1e-3L, 1, 1e-6L, 1e-3L, 1e-6L, 1e-12L;
  return all;
}

/// All symmetric matrices of the numbers -2 to 2, and F of them as many as are asked for: exactly, and with 256
/// roundings added (Gast et al. 2016), which opens values that were equal by as much.
template <class Real>
std::vector<Symmetric<Real>> integer_matrices(std::size_t count) {
  std::vector<Symmetric<Real>> matrices;
  const auto digits = [](std::size_t number, auto& entries) {
    for (auto& entry : entries) {
      entry = static_cast<std::remove_reference_t<decltype(entry)>>(static_cast<int>(number % 5) - 2);
      number /= 5;
    }
  };
  constexpr std::size_t kSymmetric = 15625, kAll = 1953125;
  for (std::size_t number = 0; number < kSymmetric; ++number) {
    Symmetric<Real> matrix;
    digits(number, matrix);
    matrices.push_back(matrix);
  }
  const std::size_t stride = count > kSymmetric ? kAll / (count - kSymmetric) + 1 : kAll;
  for (std::size_t number = 0; number < kAll; number += stride) {
    std::array<long double, 9> f;
    digits(number, f);
    ExactMatrix m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = f[static_cast<std::size_t>(k)];
    matrices.push_back(left_cauchy_green<Real>(m));
  }
  Samples samples(4001);
  const std::size_t exact_ones = matrices.size();
  for (std::size_t k = 0; k < exact_ones; ++k) {
    Symmetric<Real> moved = matrices[k];
    for (Real& entry : moved) entry += static_cast<Real>(256 * kEpsilon<Real> * samples.uniform(-1, 1));
    matrices.push_back(moved);
  }
  return matrices;
}

template <class Real>
void killer_matrices_of(Case& asked, std::size_t samples) {
  EigenErrors<Real> published, integers;
  std::vector<Symmetric<Real>> matrices;
  for (const Deformation& f : published_deformations()) {
    matrices.push_back(left_cauchy_green<Real>(f));
    matrices.push_back(left_cauchy_green<Real>(f.transpose()));
  }
  for (const ExactMatrix& m : published_symmetric()) matrices.push_back(rounded<Real>(m));
  published.measure(matrices);
  published.report(asked, "published");
  const auto all = integer_matrices<Real>(samples / 2);
  integers.measure(all);
  integers.report(asked, "integers");
}

}  // namespace

void wide_eigenvalues(std::size_t samples) {
  Case asked(1, "eigenvalues of b over 1e+-12, and of either sign");
  wide_eigenvalues_of<float>(asked, samples);
  wide_eigenvalues_of<double>(asked, samples);
}

void equal_and_missing_values(std::size_t samples) {
  Case asked(2, "identity, rotations, equal values, ranks 2 to 0, mirrors");
  equal_values_of<float>(asked, samples);
  equal_values_of<double>(asked, samples);
}

void scaled_matrices(std::size_t samples) {
  Case asked(3, "very large and very small matrices");
  scaled_matrices_of<float>(asked, samples);
  scaled_matrices_of<double>(asked, samples);
}

void subnormal_matrices(std::size_t samples) {
  Case asked(3, "subnormal matrices");
  subnormal_matrices_of<float>(asked, samples);
  subnormal_matrices_of<double>(asked, samples);
}

/// The number of sweeps is fixed, so nothing can hang.
void killer_matrices(std::size_t samples) {
  Case asked(4, "matrices that broke other decompositions");
  killer_matrices_of<float>(asked, samples);
  killer_matrices_of<double>(asked, samples);
}

}  // namespace repose::battery
