// Repose tests: a warm step asks for no memory. Every call of malloc and its kin in this program is counted, so
// it is one of its own; operator new ends there too. Sanitizers bring a malloc of their own: then nothing is
// counted and the tests skip.
#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <thread>

#include "engine/base/parallel.h"
#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"
#include "engine/state/block_sort.h"

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__) || !defined(__GLIBC__)
#define REPOSE_COUNTS_ALLOCATIONS 0
#else
#define REPOSE_COUNTS_ALLOCATIONS 1
#endif

namespace {
std::atomic<std::int64_t> g_allocations{0};
}

#if REPOSE_COUNTS_ALLOCATIONS
extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);

void* malloc(std::size_t bytes) noexcept {
  ++g_allocations;
  return __libc_malloc(bytes);
}
void* calloc(std::size_t count, std::size_t bytes) noexcept {
  ++g_allocations;
  return __libc_calloc(count, bytes);
}
void* realloc(void* old, std::size_t bytes) noexcept {
  ++g_allocations;
  return __libc_realloc(old, bytes);
}
void* aligned_alloc(std::size_t alignment, std::size_t bytes) noexcept {
  ++g_allocations;
  return __libc_memalign(alignment, bytes);
}
int posix_memalign(void** result, std::size_t alignment, std::size_t bytes) noexcept {
  ++g_allocations;
  *result = __libc_memalign(alignment, bytes);
  return *result == nullptr ? 12 : 0;  // ENOMEM
}
}
#endif

namespace repose {
namespace {

/// A box of sand in a box that it fills, at rest but for the settling under its weight.
constexpr const char* kSettled = R"json({"repose": 1, "name": "settled", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "sand", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 0.12, 0.16]}}],
  "colliders": [{"name": "walls", "hollow": true, "contact": "slip", "friction": 0.5,
                 "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.16, 1, 0.16]}}]})json";

class Allocation : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    if (!REPOSE_COUNTS_ALLOCATIONS) GTEST_SKIP() << "the sanitizer's malloc cannot be replaced";
    const std::int64_t before = g_allocations;
    int* volatile seen = new int(1);  // volatile, or the pair may be left out
    delete seen;
    ASSERT_GT(g_allocations, before) << "the count sees operator new";
  }
};

/// Has the workers that there are come together. On a machine with other work one may be started after all the
/// steps that warm up, and what its own start asks for is no step's.
void start_workers(int threads) {
  const int all = std::min(threads, static_cast<int>(std::thread::hardware_concurrency()));
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(10);
  std::atomic<int> here{0};
  Threads(all).for_each(static_cast<std::size_t>(all), [&](std::size_t) {
    ++here;
    while (here < all && std::chrono::steady_clock::now() < patience) std::this_thread::yield();
  });
}

/// Counts in a hundred warm steps of the settled box.
void expect_no_allocation(int threads, const std::vector<std::string>& overrides) {
  const auto scene = read_scene_text(kSettled, "settled", ".", {overrides, false});
  ASSERT_TRUE(scene) << scene.error().text();
  SimulationOptions options;
  options.threads = threads;
  auto simulation = Simulation::create(*scene, options);
  ASSERT_TRUE(simulation) << simulation.error().text();
  start_workers(threads);
  for (int step = 0; step < 150; ++step) ASSERT_TRUE((*simulation)->step());
  int quiet = 0;
  for (int step = 0; step < 100; ++step) {
    const std::size_t blocks = (*simulation)->memory().blocks;
    const std::int64_t before = g_allocations;
    const bool accepted = static_cast<bool>((*simulation)->step());
    const std::int64_t allocations = g_allocations - before;
    ASSERT_TRUE(accepted);
    if ((*simulation)->memory().blocks != blocks) continue;
    EXPECT_EQ(allocations, 0) << "step " << step;
    ++quiet;
  }
  EXPECT_GE(quiet, 90);
}

TEST_P(Allocation, WarmStepWithoutNewBlocks_None) {
  expect_no_allocation(GetParam(), {});
}

TEST_P(Allocation, WarmStepWithSolidsThatMovePinsAndProbes_None) {
  expect_no_allocation(GetParam(), {R"json(colliders[0].motion={"keys": [
      {"time": 0}, {"time": 1, "rotation_angle": 1, "translation": [0.001, 0, 0]}], "interpolation": "smooth"})json",
                                    R"json(probes=[{"name": "w", "type": "force", "collider": "walls"},
      {"name": "d", "type": "flow", "point": [0, 0.05, 0]}, {"name": "e", "type": "energy"}])json",
                                    R"json(pins=[{"name": "p",
      "shape": {"type": "sphere", "center": [0.08, 0.06, 0.08], "radius": 0.03}}])json"});
}

/// A cube of 8^3 blocks; ids decide velocities, so that the state is the same for any order of storage.
State<float> cube_of_blocks() {
  State<float> state;
  state.spacing = 1.0;
  ParticleSet<float>& set = state.sets.emplace_back();
  constexpr std::int32_t kSide = 32;
  set.allocate(kSide * kSide * kSide);
  std::vector<std::vector<Index3>> cells(1);
  for (std::uint32_t p = 0; p < set.count; ++p) {
    const auto cell = static_cast<std::int32_t>(p);
    cells[0].push_back({cell / kSide / kSide, cell / kSide % kSide, cell % kSide});
    for (auto& channel : set.position) channel[p] = 0.75f;
    set.id[p] = p;
  }
  place_in_blocks(state, cells, {});
  return state;
}

TEST_P(Allocation, WarmOrderWithoutNewBlocks_None) {
  State<float> state = cube_of_blocks();
  Threads threads(GetParam());
  BlockSort<float> block_sort;
  block_sort.sort(state, threads, {});
  ParticleSet<float>& set = state.sets[0];
  for (int event = 0; event < 12; ++event) {
    // To and fro by a block along z, but for those whom this would take out of the cube.
    for (std::size_t p = 0; p < set.count; ++p) {
      const std::uint32_t z = set.id[p] % 32;
      if (z >= 4 && z < 28 && set.id[p] % 3 == 0) set.position[2][p] += event % 2 == 0 ? 4.0f : -4.0f;
    }
    const std::int64_t before = g_allocations;
    const bool new_blocks = block_sort.sort(state, threads, {});
    const std::int64_t allocations = g_allocations - before;
    EXPECT_FALSE(new_blocks);
    if (event >= 4) {
      EXPECT_EQ(allocations, 0) << "event " << event;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Threads, Allocation, ::testing::Values(1, 2));

}  // namespace
}  // namespace repose
