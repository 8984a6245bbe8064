// Repose tests: how the library behaves as a guest in the process of a host: what the host has set is found as
// it was and changes no bit, and engines that come and go leave nothing behind.
#include <malloc.h>
#include <unistd.h>
#include <xmmintrin.h>

#include <clocale>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <locale>
#include <map>
#include <sstream>
#include <thread>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

/// What a host has of its work: the hash, what is written, and what is said.
using Work = std::vector<std::string>;

/// What goes through texts, numbers and files too.
Work work_of_a_host(const std::string& folder, int threads) {
  Scene scene = Scene::from_text(box_scene(R"(, "parameters": {"depth": 0.5},
    "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}])"));
  scene.set("colliders.floor.friction", "=0.625 * depth").set("gravity.acceleration", "[0.125, -9.8125, 0]");
  scene.check();
  const Scene again = Scene::from_text(scene.json());
  repose_engine_options options = repose_engine_options_init();
  options.threads = threads;
  Engine engine(again, options);
  engine.advance_frame();
  engine.add_particles("hand", std::vector<double>{0.0625, 0.25, 0.0625});
  engine.save(folder + "/state");
  engine.load(folder + "/state");
  engine.change("gravity.acceleration", "[0.25, -9.8125, 0]");
  engine.advance_frame();
  engine.surface();
  Work work{std::to_string(engine.hash()), again.json()};
  engine.save(folder + "/state");
  for (const char* name : {"points.ply", "points.vtp", "points.vdb", "state"}) {
    const std::string path = folder + "/" + name;
    if (std::string(name) != "state") engine.points().write(path);
    std::ostringstream bytes;
    bytes << std::ifstream(path, std::ios::binary).rdbuf();
    work.push_back(bytes.str());
  }
  try {
    scene.set("grid.spacing", "1.5e-3, 2.5");
    scene.check();
    ADD_FAILURE() << "it was taken";
  } catch (const Error& error) {
    work.push_back(error.what());
  }
  return work;
}

struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

void handler_of_the_host(int) {}

/// What a process has once, as a host finds it.
struct Process {
  std::string locale = std::setlocale(LC_ALL, nullptr);
  std::string decimal_point = std::localeconv()->decimal_point;
  std::locale of_streams;
  std::string folder = std::filesystem::current_path();
  mode_t mask = [] {
    const mode_t now = umask(0);
    umask(now);
    return now;
  }();
  std::map<int, void (*)(int)> handlers;

  Process() {
    for (int signal = 1; signal < SIGRTMIN; ++signal) {
      struct sigaction action {};
      if (sigaction(signal, nullptr, &action) == 0) handlers[signal] = action.sa_handler;
    }
  }
  bool operator==(const Process& other) const {
    return locale == other.locale && decimal_point == other.decimal_point && of_streams == other.of_streams &&
           folder == other.folder && mask == other.mask && handlers == other.handlers;
  }
};

/// A process as hosts make it, until the end of a test.
class OddProcess {
 public:
  OddProcess() {
    // A locale with a comma, where the machine has one.
    for (const char* name : {"de_DE.UTF-8", "de_DE.utf8", "fr_FR.UTF-8", "ru_RU.UTF-8", "C.UTF-8"}) {
      if (std::setlocale(LC_ALL, name) != nullptr) break;
    }
    std::locale::global(std::locale(std::locale(), new DecimalComma));
    for (const int signal : {SIGINT, SIGTERM, SIGSEGV, SIGFPE, SIGUSR1, SIGPIPE})
      before_[signal] = std::signal(signal, handler_of_the_host);
    std::filesystem::current_path(folder_.path());
  }
  ~OddProcess() {
    std::filesystem::current_path(was_in_);
    for (const auto& [signal, handler] : before_) std::signal(signal, handler);
    std::locale::global(std::locale::classic());
    std::setlocale(LC_ALL, "C");
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path was_in_ = std::filesystem::current_path();
  std::map<int, void (*)(int)> before_;
};

TEST(ApiGuest, ProcessOfTheHost_IsFoundAsItWasAndChangesNoBit) {
  const TemporaryFolder folder;
  const Work plain = work_of_a_host(folder.path(), 2);
  const OddProcess odd;
  const Process before;
  const Work work = work_of_a_host(folder.path(), 2);
  const Process after;
  ASSERT_EQ(work.size(), plain.size());
  for (std::size_t k = 0; k < work.size(); ++k) EXPECT_TRUE(work[k] == plain[k]) << k << work[k].substr(0, 400);
  EXPECT_EQ(after.locale, before.locale);
  EXPECT_EQ(after.folder, before.folder);
  EXPECT_TRUE(after == before);
}

TEST(ApiGuest, FlushedDenormalsAndAnotherRounding_AreFoundAsTheyWereAndChangeNoBit) {
  const TemporaryFolder folder;
  const Work plain = work_of_a_host(folder.path(), 1);
  const unsigned usual = _mm_getcsr();
  constexpr unsigned kFlush = 0x8040, kUpwards = 0x4000, kFlags = 0x3f;  // FTZ and DAZ; rounding; what was met
  for (const int threads : {1, 2}) {
    _mm_setcsr(usual | kFlush | kUpwards);
    const unsigned before = _mm_getcsr();
    const Work work = work_of_a_host(folder.path(), threads);
    const unsigned after = _mm_getcsr();
    _mm_setcsr(usual);
    EXPECT_EQ(after & ~kFlags, before & ~kFlags);
    EXPECT_TRUE(work == plain);
  }
}

TEST(ApiGuest, EnginesOfOtherScenesComingAndGoingAside_ChangeNoBit) {
  const TemporaryFolder folder;
  const Work alone = work_of_a_host(folder.path(), 1);
  std::array<Work, 8> works;
  std::vector<std::thread> hosts;
  for (std::size_t k = 0; k < works.size(); ++k) {
    hosts.emplace_back([&folder, &work = works[k], k] {
      const std::string mine = folder.path(std::to_string(k));
      std::filesystem::create_directory(mine);
      work = work_of_a_host(mine, 1 + static_cast<int>(k % 2));
      for (int often = 0; often < 4; ++often) box_engine(2, R"(, "volume_correction": {})").advance_step();
    });
  }
  for (std::thread& host : hosts) host.join();
  for (const Work& work : works) EXPECT_TRUE(work == alone) << work.back();
}

/// Bytes that the process has asked for and not given back. Sanitizers do not tell, and see what leaks
/// themselves.
std::size_t bytes_in_use() {
  const struct mallinfo2 info = mallinfo2();
  return info.uordblks + info.hblkhd;
}

TEST(ApiGuest, MadeAdvancedAndDestroyedAThousandTimes_LeavesNothing) {
  const Scene scene = Scene::from_text(R"({"repose": 1, "name": "tiny", "grid": {"spacing": 0.03125},
    "materials": {"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e5}},
    "bodies": [{"name": "box", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.03125, 0.03125, 0.03125]}}],
    "colliders": [{"name": "floor", "shape": {"type": "plane"}}]})");
  repose_engine_options options = repose_engine_options_init();
  options.threads = 2;
  std::uint64_t hash = 0;
  std::size_t early = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k == 100) early = bytes_in_use();
    Engine engine(scene, options);
    engine.advance_step();
    engine.points();
    engine.fog();
    if (k == 0) hash = engine.hash();
    ASSERT_EQ(engine.hash(), hash);
  }
  // 900 engines of some 100 kB each have come and gone.
  EXPECT_LE(bytes_in_use(), early + 64 * 1024);
}

}  // namespace
}  // namespace repose
