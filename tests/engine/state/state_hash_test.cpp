// Repose tests: the hash of a state: it must see every bit, and no place in memory.
#include "engine/state/state_hash.h"

#include <gtest/gtest.h>

#include <bit>

#include "tests/engine/state/marked_state.h"

namespace repose {
namespace {

TEST(StateHash, OrderOfStorage_DoesNotMatter) {
  State<float> state = make_state({});
  order(state);
  const std::uint64_t hash = state_hash(state);
  State<float> shuffled = make_state({.storage_seed = 3});  // placed in blocks, not sorted within them
  State<float> plain = make_state({});
  EXPECT_EQ(state_hash(shuffled), state_hash(plain));
  for (auto& set : state.sets) {
    ASSERT_GE(set.begin[1], 2u);
    set.for_each_real([](AlignedArray<float>& channel) { std::swap(channel[0], channel[1]); });
    std::swap(set.id[0], set.id[1]);
  }
  EXPECT_EQ(state_hash(state), hash);
}

TEST(StateHash, AnyBitOfAnyChannel_Matters) {
  State<float> state = make_state({});
  order(state);
  const std::uint64_t hash = state_hash(state);
  for (auto& set : state.sets) {
    set.for_each_real([&](AlignedArray<float>& channel) {
      for (const int bit : {0, 22, 31}) {
        for (const std::size_t p : {std::size_t{0}, set.count / 2, set.count - 1}) {
          const float before = channel[p];
          channel[p] = std::bit_cast<float>(std::bit_cast<std::uint32_t>(before) ^ (1u << bit));
          EXPECT_NE(state_hash(state), hash) << "bit " << bit << " of particle " << p;
          channel[p] = before;
        }
      }
    });
    ++set.id[7];
    EXPECT_NE(state_hash(state), hash);
    --set.id[7];
  }
  EXPECT_EQ(state_hash(state), hash);
  ++state.counters.step;
  EXPECT_NE(state_hash(state), hash);
}

TEST(StateHash, BlockOfTheParticles_Matters) {
  State<float> here = make_state({}), there = make_state({.lower = {-5, -9, -9}, .upper = {13, 9, 9}});
  order(here);
  order(there);
  EXPECT_NE(state_hash(here), state_hash(there)) << "the same offsets in other blocks";
}

TEST(StateHash, ValuesThatChangePlaces_Matter) {
  State<float> state = make_state({});
  order(state);
  const std::uint64_t hash = state_hash(state);
  std::swap(state.sets[0].velocity[0][3], state.sets[0].velocity[1][3]);
  EXPECT_NE(state_hash(state), hash) << "between channels";
  std::swap(state.sets[0].velocity[0][3], state.sets[0].velocity[1][3]);
  std::swap(state.sets[0].velocity[0][3], state.sets[0].velocity[0][4]);
  EXPECT_NE(state_hash(state), hash) << "between particles";
}

}  // namespace
}  // namespace repose
