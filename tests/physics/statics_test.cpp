// Repose tests: a confined elastic column under its own weight, against the exact solution for Hencky strain:
// with k(X) = rho g (H - X)/M and M = lambda + 2 mu, the Kirchhoff stress M ln s over s carries the weight
// above, so the stretch is s(X) = exp(-W(k)) with Lambert's W. Linear elasticity sinks 4.5 % more at the height
// of 1 m.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "tests/physics/physics_probe.h"

namespace repose {
namespace {

constexpr double kDensity = 2200.0, kModulus = 476134.615384615, kGravity = 9.81, kHeight = 1.0;

/// Plane strain, repeating in x: nothing can move but up and down. Gravity grows over two periods 4 H / c of
/// the column, after which it hardly rings.
constexpr const char* kColumn = R"json({"repose": 1, "name": "elastic_column",
  "parameters": {"dx": 0.03125, "period": 0.271900},
  "grid": {"spacing": "= dx", "plane_strain": "z",
           "periodic": {"x": {"lower": 0, "length": "= 8 * dx"}}},
  "materials": {"gel": {"type": "elastic", "density": 2200, "youngs_modulus": 3.537e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "column", "material": "gel", "particles_per_cell": 16,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": ["= 8 * dx", 1, 1]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}}],
  "gravity": {"ramp": "= 2 * period"}})json";

/// W(k), k > -1/e, by Newton's method.
double lambert(double k) {
  double w = std::log1p(k);
  for (int i = 0; i < 20; ++i) w -= (w * std::exp(w) - k) / (std::exp(w) * (1.0 + w));
  return w;
}

/// Displacement of the point that lay at height X, by Simpson's rule.
double exact_displacement(double height, double gravity) {
  const auto strain = [&](double x) {
    return std::exp(-lambert(kDensity * gravity * (kHeight - x) / kModulus)) - 1.0;
  };
  constexpr int kPieces = 200;
  const double h = height / kPieces;
  double sum = 0.0;
  for (int k = 0; k < kPieces; ++k) {
    sum += h / 6.0 * (strain(k * h) + 4.0 * strain((k + 0.5) * h) + strain((k + 1) * h));
  }
  return sum;
}

/// Relative error of how far the topmost eighth sinks, averaged over a period after the ramp.
double sinking_error(int cells, double assumed_gravity, int particles_per_cell = 16) {
  constexpr double kPeriod = 0.2719;
  const auto simulation =
      simulate(scene_of(kColumn, {"parameters.dx=" + std::to_string(1.0 / cells),
                                  "bodies.column.particles_per_cell=" + std::to_string(particles_per_cell)}),
               1);
  const PointCloud start = simulation->points();
  EXPECT_TRUE(run_until(*simulation, 2.0 * kPeriod));
  double sum = 0.0, exact = 0.0;
  while (simulation->counters().time < 3.0 * kPeriod && run_steps(*simulation, 10)) {
    const PointCloud now = simulation->points();
    for (std::size_t p = 0; p < now.size(); ++p) {
      const double height = start.position[p][1];
      if (height < 0.875 * kHeight) continue;
      sum += now.position[p][1] - height;
      exact += exact_displacement(height, assumed_gravity);
    }
  }
  return sum / exact - 1.0;
}

TEST(ElasticColumn, ExactSolution_AgreesWithPublishedNumber) {
  EXPECT_NEAR(exact_displacement(1.0, kGravity), -2.1694473e-2, 1e-8);
}

TEST(ElasticColumn, ConfinedUnderOwnWeight_SinksAsHenckySays) {
  std::map<int, double> error;
  for (const int cells : {16, 32, 64}) {
    error[cells] = sinking_error(cells, kGravity);
    report("elastic_column_error_" + std::to_string(cells) + "_cells", error[cells]);
  }
  EXPECT_LT(std::abs(error[32]), 0.03);
  EXPECT_LT(std::abs(error[64]), 0.015);
  EXPECT_LT(std::abs(error[64]), std::abs(error[16])) << "finer is closer";
}

TEST(ElasticColumn, FourParticlesPerCell_IsSofterByFewPercent) {
  // Random places are a poor rule of quadrature: this error falls with particles per cell and not with cells.
  for (const int cells : {32, 64}) {
    const double error = sinking_error(cells, kGravity, 4);
    report("elastic_column_error_4_per_cell_" + std::to_string(cells) + "_cells", error);
    EXPECT_LT(std::abs(error), 0.06);
  }
}

TEST(ElasticColumn, WrongWeight_IsRejected) {
  EXPECT_GT(std::abs(sinking_error(32, 1.05 * kGravity)), 0.03);
}

}  // namespace
}  // namespace repose
