// Repose tests: large arrays come from the allocator that a host has set, and go back to it, whoever is set by
// then; one that gives no more is answered, not fallen over.
#include <atomic>
#include <cstdlib>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

/// What was asked for and given back; gives at most `budget` bytes at a time.
struct Host {
  std::atomic<std::size_t> held = 0, most = 0, calls = 0;
  std::size_t budget = static_cast<std::size_t>(-1);

  Host() {
    repose_allocator mine = repose_allocator_init();
    mine.allocate = &give;
    mine.release = &take;
    mine.user = this;
    EXPECT_EQ(repose_set_allocator(&mine), REPOSE_OK);
  }
  ~Host() { repose_set_allocator(nullptr); }
  Host(const Host&) = delete;

  static void* give(void* user, std::size_t bytes, std::size_t alignment) {
    auto& host = *static_cast<Host*>(user);
    EXPECT_EQ(alignment, 64u);
    EXPECT_EQ(bytes % alignment, 0u);
    ++host.calls;
    const std::size_t held = host.held += bytes;
    if (held > host.budget) {
      host.held -= bytes;
      return nullptr;
    }
    host.most = std::max(host.most.load(), held);
    return std::aligned_alloc(alignment, bytes);
  }
  static void take(void* user, void* memory, std::size_t bytes, std::size_t alignment) {
    EXPECT_EQ(alignment, 64u);
    static_cast<Host*>(user)->held -= bytes;
    std::free(memory);
  }
};

std::uint64_t hash_after_a_frame(Engine engine) {
  engine.advance_frame();
  return engine.hash();
}

TEST(HostsAllocator, GivesAllThatGrowsWithParticlesAndGetsItBack) {
  const std::uint64_t plain = hash_after_a_frame(box_engine());
  Host host;
  EXPECT_EQ(hash_after_a_frame(box_engine()), plain);
  constexpr std::size_t kParticles = 512, kLeast = 21 * 4 + 4;  // x, v, C, strain and id
  EXPECT_GT(host.most.load(), kParticles * kLeast);
  EXPECT_EQ(host.held.load(), 0u);
}

TEST(HostsAllocator, ImplicitSolversAskItToo) {
  std::size_t of_explicit = 0, of_implicit = 0;
  for (const char* integrator : {"explicit", "implicit"}) {
    Host host;
    Scene scene = Scene::from_text(box_scene());
    scene.set("time.integrator", integrator);
    hash_after_a_frame(Engine(scene));
    (integrator[0] == 'e' ? of_explicit : of_implicit) = host.most;
    EXPECT_EQ(host.held.load(), 0u);
  }
  EXPECT_GT(of_implicit, 2 * of_explicit);
}

TEST(HostsAllocator, OneThatGivesNoMore_IsAMemoryError) {
  std::size_t most = 0;
  {
    Host host;
    hash_after_a_frame(box_engine());
    most = host.most;
  }
  for (const std::size_t budget : {std::size_t{0}, most / 4, most / 2, most - 1}) {
    Host host;
    host.budget = budget;
    try {
      hash_after_a_frame(box_engine());
      ADD_FAILURE() << budget << " of " << most << " bytes were enough";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), REPOSE_ERROR_MEMORY) << error.what();
    }
    EXPECT_EQ(host.held.load(), 0u) << "of what was given all came back";
  }
}

TEST(HostsAllocator, ReplacedWhileAnEngineLives_GetsBackWhatItGave) {
  const std::uint64_t plain = hash_after_a_frame(box_engine());
  Host first;
  Engine engine = box_engine();
  EXPECT_GT(first.held.load(), 0u);
  {
    Host second;
    engine.advance_frame();
    EXPECT_EQ(engine.hash(), plain);
    { const Engine gone = std::move(engine); }
    EXPECT_EQ(second.held.load(), 0u);
  }
  EXPECT_EQ(first.held.load(), 0u);
}

TEST(HostsAllocator, WithoutAFunction_IsRefused) {
  repose_allocator half = repose_allocator_init();
  EXPECT_EQ(repose_set_allocator(&half), REPOSE_ERROR_ARGUMENT);
  half.allocate = &Host::give;
  EXPECT_EQ(repose_set_allocator(&half), REPOSE_ERROR_ARGUMENT);
  EXPECT_NO_THROW(box_engine());
}

}  // namespace
}  // namespace repose
