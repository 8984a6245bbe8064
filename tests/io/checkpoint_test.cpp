// Repose tests: checkpoints: a state comes back bit for bit, or the error names what is wrong with the file.
#include "engine/io/checkpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <cstring>
#include <filesystem>
#include <fstream>

#include "engine/state/state_hash.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

constexpr std::size_t kParticles = 50;

/// Two sets in five blocks; the second has two extra channels. Every value differs, and some are no plain
/// numbers.
template <class Real>
State<Real> make_state(bool filled) {
  State<Real> state;
  state.spacing = 0.1;
  state.tallies.assign(3, 0.0);
  state.rest.on = true;
  const std::vector<Index3> occupied_blocks{{0, 0, 0}, {1, 0, 0}, {-3, 7, 2}, {250000, -250000, 1}, {0, 0, 1}};
  if (filled) state.grid.build(occupied_blocks, state.topology);
  for (int k = 0; k < 2; ++k) {
    ParticleSet<Real>& set = state.sets.emplace_back();
    set.name = k == 0 ? "first" : "second";
    for (const char* name : {"gained", "age"}) {
      if (k == 1) set.extra.push_back({name, {}});
    }
    set.allocate(kParticles);
    if (!filled) continue;
    int value = 17 * k;
    set.for_each_real([&](AlignedArray<Real>& channel) {
      for (std::size_t p = 0; p < set.count; ++p) channel[p] = Real(1) / Real(++value);
    });
    set.velocity[1][3] = -Real(0);
    set.strain[2][4] = std::numeric_limits<Real>::denorm_min();
    set.begin = {0, 10, 10, 25, 49, 50};
    for (std::size_t p = 0; p < set.count; ++p) set.id[p] = static_cast<std::uint32_t>(1000 * k + 7 * p);
  }
  if (filled) {
    state.tallies = {0.25, -7.0, 1e300};
    state.rest.resize(occupied_blocks.size());
    state.rest.asleep[2] = 1;
    state.rest.calm[3] = 0.25;
    state.rest.way[2] = {1e-3, -2e-5, 0.5};
    state.counters = {3, 271, 0.0123, 0.1373, 1e-4, 2.5, 17.0, 2, 991, 5, 8, 0.01};
  }
  return state;
}

/// The same counters with other bytes between them, where the compiler leaves gaps.
void fill_gaps(Counters& counters, int byte) {
  const Counters c = counters;
  std::memset(static_cast<void*>(&counters), byte, sizeof counters);
  counters.frame = c.frame;
  counters.step = c.step;
  counters.time_in_frame = c.time_in_frame;
  counters.time = c.time;
  counters.last_dt = c.last_dt;
  counters.max_speed = c.max_speed;
  counters.max_gradient = c.max_gradient;
  counters.sort_due = c.sort_due;
  counters.segments_when_sorted = c.segments_when_sorted;
  counters.segments_wasted = c.segments_wasted;
  counters.sorts = c.sorts;
  counters.unseen_motion = c.unseen_motion;
}

template <class Real>
class Checkpoint : public ::testing::Test {
 protected:
  void SetUp() override {
    const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / ("repose_checkpoint_" + std::string(test->name()) +
                                           std::to_string(sizeof(Real)) + "_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }
  std::string path() const { return (folder_ / "a.checkpoint").string(); }

  void save(const State<Real>& state) const {
    const auto saved = save_checkpoint(state, "0123456789abcdef", path());
    ASSERT_TRUE(saved) << saved.error().text();
  }
  Error load_error(State<Real>& state, const std::string& scene = "0123456789abcdef") const {
    const auto loaded = load_checkpoint(path(), scene, state);
    EXPECT_FALSE(loaded);
    return loaded ? Error{} : loaded.error();
  }
  std::string bytes() const { return bytes_of(path()); }
  void rewrite(const std::string& text) const { std::ofstream(path(), std::ios::binary) << text; }

  fs::path folder_;
};

using Reals = ::testing::Types<float, double>;
TYPED_TEST_SUITE(Checkpoint, Reals);

TYPED_TEST(Checkpoint, SavedAndLoaded_IsTheSameBitForBit) {
  const State<TypeParam> saved = make_state<TypeParam>(true);
  this->save(saved);
  State<TypeParam> loaded = make_state<TypeParam>(false);
  const auto result = load_checkpoint(this->path(), "0123456789abcdef", loaded);
  ASSERT_TRUE(result) << result.error().text();
  for (std::size_t k = 0; k < 2; ++k) {
    EXPECT_EQ(loaded.sets[k].begin, saved.sets[k].begin);
    EXPECT_EQ(loaded.rest.asleep, saved.rest.asleep);
    EXPECT_EQ(loaded.rest.calm, saved.rest.calm);
    EXPECT_EQ(loaded.rest.way, saved.rest.way);
    std::vector<const TypeParam*> before;
    saved.sets[k].for_each_real([&](const auto& channel) { before.push_back(channel.data()); });
    std::size_t c = 0;
    loaded.sets[k].for_each_real([&](const auto& channel) {
      EXPECT_EQ(std::memcmp(channel.data(), before[c], kParticles * sizeof(TypeParam)), 0) << "channel " << c;
      ++c;
    });
    EXPECT_EQ(c, 21u + 2u * k);
    EXPECT_EQ(std::memcmp(loaded.sets[k].id.data(), saved.sets[k].id.data(), kParticles * 4), 0);
  }
  EXPECT_EQ(loaded.tallies, saved.tallies);
  EXPECT_EQ(loaded.counters.frame, saved.counters.frame);
  EXPECT_EQ(loaded.counters.step, saved.counters.step);
  EXPECT_EQ(loaded.counters.time_in_frame, saved.counters.time_in_frame);
  EXPECT_EQ(loaded.counters.time, saved.counters.time);
  EXPECT_EQ(loaded.counters.last_dt, saved.counters.last_dt);
  EXPECT_EQ(loaded.counters.max_speed, saved.counters.max_speed);
  EXPECT_EQ(loaded.counters.max_gradient, saved.counters.max_gradient);
  EXPECT_EQ(loaded.counters.sort_due, saved.counters.sort_due);
  EXPECT_EQ(loaded.counters.segments_when_sorted, saved.counters.segments_when_sorted);
  EXPECT_EQ(loaded.counters.segments_wasted, saved.counters.segments_wasted);
  EXPECT_EQ(loaded.counters.sorts, saved.counters.sorts);
  ASSERT_EQ(loaded.grid.size(), saved.grid.size());
  EXPECT_TRUE(
      std::equal(loaded.grid.blocks().begin(), loaded.grid.blocks().end(), saved.grid.blocks().begin()));
  EXPECT_TRUE(std::equal(loaded.grid.occupied_blocks().begin(), loaded.grid.occupied_blocks().end(),
                         saved.grid.occupied_blocks().begin()));
  EXPECT_EQ(state_hash(loaded), state_hash(saved));
  EXPECT_EQ(loaded.rows_touched.size(), loaded.grid.occupied_blocks().size());
  EXPECT_EQ(loaded.nodes.values.size(), loaded.grid.size() * kBlockValues);
}

TYPED_TEST(Checkpoint, SavedTwice_EqualBytes) {
  State<TypeParam> state = make_state<TypeParam>(true);
  fill_gaps(state.counters, 0x00);
  this->save(state);
  const std::string first = this->bytes();
  fill_gaps(state.counters, 0xff);
  this->save(state);
  EXPECT_EQ(this->bytes(), first);
}

TYPED_TEST(Checkpoint, AnyFlippedBit_IsRefused) {
  this->save(make_state<TypeParam>(true));
  const std::string good = this->bytes();
  State<TypeParam> state = make_state<TypeParam>(false);
  for (std::size_t at = 0; at < good.size(); at += 101) {
    std::string bad = good;
    bad[at] = static_cast<char>(bad[at] ^ 4);
    this->rewrite(bad);
    EXPECT_EQ(this->load_error(state).kind, ErrorKind::kIo) << "byte " << at;
  }
}

TYPED_TEST(Checkpoint, FlippedBit_NamesFileAndChunk) {
  this->save(make_state<TypeParam>(true));
  std::string bad = this->bytes();
  const std::size_t head = bad.find("set1.3");  // the first velocity of the second set
  ASSERT_NE(head, std::string::npos);
  bad[head + 32 + 5] = static_cast<char>(bad[head + 32 + 5] ^ 1);
  this->rewrite(bad);
  State<TypeParam> state = make_state<TypeParam>(false);
  EXPECT_EQ(this->load_error(state).text(),
            this->path() + ": chunk 'set1.3' does not have its checksum; use an older checkpoint");
}

TYPED_TEST(Checkpoint, CutAnywhere_IsRefused) {
  this->save(make_state<TypeParam>(true));
  const std::string good = this->bytes();
  State<TypeParam> state = make_state<TypeParam>(false);
  for (std::size_t size = 0; size < good.size(); size += 97) {
    this->rewrite(good.substr(0, size));
    EXPECT_EQ(this->load_error(state).kind, ErrorKind::kIo) << "cut at " << size;
  }
  this->rewrite(good.substr(0, good.size() - 1));
  EXPECT_THAT(this->load_error(state).text(), HasSubstr("chunk 'set1.22' is cut short"));
}

TYPED_TEST(Checkpoint, OtherScene_NamesBoth) {
  this->save(make_state<TypeParam>(true));
  State<TypeParam> state = make_state<TypeParam>(false);
  const Error error = this->load_error(state, "fedcba9876543210");
  EXPECT_EQ(error.kind, ErrorKind::kBadScene);
  EXPECT_THAT(error.text(), HasSubstr("0123456789abcdef"));
  EXPECT_THAT(error.text(), HasSubstr("fedcba9876543210"));
}

TYPED_TEST(Checkpoint, WhereParticlesBeginAndEnd_OtherCountsAndTheLedgerComeBack) {
  State<TypeParam> saved = make_state<TypeParam>(true);
  saved.ledger = {kParticles, 991, {17, 24}, {1, 2, 3, 4}, {5, 6}};
  this->save(saved);
  State<TypeParam> fresh;  // as compiled: an empty set, and a longer one
  fresh.tallies.assign(3, 0.0);
  fresh.rest.on = true;
  fresh.sets.resize(2);
  for (const char* name : {"gained", "age"}) fresh.sets[1].extra.push_back({name, {}});
  fresh.sets[1].allocate(3 * kParticles);
  fresh.ledger = {0, 0, {0, 0}, {0, 0, 0, 0}, {0, 0}};
  const auto loaded = load_checkpoint(this->path(), "0123456789abcdef", fresh);
  ASSERT_TRUE(loaded) << loaded.error().text();
  EXPECT_EQ(state_hash(fresh), state_hash(saved));
  for (std::size_t k = 0; k < 2; ++k) EXPECT_EQ(fresh.sets[k].count, kParticles);
  EXPECT_EQ(fresh.ledger.initial, kParticles);
  EXPECT_EQ(fresh.ledger.next_id, 991u);
  EXPECT_EQ(fresh.ledger.emitted, saved.ledger.emitted);
  EXPECT_EQ(fresh.ledger.removed, saved.ledger.removed);
  EXPECT_EQ(fresh.ledger.strayed, saved.ledger.strayed);
  EXPECT_EQ(fresh.counters.unseen_motion, saved.counters.unseen_motion);
}

TYPED_TEST(Checkpoint, EmptyState_IsSavedAndLoaded) {
  State<TypeParam> saved;
  saved.sets.resize(1);
  saved.sets[0].begin = {0};
  saved.ledger.emitted = {0};
  this->save(saved);
  State<TypeParam> loaded;
  loaded.sets.resize(1);
  loaded.sets[0].allocate(5);
  loaded.ledger.emitted = {0};
  ASSERT_TRUE(load_checkpoint(this->path(), "0123456789abcdef", loaded));
  EXPECT_EQ(loaded.particles(), 0u);
  EXPECT_EQ(loaded.grid.size(), 0u);
}

TYPED_TEST(Checkpoint, OtherPrecisionOrParticles_IsRefused) {
  this->save(make_state<TypeParam>(true));
  using Other = std::conditional_t<sizeof(TypeParam) == 4, double, float>;
  State<Other> other = make_state<Other>(false);
  const auto precision = load_checkpoint(this->path(), "0123456789abcdef", other);
  ASSERT_FALSE(precision);
  EXPECT_EQ(precision.error().kind, ErrorKind::kBadScene);
  State<TypeParam> more = make_state<TypeParam>(false);
  more.sets[1].allocate(kParticles + 1);
  EXPECT_EQ(this->load_error(more).kind, ErrorKind::kBadScene);
}

TYPED_TEST(Checkpoint, NoFile_NoInput) {
  State<TypeParam> state = make_state<TypeParam>(false);
  EXPECT_EQ(this->load_error(state).kind, ErrorKind::kNoInput);
}

TYPED_TEST(Checkpoint, OtherFile_IsRefused) {
  this->rewrite("REPOSE STATE 9\n" + std::string(1000, ' '));
  State<TypeParam> state = make_state<TypeParam>(false);
  const Error error = this->load_error(state);
  EXPECT_EQ(error.kind, ErrorKind::kIo);
  EXPECT_THAT(error.text(), HasSubstr("is not a checkpoint of this version"));
}

TYPED_TEST(Checkpoint, Header_TellsCounters) {
  this->save(make_state<TypeParam>(true));
  const auto header = read_checkpoint_header(this->path());
  ASSERT_TRUE(header) << header.error().text();
  EXPECT_EQ(header->scene_hash, "0123456789abcdef");
  EXPECT_EQ(header->precision_bytes, static_cast<int>(sizeof(TypeParam)));
  EXPECT_EQ(header->particles, 2 * kParticles);
  EXPECT_EQ(header->counters.frame, 3);
  EXPECT_EQ(header->counters.step, 271);
}

}  // namespace
}  // namespace repose
