// Repose tests: VDB files are parsed by another program, which may be missing, hang, crash or lie.
#include <fcntl.h>
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cmath>

#include "engine/geometry/vdb_grid.h"
#include "engine/io/point_cloud.h"
#include "engine/io/surface.h"
#include "engine/vdb/find_reader.h"
#include "tests/engine/geometry/grid_writer.h"
#include "tests/engine/vdb/reader_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

double seconds_of(const std::function<void()>& work) {
  const auto begin = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Some particles with masses.
PointCloud particles() {
  PointCloud points;
  points.spacing = 0.1;
  for (std::uint32_t p = 0; p < 300; ++p) {
    points.position.push_back({0.05 * (p % 10), 0.05 * (p / 10 % 10), 0.05 * (p / 100)});
    points.velocity.push_back({1.0f, -0.5f, 0.25f});
    points.id.push_back(p);
    points.radius.push_back(0.03f);
    points.mass.push_back(0.2f);
  }
  return points;
}

class VdbReaderProgram : public ::testing::Test {
 protected:
  void SetUp() override {
    write_grids(path("g.vdb"),
                {{"a", TestGrid::Kind::kFloat, [](const Vec3& x) { return Vec3(x[0] + 2.0, 0, 0); }}});
    good_ = bytes_of(path("g.vdb"));
    const auto found = find_reader({});
    ASSERT_TRUE(found) << found.error().text();
    program_ = *found;
  }
  std::string path(const std::string& name) const { return folder_.path(name); }
  Result<std::shared_ptr<const ScalarGrid>> read(const std::string& file, const VdbReader& reader = {},
                                                 const std::string& grid = "a") const {
    return ScalarGrid::read({true, file, grid}, {folder_.path().string(), false, reader});
  }
  /// By a script, within some seconds.
  std::string refusal_by(const std::string& lines, const std::string& part, double seconds = 20.0) const {
    const auto read_by = read("g.vdb", {script(folder_, "reader", lines), 0.0, seconds});
    EXPECT_FALSE(read_by) << lines;
    if (read_by) return {};
    EXPECT_EQ(read_by.error().kind, ErrorKind::kNoInput) << read_by.error().text();
    EXPECT_EQ(read_by.error().where, path("g.vdb"));
    EXPECT_NE(read_by.error().message.find(part), std::string::npos) << read_by.error().text();
    return read_by.error().message;
  }
  /// What the true program tells of the good file.
  std::string told() const {
    std::string all;
    FILE* const pipe = ::popen((program_ + " 1000000000 20 float " + path("g.vdb") + " a").c_str(), "r");
    for (int c = std::fgetc(pipe); c != EOF; c = std::fgetc(pipe)) all += static_cast<char>(c);
    ::pclose(pipe);
    return all;
  }

  const TemporaryFolder folder_;
  std::string good_, program_;
};

TEST_F(VdbReaderProgram, GoodFile_IsRead) {
  const auto grid = read("g.vdb");
  ASSERT_TRUE(grid) << grid.error().text();
  EXPECT_NEAR((*grid)->at({0.25, 0.5, 0.5}), 2.25, 1e-6);
}

TEST_F(VdbReaderProgram, FileCutWhereItsSizesStand_IsRefusedInLittleMemory) {
  const double before = own_memory("VmHWM");
  double longest = 0.0;
  for (std::size_t bytes = 150; bytes < 400; bytes += bytes == 220 || bytes == 225 ? 5 : 10) {
    folder_.write("cut.vdb", good_.substr(0, bytes));
    const double seconds = seconds_of([&] {
      const auto grid = read("cut.vdb");
      ASSERT_FALSE(grid) << bytes;
      EXPECT_EQ(grid.error().kind, ErrorKind::kNoInput);
      EXPECT_NE(grid.error().text().find("cut.vdb: cannot be read as a VDB file: "), std::string::npos)
          << grid.error().text();
    });
    longest = std::max(longest, seconds);
  }
  rusage children{};
  ::getrusage(RUSAGE_CHILDREN, &children);
  std::printf("%.2f s, here %.1f MB, there at most %.0f MB\n", longest, 1e-6 * (own_memory("VmHWM") - before),
              1e-3 * static_cast<double>(children.ru_maxrss));
  EXPECT_LT(longest, 22.0);
  EXPECT_LT(own_memory("VmHWM") - before, 16e6);
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_LT(children.ru_maxrss, 600 << 10);
#endif
}

TEST_F(VdbReaderProgram, OwnFileWithAFlippedBit_IsRefused) {
  ASSERT_TRUE(write_fog(particles(), {.voxel = 0.1, .flat_axis = {}}, path("fog.vdb")));
  const std::string fog = bytes_of(path("fog.vdb"));
  ASSERT_TRUE(read("fog.vdb", {}, "density"));
  std::mt19937_64 random(3);
  for (std::size_t k = 0; k < 400; ++k) {
    std::string flipped = fog;
    flipped[k < 64 ? k : random() % fog.size()] ^= static_cast<char>(1 << random() % 8);
    folder_.write("bad.vdb", flipped);
    const auto grid = read("bad.vdb", {}, "density");
    ASSERT_FALSE(grid) << k;
    ASSERT_EQ(grid.error().kind, ErrorKind::kBadScene) << k << ": " << grid.error().text();
    ASSERT_NE(grid.error().message.find("its checksum does not fit"), std::string::npos);
  }
}

TEST_F(VdbReaderProgram, NoProgram_NoInput) {
  const auto by_option = read("g.vdb", {path("none"), 0.0, 0.0});
  ASSERT_FALSE(by_option);
  EXPECT_EQ(by_option.error().kind, ErrorKind::kNoInput);
  EXPECT_NE(by_option.error().text().find(path("none")), std::string::npos) << by_option.error().text();
  ::setenv("REPOSE_VDB_READER", path("other").c_str(), 1);
  const auto by_environment = read("g.vdb");
  ::unsetenv("REPOSE_VDB_READER");
  ASSERT_FALSE(by_environment);
  EXPECT_EQ(by_environment.error().kind, ErrorKind::kNoInput);
  EXPECT_NE(by_environment.error().text().find(path("other") + "\", which REPOSE_VDB_READER names"),
            std::string::npos);
  folder_.write("text", "no program");
  ::chmod(path("text").c_str(), 0755);
  const auto text = read("g.vdb", {path("text"), 0.0, 0.0});
  ASSERT_FALSE(text);
  EXPECT_EQ(text.error().kind, ErrorKind::kNoInput);
  EXPECT_NE(text.error().text().find("cannot be started"), std::string::npos) << text.error().text();
}

TEST_F(VdbReaderProgram, ProgramThatHangs_IsKilledInTime) {
  for (const char* lines : {"exec sleep 1000", "sleep 1000 & sleep 1000", "while :; do :; done"}) {
    EXPECT_LT(seconds_of([&] { refusal_by(lines, "the reader ran past 1.5 s", 1.5); }), 6.0);
  }
  // It has told all but the end, or all and does not end.
  folder_.write("told", told());
  EXPECT_LT(seconds_of([&] {
              refusal_by("head -c -8 " + path("told") + "; exec sleep 1000", "the reader ran past 1.5 s", 1.5);
            }),
            6.0);
  const auto stays =
      read("g.vdb", {script(folder_, "reader", "cat " + path("told") + "; exec sleep 1000 >&-"), 0, 9});
  EXPECT_TRUE(stays) << stays.error().text();
}

TEST_F(VdbReaderProgram, ProgramThatEndsOrCrashes_IsToldOf) {
  refusal_by("kill -SEGV $$", "the reader crashed (signal 11)");
  refusal_by("exit 3", "the reader ended with exit code 3");
  refusal_by("echo no library >&2; exit 127", "the reader ended with exit code 127: no library");
  refusal_by("yes | head -c 1000000 >&2; exit 4", "the reader ended with exit code 4: y");
}

TEST_F(VdbReaderProgram, ProgramThatTellsNonsense_IsRefused) {
  refusal_by("echo 01234567890123456789", "not the beginning of an answer");
  const std::string all = told();
  ASSERT_GT(all.size(), 2000u);
  folder_.write("told", all);
  refusal_by("cat " + path("told") + "; echo", "more than an answer");
  const double before = own_memory("VmHWM");
  refusal_by("cat " + path("told") + " /dev/zero", "more than an answer");
  refusal_by("head -c 300 " + path("told") + "; exec cat /dev/zero", "the reader ");
  std::mt19937_64 random(4);
  int read_well = 0;
  for (int k = 0; k < 200; ++k) {
    std::string lie = all;
    if (k % 4 == 0)
      lie.resize(random() % lie.size());
    else
      lie[k % 4 == 1 ? random() % 310 : random() % lie.size()] ^= static_cast<char>(1 << random() % 8);
    folder_.write("lie", lie);
    const auto grid = read("g.vdb", {script(folder_, "reader", "exec cat " + path("lie")), 300e6, 20.0});
    read_well += grid ? 1 : 0;
    if (grid) continue;
    ASSERT_EQ(grid.error().kind, ErrorKind::kNoInput) << grid.error().text();
  }
  EXPECT_EQ(read_well, 0);
  EXPECT_LT(own_memory("VmHWM") - before, 700e6) << "twice what may be told";
}

TEST_F(VdbReaderProgram, LimitOfMemory_IsKept) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  write_grids(path("big.vdb"), {{"a", TestGrid::Kind::kFloat,
                                 [](const Vec3& x) { return Vec3(std::sin(9 * x[0]), 0, 0); }, 0.01}});
  ASSERT_TRUE(read("big.vdb"));
  const auto grid = read("big.vdb", {"", 1e6, 0.0});
  ASSERT_FALSE(grid);
  EXPECT_EQ(grid.error().kind, ErrorKind::kNoInput) << grid.error().text();
#endif
}

volatile sig_atomic_t heard = 0;
void hear(int) {
  heard = heard + 1;
}

TEST_F(VdbReaderProgram, SignalsOfTheHost_StayAsTheyAre) {
  for (void (*handler)(int) : {SIG_DFL, SIG_IGN, &hear}) {
    struct sigaction before {
    }, child{}, pipe{};
    before.sa_handler = handler;
    ::sigaction(SIGCHLD, &before, nullptr);
    ::sigaction(SIGPIPE, &before, nullptr);
    sigset_t blocked, mask;
    sigfillset(&blocked);
    ::sigprocmask(SIG_BLOCK, &blocked, &mask);  // what a host blocks reaches no child
    const auto grid = read("g.vdb");
    refusal_by("kill -TERM $$; exec sleep 1000",
               handler == SIG_IGN ? "the reader ended without an answer" : "the reader crashed (signal 15)");
    ::sigprocmask(SIG_SETMASK, &mask, nullptr);
    ::sigaction(SIGCHLD, nullptr, &child);
    ::sigaction(SIGPIPE, nullptr, &pipe);
    ::signal(SIGCHLD, SIG_DFL);
    ::signal(SIGPIPE, SIG_DFL);
    EXPECT_TRUE(grid) << grid.error().text();
    EXPECT_EQ(child.sa_handler, handler);
    EXPECT_EQ(pipe.sa_handler, handler);
    EXPECT_LT(::waitpid(-1, nullptr, WNOHANG), 0) << "a child is left";
  }
}

TEST_F(VdbReaderProgram, HostWithoutStandardFiles_ReadsAllTheSame) {
  const pid_t host = ::fork();
  if (host == 0) {
    for (int file = 0; file < 3; ++file) ::close(file);
    ::_exit(read("g.vdb") ? 0 : 1);
  }
  int status = 0;
  ::waitpid(host, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
}

TEST_F(VdbReaderProgram, DescriptorsOfTheHost_ReachNoProgramAndNoneIsLeft) {
  const auto count = [] {
    std::size_t files = 0;
    for (const auto& file : std::filesystem::directory_iterator("/proc/self/fd"))
      files += file.path().empty() ? 0 : 1;
    return files;
  };
  const int opened = ::open("/dev/null", O_RDONLY), open_here = ::fcntl(opened, F_DUPFD, 50);
  ASSERT_EQ(open_here, 50);  // without close-on-exec
  const std::size_t before = count();
  refusal_by("[ -e /proc/$$/fd/50 ]; exit $?", "the reader ended with exit code 1");
  EXPECT_TRUE(read("g.vdb"));
  EXPECT_EQ(count(), before);
  ::close(open_here);
  ::close(opened);
}

TEST_F(VdbReaderProgram, PointsAndFigures_ComeByTheProgramToo) {
  ASSERT_TRUE(write_vdb_points(particles(), path("p.vdb")));
  const auto points = read_vdb_points(path("p.vdb"));
  const auto figures = read_grid_figures(path("p.vdb"));
  ASSERT_TRUE(points && figures);
  EXPECT_EQ(points->size(), 300u);
  EXPECT_TRUE(figures->size() == 1 && (*figures)[0].points);
  ::setenv("REPOSE_VDB_READER", path("none").c_str(), 1);
  const auto none = read_vdb_points(path("p.vdb"));
  const auto no_figures = read_grid_figures(path("p.vdb"));
  ::unsetenv("REPOSE_VDB_READER");
  ASSERT_TRUE(!none && !no_figures);
  EXPECT_EQ(none.error().kind, ErrorKind::kNoInput);
  EXPECT_EQ(no_figures.error().kind, ErrorKind::kNoInput);
}

}  // namespace
}  // namespace repose
