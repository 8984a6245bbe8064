// Repose tests: particles to nodes, on every instruction set, against the reference.
#include <gtest/gtest.h>

#include "tests/kernels/transfer_reference.h"

namespace repose {
namespace {

template <class Real>
class Scatter : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Scatter, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-12;

constexpr std::size_t kCounts[] = {0, 1, 7, 16, 17, 255, 256};

template <class Real>
struct Scattered {
  std::vector<Real> arena = std::vector<Real>(kArenaValues, Real(0));
  Reach reach;
};

template <class Real>
Scattered<Real> scatter(Target target, Particles<Real>& particles, const TransferCase& transfer) {
  Scattered<Real> result;
  const auto in = particles.scatter_input(transfer);
  result.reach.runs = kernels<Real>(target).transfer[0][0].scatter(in, result.arena.data(), result.reach.rows);
  EXPECT_TRUE(particles.canaries_alive()) << target_name(target);
  return result;
}

/// Compares masses and momenta, each to its largest.
void expect_near(const NodeValues& nodes, const NodeValues& expected, double tolerance,
                 const std::string& what) {
  const double scale[2] = {tolerance * expected.largest(false), tolerance * expected.largest(true)};
  for (int node = 0; node < kArenaSide * kArenaSide * kArenaSide; ++node) {
    const int x = node / 64 - 1, y = node / 8 % 8 - 1, z = node % 8 - 1;
    for (int value = 0; value < kNodeValues; ++value) {
      ASSERT_NEAR(nodes.at(x, y, z)[value], expected.at(x, y, z)[value], scale[value != 0])
          << what << ", node " << x << ' ' << y << ' ' << z << ", value " << value;
    }
  }
}

TYPED_TEST(Scatter, RandomParticles_EveryCountAndOrder_MatchTheReference) {
  const TransferCase transfer;
  for (const Order order : {Order::kRuns, Order::kScattered}) {
    for (const std::size_t count : kCounts) {
      auto particles = random_particles<TypeParam>(count, order, 100 + count);
      const NodeValues expected = reference_scatter(particles, transfer);
      const Reach reach = reach_of(particles);
      for (const Target target : supported_targets()) {
        const auto result = scatter(target, particles, transfer);
        const std::string what = std::string(target_name(target)) + ", " + std::to_string(count) + " particles";
        expect_near(values_of(result.arena), expected, kTolerance<TypeParam>, what);
        EXPECT_EQ(result.reach.rows, reach.rows) << what;
        EXPECT_EQ(result.reach.runs, reach.runs) << what;
      }
    }
  }
}

TYPED_TEST(Scatter, FlatAxis_EveryAxis_MatchesTheReference) {
  for (const int axis : {0, 1, 2}) {
    TransferCase transfer;
    transfer.flat_axis = axis;
    auto particles = random_particles<TypeParam>(101, Order::kScattered, 110);
    const NodeValues expected = reference_scatter(particles, transfer);
    const Reach reach = reach_of(particles);
    for (const Target target : supported_targets()) {
      const auto result = scatter(target, particles, transfer);
      const std::string what = std::string(target_name(target)) + ", axis " + std::to_string(axis);
      expect_near(values_of(result.arena), expected, kTolerance<TypeParam>, what);
      EXPECT_EQ(result.reach.rows, reach.rows) << what;
    }
  }
}

/// Where a particle changes its nodes, and one number below and above.
TYPED_TEST(Scatter, OnCellFaces_WithinAnUlp_MatchTheReference) {
  std::vector<TypeParam> places;
  for (int face = -1; face <= 5; ++face) {
    const TypeParam x = static_cast<TypeParam>(face + 0.5);
    for (const TypeParam place : {std::nextafter(x, TypeParam(-9)), x, std::nextafter(x, TypeParam(9))}) {
      if (place >= TypeParam(-0.5) && place < TypeParam(5.5)) places.push_back(place);
    }
  }
  const TransferCase transfer;
  auto particles = random_particles<TypeParam>(places.size() * places.size(), Order::kScattered, 120);
  for (std::size_t p = 0; p < particles.count; ++p) {
    particles.position[0][p] = places[p % places.size()];
    particles.position[1][p] = places[p / places.size()];
    particles.position[2][p] = places[(p * 7 + p / places.size()) % places.size()];
  }
  const NodeValues expected = reference_scatter(particles, transfer);
  const Reach reach = reach_of(particles);
  for (const Target target : supported_targets()) {
    const auto result = scatter(target, particles, transfer);
    expect_near(values_of(result.arena), expected, kTolerance<TypeParam>, target_name(target));
    EXPECT_EQ(result.reach.rows, reach.rows) << target_name(target);
    EXPECT_EQ(result.reach.runs, reach.runs) << target_name(target);
  }
}

TYPED_TEST(Scatter, UsedArena_IsAddedTo_AndOtherRowsAreLeftAlone) {
  const TransferCase transfer;
  auto particles = random_particles<TypeParam>(3, Order::kScattered, 130);
  const auto reach = reach_of(particles);
  for (const Target target : supported_targets()) {
    const auto fresh = scatter(target, particles, transfer);
    std::vector<TypeParam> arena(kArenaValues, TypeParam(1));
    std::uint64_t rows = std::uint64_t{1} << 63;
    const auto in = particles.scatter_input(transfer);
    kernels<TypeParam>(target).transfer[0][0].scatter(in, arena.data(), rows);
    EXPECT_EQ(rows, reach.rows | std::uint64_t{1} << 63) << target_name(target);
    for (int k = 0; k < kArenaSide * kArenaSide * kArenaRow; ++k) {
      const bool touched = (reach.rows >> (k / kArenaRow) & 1) != 0;
      const double expected = touched ? 1.0 + double{fresh.arena[k]} : 1.0;
      const double rounding = touched ? 4.0 * std::numeric_limits<TypeParam>::epsilon() : 0.0;
      ASSERT_NEAR(arena[k], expected, rounding) << target_name(target) << ' ' << k;
    }
  }
}

TYPED_TEST(Scatter, RandomParticles_MassAndMomentum_AreTheirSums) {
  const TransferCase transfer;
  auto particles = random_particles<TypeParam>(256, Order::kScattered, 140);
  for (const Target target : supported_targets()) {
    const NodeValues nodes = values_of(scatter(target, particles, transfer).arena);
    double sum[kNodeValues] = {};
    for (int k = 0; k < kArenaSide * kArenaSide * kArenaSide * kNodeValues; ++k) {
      sum[k % kNodeValues] += (&nodes.value[0][0][0][0])[k];
    }
    const double mass = transfer.mass * static_cast<double>(particles.count);
    EXPECT_NEAR(sum[0], mass, kTolerance<TypeParam> * mass) << target_name(target);
    for (int axis = 0; axis < 3; ++axis) {
      double momentum = 0;
      for (std::size_t p = 0; p < particles.count; ++p) momentum += transfer.mass * particles.velocity[axis][p];
      EXPECT_NEAR(sum[1 + axis], momentum, kTolerance<TypeParam> * mass) << target_name(target);
    }
  }
}

/// Stresses alone: the forces of each particle sum to nothing and turn nothing, for tau is symmetric.
TYPED_TEST(Scatter, StressAlone_NoNetForceNoTorque) {
  const TransferCase transfer;
  auto particles = random_particles<TypeParam>(101, Order::kScattered, 150);
  for (auto* channels : {particles.velocity, particles.affine}) {
    for (int k = 0; k < (channels == particles.velocity ? 3 : 9); ++k) {
      std::fill_n(channels[k].begin(), particles.count, TypeParam(0));
    }
  }
  for (const Target target : supported_targets()) {
    const NodeValues nodes = values_of(scatter(target, particles, transfer).arena);
    double force[3] = {}, torque[3] = {}, scale = 0;
    for (int node = 0; node < kArenaSide * kArenaSide * kArenaSide; ++node) {
      const int x[3] = {node / 64 - 1, node / 8 % 8 - 1, node % 8 - 1};
      const double* f = nodes.at(x[0], x[1], x[2]) + 1;
      for (int k = 0; k < 3; ++k) {
        const int a = (k + 1) % 3, b = (k + 2) % 3;
        force[k] += f[k];
        torque[k] += x[a] * f[b] - x[b] * f[a];
        scale += std::fabs(f[k]);
      }
    }
    EXPECT_GT(scale, 0.0) << target_name(target);
    for (int k = 0; k < 3; ++k) {
      EXPECT_NEAR(force[k], 0, kTolerance<TypeParam> * scale) << target_name(target);
      EXPECT_NEAR(torque[k], 0, kTolerance<TypeParam> * scale) << target_name(target);
    }
  }
}

}  // namespace
}  // namespace repose
