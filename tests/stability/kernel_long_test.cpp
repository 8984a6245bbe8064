// Repose tests: the cases of the battery that go over many samples, with a million.
#include <gtest/gtest.h>

#include "tests/stability/kernel_cases.h"

namespace repose::battery {
namespace {

constexpr std::size_t kSamples = 1000000;

TEST(BatteryLong, Case01_WideEigenvalues_Within16Eps) {
  wide_eigenvalues(kSamples);
}

TEST(BatteryLong, Case02_EqualAndMissingValues_Within16Eps) {
  equal_and_missing_values(kSamples);
}

TEST(BatteryLong, Case03_ScaledMatrices_Within16Eps) {
  scaled_matrices(kSamples);
}

TEST(BatteryLong, Case04_KillerMatrices_AreRight) {
  killer_matrices(kSamples);
}

TEST(BatteryLong, Case06_ReturnMapOverADecade_IsOnTheConeAndIdempotent) {
  return_over_a_decade(kSamples);
}

TEST(BatteryLong, Case07_ReturnMapOverSixDecades_IsOnTheConeAndFinite) {
  return_over_six_decades(kSamples);
}

TEST(BatteryLong, Case08_TipOfTheCone_IsContinuous) {
  cone_tip(kSamples);
}

TEST(BatteryLong, Case10_ExtremeSands_AreFinite) {
  extreme_sands(kSamples);
}

TEST(BatteryLong, Case11_TurnedStates_TurnTheResult) {
  turned_states(kSamples);
}

TEST(BatteryLong, Case12_StressAndFlow_HaveAnEnergy) {
  energy_and_work(kSamples);
}

TEST(BatteryLong, Case14_StencilSums_AreOneZeroAndZero) {
  stencil_sums(kSamples);
}

TEST(BatteryLong, Case22_LightNodes_AreNotFasterThanParticles) {
  light_nodes(2000);
}

}  // namespace
}  // namespace repose::battery
