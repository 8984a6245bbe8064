// Repose tests: the point of the law at which an implicit step makes its next linear model of a particle.
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <string>

#include "kernels/material/materials.h"
#include "kernels/pass/pass.h"
#include "tests/kernels/samples.h"

namespace repose {
namespace {

using Mat3d = Eigen::Matrix3d;

constexpr std::size_t kCount = 61;  // whole registers and a remainder
constexpr std::size_t kSand = 0;    // of the list of materials
constexpr int kAt[6][2] = {{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}};

struct Sand {
  std::string name;
  DruckerPragerParameters parameters;
  DruckerPragerConstants<double> constants{parameters};
  const MaterialKernels<double>& material;
  std::array<std::vector<double>, 6> strain, stress;
  std::array<std::vector<double>, 9> gradient, predicted, offset;
  std::vector<double> yield_slope, cohesion, dilatancy, spare = std::vector<double>(3 * kCount);

  explicit Sand(Target target) : material(kernels<double>(target).material[kSand]) {
    for (auto& one : strain) one.resize(kCount);
    for (auto& one : stress) one.resize(kCount);
    for (auto* all : {&gradient, &predicted, &offset}) {
      for (auto& one : *all) one.resize(kCount);
    }
  }

  MaterialInput<double> input(std::array<std::vector<double>, 6>& strains) {
    MaterialInput<double> in{};
    in.constants = &constants;
    in.dt = 1.0;
    in.count = kCount;
    for (std::size_t k = 0; k < 6; ++k) {
      in.strain[k] = strains[k].data();
      in.stress[k] = stress[k].data();
    }
    for (std::size_t k = 0; k < 9; ++k) in.gradient[k] = gradient[k].data();
    return in;
  }
  YieldInput<double> surface() {
    if (yield_slope.empty()) return {};
    return {yield_slope.data(), cohesion.data(),       dilatancy.data(),
            spare.data(),       spare.data() + kCount, spare.data() + 2 * kCount};
  }
  std::array<std::vector<double>, 6> returned(std::array<std::vector<double>, 6> strains) {
    yield_slope.empty() ? material.return_map(input(strains))
                        : material.return_map_per_particle(input(strains), surface());
    return strains;
  }

  /// Trial strains of about `size`, inside the cone, beyond it and open.
  void be_strained(double size) {
    Samples samples(5);
    for (std::size_t p = 0; p < kCount; ++p) {
      const double pressed = size * static_cast<double>(static_cast<int>(p % 4) - 1);
      for (std::size_t k = 0; k < 6; ++k)
        strain[k][p] = size * samples.uniform(-1.0, 1.0) - (kAt[k][0] == kAt[k][1] ? pressed : 0.0);
      for (std::size_t k = 0; k < 9; ++k) gradient[k][p] = 0.2 * samples.uniform(-1.0, 1.0);
    }
  }
  Mat3d map(std::size_t p) const {
    Mat3d f = Mat3d::Identity();
    for (int k = 0; k < 9; ++k) f(k / 3, k % 3) += gradient[static_cast<std::size_t>(k)][p];
    return f;
  }
  static Mat3d matrix(const std::array<std::vector<double>, 6>& of, std::size_t p) {
    Mat3d m;
    for (std::size_t k = 0; k < 6; ++k) m(kAt[k][0], kAt[k][1]) = m(kAt[k][1], kAt[k][0]) = of[k][p];
    return m;
  }
  /// Foretells the stress of these elastic strains.
  void foretell(const std::array<std::vector<double>, 6>& elastic) {
    for (std::size_t p = 0; p < kCount; ++p) {
      const Mat3d e = matrix(elastic, p);
      const Mat3d tau =
          2.0 * constants.elastic.mu * e + constants.elastic.lambda * e.trace() * Mat3d::Identity();
      const Mat3d s = tau * map(p).inverse().transpose();
      for (int k = 0; k < 9; ++k) predicted[static_cast<std::size_t>(k)][p] = s(k / 3, k % 3);
    }
  }
  std::array<std::vector<double>, 6> linearization_point() {
    std::array<std::vector<double>, 6> point = strain;
    const double* from[9];
    double* to[9];
    for (std::size_t k = 0; k < 9; ++k) {
      from[k] = predicted[k].data();
      to[k] = offset[k].data();
    }
    material.linearization_point({input(point), surface(), {}, nullptr}, from, to);
    return point;
  }
};

/// On all instruction sets, yielding by the numbers of the material and by numbers of their own.
std::vector<Sand> all_sands() {
  std::vector<Sand> all;
  for (const Target target : supported_targets()) {
    for (const bool per_particle : {false, true}) {
      Sand& sand = all.emplace_back(target);
      sand.name = std::string(target_name(target)) + (per_particle ? ", per particle" : "");
      sand.be_strained(1e-4);
      if (!per_particle) continue;
      sand.yield_slope.assign(kCount, 0.8);
      sand.cohesion.assign(kCount, 3e-5);
      sand.dilatancy.assign(kCount, 0.0);
    }
  }
  return all;
}

double largest(const std::array<std::vector<double>, 6>& a, const std::array<std::vector<double>, 6>& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < 6; ++k) {
    for (std::size_t p = 0; p < kCount; ++p) most = std::max(most, std::abs(a[k][p] - b[k][p]));
  }
  return most;
}

// Nothing to reconcile: the model is made at the trial state, by whatever numbers sand yields.
TEST(Resolve, WhereTheStressForetoldIsThatOfTheLaw_IsTheTrialState) {
  for (Sand sand : all_sands()) {
    sand.foretell(sand.returned(sand.strain));
    EXPECT_LT(largest(sand.linearization_point(), sand.strain), 1e-15) << sand.name;
    for (const auto& one : sand.offset) {
      for (const double number : one) EXPECT_LT(std::abs(number), 1e-15);
    }
  }
}

// Z(eps') + theta eps' = e + theta eps, and the offset is what leads from eps' to eps.
TEST(Resolve, OfAnyStress_IsThePointOfTheLawBetweenThatAndTheTrialState) {
  for (Sand sand : all_sands()) {
    std::array<std::vector<double>, 6> elastic = sand.strain;  // of another particle
    for (auto& one : elastic) std::rotate(one.begin(), one.begin() + 7, one.end());
    sand.foretell(elastic);
    const auto point = sand.linearization_point();
    const auto back = sand.returned(point);
    int moved = 0;
    for (std::size_t p = 0; p < kCount; ++p) {
      const Mat3d eps = Sand::matrix(sand.strain, p), at = Sand::matrix(point, p);
      const Mat3d sum = Sand::matrix(back, p) + kTrialWeight * at;
      EXPECT_LT((sum - Sand::matrix(elastic, p) - kTrialWeight * eps).norm(), 1e-15) << sand.name << " " << p;
      Mat3d offset;
      for (int k = 0; k < 9; ++k) offset(k / 3, k % 3) = sand.offset[static_cast<std::size_t>(k)][p];
      EXPECT_LT((offset - (eps - at) * sand.map(p)).norm(), 1e-15);
      moved += (at - eps).norm() > 1e-5;
    }
    EXPECT_GT(moved, 40);
  }
}

// What a model far off foretells must not overflow: strains have a length of one at most.
TEST(Resolve, OfAStressFarOff_StaysWhereStrainsHaveExponentials) {
  Sand sand(best_target());
  sand.be_strained(1e-4);
  std::array<std::vector<double>, 6> elastic = sand.strain;
  for (auto& one : elastic) {
    std::rotate(one.begin(), one.begin() + 7, one.end());
    for (double& number : one) number *= 1e7;
  }
  sand.foretell(elastic);
  const auto point = sand.linearization_point();
  for (std::size_t p = 0; p < kCount; ++p) {
    const double length = Sand::matrix(point, p).norm();
    EXPECT_LT(length, 1.0 + 1e-12);
    EXPECT_GT(length, 0.99);
  }
}

}  // namespace
}  // namespace repose
