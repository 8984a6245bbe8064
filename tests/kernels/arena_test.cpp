// Repose tests: arenas and the blocks under them: nodes [-1, 6] and no other are written, as the colouring of
// blocks relies on, missing neighbours are passed over, and what was added is what is loaded.
#include <gtest/gtest.h>

#include "tests/kernels/node_blocks.h"

namespace repose {
namespace {

template <class Real>
class Arena : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Arena, Precisions);

constexpr std::uint64_t kAllRows = ~std::uint64_t{0};

/// Every value of an arena tells its place; exact in float.
template <class Real>
std::vector<Real> numbered_arena() {
  std::vector<Real> arena(kArenaValues);
  for (std::size_t k = 0; k < arena.size(); ++k) arena[k] = static_cast<Real>(k + 1);
  return arena;
}

bool covered(int x, int y, int z) {
  return std::min({x, y, z}) >= -1 && std::max({x, y, z}) <= 6;
}

bool in_rows(std::uint64_t rows, int x, int y) {
  return (rows >> ((x + 1) * kArenaSide + y + 1) & 1) != 0;
}

/// Calls visit(x, y, z) for all nodes of the 27 blocks.
template <class Visit>
void for_each_node(Visit visit) {
  for (int node = 0; node < 12 * 12 * 12; ++node) visit(node / 144 - 4, node / 12 % 12 - 4, node % 12 - 4);
}

std::vector<std::uint64_t> row_sets() {
  std::vector<std::uint64_t> sets{0, kAllRows};
  for (int bit = 0; bit < 64; ++bit) sets.push_back(std::uint64_t{1} << bit);
  Samples samples(400);
  for (int k = 0; k < 20; ++k) sets.push_back(samples.index(~std::size_t{0}));
  return sets;
}

TYPED_TEST(Arena, Add_AnyRows_WritesTheirNodesAndNoOther) {
  const auto arena = numbered_arena<TypeParam>();
  for (const Target target : supported_targets()) {
    for (const std::uint64_t rows : row_sets()) {
      NodeBlocks<TypeParam> blocks;
      blocks.fill(TypeParam(7));
      kernels<TypeParam>(target).add_arena(arena.data(), rows, blocks.pointers);
      for_each_node([&](int x, int y, int z) {
        const bool written = covered(x, y, z) && in_rows(rows, x, y);
        for (int value = 0; value < kNodeValues; ++value) {
          const TypeParam added = written ? arena[arena_place(x, y, z) + value] : TypeParam(0);
          ASSERT_EQ(blocks.at(x, y, z)[value], TypeParam(7) + added)
              << target_name(target) << ", node " << x << ' ' << y << ' ' << z;
        }
      });
    }
  }
}

/// Other threads may write the nodes beyond: adding zero to them would be a race as well, and a NaN shows it.
TYPED_TEST(Arena, Add_NodesBeyondSix_AreNotEvenRead) {
  std::vector<TypeParam> arena(kArenaValues, std::numeric_limits<TypeParam>::quiet_NaN());
  for (const Target target : supported_targets()) {
    NodeBlocks<TypeParam> blocks;
    kernels<TypeParam>(target).add_arena(arena.data(), kAllRows, blocks.pointers);
    for_each_node([&](int x, int y, int z) {
      for (int value = 0; value < kNodeValues; ++value) {
        ASSERT_EQ(std::isnan(blocks.at(x, y, z)[value]), covered(x, y, z))
            << target_name(target) << ", node " << x << ' ' << y << ' ' << z;
      }
    });
  }
}

TYPED_TEST(Arena, Add_MissingNeighbours_ArePassedOver) {
  const auto arena = numbered_arena<TypeParam>();
  Samples samples(410);
  for (const Target target : supported_targets()) {
    for (int round = 0; round < kNeighbours + 10; ++round) {
      NodeBlocks<TypeParam> blocks;
      TypeParam* given[kNeighbours];
      for (int k = 0; k < kNeighbours; ++k) {
        const bool missing = round < kNeighbours ? k == round : samples.index(2) == 0;
        given[k] = missing ? nullptr : blocks.pointers[k];
      }
      kernels<TypeParam>(target).add_arena(arena.data(), kAllRows, given);
      for_each_node([&](int x, int y, int z) {
        const int block = neighbour_index((x + 4) / 4 - 1, (y + 4) / 4 - 1, (z + 4) / 4 - 1);
        const bool written = covered(x, y, z) && given[block] != nullptr;
        const TypeParam expected = written ? arena[arena_place(x, y, z)] : TypeParam(0);
        ASSERT_EQ(blocks.at(x, y, z)[0], expected) << target_name(target);
      });
    }
  }
}

TYPED_TEST(Arena, Load_AfterAdd_ReturnsTheSameValues) {
  const auto arena = numbered_arena<TypeParam>();
  for (const Target target : supported_targets()) {
    for (const std::uint64_t rows : row_sets()) {
      NodeBlocks<TypeParam> blocks;
      kernels<TypeParam>(target).add_arena(arena.data(), rows, blocks.pointers);
      std::vector<TypeParam> loaded(kArenaValues, TypeParam(-1));
      kernels<TypeParam>(target).load_arena(loaded.data(), rows, blocks.pointers);
      for (int k = 0; k < kArenaSide * kArenaSide * kArenaRow; ++k) {
        const bool asked = (rows >> (k / kArenaRow) & 1) != 0;
        ASSERT_TRUE(!asked || loaded[k] == arena[k]) << target_name(target) << ' ' << k;
      }
    }
  }
}

TYPED_TEST(Arena, Load_MissingNeighbours_AreZero) {
  for (const Target target : supported_targets()) {
    for (int missing = 0; missing < kNeighbours; ++missing) {
      NodeBlocks<TypeParam> blocks;
      blocks.fill(TypeParam(3));
      blocks.pointers[missing] = nullptr;
      std::vector<TypeParam> loaded(kArenaValues, TypeParam(-1));
      kernels<TypeParam>(target).load_arena(loaded.data(), kAllRows, blocks.pointers);
      for_each_node([&](int x, int y, int z) {
        if (!covered(x, y, z)) return;
        const int block = neighbour_index((x + 4) / 4 - 1, (y + 4) / 4 - 1, (z + 4) / 4 - 1);
        ASSERT_EQ(loaded[arena_place(x, y, z)], TypeParam(block == missing ? 0 : 3)) << target_name(target);
      });
    }
  }
}

}  // namespace
}  // namespace repose
