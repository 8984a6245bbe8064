// Repose tests: how much sand has flowed: the sum of its plastic increments, on one element and on a run; and
// the rate of shear of points, where it is known.
#include <algorithm>

#include "engine/state/difference.h"
#include "tests/physics/strained_box.h"

namespace repose {
namespace {

const char* const kKey = "\"plastic_strain\": {}";
constexpr const char* kChannel = "equivalent_plastic_strain";

TEST(PlasticStrain, ConstantVolumeShear_GrowsByTheRateOverRootThree) {
  StrainedBox element("", kKey);
  element.compress(1e-3);
  const double rate = 2.0, dt = 1e-5;
  while (element.channel(kChannel) == 0.0) element.shear(rate, dt);
  for (int step = 0; step < 200; ++step) element.shear(rate, dt);  // until stresses are those of steady flow
  const double before = element.channel(kChannel);
  constexpr int kSteps = 1000;
  for (int step = 0; step < kSteps; ++step) element.shear(rate, dt);
  // All of the rate of strain is plastic then: sqrt(2/3) |dev D| = rate / sqrt(3).
  const double slope = (element.channel(kChannel) - before) / (kSteps * dt);
  report("slope", slope * std::sqrt(3.0) / rate);
  EXPECT_NEAR(slope, rate / std::sqrt(3.0), 1e-3 * rate);
}

TEST(PlasticStrain, ElasticElement_HasNone) {
  StrainedBox element("", kKey);
  element.compress(1e-3);
  for (int step = 0; step < 10; ++step) element.shear(1.0, 1e-6);
  EXPECT_EQ(element.channel(kChannel), 0.0);
}

TEST(PlasticStrain, VolumeCorrectionAndTheTip_CountNoChangeOfVolume) {
  StrainedBox element("", "\"volume_correction\": {}, " + std::string(kKey));
  element.compress(1e-3);
  const double out = 1.0, dt = 1e-3;
  for (const double sign : {1.0, -1.0}) {  // it opens, and closes again
    for (int step = 0; step < 20; ++step)
      element.step({sign * out, 0, 0, 0, sign * out, 0, 0, 0, sign * out}, dt);
  }
  EXPECT_LT(element.trace(), 0.0);
  EXPECT_NEAR(element.channel(kChannel), 0.0, 1e-12);
  element.step({1.0, 0, 0, 0, -1.0, 0, 0, 0, 0}, 0.1);  // the control: it does count shear
  EXPECT_GT(element.channel(kChannel), 1e-2);
}

Scene column(const std::vector<std::string>& overrides = {}) {
  return scene_of(R"json({"repose": 1, "name": "column", "grid": {"spacing": 0.05},
    "materials": {"sand": {"type": "drucker_prager"}, "rubber": {"type": "elastic", "youngs_modulus": 1e6}},
    "bodies": [{"name": "sand", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.4, 0.6, 0.4]}},
               {"name": "ball", "material": "rubber",
                "shape": {"type": "box", "lower": [0.1, 0.7, 0.1], "upper": [0.3, 0.9, 0.3]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.4}]})json",
                  overrides);
}

TEST(PlasticStrain, Measured_ChangesNoOtherBit) {
  auto with = simulate(column({"plastic_strain={}"})), without = simulate(column());
  ASSERT_TRUE(run_steps(*with, 300) && run_steps(*without, 300));
  const auto a = with->channel_hashes(), b = without->channel_hashes();
  EXPECT_EQ(a.size(), b.size() + 1) << "one number for each particle of sand, none for rubber";
  for (const ChannelHash& channel : b) {
    EXPECT_TRUE(std::any_of(a.begin(), a.end(), [&](const ChannelHash& other) {
      return other.channel == channel.channel && other.hash == channel.hash;
    })) << channel.channel;
  }
  const PointCloud points = with->points({{OutputAttribute::kPlasticStrain}});
  const auto& values = points.attributes.back().values;
  EXPECT_GT(*std::max_element(values.begin(), values.end()), 1e-3f);
}

TEST(PlasticStrain, ImplicitSteps_ComeToWhatExplicitOnesComeTo) {
  double most[2];
  for (const bool implicit : {false, true}) {
    auto simulation = simulate(
        column({"plastic_strain={}", "grid.precision=double",
                implicit ? "time.integrator=implicit" : "time.integrator=explicit", "time.max_step=5e-4"}));
    ASSERT_TRUE(run_until(*simulation, 0.1));
    double sum = 0.0;
    const PointCloud points = simulation->points({{OutputAttribute::kPlasticStrain}});
    for (const float value : points.attributes.back().values) sum += value;
    most[implicit] = sum / static_cast<double>(simulation->particles());
  }
  report("mean, explicit", most[0]);
  report("mean, implicit", most[1]);
  EXPECT_NEAR(most[1], most[0], 0.1 * most[0]);
}

/// A block of rubber in free flight that turns, or is sheared as a whole at first.
std::vector<float> rates_of(const std::string& more) {
  auto simulation = simulate(scene_of(R"json({"repose": 1, "name": "block",
    "grid": {"spacing": 0.05, "precision": "double"},
    "gravity": {"acceleration": [0, 0, 0]}, "materials": {"rubber": {"type": "elastic"}},
    "bodies": [{"name": "block", "material": "rubber", "shape": {"type": "box", "lower": [0, 0, 0],
                "upper": [0.4, 0.4, 0.4]}, )json" +
                                      more + "}]}"));
  EXPECT_TRUE(run_steps(*simulation, 20));
  return simulation->points({{OutputAttribute::kShearRate}}).attributes.back().values;
}

TEST(ShearRate, BlockThatTurns_HasNextToNone) {
  const double spin = 3.0;
  const auto turning = rates_of(R"("angular_velocity": [0, 0, 3])");
  double largest = 0.0;
  for (const float rate : turning) largest = std::max(largest, static_cast<double>(rate));
  report("largest", largest / spin);
  // What is left is what spin stretches a block by. The measure without its deviator's symmetry would be
  // sqrt(2).
  EXPECT_LE(largest, 0.05 * spin);
}

}  // namespace
}  // namespace repose
