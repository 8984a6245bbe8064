// Repose tests: what effects make of an element: each acts by the passes of a step, or is refused by its name,
// or is no part of a material.
#include <gmock/gmock.h>

#include "engine/effect/hardening.h"
#include "tests/element/element_test_rig.h"

namespace repose {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

constexpr double kPressure = 1e3;

double channel(const Element& element, const ElementState& state, const std::string& name) {
  for (std::size_t k = 0; k < element.channels().size(); ++k) {
    if (element.channels()[k] == name) return state.channels[k];
  }
  ADD_FAILURE() << "no channel " << name;
  return std::nan("");
}

/// J of sand that has not opened: cohesion is one of Kirchhoff's stress, J times Cauchy's.
double change_of_volume(const ElementState& state) {
  return std::exp(state.elastic[0] + state.elastic[3] + state.elastic[5]);
}

TEST(ElementCohesion, TriaxialCompression_HasMohrAndCoulombsStrength) {
  const double c = 500.0, sine = 0.5, kp = (1.0 + sine) / (1.0 - sine);
  const Path path = triaxial_path(kPressure, {0.01, 200, 1.0}, false);
  const ElementState end = driven(sand_scene(", \"cohesion\": {\"strength\": 500}"), path).back();
  const double expected = kp * kPressure + 2.0 * c / change_of_volume(end) * std::sqrt(kp);
  EXPECT_NEAR(axial(end), expected, 1e-6 * expected);
  EXPECT_LT(axial(driven(sand_scene(), path).back()), 0.9 * expected) << "the control";
}

TEST(ElementCohesion, WithoutPressureFromTheSides_StandsByItself) {
  const double c = 500.0, kp = 3.0;
  const Path path = triaxial_path(0.0, {0.01, 200, 1.0}, false);
  const ElementState end = driven(sand_scene(", \"cohesion\": {\"strength\": 500}"), path).back();
  EXPECT_NEAR(axial(end), 2.0 * c / change_of_volume(end) * std::sqrt(kp), 1e-6 * axial(end));
  EXPECT_NEAR(axial(driven(sand_scene(), path).back()), 0.0, 1e-6) << "the control: dry sand bears none";
}

TEST(ElementDilatancy, OnTheCone_OpensByItsAngle) {
  Element element = element_of(sand_scene(R"(, "dilatancy": {"angle": 10, "limit": 1000})"));
  const auto states = driven(element, triaxial_path(kPressure, {0.02, 1000, 1.0}, false));
  const ElementState &from = states[500], &to = states.back();
  const double slope = (to.volumetric - from.volumetric) / (to.deviatoric - from.deviatoric);
  // With constant stress all strain is plastic: d eps_v / d eps_q = 6 sin(psi) / (3 - sin(psi)); eps_q is the
  // deviatoric strain, not counting what opens.
  const double sine = std::sin(10.0 / kDegrees);
  EXPECT_NEAR(slope, 6.0 * sine / (3.0 - sine), 1e-3 * slope);
  const auto plain = driven(sand_scene(), triaxial_path(kPressure, {0.02, 1000, 1.0}, false));
  EXPECT_NEAR(plain.back().volumetric, plain[500].volumetric, 1e-10) << "the control: without it, none";
}

TEST(ElementHardening, StressRatio_FollowsTheAngleOfItsShear) {
  Element element = element_of(sand_scene(R"(, "hardening": {"h0": 35, "h1": 9, "h2": 0.2, "h3": 10})"));
  const auto states = driven(element, triaxial_path(kPressure, {0.5, 5000, 1.0}, false));
  const HardeningParameters law;
  for (std::size_t k = 1000; k < states.size(); k += 500) {
    const double angle = law.angle(channel(element, states[k], "plastic_shear"));
    const double expected = ratio_of(slope_of("triaxial_compression", angle));
    EXPECT_NEAR(states[k].q() / states[k].p(), expected, 1e-3 * expected) << k;
  }
  EXPECT_GT(states.back().q() / states.back().p(), 1.05 * ratio_of(slope_of("triaxial_compression", 25.0)))
      << "the control: it has hardened";
}

TEST(ElementRateFriction, SimpleShear_FollowsMuOfI) {
  const double d = 1e-3, grains = 2500.0, rise = 0.26, threshold = 0.279;
  for (const double rate : {1.0, 30.0}) {
    const ElementState end = driven(sand_scene(R"(, "rate_friction": {"rise": 0.26, "threshold": 0.279,
                                                  "grain_diameter": 1e-3, "grain_density": 2500})"),
                                    simple_shear_path(1e2, {0.05, 2000, rate}, false))
                                 .back();
    const double inertial = rate * d / std::sqrt(end.p() / grains);
    const double still = 3.0 / std::sqrt(2.0) * slope_of("triaxial_compression", 30.0);
    const double expected = still + rise / (1.0 + threshold / inertial);
    EXPECT_NEAR(end.stress[2] / end.p(), expected, 2e-3 * expected) << rate;
    if (rate > 10.0) {
      EXPECT_GT(expected, 1.05 * still) << "the control";
    }
  }
}

TEST(ElementMoisture, Saturation_AddsItsCohesion) {
  const Path path = triaxial_path(kPressure, {0.01, 200, 1.0}, false);
  const double wet =
      axial(driven(sand_scene(R"(, "moisture": {"initial": 0.5, "cohesion_change": 1000})"), path).back());
  const double cohesive = axial(driven(sand_scene(R"(, "cohesion": {"strength": 500})"), path).back());
  EXPECT_NEAR(wet, cohesive, 1e-6 * cohesive);
}

TEST(ElementPlasticStrain, TriaxialCompression_IsTheAxialStrainOfFlow) {
  Element element = element_of(sand_scene("", ", \"plastic_strain\": {}"));
  const auto states = driven(element, triaxial_path(kPressure, {0.02, 1000, 1.0}, false));
  const ElementState &from = states[500], &to = states.back();
  const double grown =
      channel(element, to, "equivalent_plastic_strain") - channel(element, from, "equivalent_plastic_strain");
  EXPECT_NEAR(grown, from.strain[5] - to.strain[5], 1e-6);
}

/// The message by which an element of a scene is refused.
std::string refusal(const Scene& scene, const std::string& material = "") {
  std::vector<std::string> left_out;
  const auto element = element_scene(scene, material, left_out);
  return element ? "" : element.error().text();
}

TEST(ElementScene, WhatGoesByPlace_IsRefusedByName) {
  EXPECT_THAT(refusal(sand_scene(R"(, "variation": {"friction": 0.1})")),
              HasSubstr("\"materials.sand.variation\" changes sand by its place or its neighbours"));
  EXPECT_THAT(refusal(sand_scene("", R"(, "density_correction": {})")),
              HasSubstr("\"density_correction\" changes"));
  EXPECT_THAT(refusal(sand_scene(R"(, "moisture": {"cohesion_change": 100})",
                                 R"(, "wetting": [{"name": "rain", "shape": {"type": "plane"}}])")),
              HasSubstr("\"wetting\" changes moisture by place"));
  EXPECT_EQ(refusal(sand_scene(R"(, "moisture": {"cohesion_change": 100}, "cohesion": {}, "hardening": {},
                                  "dilatancy": {}, "rate_friction": {})",
                               R"(, "volume_correction": {}, "plastic_strain": {})")),
            "");
}

TEST(ElementScene, WhatIsNoMatterOfAMaterial_IsNamed) {
  std::vector<std::string> left_out;
  const Scene scene =
      sand_scene(R"(, "hardening": {})", R"(, "colliders": [{"name": "floor", "shape": {"type": "plane"}}])");
  ASSERT_TRUE(element_scene(scene, "sand", left_out));
  EXPECT_THAT(left_out, Contains("collider"));
  EXPECT_THAT(left_out, Contains("gravity"));
  EXPECT_THAT(left_out, Not(Contains("hardening")));
}

TEST(ElementScene, MaterialThatIsNotThere_IsRefusedWithThoseThatAre) {
  EXPECT_THAT(refusal(sand_scene(), "sant"), HasSubstr("no material \"sant\"; did you mean \"sand\"?"));
  Scene two = sand_scene();
  two.materials.push_back(two.materials[0]);
  two.materials[1].name = "gravel";
  EXPECT_THAT(refusal(two), HasSubstr("the scene has 2 materials; choose among \"sand\", \"gravel\""));
  EXPECT_EQ(refusal(two, "gravel"), "");
}

}  // namespace
}  // namespace repose
