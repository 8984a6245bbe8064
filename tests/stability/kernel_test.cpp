// Repose tests: the cases of the battery that go over many samples, with some ten thousand.
#include <gtest/gtest.h>

#include "tests/stability/kernel_cases.h"

namespace repose::battery {
namespace {

constexpr std::size_t kSamples = 50021;

TEST(Battery, Case01_WideEigenvalues_Within16Eps) {
  wide_eigenvalues(kSamples);
}

TEST(Battery, Case02_EqualAndMissingValues_Within16Eps) {
  equal_and_missing_values(kSamples);
}

TEST(Battery, Case03_ScaledMatrices_Within16Eps) {
  scaled_matrices(kSamples);
}

TEST(Battery, Case03_SubnormalMatrices_StayBelowTheSmallestNumber) {
  subnormal_matrices(kSamples);
}

TEST(Battery, Case04_KillerMatrices_AreRight) {
  killer_matrices(kSamples);
}

TEST(Battery, Case06_ReturnMapOverADecade_IsOnTheConeAndIdempotent) {
  return_over_a_decade(kSamples);
}

TEST(Battery, Case07_ReturnMapOverSixDecades_IsOnTheConeAndFinite) {
  return_over_six_decades(kSamples);
}

TEST(Battery, Case08_TipOfTheCone_IsContinuous) {
  cone_tip(kSamples);
}

TEST(Battery, Case10_ExtremeSands_AreFinite) {
  extreme_sands(kSamples / 4);
}

TEST(Battery, Case11_TurnedStates_TurnTheResult) {
  turned_states(kSamples);
}

TEST(Battery, Case12_StressAndFlow_HaveAnEnergy) {
  energy_and_work(kSamples / 4);
}

TEST(Battery, Case14_StencilSums_AreOneZeroAndZero) {
  stencil_sums(kSamples / 2);
}

TEST(Battery, Case22_LightNodes_AreNotFasterThanParticles) {
  light_nodes(40);
}

}  // namespace
}  // namespace repose::battery
