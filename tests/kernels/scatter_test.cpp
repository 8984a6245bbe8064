// Repose tests: particles to nodes, with every stencil and transfer on every instruction set, against the
// reference.
#include <gtest/gtest.h>

#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

template <class Real>
class Scatter : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Scatter, Precisions);

constexpr std::size_t kCounts[] = {0, 1, 7, 16, 17, 127, 128};

std::string what(const TransferCase& transfer, Target target, std::size_t count) {
  return transfer.name() + ", " + target_name(target) + ", " + std::to_string(count) + " particles";
}

template <class Real>
struct Scattered {
  Arena<Real> arena = Arena<Real>(kArenaValues, Real(0)), before = arena;
  Touched touched;
};

template <class Real>
Scattered<Real> scatter(Target target, Particles<Real>& particles, const TransferCase& transfer) {
  Scattered<Real> result;
  const auto in = particles.scatter_input(transfer, result.before.data());
  result.touched.segments = transfer.scatter<Real>(target)(in, result.arena.data(), result.touched.rows);
  EXPECT_TRUE(particles.canaries_alive()) << transfer.name() << ", " << target_name(target);
  return result;
}

/// Every instruction set against the reference, in values, rows and segments.
template <class Real>
void expect_reference(Particles<Real>& particles, const TransferCase& transfer) {
  const ScatteredReference<Real> expected(particles, transfer);
  const Touched touched = touched_by(particles, transfer.stencil);
  for (const Target target : supported_targets()) {
    const auto result = scatter(target, particles, transfer);
    const std::string name = what(transfer, target, particles.count);
    expect_near(result.arena, expected.arena, kTransferTolerance<Real>, name);
    expect_near(result.before, expected.before, kTransferTolerance<Real>, name + ", before forces");
    EXPECT_EQ(result.touched.rows, touched.rows) << name;
    EXPECT_EQ(result.touched.segments, touched.segments) << name;
  }
}

TYPED_TEST(Scatter, RandomParticles_EveryCountAndOrder_MatchTheReference) {
  for (const TransferCase& transfer : all_cases()) {
    for (const Order order : {Order::kSegments, Order::kScattered}) {
      for (const std::size_t count : kCounts) {
        auto particles = random_particles<TypeParam>(count, order, 100 + count, transfer.stencil);
        expect_reference(particles, transfer);
      }
    }
  }
}

TYPED_TEST(Scatter, FlatAxis_EveryAxis_MatchesTheReference) {
  for (TransferCase transfer : all_cases()) {
    for (const int axis : {0, 1, 2}) {
      transfer.flat_axis = axis;
      auto particles = random_particles<TypeParam>(101, Order::kScattered, 110, transfer.stencil);
      expect_reference(particles, transfer);
    }
  }
}

/// Where a particle changes its nodes, and one number below and above.
TYPED_TEST(Scatter, OnCellFaces_WithinAnUlp_MatchTheReference) {
  for (const TransferCase& transfer : all_cases()) {
    const TypeParam shift = static_cast<TypeParam>(transfer.nodes().base_shift);
    const TypeParam first = shift + static_cast<TypeParam>(transfer.nodes().lowest_base);
    const TypeParam last = shift + static_cast<TypeParam>(transfer.nodes().highest_base + 1);
    std::vector<TypeParam> places;
    for (TypeParam x = first; x <= last; x += TypeParam(1)) {
      for (const TypeParam place : {std::nextafter(x, TypeParam(-9)), x, std::nextafter(x, TypeParam(9))}) {
        if (place >= first && place < last) places.push_back(place);
      }
    }
    auto particles = random_particles<TypeParam>(places.size() * places.size(), Order::kScattered, 120);
    for (std::size_t p = 0; p < particles.count; ++p) {
      particles.position[0][p] = places[p % places.size()];
      particles.position[1][p] = places[p / places.size()];
      particles.position[2][p] = places[(p * 7 + p / places.size()) % places.size()];
    }
    expect_reference(particles, transfer);
  }
}

TYPED_TEST(Scatter, UsedArena_IsAddedTo_AndOtherRowsAreLeftAlone) {
  for (const TransferCase& transfer : all_cases()) {
    auto particles = random_particles<TypeParam>(3, Order::kScattered, 130, transfer.stencil);
    const auto touched = touched_by(particles, transfer.stencil);
    for (const Target target : supported_targets()) {
      const auto fresh = scatter(target, particles, transfer);
      Arena<TypeParam> arena(kArenaValues, TypeParam(1));
      std::uint64_t rows = std::uint64_t{1} << 63;
      Arena<TypeParam> before(kArenaValues, TypeParam(0));
      const auto in = particles.scatter_input(transfer, before.data());
      transfer.scatter<TypeParam>(target)(in, arena.data(), rows);
      EXPECT_EQ(rows, touched.rows | std::uint64_t{1} << 63) << what(transfer, target, 3);
      for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) {
        const bool hit = (touched.rows >> (k / kArenaRow) & 1) != 0;
        const double expected = hit ? 1.0 + double{fresh.arena[k]} : 1.0;
        const double rounding = hit ? 4.0 * std::numeric_limits<TypeParam>::epsilon() : 0.0;
        ASSERT_NEAR(arena[k], expected, rounding) << what(transfer, target, 3) << ' ' << k;
      }
    }
  }
}

TYPED_TEST(Scatter, RandomParticles_MassAndMomentum_AreTheirSums) {
  constexpr double kTolerance = kTransferTolerance<TypeParam>;
  for (const TransferCase& transfer : all_cases()) {
    auto particles = random_particles<TypeParam>(128, Order::kScattered, 140, transfer.stencil);
    const double mass = transfer.mass * static_cast<double>(particles.count);
    for (const Target target : supported_targets()) {
      const auto nodes = scatter(target, particles, transfer).arena;
      double sum[kNodeValues] = {};
      for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) sum[k % kNodeValues] += nodes[k];
      EXPECT_NEAR(sum[0], mass, kTolerance * mass) << what(transfer, target, 128);
      for (int axis = 0; axis < 3; ++axis) {
        double momentum = 0;
        for (std::size_t p = 0; p < particles.count; ++p) {
          momentum += transfer.mass * particles.velocity[axis][p];
        }
        EXPECT_NEAR(sum[1 + axis], momentum, kTolerance * mass) << what(transfer, target, 128);
      }
    }
  }
}

/// Stresses alone: the forces of each particle sum to nothing and turn nothing, for tau is symmetric.
TYPED_TEST(Scatter, StressAlone_NoNetForceNoTorque) {
  for (const TransferCase& transfer : all_cases()) {
    auto particles = random_particles<TypeParam>(101, Order::kScattered, 150, transfer.stencil);
    for (auto& channel : particles.velocity) std::fill_n(channel.begin(), particles.count, TypeParam(0));
    for (auto& channel : particles.affine) std::fill_n(channel.begin(), particles.count, TypeParam(0));
    for (const Target target : supported_targets()) {
      const auto nodes = scatter(target, particles, transfer).arena;
      double force[3] = {}, torque[3] = {}, scale = 0;
      for (int node = 0; node < static_cast<int>(kArenaNodes); ++node) {
        const int x[3] = {node / 64, node / 8 % 8, node % 8};
        const TypeParam* f = &nodes[node * kNodeValues + 1];
        for (int k = 0; k < 3; ++k) {
          const int a = (k + 1) % 3, b = (k + 2) % 3;
          force[k] += f[k];
          torque[k] += x[a] * double{f[b]} - x[b] * double{f[a]};
          scale += std::fabs(double{f[k]});
        }
      }
      EXPECT_GT(scale, 1e-4) << what(transfer, target, 101);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(force[k], 0, kTransferTolerance<TypeParam> * scale) << what(transfer, target, 101);
        EXPECT_NEAR(torque[k], 0, kTransferTolerance<TypeParam> * scale) << what(transfer, target, 101);
      }
    }
  }
}

}  // namespace
}  // namespace repose
