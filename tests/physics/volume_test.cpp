// Repose tests: sand that was thrown apart and falls together again keeps its bulk only with volume correction.
// Without it, every opening leaves a new rest state at the opened volume (Tampubolon et al. 2017,
// section 4.3.4).
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

/// A spinning disc of sand flies apart in a box, then settles; slippery sand on slippery walls lies flat.
constexpr const char* kThrown = R"json({"repose": 1, "name": "thrown",
  "grid": {"spacing": 0.01, "plane_strain": "z"},
  "materials": {"sand": {"type": "drucker_prager", "friction_angle": 10}},
  "bodies": [{"name": "disc", "material": "sand", "angular_velocity": [0, 0, 12],
              "shape": {"type": "sphere", "center": [0.2, 0.25, 0], "radius": 0.1}}],
  "colliders": [
    {"name": "box", "hollow": true, "contact": "separating",
     "shape": {"type": "box", "lower": [0, 0, -10], "upper": [0.4, 2, 10]}}]})json";

/// Volume of the bed over the volume of the disc: twice the height of the centre of mass, over the level that
/// the disc would fill.
double bulking(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kThrown, overrides));
  EXPECT_TRUE(run_until(*simulation, 2.0));
  constexpr double kLevel = 3.14159265 * 0.1 * 0.1 / 0.4;
  return 2.0 * simulation->diagnose().center_of_mass[1] / kLevel;
}

TEST(VolumeCorrection, ThrownSand_GainsLessVolumeThanWithout) {
  const double without = bulking({}), with = bulking({"volume_correction={}"});
  report("bulking_without_volume_correction", without);
  report("bulking_with_volume_correction", with);
  EXPECT_GT(without, 1.5) << "the artefact that the effect is there for";
  EXPECT_LT(with - 1.0, 0.25 * (without - 1.0));
}

TEST(VolumeCorrection, SandLaidDownGently_GainsNoVolumeToCorrect) {
  // The measure itself: what was never thrown apart lies as it was seeded, with the effect or without.
  const std::vector<std::string> gently = {"bodies.disc.angular_velocity=[0,0,0]",
                                           "bodies.disc.shape.center=[0.2,0.1,0]"};
  std::vector<std::string> corrected = gently;
  corrected.push_back("volume_correction={}");
  const double without = bulking(gently), with = bulking(corrected);
  report("bulking_laid_down_without", without);
  report("bulking_laid_down_with", with);
  EXPECT_NEAR(without, 1.0, 0.06);
  EXPECT_NEAR(with, 1.0, 0.06);
}

}  // namespace
}  // namespace repose
