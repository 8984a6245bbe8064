// Repose tests: the order of a state. It must keep every particle with all that belongs to it, and come out the
// same whatever it was before and however many threads make it.
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <map>
#include <random>

#include "engine/state/state_hash.h"
#include "tests/engine/state/marked_state.h"

namespace repose {
namespace {

/// Calls visit(set, occupied block, p) for every particle.
template <class Visit>
void for_each_particle(const State<float>& state, Visit visit) {
  for (const auto& set : state.sets) {
    ASSERT_EQ(set.begin.size(), state.grid.occupied_blocks().size() + 1);
    ASSERT_EQ(set.begin.back(), set.count);
    for (std::size_t occupied = 0; occupied + 1 < set.begin.size(); ++occupied) {
      for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) visit(set, occupied, p);
    }
  }
}

Vec3 world(const State<float>& state, const ParticleSet<float>& set, std::size_t occupied, std::size_t p) {
  return state.world(state.grid.blocks()[static_cast<std::size_t>(state.grid.occupied_blocks()[occupied])],
                     {set.position[0][p], set.position[1][p], set.position[2][p]});
}

std::map<std::uint32_t, Vec3> places(const State<float>& state) {
  std::map<std::uint32_t, Vec3> result;
  for_each_particle(state, [&](const auto& set, std::size_t occupied, std::size_t p) {
    EXPECT_TRUE(result.emplace(set.id[p], world(state, set, occupied, p)).second)
        << "id " << set.id[p] << " is there twice";
  });
  return result;
}

/// Sorted by block, cell and id; offsets within the block; all channels with their particle.
void expect_ordered(const State<float>& state, const Ownership& ownership = {}) {
  const float shift = static_cast<float>(ownership.base_shift);
  const float lowest = static_cast<float>(ownership.block_shift);
  std::size_t last_occupied = 0;
  std::array<std::uint32_t, 2> last{0, 0};
  const ParticleSet<float>* last_set = nullptr;
  for_each_particle(state, [&](const ParticleSet<float>& set, std::size_t occupied, std::size_t p) {
    std::uint32_t cell = 0;
    for (const auto& channel : set.position) {
      const float x = channel[p] - shift;
      ASSERT_TRUE(x >= lowest && x < lowest + 4.0f) << x;
      const float base = std::floor(x);
      ASSERT_TRUE(base >= 0.0f && base <= (lowest > 0.0f ? 4.0f : 3.0f)) << base;
      cell = cell * 5 + static_cast<std::uint32_t>(base);
    }
    const std::array<std::uint32_t, 2> key{cell, set.id[p]};
    if (last_set == &set && last_occupied == occupied) {
      ASSERT_LT(last, key);
    }
    last_set = &set;
    last_occupied = occupied;
    last = key;
    int c = 0;
    set.for_each_real([&](const AlignedArray<float>& channel) {
      if (c >= 3) {
        ASSERT_EQ(channel[p], mark(set.id[p], c)) << "channel " << c;
      }
      ++c;
    });
  });
}

/// Equal bits of every channel, block and id.
void expect_same(const State<float>& a, const State<float>& b) {
  ASSERT_TRUE(std::equal(a.grid.blocks().begin(), a.grid.blocks().end(), b.grid.blocks().begin(),
                         b.grid.blocks().end()));
  for (std::size_t k = 0; k < a.sets.size(); ++k) {
    EXPECT_EQ(a.sets[k].begin, b.sets[k].begin);
    ASSERT_EQ(std::memcmp(a.sets[k].id.data(), b.sets[k].id.data(), a.sets[k].count * 4), 0);
    std::vector<const float*> channels;
    a.sets[k].for_each_real([&](const auto& channel) { channels.push_back(channel.data()); });
    std::size_t c = 0;
    b.sets[k].for_each_real([&](const auto& channel) {
      EXPECT_EQ(std::memcmp(channels[c++], channel.data(), a.sets[k].count * sizeof(float)), 0)
          << "channel " << c;
    });
  }
}

/// Moves each particle by up to `cells` cells along each axis, by its id and not by its place in memory.
void drift(State<float>& state, int cells) {
  for (auto& set : state.sets) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (static_cast<int>(axis) == state.topology.flat_axis) continue;
      for (std::size_t p = 0; p < set.count; ++p) {
        std::minstd_rand random(set.id[p] * 3 + static_cast<std::uint32_t>(axis) + 1);
        random.discard(3);
        const int parts = 64 * cells;
        set.position[axis][p] +=
            static_cast<float>(static_cast<int>(random() % (2 * parts + 1)) - parts) / 64.0f;
      }
    }
  }
}

void expect_same_places(const State<float>& state, const std::map<std::uint32_t, Vec3>& before) {
  const auto after = places(state);
  ASSERT_EQ(after.size(), before.size()) << "every particle is kept";
  for (const auto& [id, x] : before) {
    Vec3 away = after.at(id) - x;
    for (int axis = 0; axis < 3; ++axis) {
      const double period = state.topology.period[static_cast<std::size_t>(axis)] * kBlockSide * state.spacing;
      if (period > 0.0) away[axis] -= period * std::round(away[axis] / period);
    }
    ASSERT_EQ(away.norm(), 0.0) << "id " << id;
  }
}

TEST(BlockSort, FreshParticles_SortedAndWhole) {
  State<float> state = make_state({});
  const auto before = places(state);
  order(state);
  expect_ordered(state);
  expect_same_places(state, before);
}

TEST(BlockSort, AnyOrderBefore_SameBits) {
  State<float> a = make_state({}), b = make_state({.storage_seed = 1}), c = make_state({.storage_seed = 2});
  for (State<float>* state : {&a, &b, &c}) order(*state);
  expect_same(a, b);
  expect_same(a, c);
}

TEST(BlockSort, AnyNumberOfThreads_SameBits) {
  State<float> one = make_state({.count = 20000}), two = make_state({.count = 20000}),
               seven = make_state({.count = 20000});
  for (const auto& [state, threads] : {std::pair{&one, 1}, std::pair{&two, 2}, std::pair{&seven, 7}}) {
    order(*state, threads);
    drift(*state, 1);
    order(*state, threads);
  }
  expect_same(one, two);
  expect_same(one, seven);
}

// Sets of few particles are each sorted by one thread, and know of few blocks.
TEST(BlockSort, ManySmallSets_AreWholeAndTheSameForAnyThreads) {
  const Making many{.lower = {-20, -9, -9}, .upper = {20, 9, 9}, .sets = 60, .count = 40};
  State<float> one = make_state(many), two = make_state(many), seven = make_state(many);
  for (const auto& [state, threads] : {std::pair{&one, 1}, std::pair{&two, 2}, std::pair{&seven, 7}}) {
    for (const int cells : {0, 1, 4}) {
      drift(*state, cells);
      const auto before = places(*state);
      order(*state, threads);
      expect_ordered(*state);
      expect_same_places(*state, before);
    }
  }
  expect_same(one, two);
  expect_same(one, seven);
}

TEST(BlockSort, BlocksKnowTheirSets) {
  State<float> state = make_state({.sets = 30, .count = 20});
  const auto expect_listed = [&state](const char* when) {
    std::size_t fewer = 0;
    for (std::size_t occupied = 0; occupied < state.grid.occupied_blocks().size(); ++occupied) {
      std::vector<std::uint32_t> have;
      for (std::uint32_t k = 0; k < state.sets.size(); ++k) {
        if (state.sets[k].begin[occupied] < state.sets[k].begin[occupied + 1]) have.push_back(k);
      }
      const auto listed = state.sets_of_blocks.of(occupied);
      ASSERT_EQ(std::vector(listed.begin(), listed.end()), have) << when;
      fewer += have.size() < state.sets.size() ? 1 : 0;
    }
    ASSERT_GT(fewer, 0u) << "all sets are everywhere";
  };
  expect_listed("placed");
  order(state);
  expect_listed("sorted");
  drift(state, 4);
  order(state);
  expect_listed("sorted anew");
}

TEST(BlockSort, OrderedTwice_ChangesNothing) {
  State<float> once = make_state({}), twice = make_state({});
  order(once);
  order(twice);
  order(twice);
  expect_same(once, twice);
}

TEST(BlockSort, DriftAcrossFaces_KeepsPlaces) {
  State<float> state = make_state({.count = 5000});
  order(state);
  for (const int cells : {1, 2, 4}) {
    drift(state, cells);
    const auto before = places(state);
    order(state);
    expect_ordered(state);
    expect_same_places(state, before);
  }
}

TEST(BlockSort, ShiftedBlocks_HoldBasesZeroToFour) {
  // The base of an even stencil changes at nodes: blocks shifted by half a cell give its drift the same room on
  // either side.
  for (const Ownership& ownership : {Ownership{1.0, 0.5}, Ownership{0.5, 0.5}, Ownership{1.0, 0.0}}) {
    State<float> state = make_state({.count = 20000, .ownership = ownership});
    const auto fresh = places(state);
    order(state, 2, ownership);
    expect_ordered(state, ownership);
    expect_same_places(state, fresh);
    drift(state, 1);
    const auto drifted = places(state);
    order(state, 2, ownership);
    expect_ordered(state, ownership);
    expect_same_places(state, drifted);
    float highest = 0.0f;
    for (const auto& set : state.sets) {
      for (std::size_t p = 0; p < set.count; ++p) highest = std::max(highest, set.position[0][p]);
    }
    EXPECT_GE(highest, static_cast<float>(ownership.base_shift + ownership.block_shift + 3.5));
  }
}

TEST(BlockSort, OccupiedBlocksComeAndGo_GridFollows) {
  // Three particles of two sets wander; a block exists as long as it holds one, or lies beside one that does.
  State<float> state = make_state({.lower = {1, 1, 1}, .upper = {3, 3, 3}, .count = 3});
  Threads pool(2);
  BlockSort<float> block_sort;
  EXPECT_FALSE(block_sort.sort(state, pool, {})) << "the grid that the particles were placed in";
  ASSERT_EQ(state.grid.occupied_blocks().size(), 1u);
  const auto push = [&](ParticleSet<float>& set, float cells) {
    for (std::size_t p = 0; p < set.count; ++p) set.position[0][p] += cells;
  };
  push(state.sets[0], 4.0f);
  EXPECT_TRUE(block_sort.sort(state, pool, {}));
  ASSERT_EQ(state.grid.occupied_blocks().size(), 2u) << "one set stayed";
  push(state.sets[1], 4.0f);
  EXPECT_TRUE(block_sort.sort(state, pool, {}));
  ASSERT_EQ(state.grid.occupied_blocks().size(), 1u) << "both sets are in the next block";
  EXPECT_EQ(state.grid.blocks()[static_cast<std::size_t>(state.grid.occupied_blocks()[0])], (Index3{1, 0, 0}));
  EXPECT_FALSE(block_sort.sort(state, pool, {}));
  expect_ordered(state);
}

void expect_drift_is_ordered(State<float>& state) {
  order(state);
  drift(state, 1);
  const auto before = places(state);
  order(state);
  expect_ordered(state);
  expect_same_places(state, before);
}

TEST(BlockSort, DriftAcrossASeam_FallsOnTheOtherSide) {
  for (const std::int32_t blocks : {2, 6}) {
    Making making;
    making.topology = {-1, {-1, 0, 0}, {blocks, 0, 0}};
    State<float> state = make_state(making);
    expect_drift_is_ordered(state);
    for (const Index3& block : state.grid.blocks())
      EXPECT_TRUE(block[0] >= -1 && block[0] < blocks - 1) << block[0];
  }
}

TEST(BlockSort, FlatAxis_StaysInOneLayer) {
  Making making;
  making.topology.flat_axis = 1;
  State<float> state = make_state(making);
  expect_drift_is_ordered(state);
  for (const Index3& block : state.grid.blocks()) EXPECT_EQ(block[1], 0);
}

TEST(BlockSort, FarFromTheOrigin_SameBitsButForTheBlocks) {
  // A million cells away, as by grid.origin_cells: offsets, cells and colours must not notice.
  State<float> near = make_state({}), far = make_state({.origin = {1000000, -1000000, 8}});
  for (State<float>* state : {&near, &far}) {
    order(*state);
    drift(*state, 1);
    order(*state);
  }
  expect_ordered(far);
  const auto a = places(near), b = places(far);
  for (const auto& [id, x] : a) ASSERT_EQ(b.at(id), x);
  EXPECT_EQ(state_hash(near), state_hash(far));
  for (int colour = 0; colour < 8; ++colour)
    EXPECT_EQ(near.grid.colour(colour).size(), far.grid.colour(colour).size());
}

TEST(BlockSort, MillionInOneCell_InSeconds) {
  Making making{.lower = {1, 1, 1}, .upper = {2, 2, 2}, .count = 500000, .storage_seed = 1};
  State<float> state = make_state(making);
  for (auto& set : state.sets) {
    for (auto& channel : set.position) std::fill_n(channel.data(), set.count, 1.75f);  // one cell, one point
  }
  const auto start = std::chrono::steady_clock::now();
  EXPECT_NO_FATAL_FAILURE(order(state, 1));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  RecordProperty("seconds", std::to_string(seconds));
  std::printf("a million particles in one cell, in random order: %.2f s on one thread\n", seconds);
  EXPECT_LT(seconds, 5.0);
  for (const auto& set : state.sets) EXPECT_TRUE(std::is_sorted(set.id.data(), set.id.data() + set.count));
}

}  // namespace
}  // namespace repose
