// Repose tests: arenas and the blocks under them, for the arena of every stencil: its eight nodes an axis and
// no other are written, as the colouring of blocks relies on, missing neighbours are passed over, and what was
// added is what is loaded.
#include <gtest/gtest.h>

#include "tests/kernels/node_blocks.h"

namespace repose {
namespace {

template <class Real>
class ArenaBlocks : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(ArenaBlocks, Precisions);

constexpr std::uint64_t kAllRows = ~std::uint64_t{0};

/// Every value of an arena tells its place; exact in float.
template <class Real>
Arena<Real> numbered_arena() {
  Arena<Real> arena(kArenaValues);
  for (std::size_t k = 0; k < arena.size(); ++k) arena[k] = static_cast<Real>(k + 1);
  return arena;
}

/// Whether an arena whose first node is `origin` holds the node.
bool covered(int origin, int x, int y, int z) {
  return std::min({x, y, z}) >= origin && std::max({x, y, z}) < origin + kArenaSide;
}

bool in_rows(std::uint64_t rows, int origin, int x, int y) {
  return (rows >> ((x - origin) * kArenaSide + y - origin) & 1) != 0;
}

std::vector<std::uint64_t> row_sets() {
  std::vector<std::uint64_t> sets{0, kAllRows};
  for (int bit = 0; bit < 64; ++bit) sets.push_back(std::uint64_t{1} << bit);
  Samples samples(400);
  for (int k = 0; k < 20; ++k) sets.push_back(samples.index(~std::size_t{0}));
  return sets;
}

/// Calls test(stencil kernels, first node, words for messages) for every stencil and instruction set.
template <class Real, class Test>
void for_each_arena(Test test) {
  for (const TransferCase& transfer : all_stencils()) {
    for (const Target target : supported_targets()) {
      const std::string what = std::string(transfer.nodes().name) + ", " + target_name(target);
      test(transfer.stencil_kernel<Real>(target), transfer.origin(), what);
    }
  }
}

TYPED_TEST(ArenaBlocks, Add_AnyRows_WritesTheirNodesAndNoOther) {
  const auto arena = numbered_arena<TypeParam>();
  for_each_arena<TypeParam>([&](const auto& kernel, int origin, const std::string& what) {
    for (const std::uint64_t rows : row_sets()) {
      NodeBlocks<TypeParam> blocks;
      blocks.fill(TypeParam(7));
      kernel.add_arena(arena.data(), rows, blocks.pointers);
      for_each_node([&](int x, int y, int z) {
        const bool written = covered(origin, x, y, z) && in_rows(rows, origin, x, y);
        for (int value = 0; value < kNodeValues; ++value) {
          const TypeParam added = written ? arena[arena_place(x - origin, y - origin, z - origin) + value] : 0;
          ASSERT_EQ(blocks.at(x, y, z)[value], TypeParam(7) + added)
              << what << ", node " << x << ' ' << y << ' ' << z;
        }
      });
    }
  });
}

/// Other threads may write the nodes beyond: adding zero to them would be a race as well, and a NaN shows it.
TYPED_TEST(ArenaBlocks, Add_NodesBeyond_AreNotEvenRead) {
  const Arena<TypeParam> arena(kArenaValues, std::numeric_limits<TypeParam>::quiet_NaN());
  for_each_arena<TypeParam>([&](const auto& kernel, int origin, const std::string& what) {
    NodeBlocks<TypeParam> blocks;
    kernel.add_arena(arena.data(), kAllRows, blocks.pointers);
    for_each_node([&](int x, int y, int z) {
      for (int value = 0; value < kNodeValues; ++value) {
        ASSERT_EQ(std::isnan(blocks.at(x, y, z)[value]), covered(origin, x, y, z))
            << what << ", node " << x << ' ' << y << ' ' << z;
      }
    });
  });
}

TYPED_TEST(ArenaBlocks, Add_MissingNeighbours_ArePassedOver) {
  const auto arena = numbered_arena<TypeParam>();
  Samples samples(410);
  for_each_arena<TypeParam>([&](const auto& kernel, int origin, const std::string& what) {
    for (int round = 0; round < kNeighbours + 10; ++round) {
      NodeBlocks<TypeParam> blocks;
      TypeParam* given[kNeighbours];
      for (int k = 0; k < kNeighbours; ++k) {
        const bool missing = round < kNeighbours ? k == round : samples.index(2) == 0;
        given[k] = missing ? nullptr : blocks.pointers[k];
      }
      kernel.add_arena(arena.data(), kAllRows, given);
      for_each_node([&](int x, int y, int z) {
        const bool written = covered(origin, x, y, z) && given[blocks.block_of(x, y, z)] != nullptr;
        const TypeParam expected =
            written ? arena[arena_place(x - origin, y - origin, z - origin)] : TypeParam(0);
        ASSERT_EQ(blocks.at(x, y, z)[0], expected) << what;
      });
    }
  });
}

TYPED_TEST(ArenaBlocks, Load_AfterAdd_ReturnsTheSameValues) {
  const auto arena = numbered_arena<TypeParam>();
  for_each_arena<TypeParam>([&](const auto& kernel, int, const std::string& what) {
    for (const std::uint64_t rows : row_sets()) {
      NodeBlocks<TypeParam> blocks;
      kernel.add_arena(arena.data(), rows, blocks.pointers);
      Arena<TypeParam> loaded(kArenaValues, TypeParam(-1));
      kernel.load_arena(loaded.data(), rows, blocks.pointers);
      for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) {
        const bool asked = (rows >> (k / kArenaRow) & 1) != 0;
        ASSERT_TRUE(!asked || loaded[k] == arena[k]) << what << ' ' << k;
      }
    }
  });
}

TYPED_TEST(ArenaBlocks, Load_MissingNeighbours_AreZero) {
  for_each_arena<TypeParam>([&](const auto& kernel, int origin, const std::string& what) {
    for (int missing = 0; missing < kNeighbours; ++missing) {
      NodeBlocks<TypeParam> blocks;
      blocks.fill(TypeParam(3));
      blocks.pointers[missing] = nullptr;
      Arena<TypeParam> loaded(kArenaValues, TypeParam(-1));
      kernel.load_arena(loaded.data(), kAllRows, blocks.pointers);
      for_each_node([&](int x, int y, int z) {
        if (!covered(origin, x, y, z)) return;
        ASSERT_EQ(loaded[arena_place(x - origin, y - origin, z - origin)],
                  TypeParam(blocks.block_of(x, y, z) == missing ? 0 : 3))
            << what;
      });
    }
  });
}

/// Blocks of a colour lie two blocks apart.
TEST(BlockColours, BlocksOfOneColour_ShareNoNode) {
  for (const TransferCase& transfer : all_stencils()) {
    const StencilFigures& nodes = transfer.nodes();
    const int last = nodes.highest_base + stencil_width(transfer.stencil) - 1;
    EXPECT_LT(last, nodes.lowest_base + 2 * kBlockSide) << nodes.name;
    EXPECT_LT(last, nodes.lowest_base + kArenaSide) << nodes.name << ": the arena is too narrow";
    EXPECT_GE(nodes.lowest_base, -kBlockSide) << nodes.name << ": beyond the neighbours";
    EXPECT_LT(last, 2 * kBlockSide) << nodes.name << ": beyond the neighbours";
    // What a block owns lies between: there is room to drift on either side.
    const double first_own = nodes.base_shift + nodes.block_shift, end_own = first_own + kBlockSide;
    EXPECT_GE(first_own - nodes.base_shift - nodes.lowest_base, 0.5) << nodes.name;
    EXPECT_GE(nodes.highest_base + 1 + nodes.base_shift - end_own, 0.5) << nodes.name;
  }
}

}  // namespace
}  // namespace repose
