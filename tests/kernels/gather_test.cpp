// Repose tests: nodes to particles, on every instruction set, against the reference.
#include <gtest/gtest.h>

#include "tests/kernels/node_blocks.h"
#include "tests/kernels/transfer_reference.h"

namespace repose {
namespace {

template <class Real>
class Gather : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Gather, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-12;

constexpr std::size_t kCounts[] = {0, 1, 7, 16, 17, 255, 256};

/// Mass 1 and velocities to 1 m/s on every node.
NodeValues random_nodes(std::uint64_t seed) {
  Samples samples(seed);
  NodeValues nodes;
  for (int k = 0; k < kArenaSide * kArenaSide * kArenaSide * kNodeValues; ++k) {
    (&nodes.value[0][0][0][0])[k] = k % kNodeValues == 0 ? 1.0 : samples.uniform(-1, 1);
  }
  return nodes;
}

/// Gathers into other arrays than those of the particles: only positions may be read.
template <class Real>
Particles<Real> gather(Target target, Particles<Real>& particles, const TransferCase& transfer,
                       const Real* arena) {
  Particles<Real> result(particles.count);
  GatherInput<Real> in{particles.span(), transfer.lattice<Real>(), {}, {}};
  for (int k = 0; k < 3; ++k) in.velocity[k] = result.velocity[k].data();
  for (int k = 0; k < 9; ++k) in.affine[k] = result.affine[k].data();
  kernels<Real>(target).transfer[0][0].gather(in, arena);
  EXPECT_TRUE(result.canaries_alive()) << target_name(target);
  EXPECT_TRUE(particles.canaries_alive()) << target_name(target);
  return result;
}

/// Velocities to 1 m/s, gradients to D^-1 dx times that.
template <class Real>
void expect_near(const Particles<Real>& result, const Particles<Real>& particles, const NodeValues& nodes,
                 const TransferCase& transfer, const std::string& what) {
  const double tolerance = kTolerance<Real>, per_cell = QuadraticStencil::kInverseD / transfer.spacing;
  for (std::size_t p = 0; p < particles.count; ++p) {
    const auto expected = reference_gather(particles, p, nodes, transfer);
    for (int k = 0; k < 3; ++k) ASSERT_NEAR(result.velocity[k][p], expected[k], tolerance) << what << ' ' << p;
    for (int k = 0; k < 9; ++k) {
      ASSERT_NEAR(result.affine[k][p], expected[3 + k], tolerance * per_cell)
          << what << ' ' << p << ", C " << k;
    }
  }
}

TYPED_TEST(Gather, RandomNodes_EveryCountAndOrder_MatchTheReference) {
  const TransferCase transfer;
  const NodeValues nodes = random_nodes(200);
  const auto arena = arena_of<TypeParam>(nodes);
  for (const Order order : {Order::kRuns, Order::kScattered}) {
    for (const std::size_t count : kCounts) {
      auto particles = random_particles<TypeParam>(count, order, 210 + count);
      for (const Target target : supported_targets()) {
        const auto result = gather(target, particles, transfer, arena.data());
        const std::string what = std::string(target_name(target)) + ", " + std::to_string(count) + " particles";
        expect_near(result, particles, nodes, transfer, what);
      }
    }
  }
}

TYPED_TEST(Gather, FlatAxis_EveryAxis_MatchesTheReferenceWithoutGradient) {
  const NodeValues nodes = random_nodes(220);
  const auto arena = arena_of<TypeParam>(nodes);
  for (const int axis : {0, 1, 2}) {
    TransferCase transfer;
    transfer.flat_axis = axis;
    auto particles = random_particles<TypeParam>(101, Order::kScattered, 221);
    for (const Target target : supported_targets()) {
      const auto result = gather(target, particles, transfer, arena.data());
      expect_near(result, particles, nodes, transfer, target_name(target));
      for (int row = 0; row < 3; ++row) {
        for (std::size_t p = 0; p < particles.count; ++p) {
          ASSERT_EQ(result.affine[3 * row + axis][p], TypeParam(0)) << target_name(target);
        }
      }
    }
  }
}

/// v_i = v + G x_i comes back as v + G x_p and G itself.
TYPED_TEST(Gather, AffineField_IsReproduced) {
  const TransferCase transfer;
  constexpr double kVelocity[3] = {0.3, -0.2, 0.1};
  constexpr double kSlope[3][3] = {{0.05, -0.1, 0.02}, {0.07, 0.03, -0.04}, {-0.06, 0.08, 0.01}};  // m/s a cell
  NodeValues nodes;
  for (int node = 0; node < kArenaSide * kArenaSide * kArenaSide; ++node) {
    const int x[3] = {node / 64 - 1, node / 8 % 8 - 1, node % 8 - 1};
    for (int row = 0; row < 3; ++row) {
      double v = kVelocity[row];
      for (int axis = 0; axis < 3; ++axis) v += kSlope[row][axis] * x[axis];
      nodes.at(x[0], x[1], x[2])[1 + row] = v;
    }
  }
  const auto arena = arena_of<TypeParam>(nodes);
  auto particles = random_particles<TypeParam>(255, Order::kScattered, 230);
  for (const Target target : supported_targets()) {
    const auto result = gather(target, particles, transfer, arena.data());
    for (std::size_t p = 0; p < particles.count; ++p) {
      for (int row = 0; row < 3; ++row) {
        double v = kVelocity[row];
        for (int axis = 0; axis < 3; ++axis) {
          v += kSlope[row][axis] * particles.position[axis][p];
          ASSERT_NEAR(result.affine[3 * row + axis][p], kSlope[row][axis] / transfer.spacing,
                      kTolerance<TypeParam> * 4 / transfer.spacing)
              << target_name(target);
        }
        ASSERT_NEAR(result.velocity[row][p], v, kTolerance<TypeParam>) << target_name(target);
      }
    }
  }
}

/// A row is read four nodes wide where the stencil has three. The fourth weighs nothing, so it must not be a
/// NaN left over in the arena: load_arena has to write it.
TYPED_TEST(Gather, ArenaFullOfNan_LoadedRowsOnly_IsNotContaminated) {
  const TransferCase transfer;
  const NodeValues nodes = random_nodes(240);
  NodeBlocks<TypeParam> blocks;
  blocks.fill(nodes);
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    auto particles = random_particles<TypeParam>(1 + seed % 3, Order::kScattered, 250 + seed);
    if (seed % 2 == 0) particles.position[2][0] = TypeParam(5.25);  // base node 4: reads beyond the arena's row
    for (const Target target : supported_targets()) {
      std::vector<TypeParam> arena(kArenaValues, std::numeric_limits<TypeParam>::quiet_NaN());
      kernels<TypeParam>(target).load_arena(arena.data(), reach_of(particles).rows, blocks.pointers);
      const auto result = gather(target, particles, transfer, arena.data());
      expect_near(result, particles, nodes, transfer, target_name(target));
    }
  }
}

}  // namespace
}  // namespace repose
