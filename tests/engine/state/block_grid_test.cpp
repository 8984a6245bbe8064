// Repose tests: the topology of blocks: which exist, who are neighbours, and that two blocks of a colour never
// meet, anywhere in the lattice, across seams and on the single-block axis of plane strain.
#include "engine/state/block_grid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

namespace repose {
namespace {

std::vector<Index3> random_blocks(std::size_t count, std::int32_t lowest, std::int32_t highest) {
  std::mt19937 random(5);
  std::uniform_int_distribution<std::int32_t> any(lowest, highest);
  std::vector<Index3> blocks(count);
  for (Index3& block : blocks) block = {any(random), any(random), any(random)};
  return blocks;
}

Index3 plus(const Index3& a, const Index3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}

Index3 occupied_block(const BlockGrid& grid, std::int32_t occupied) {
  return grid.blocks()[static_cast<std::size_t>(grid.occupied_blocks()[static_cast<std::size_t>(occupied)])];
}

/// Blocks between two coordinates, the short way round.
std::int32_t apart(std::int32_t a, std::int32_t b, std::int32_t period) {
  const std::int32_t distance = std::abs(a - b);
  return period == 0 ? distance : std::min(distance, period - distance);
}

/// What every grid must be, whatever it was built from.
void expect_sound(const BlockGrid& grid, const std::vector<Index3>& asked, const Topology& topology) {
  std::set<Index3> wanted, present(grid.blocks().begin(), grid.blocks().end());
  for (const Index3& block : asked) wanted.insert(topology.wrap(block));
  ASSERT_EQ(grid.occupied_blocks().size(), wanted.size());
  ASSERT_EQ(present.size(), grid.size()) << "no block is there twice";
  EXPECT_TRUE(std::is_sorted(grid.occupied_blocks().begin(), grid.occupied_blocks().end()));
  std::set<Index3> reached;
  std::vector<int> coloured(wanted.size(), 0);
  for (std::size_t occupied = 0; occupied < wanted.size(); ++occupied) {
    const Index3 at = occupied_block(grid, static_cast<std::int32_t>(occupied));
    EXPECT_TRUE(wanted.contains(at));
    EXPECT_EQ(grid.find_occupied(at), static_cast<std::int32_t>(occupied));
    for (int k = 0; k < kNeighbours; ++k) {
      const Index3 offset{k / 9 - 1, k / 3 % 3 - 1, k % 3 - 1};
      const std::int32_t neighbour = grid.neighbours(occupied)[static_cast<std::size_t>(k)];
      if (topology.flat_axis >= 0 && offset[static_cast<std::size_t>(topology.flat_axis)] != 0) {
        EXPECT_EQ(neighbour, -1);
        continue;
      }
      const Index3 expected = topology.wrap(plus(at, offset));
      reached.insert(expected);
      ASSERT_GE(neighbour, 0);
      EXPECT_EQ(grid.blocks()[static_cast<std::size_t>(neighbour)], expected);
    }
  }
  EXPECT_EQ(reached, present) << "the blocks are those that particles can reach, and no more";
  for (int colour = 0; colour < 8; ++colour) {
    for (const std::int32_t a : grid.colour(colour)) {
      ++coloured[static_cast<std::size_t>(a)];
      for (const std::int32_t b : grid.colour(colour)) {
        if (a == b) continue;
        const Index3 x = occupied_block(grid, a), y = occupied_block(grid, b);
        std::int32_t most = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          most = std::max(most, apart(x[axis], y[axis], topology.period[axis]));
        }
        ASSERT_GE(most, 2);
      }
    }
  }
  EXPECT_TRUE(std::all_of(coloured.begin(), coloured.end(), [](int times) { return times == 1; }));
}

void expect_sound(const std::vector<Index3>& occupied_blocks, const Topology& topology = {}) {
  BlockGrid grid;
  grid.build(occupied_blocks, topology);
  expect_sound(grid, occupied_blocks, topology);
}

TEST(FloorDivide, BothSigns_RoundsDown) {
  for (const std::int32_t b : {1, 2, 4, 7}) {
    for (std::int32_t a = -40; a <= 40; ++a) {
      const std::int32_t q = floor_divide(a, b);
      EXPECT_LE(q * b, a);
      EXPECT_GT((q + 1) * b, a);
    }
  }
  EXPECT_EQ(floor_divide(-2000000000, 4), -500000000);
}

TEST(Topology, NoPeriod_BlocksStandForThemselves) {
  const Topology topology;
  for (const Index3& block : random_blocks(50, -300000, 300000)) EXPECT_EQ(topology.wrap(block), block);
}

TEST(Topology, Wrap_FallsIntoThePeriodByWholeOnes) {
  const Topology topology{-1, {-3, 0, 250000}, {4, 0, 10}};
  for (const Index3& block : random_blocks(200, -500000, 500000)) {
    const Index3 in = topology.wrap(block);
    EXPECT_GE(in[0], -3);
    EXPECT_LT(in[0], 1);
    EXPECT_EQ((block[0] - in[0]) % 4, 0);
    EXPECT_EQ(in[1], block[1]);
    EXPECT_GE(in[2], 250000);
    EXPECT_LT(in[2], 250010);
    EXPECT_EQ((block[2] - in[2]) % 10, 0);
    EXPECT_EQ(topology.wrap(in), in);
  }
}

TEST(BlockGrid, NoOccupiedBlock_NoBlock) {
  expect_sound({});
}

TEST(BlockGrid, OneOccupiedBlock_HasItsNeighbours) {
  BlockGrid grid;
  grid.build(std::vector<Index3>{{0, 0, 0}}, {});
  EXPECT_EQ(grid.size(), 27u);
  EXPECT_EQ(grid.occupied_blocks().size(), 1u);
  EXPECT_EQ(grid.find_occupied({0, 0, 1}), -1) << "a block of nodes that holds no particle";
  EXPECT_EQ(grid.find_occupied({0, 0, 2}), -1) << "no block at all";
}

TEST(BlockGrid, OccupiedBlockNamedTwice_IsOne) {
  expect_sound({{1, 2, 3}, {1, 2, 3}, {1, 2, 4}, {1, 2, 3}});
}

TEST(BlockGrid, DenseBlocksOfBothSigns_Sound) {
  expect_sound(random_blocks(600, -5, 5));
}

TEST(BlockGrid, SparseBlocksFarAway_Sound) {
  std::vector<Index3> blocks = random_blocks(200, -250000, 250000);
  for (const std::int32_t far : {-250000, 250000}) {
    for (std::int32_t k = -2; k <= 2; ++k) blocks.push_back({far + k, -far, k});
  }
  expect_sound(blocks);
}

TEST(BlockGrid, PeriodicAxes_NeighboursAcrossTheSeam) {
  const Topology topology{-1, {-2, 3, 0}, {4, 0, 2}};
  expect_sound(random_blocks(60, -5, 5), topology);
  BlockGrid grid;
  grid.build(std::vector<Index3>{{-2, 0, 0}}, topology);
  const std::int32_t left = grid.neighbours(0)[static_cast<std::size_t>(neighbour_index(-1, 0, 0))];
  EXPECT_EQ(grid.blocks()[static_cast<std::size_t>(left)], (Index3{1, 0, 0}));
  EXPECT_EQ(grid.find_occupied({-2, 0, 0}), 0);
}

TEST(BlockGrid, SmallestPeriod_NoColourMeetsItself) {
  const Topology topology{-1, {0, 0, 0}, {2, 2, 2}};
  expect_sound({{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {0, 1, 1}, {1, 0, 0}, {1, 0, 1}, {1, 1, 0}, {1, 1, 1}},
               topology);
}

TEST(BlockGrid, FlatAxis_HasNoNeighboursAcross) {
  Topology topology;
  topology.flat_axis = 2;
  BlockGrid grid;
  grid.build(std::vector<Index3>{{0, 0, 0}}, topology);
  EXPECT_EQ(grid.size(), 9u);
  std::vector<Index3> blocks = random_blocks(60, -4, 4);
  for (Index3& block : blocks) block[2] = 0;
  expect_sound(blocks, topology);
}

TEST(BlockGrid, BuiltAgain_ForgetsTheFormer) {
  BlockGrid grid;
  grid.build(random_blocks(100, -4, 4), {});
  grid.active(0) = ~std::uint64_t{0};
  const std::vector<Index3> occupied_blocks = random_blocks(20, 100, 103);
  grid.build(occupied_blocks, {});
  expect_sound(grid, occupied_blocks, {});
  EXPECT_EQ(grid.active_nodes(), 0u);
}

TEST(BlockGrid, Active_CountsNodes) {
  BlockGrid grid;
  grid.build(std::vector<Index3>{{0, 0, 0}, {9, 9, 9}}, {});
  grid.active(0) = 0xffu;
  grid.active(grid.size() - 1) = 1u;
  EXPECT_EQ(grid.active_nodes(), 9u);
}

}  // namespace
}  // namespace repose
