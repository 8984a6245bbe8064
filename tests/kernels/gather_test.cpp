// Repose tests: nodes to particles, with every stencil and transfer on every instruction set, against the
// reference.
#include <gtest/gtest.h>

#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

template <class Real>
class Gather : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Gather, Precisions);

constexpr std::size_t kCounts[] = {0, 1, 7, 16, 17, 127, 128};

std::string what(const TransferCase& transfer, Target target, std::size_t count) {
  return transfer.name() + ", " + target_name(target) + ", " + std::to_string(count) + " particles";
}

/// Gathers all that there is into other arrays than those of the particles.
template <class Real>
Gathered<Real> gather(Target target, Particles<Real>& particles, const TransferCase& transfer,
                      const Arena<Real>& arena) {
  Gathered<Real> result(particles.count);
  transfer.gather<Real>(target)(result.input(particles, transfer), arena.data());
  EXPECT_TRUE(result.canaries_alive() && particles.canaries_alive()) << what(transfer, target, particles.count);
  return result;
}

template <class Real>
Gathered<Real> reference_gather(Particles<Real>& particles, const TransferCase& transfer,
                                const Arena<Real>& arena) {
  Gathered<Real> result(particles.count);
  reference::gather(transfer.stencil, transfer.transfer, result.input(particles, transfer), arena.data());
  return result;
}

TYPED_TEST(Gather, RandomNodes_EveryCountAndOrder_MatchTheReference) {
  const auto arena = random_arena<TypeParam>(200);
  for (const TransferCase& transfer : all_cases()) {
    for (const Order order : {Order::kSegments, Order::kScattered}) {
      for (const std::size_t count : kCounts) {
        auto particles = random_particles<TypeParam>(count, order, 210 + count, transfer.stencil);
        const auto expected = reference_gather(particles, transfer, arena);
        for (const Target target : supported_targets()) {
          expect_near(gather(target, particles, transfer, arena), expected, transfer,
                      what(transfer, target, count));
        }
      }
    }
  }
}

TYPED_TEST(Gather, FlatAxis_EveryAxis_MatchesTheReferenceWithoutGradient) {
  const auto arena = random_arena<TypeParam>(220);
  for (TransferCase transfer : all_cases()) {
    for (const int axis : {0, 1, 2}) {
      transfer.flat_axis = axis;
      auto particles = random_particles<TypeParam>(101, Order::kScattered, 221, transfer.stencil);
      const auto expected = reference_gather(particles, transfer, arena);
      for (const Target target : supported_targets()) {
        const auto result = gather(target, particles, transfer, arena);
        expect_near(result, expected, transfer, what(transfer, target, 101));
        for (int entry = axis; entry < kAffineComponents; entry += 3) {
          for (std::size_t p = 0; p < particles.count; ++p) {
            ASSERT_EQ(result.gradient[entry][p], TypeParam(0)) << what(transfer, target, 101);
            if (!transfer.keeps_affine()) continue;
            ASSERT_EQ(result.affine[entry][p], TypeParam(0)) << what(transfer, target, 101);
          }
        }
      }
    }
  }
}

/// v_i = v + G x_i comes back as v + G x_p and G itself, in C and in the gradient of every transfer.
TYPED_TEST(Gather, AffineField_IsReproduced) {
  constexpr double kVelocity[3] = {0.3, -0.2, 0.1};
  constexpr double kSlope[3][3] = {{0.05, -0.1, 0.02}, {0.07, 0.03, -0.04}, {-0.06, 0.08, 0.01}};  // m/s a cell
  for (TransferCase transfer : all_cases()) {
    transfer.dt = 0;  // what turns is another slope at the end of the step
    Arena<TypeParam> arena(kArenaValues, TypeParam(0));
    const auto field = [&](int row, const auto* x) {
      return kVelocity[row] + kSlope[row][0] * x[0] + kSlope[row][1] * x[1] + kSlope[row][2] * x[2];
    };
    for (int node = 0; node < static_cast<int>(kArenaNodes); ++node) {
      const double at[3] = {node / 64 + 1.0 * transfer.origin(), node / 8 % 8 + 1.0 * transfer.origin(),
                            node % 8 + 1.0 * transfer.origin()};
      for (int row = 0; row < 3; ++row)
        arena[node * kNodeValues + 1 + row] = static_cast<TypeParam>(field(row, at));
    }
    auto particles = random_particles<TypeParam>(127, Order::kScattered, 230, transfer.stencil);
    const double steepest = kTransferTolerance<TypeParam> * 4 / transfer.spacing;
    for (const Target target : supported_targets()) {
      const auto result = gather(target, particles, transfer, arena);
      for (std::size_t p = 0; p < particles.count; ++p) {
        const double at[3] = {particles.position[0][p], particles.position[1][p], particles.position[2][p]};
        for (int k = 0; k < kAffineComponents; ++k) {
          const double slope = kSlope[k / 3][k % 3] / transfer.spacing;
          ASSERT_NEAR(result.gradient[k][p], slope, steepest) << what(transfer, target, 127);
          if (transfer.keeps_affine()) {
            ASSERT_NEAR(result.affine[k][p], slope, steepest) << what(transfer, target, 127);
          }
        }
        for (int row = 0; row < 3; ++row) {
          ASSERT_NEAR(result.moving[row][p], field(row, at), kTransferTolerance<TypeParam>)
              << what(transfer, target, 127);
        }
      }
    }
  }
}

/// |grad v| dx <= bound d where node velocities lie within d: the proof that a step is good rests on it. Signs
/// that follow the sign of the slopes are the worst, so all of a small set of patterns are tried.
TYPED_TEST(Gather, NodesWithinADistance_GradientWithinTheStencilsBound) {
  for (const TransferCase& transfer : all_cases()) {
    double steepest = 0;
    for (int pattern = 1; pattern < 64; ++pattern) {
      Arena<TypeParam> arena(kArenaValues, TypeParam(0));
      for (int node = 0; node < static_cast<int>(kArenaNodes); ++node) {
        const int x[3] = {node / 64, node / 8 % 8, node % 8};
        // Velocities of length 1 that change sign from node to node, or every other node, along some axes.
        int sum = 0;
        for (int axis = 0; axis < 3; ++axis)
          sum += (pattern >> axis & 1) * (x[axis] >> (pattern >> (3 + axis) & 1));
        arena[node * kNodeValues + 1 + (pattern % 3)] = sum % 2 == 0 ? TypeParam(1) : TypeParam(-1);
      }
      auto particles = random_particles<TypeParam>(128, Order::kScattered, 235, transfer.stencil);
      const auto result = gather(best_target(), particles, transfer, arena);
      for (std::size_t p = 0; p < particles.count; ++p) {
        double square = 0;
        for (const auto& entry : result.gradient) square += double{entry[p]} * entry[p];
        steepest = std::max(steepest, std::sqrt(square) * transfer.spacing);
      }
    }
    EXPECT_LE(steepest, transfer.nodes().gradient_bound * 1.00001) << transfer.name();
    EXPECT_GE(steepest, transfer.nodes().gradient_bound * 0.4) << transfer.name() << ": no test of the bound";
  }
}

/// A row is read four nodes wide where a stencil has two or three. The others weigh nothing, so they must not
/// be a NaN left over in the arena: load_arena has to write them.
TYPED_TEST(Gather, ArenaFullOfNan_LoadedRowsOnly_IsNotContaminated) {
  const auto nodes = random_arena<TypeParam>(240);
  std::vector<TypeParam> values(kNeighbours * kBlockValues, TypeParam(0.5));
  const TypeParam* blocks[kNeighbours];
  for (int block = 0; block < kNeighbours; ++block) blocks[block] = &values[block * kBlockValues];
  for (const TransferCase& transfer : all_cases()) {
    Arena<TypeParam> full(kArenaValues, TypeParam(0));
    kernels<TypeParam>(best_target())
        .stencil[transfer.stencil]
        .load_arena(full.data(), ~std::uint64_t{0}, blocks);
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      auto particles =
          random_particles<TypeParam>(1 + seed % 3, Order::kScattered, 250 + seed, transfer.stencil);
      if (seed % 2 == 0) {  // the last base node: what is read beyond it lies in the next row
        particles.position[2][0] =
            static_cast<TypeParam>(transfer.nodes().highest_base + transfer.nodes().base_shift + 0.75);
      }
      const auto expected = reference_gather(particles, transfer, full);
      for (const Target target : supported_targets()) {
        Arena<TypeParam> arena(kArenaValues, std::numeric_limits<TypeParam>::quiet_NaN());
        const auto rows = touched_by(particles, transfer.stencil).rows;
        transfer.stencil_kernel<TypeParam>(target).load_arena(arena.data(), rows, blocks);
        expect_near(gather(target, particles, transfer, arena), expected, transfer,
                    what(transfer, target, particles.count));
      }
    }
  }
}

}  // namespace
}  // namespace repose
