// Repose tests: the tracked specimen, whose trial state is its own: F is the product of all steps, in kernels
// and in the engine, where an implicit step evaluates many trial states and makes one.
#include "tests/kernels/material_rig.h"
#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

using HWY_NAMESPACE::Tracked;

TEST(Tracked, ManySteps_KeepTheProductOfAll) {
  constexpr std::size_t kCount = 37;
  for (const auto& rig : default_rigs<Tracked, double>()) {
    Samples samples(95);
    auto own = rig.initial_own(kCount);
    std::vector<Symmetric<double>> strains(kCount);
    std::vector<ExactMatrix> expected(kCount, ExactMatrix::Identity());
    for (int step = 0; step < 8; ++step) {
      std::vector<Gradient<double>> gradients(kCount);
      for (std::size_t p = 0; p < kCount; ++p) {
        ExactMatrix map = ExactMatrix::Identity();
        for (int k = 0; k < 9; ++k) {
          gradients[p][k] = samples.uniform(-0.2, 0.2);
          map(k / 3, k % 3) += 0.5L * gradients[p][k];
        }
        expected[p] = (map * expected[p]).eval();
      }
      strains = rig.trial(strains, gradients, 0.5, own);
    }
    for (std::size_t p = 0; p < kCount; ++p) {
      for (std::size_t k = 0; k < 9; ++k)
        ASSERT_NEAR(own[k][p], static_cast<double>(expected[p](int(k) / 3, int(k) % 3)), 1e-13) << rig.name();
    }
  }
}

/// Largest |ln det F - tr eps| of the particles of a block that rings, and the largest |tr eps|.
std::array<double, 2> apart(const std::string& integrator) {
  const auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "ring",
    "grid": {"spacing": 0.05, "precision": "double"}, "time": {"max_step": 5e-4},
    "materials": {"gel": {"type": "tracked", "youngs_modulus": 2e5}},
    "bodies": [{"name": "block", "material": "gel", "angular_velocity": [0, 0, 20],
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.2, 0.3, 0.2]}}],
    "gravity": {"acceleration": [0, 0, 0]}})json",
                                            {"time.integrator=" + integrator}));
  EXPECT_TRUE(run_steps(*simulation, 40));
  const PointCloud cloud =
      simulation->points({{OutputAttribute::kElasticStrain, OutputAttribute::kChannels}, false});
  EXPECT_EQ(cloud.attributes.size(), 10u);
  const auto& strain = cloud.attributes[0].values;  // xx yy zz first
  double most = 0.0, size = 0.0;
  for (std::size_t p = 0; p < cloud.size(); ++p) {
    Mat3 f;
    for (std::size_t k = 0; k < 9; ++k)
      f(static_cast<int>(k) / 3, static_cast<int>(k) % 3) = cloud.attributes[1 + k].values[p];
    const double trace = double(strain[6 * p]) + double(strain[6 * p + 1]) + double(strain[6 * p + 2]);
    most = std::max(most, std::abs(std::log(f.determinant()) - trace));
    size = std::max(size, std::abs(trace));
  }
  return {most, size};
}

TEST(Tracked, InBothKindsOfSteps_FIsThatOfTheStrain) {
  for (const char* integrator : {"explicit", "implicit"}) {
    const auto [difference, size] = apart(integrator);
    EXPECT_GT(size, 1e-3) << integrator << ": it is strained";
    EXPECT_LT(difference, 1e-6) << integrator;
  }
}

}  // namespace
}  // namespace repose
