// Repose tests: the change of a particle's stress with the velocities, as implicit steps apply it, against
// central differences of the stress itself; and its symmetry, where a mode promises one.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <random>
#include <string>

#include "kernels/pass/pass.h"

namespace repose {
namespace {

using Mat3d = Eigen::Matrix3d;

constexpr std::size_t kCount = 61;  // whole registers and a remainder, several groups

/// Particles with a strain, on which the passes of one material act in one mode.
class Stiffness {
 public:
  using Matrices = std::vector<Mat3d>;

  Stiffness(Target target, const MaterialParameters& material, TangentMode mode)
      : kernels_(kernels<double>(target)), material_(kernels_.material[material.index()]), mode_(mode) {
    std::visit(
        [this](const auto& p) {
          using Constants = typename std::decay_t<decltype(p)>::template Constants<double>;
          constants_ = std::make_shared<Constants>(p);
          const auto begin = p.initial_channels();
          begin_.assign(begin.begin(), begin.end());
        },
        material);
  }

  std::vector<std::array<double, 6>> strain;
  UnilateralConstants<double> unilateral{-0.02, 0.03, 0.5};
  /// Numbers of the yield surface; empty: those of the material.
  std::vector<double> yield_slope, cohesion, dilatancy;

  /// S of the steps' gradients G.
  Matrices stress(const Matrices& g) const {
    Arrays a(strain, begin_, g);
    MaterialInput<double> in = a.input(constants_.get());
    material_.trial(in);
    const bool returns = mode_ == TangentMode::kExact || mode_ == TangentMode::kProjected;
    if (material_.return_map != nullptr && returns) {
      yield_slope.empty() ? material_.return_map(in) : material_.return_map_per_particle(in, surface(a));
    }
    if (material_.unilateral_stress != nullptr && mode_ == TangentMode::kUnilateral) {
      material_.unilateral_stress(in, unilateral);
    } else {
      material_.stress(in);
    }
    double* matrix[9];
    for (int k = 0; k < 9; ++k) matrix[k] = a.matrix[k].data();
    kernels_.tangent.pull_back(in.stress, in.gradient, 1.0, matrix, kCount);
    return a.matrices();
  }

  /// dS of a change of G, by the tangent.
  Matrices change(const Matrices& g, const Matrices& dg) const {
    Arrays at(strain, begin_, g), by(strain, begin_, dg);
    MaterialInput<double> in = at.input(constants_.get());
    material_.trial(in);
    std::vector<double> tangent((kCount + kTangentGroup) * kTangentValues, 1e300);
    material_.linearize[static_cast<int>(mode_)](
        {in, yield_slope.empty() ? YieldInput<double>{} : surface(at), unilateral, tangent.data()});
    double* matrix[9];
    const double* gradient[9];
    for (int k = 0; k < 9; ++k) {
      matrix[k] = by.matrix[k].data();
      gradient[k] = by.gradient[k].data();
    }
    kernels_.tangent.apply(tangent.data(), gradient, matrix, kCount);
    return by.matrices();
  }

 private:
  struct Arrays {
    std::array<std::vector<double>, 6> strain, stress;
    std::array<std::vector<double>, 9> gradient, matrix;
    std::vector<double> spare = std::vector<double>(3 * kCount);

    std::vector<std::vector<double>> channels;

    Arrays(const std::vector<std::array<double, 6>>& strains, const std::vector<double>& begin,
           const Matrices& g) {
      for (const double value : begin) channels.emplace_back(kCount, value);
      for (std::size_t k = 0; k < 6; ++k) {
        stress[k].resize(kCount);
        for (const auto& s : strains) strain[k].push_back(s[k]);
      }
      for (std::size_t k = 0; k < 9; ++k) {
        matrix[k].resize(kCount);
        for (const auto& m : g) gradient[k].push_back(m(static_cast<int>(k) / 3, static_cast<int>(k) % 3));
      }
    }
    MaterialInput<double> input(const void* constants) {
      MaterialInput<double> in{};
      in.constants = constants;
      in.dt = 1.0;
      in.count = kCount;
      for (std::size_t k = 0; k < channels.size(); ++k) in.channels[k] = channels[k].data();
      for (std::size_t k = 0; k < 6; ++k) {
        in.strain[k] = strain[k].data();
        in.stress[k] = stress[k].data();
      }
      for (std::size_t k = 0; k < 9; ++k) in.gradient[k] = gradient[k].data();
      return in;
    }
    Matrices matrices() const {
      Matrices all(kCount);
      for (std::size_t p = 0; p < kCount; ++p) {
        for (std::size_t k = 0; k < 9; ++k)
          all[p](static_cast<int>(k) / 3, static_cast<int>(k) % 3) = matrix[k][p];
      }
      return all;
    }
  };
  YieldInput<double> surface(Arrays& a) const {
    return {yield_slope.data(), cohesion.data(),         dilatancy.data(),
            a.spare.data(),     a.spare.data() + kCount, a.spare.data() + 2 * kCount};
  }

  const Kernels<double>& kernels_;
  const MaterialKernels<double>& material_;
  TangentMode mode_;
  std::shared_ptr<const void> constants_;
  std::vector<double> begin_;  // of the channels that the law keeps
};

std::vector<Mat3d> random_matrices(double size, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<Mat3d> all(kCount);
  for (Mat3d& m : all) m = Mat3d::NullaryExpr([&] { return uniform(engine); });
  return all;
}

/// Strains about a mean compression, so that some particles yield, some are inside the cone and some have
/// opened.
std::vector<std::array<double, 6>> random_strains(double size, double mean, unsigned seed) {
  std::mt19937 engine(seed);
  std::uniform_real_distribution<double> uniform(-size, size);
  std::vector<std::array<double, 6>> all(kCount);
  for (auto& strain : all) {
    const double spread = 0.5 + std::abs(uniform(engine)) / size;
    for (std::size_t k = 0; k < 6; ++k)
      strain[k] = spread * uniform(engine) + (k == 0 || k == 3 || k == 5 ? mean : 0.0);
  }
  for (std::size_t k = 0; k < 6; ++k) all[3][k] = 0.0;  // equal stretches
  return all;
}

struct Trial {
  std::string name;
  MaterialParameters material;
  TangentMode mode;
  bool per_particle;
};

/// Every material of the list in every mode; of one with a cone also by numbers per particle.
std::vector<Trial> trials() {
  constexpr const char* kModes[] = {"exact", "projected", "lagged", "unilateral"};
  std::vector<Trial> all;
  const auto add = [&](const MaterialParameters& material) {
    const std::string name = std::visit([](const auto& p) { return std::string(p.kName); }, material) + " ";
    for (int mode = 0; mode < kTangentModes; ++mode) {
      all.push_back({name + kModes[mode], material, static_cast<TangentMode>(mode), false});
      if (cone_of(material) != nullptr && mode < 2)
        all.push_back({name + kModes[mode] + ", per particle", material, static_cast<TangentMode>(mode), true});
    }
  };
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (add(std::variant_alternative_t<k, MaterialParameters>()), ...);
  }
  (std::make_index_sequence<std::variant_size_v<MaterialParameters>>());
  return all;
}

double modulus(const MaterialParameters& material) {
  return std::visit([](const auto& p) { return p.elasticity.lambda() + 2.0 * p.elasticity.mu(); }, material);
}

Stiffness make(const Trial& trial, Target target, double size) {
  Stiffness stiffness(target, trial.material, trial.mode);
  stiffness.strain = random_strains(size, -0.6 * size, 5);
  if (trial.per_particle) {
    std::mt19937 engine(9);
    std::uniform_real_distribution<double> uniform(0.0, 1.0);
    for (std::size_t p = 0; p < kCount; ++p) {
      stiffness.yield_slope.push_back(0.5 + uniform(engine));
      stiffness.cohesion.push_back(0.3 * size * uniform(engine));
      stiffness.dilatancy.push_back(0.3 * uniform(engine));
    }
  }
  return stiffness;
}

std::vector<Mat3d> plus(const std::vector<Mat3d>& a, double scale, const std::vector<Mat3d>& b) {
  std::vector<Mat3d> sum = a;
  for (std::size_t p = 0; p < sum.size(); ++p) sum[p] += scale * b[p];
  return sum;
}

/// Largest difference between the tangent and central differences, over the modulus and the change; particles
/// that pass a corner of the return map within the difference are counted instead.
double worst(const Stiffness& stiffness, double size, double scale, const std::vector<Mat3d>& g, int& corners) {
  const auto dg = random_matrices(1.0, 77);
  const double h = 1e-4 * size;
  const auto ahead = stiffness.stress(plus(g, h, dg)), behind = stiffness.stress(plus(g, -h, dg));
  const auto near_ahead = stiffness.stress(plus(g, 0.5 * h, dg)),
             near_behind = stiffness.stress(plus(g, -0.5 * h, dg));
  const auto change = stiffness.change(g, dg);
  double most = 0.0;
  for (std::size_t p = 0; p < kCount; ++p) {
    const Mat3d coarse = (ahead[p] - behind[p]) / (2.0 * h), fine = (near_ahead[p] - near_behind[p]) / h;
    const Mat3d measured = (4.0 * fine - coarse) / 3.0;  // Richardson: the error is of fourth order
    if ((coarse - fine).norm() > 1e-6 * scale) {
      ++corners;
      continue;
    }
    most = std::max(most, (change[p] - measured).norm() / scale);
  }
  return most;
}

std::vector<Target> targets() {
  std::vector<Target> all;
  for (const Target target : {Target::kBaseline, Target::kAvx2, Target::kAvx512}) {
    if (target_supported(target)) all.push_back(target);
  }
  return all;
}

TEST(Stiffness, IsTheDerivativeOfTheStress) {
  for (const Target target : targets()) {
    for (const double size : {0.1, 1e-3}) {
      for (const Trial& trial : trials()) {
        // Of a cone it is a part of the derivative alone.
        if (trial.mode == TangentMode::kProjected && cone_of(trial.material) != nullptr) continue;
        Stiffness stiffness = make(trial, target, size);
        if (size < 0.01) stiffness.unilateral = {-2e-4, 3e-4, 0.5};
        int corners = 0;
        const double error =
            worst(stiffness, size, modulus(trial.material), random_matrices(0.3 * size, 3), corners);
        EXPECT_LT(error, 1e-7) << trial.name << " " << size << " " << target_name(target);
        EXPECT_LE(corners, 6) << trial.name << " " << size;
      }
    }
  }
}

/// Of plain sand: -2 mu bc e/n tr(dL), on the axes of the trial state.
TEST(Stiffness, Projected_LeavesOutOneTerm) {
  const DruckerPragerParameters sand;
  const double mu = sand.elasticity.mu(), yield_slope = sand.yield_slope();
  const auto g = random_matrices(0.02, 3), dg = random_matrices(1.0, 77);
  const Stiffness exact = make({"", sand, TangentMode::kExact, false}, best_target(), 0.1),
                  projected = make({"", sand, TangentMode::kProjected, false}, best_target(), 0.1);
  const auto whole = exact.change(g, dg), part = projected.change(g, dg);
  int yielding = 0;
  for (std::size_t p = 0; p < kCount; ++p) {
    const auto& s = exact.strain[p];
    const Mat3d eps = (Mat3d() << s[0], s[1], s[2], s[1], s[3], s[4], s[2], s[4], s[5]).finished();
    const Eigen::SelfAdjointEigenSolver<Mat3d> before(2.0 * eps);
    const Mat3d b = before.eigenvectors() * before.eigenvalues().array().exp().matrix().asDiagonal() *
                    before.eigenvectors().transpose();
    const Mat3d step = Mat3d::Identity() + g[p];
    const Eigen::SelfAdjointEigenSolver<Mat3d> after(step * b * step.transpose());
    const Eigen::Vector3d trial = 0.5 * after.eigenvalues().array().log();
    const double t = trial.sum();
    const Eigen::Vector3d e = trial.array() - t / 3.0;
    const bool yields = t < 0.0 && e.norm() + yield_slope * t > 0.0;
    Mat3d missing = Mat3d::Zero();
    if (yields) {
      const double opens = (dg[p] * step.inverse()).trace();
      const Mat3d tau = after.eigenvectors() * (-2.0 * mu * yield_slope * opens * e / e.norm()).asDiagonal() *
                        after.eigenvectors().transpose();
      missing = tau * step.inverse().transpose();
      ++yielding;
    }
    EXPECT_LT((whole[p] - part[p] - missing).norm(), 1e-9 * modulus(sand)) << p << (yields ? " yields" : "");
  }
  EXPECT_GT(yielding, 10);
  EXPECT_LT(yielding, 55);
}

/// Largest |<a, dS b> - <b, dS a>| over their size.
double asymmetry(const Stiffness& stiffness, const std::vector<Mat3d>& g) {
  const auto a = random_matrices(1.0, 21), b = random_matrices(1.0, 22);
  const auto of_a = stiffness.change(g, a), of_b = stiffness.change(g, b);
  double most = 0.0;
  for (std::size_t p = 0; p < kCount; ++p) {
    const double one = a[p].cwiseProduct(of_b[p]).sum(), other = b[p].cwiseProduct(of_a[p]).sum();
    most = std::max(most, std::abs(one - other) / std::max(of_a[p].norm() * b[p].norm(), 1e-300));
  }
  return most;
}

TEST(Stiffness, IsSymmetric_ExceptOfTheExactMode) {
  const auto g = random_matrices(0.03, 3);
  for (const Trial& trial : trials()) {
    const double size = asymmetry(make(trial, best_target(), 0.1), g);
    if (cone_of(trial.material) != nullptr && trial.mode == TangentMode::kExact) {
      EXPECT_GT(size, 0.05) << trial.name;
    } else {
      EXPECT_LT(size, 1e-12) << trial.name;
    }
  }
}

TEST(Stiffness, OfSandThatHasOpened_IsNothing) {
  const DruckerPragerParameters sand;
  Stiffness stiffness(best_target(), sand, TangentMode::kExact);
  stiffness.strain.assign(kCount, {0.01, 0, 0, 0.01, 0, 0.01});
  const auto none = stiffness.change(random_matrices(1e-3, 1), random_matrices(1.0, 2));
  for (const Mat3d& change : none) EXPECT_EQ(change.norm(), 0.0);
}

}  // namespace
}  // namespace repose
