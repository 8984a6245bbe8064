// Repose tests: particles that begin and end. A state that was edited and ordered must be, bit for bit, the
// state that is made from scratch of the same particles, whatever was drifting, and however many threads did
// it.
#include "engine/state/particle_edit.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <random>

#include "engine/state/block_sort.h"
#include "engine/state/state_hash.h"

namespace repose {
namespace {

constexpr std::int32_t kParts = 64;  // of a cell; places are whole parts, exact in any block

/// What the brute-force model knows: where each particle of each set is, in parts of a cell.
using Model = std::array<std::map<std::uint32_t, Index3>, 2>;

float mark(std::uint32_t id, int c) {
  return static_cast<float>(id % 4096 * 32 + static_cast<std::uint32_t>(c));
}

void write_particle(ParticleSet<float>& set, std::size_t p, std::uint32_t id, const Index3& at, Index3& cell) {
  int c = 0;
  set.for_each_real([&](AlignedArray<float>& channel) { channel[p] = mark(id, c++); });
  for (std::size_t axis = 0; axis < 3; ++axis) {
    cell[axis] = floor_divide(at[axis], kParts);
    set.position[axis][p] = static_cast<float>(at[axis] - cell[axis] * kParts) / kParts;
  }
}

State<float> state_of(const Model& model, const Topology& topology) {
  State<float> state;
  state.spacing = 0.25;
  state.topology = topology;
  std::vector<std::vector<Index3>> cells(2);
  for (std::size_t k = 0; k < 2; ++k) {
    ParticleSet<float>& set = state.sets.emplace_back();
    if (k == 1) set.extra.push_back({"gained", {}});
    set.keeps_affine = k == 0;
    set.allocate(model[k].size());
    cells[k].resize(model[k].size());
    std::size_t p = 0;
    for (const auto& [id, at] : model[k]) {
      write_particle(set, p, id, at, cells[k][p]);
      set.id[p++] = id;
    }
  }
  place_in_blocks(state, cells, {});
  return state;
}

class Editing {
 public:
  Editing(unsigned seed, int threads, Topology topology = {})
      : random_(seed), threads_(threads), topology_(topology), state_(state_of(model_, topology)) {
    order();
  }

  void order() { sort_.sort(state_, threads_, {}); }

  /// Where a particle is, in parts, its block and its drift taken together; axes that repeat are wrapped.
  Index3 place(const ParticleSet<float>& set, std::size_t occupied, std::size_t p) const {
    const Index3 block =
        state_.grid.blocks()[static_cast<std::size_t>(state_.grid.occupied_blocks()[occupied])];
    Index3 at;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      at[axis] = block[axis] * kBlockSide * kParts + static_cast<std::int32_t>(set.position[axis][p] * kParts);
    }
    return at;
  }

  /// Moves particles by up to a cell, so that some lie outside their blocks.
  void drift() {
    for (std::size_t k = 0; k < 2; ++k) {
      ParticleSet<float>& set = state_.sets[k];
      for (std::size_t occupied = 0; occupied + 1 < set.begin.size(); ++occupied) {
        for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
          for (auto& channel : set.position) {
            channel[p] += static_cast<float>(number(-kParts, kParts)) / kParts;
          }
          model_[k][set.id[p]] = place(set, occupied, p);
        }
      }
    }
  }

  void edit(double leaving, std::array<std::size_t, 2> coming, std::int32_t reach) {
    ParticleEdit<float> edit(state_, threads_);
    for (std::size_t k = 0; k < 2; ++k) {
      ParticleSet<float>& set = state_.sets[k];
      for (std::uint32_t p = 0; p < set.count; ++p) {
        if (number(0, 999) >= static_cast<int>(1000 * leaving)) continue;
        edit.sets[k].removed.push_back(p);
        model_[k].erase(set.id[p]);
      }
      if (coming[k] == 0) continue;
      SetEdit<float>& added = edit.add(state_, k, coming[k]);
      for (std::size_t p = 0; p < coming[k]; ++p) {
        const Index3 at{number(-reach, reach), number(-reach, reach), number(-reach, reach)};
        write_particle(added.newcomers, p, next_, at, added.cells[p]);
        model_[k][next_++] = at;
      }
    }
    const auto applied = apply_edit(std::move(edit), state_, {});
    ASSERT_TRUE(applied) << applied.error().text();
    EXPECT_EQ(state_.ledger.next_id, next_);
    EXPECT_EQ(state_.counters.sort_due, 1);
    for (const auto& set : state_.sets) {
      ASSERT_EQ(set.begin.size(), state_.grid.occupied_blocks().size() + 1);
      EXPECT_EQ(set.begin.back(), set.count);
    }
  }

  /// The state against one made from scratch of what the model holds.
  void expect_fresh() {
    State<float> fresh = state_of(model_, topology_);
    BlockSort<float>().sort(fresh, threads_, {});
    ASSERT_TRUE(std::equal(state_.grid.blocks().begin(), state_.grid.blocks().end(),
                           fresh.grid.blocks().begin(), fresh.grid.blocks().end()));
    for (std::size_t k = 0; k < 2; ++k) {
      ASSERT_EQ(state_.sets[k].count, model_[k].size());
      ASSERT_EQ(state_.sets[k].begin, fresh.sets[k].begin);
      EXPECT_TRUE(std::equal(state_.sets[k].id.data(), state_.sets[k].id.data() + model_[k].size(),
                             fresh.sets[k].id.data()));
      std::vector<const float*> channels;
      fresh.sets[k].for_each_real([&](const auto& channel) { channels.push_back(channel.data()); });
      std::size_t c = 0;
      state_.sets[k].for_each_real([&](const auto& channel) {
        ASSERT_EQ(channel.size(), model_[k].size());
        EXPECT_TRUE(std::equal(channel.data(), channel.data() + channel.size(), channels[c]))
            << "set " << k << ", channel " << c;
        ++c;
      });
    }
  }

  State<float>& state() { return state_; }
  Threads& threads() { return threads_; }

 private:
  std::int32_t number(std::int32_t low, std::int32_t high) {
    return low + static_cast<std::int32_t>(random_() % static_cast<std::uint32_t>(high - low + 1));
  }

  std::mt19937 random_;
  Threads threads_;
  Topology topology_;
  Model model_;
  State<float> state_;
  BlockSort<float> sort_;
  std::uint32_t next_ = 0;
};

/// Rounds of all kinds: growing from nothing, turnover, one set only, shrinking, all gone, beginning again.
void rounds(Editing& editing) {
  struct Round {
    double leaving;
    std::array<std::size_t, 2> coming;
    std::int32_t reach;  // parts
  };
  const Round kRounds[] = {{0.0, {0, 40}, 300},   {0.0, {500, 200}, 900}, {0.3, {0, 0}, 0},
                           {0.1, {300, 0}, 2000}, {0.5, {10, 400}, 200},  {0.99, {1, 0}, 5000},
                           {1.0, {0, 0}, 0},      {0.0, {0, 0}, 0},       {0.0, {700, 3}, 600}};
  for (const Round& round : kRounds) {
    editing.drift();
    editing.edit(round.leaving, round.coming, round.reach);
    editing.order();
    editing.expect_fresh();
  }
}

TEST(ParticleEdit, RandomRounds_AreTheStateMadeFromScratch) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    Editing editing(seed, 2);
    rounds(editing);
  }
}

TEST(ParticleEdit, PeriodicAxes_NewcomersComeInWhereTheyStand) {
  Topology topology;
  topology.period = {6, 0, 4};
  topology.period_start = {-2, 0, 0};
  Editing editing(7, 2, topology);
  for (int round = 0; round < 4; ++round) {
    editing.edit(0.2, {200, 100}, 3000);
    editing.order();
    editing.expect_fresh();
  }
}

TEST(ParticleEdit, OneTwoAndSevenThreads_SameBits) {
  std::vector<std::uint64_t> hashes;
  for (const int threads : {1, 2, 7}) {
    Editing editing(3, threads);
    rounds(editing);
    hashes.push_back(state_hash(editing.state()));
  }
  EXPECT_EQ(hashes[1], hashes[0]);
  EXPECT_EQ(hashes[2], hashes[0]);
}

TEST(ParticleEdit, Newcomers_LimitTheNextStep) {
  Editing editing(1, 1);
  State<float>& state = editing.state();
  state.counters.max_speed = 2.0;
  ParticleEdit<float> edit(state, editing.threads());
  ParticleSet<float>& newcomers = edit.add(state, 0, 2).newcomers;
  newcomers.velocity[1][1] = -3.0f;
  newcomers.velocity[2][1] = 4.0f;
  newcomers.affine[5][0] = 6.0f;
  ASSERT_TRUE(apply_edit(std::move(edit), state, {}));
  EXPECT_EQ(state.counters.max_speed, 5.0);
  EXPECT_EQ(state.counters.max_gradient, 6.0);
}

TEST(ParticleEdit, NoIdsLeft_IsRefusedAndNothingChanges) {
  Editing editing(1, 1);
  editing.edit(0.0, {20, 10}, 500);
  State<float>& state = editing.state();
  state.ledger.next_id = kMostIds - 4;
  const std::uint64_t hash = state_hash(state);
  ParticleEdit<float> edit(state, editing.threads());
  edit.add(state, 0, 5);
  edit.sets[1].removed = {0, 1};
  const auto applied = apply_edit(std::move(edit), state, {});
  ASSERT_FALSE(applied);
  EXPECT_EQ(applied.error().kind, ErrorKind::kMemory);
  EXPECT_EQ(state_hash(state), hash);
  EXPECT_EQ(state.ledger.next_id, kMostIds - 4);
  ParticleEdit<float> fits(state, editing.threads());
  fits.add(state, 0, 4);
  EXPECT_TRUE(apply_edit(std::move(fits), state, {}));
}

TEST(ParticleEdit, SetsThatGrow_AskForMemoryInEighths) {
  Editing editing(5, 2);
  editing.edit(0.0, {2000, 0}, 400);
  editing.order();
  const State<float>& state = editing.state();
  int asked = 0;
  std::size_t room = state.sets[0].id.capacity();
  for (int round = 0; round < 200; ++round) {
    editing.edit(0.0, {20, 0}, 400);
    editing.order();
    state.sets[0].for_each_real([&](const auto& channel) { EXPECT_GE(channel.capacity(), channel.size()); });
    asked += state.sets[0].id.capacity() != room ? 1 : 0;
    room = state.sets[0].id.capacity();
  }
  EXPECT_LE(asked, 10);  // ln 3 / ln 1.125
  EXPECT_LE(room, state.sets[0].count * 5 / 4);
}

}  // namespace
}  // namespace repose
