// Repose tests: kernel_bench as its users run it: right kernels are timed and stand in the table, a wrong one
// is not, and ends it with exit code 1.
#include <gmock/gmock.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace repose {
namespace {

using ::testing::ContainsRegex;
using ::testing::HasSubstr;
using ::testing::Not;

struct Finished {
  int code = -1;
  std::string text;  ///< out and err
};

/// Runs kernel_bench for an instant a kernel; `before` sets the environment.
Finished kernel_bench(const std::string& words, const std::string& before = "") {
  const std::string line =
      before + " '" REPOSE_KERNEL_BENCH "' --benchmark_min_time=0.000001 " + words + " 2>&1";
  Finished finished;
  std::FILE* pipe = popen(line.c_str(), "r");
  if (pipe == nullptr) return finished;
  char piece[4096];
  while (const std::size_t got = std::fread(piece, 1, sizeof piece, pipe)) finished.text.append(piece, got);
  const int status = pclose(pipe);
  if (WIFEXITED(status)) finished.code = WEXITSTATUS(status);
  return finished;
}

/// One kernel of every kind, in every precision and instruction set.
constexpr const char* kSome =
    "--benchmark_filter='^(scatter/quadratic/mls_apic|gather/cubic/flip|scatter/linear/flip/measuring|trial/elastic|"
    "return_map(_per_particle)?/drucker_prager|stress/"
    "elastic|harden|strengthen|cut_tension|advance|first_failed|open_volume|close_volume|add_arena/quadratic|"
    "load_arena/linear|normalize|accelerate|bound)/(float|double)/[a-z0-9]+/cache'";

TEST(KernelBench, RightKernels_AreTimed) {
  const Finished finished = kernel_bench(kSome);
  EXPECT_EQ(finished.code, 0) << finished.text;
  for (const char* kernel :
       {"scatter/quadratic/mls_apic", "gather/cubic/flip", "trial/elastic", "load_arena/linear"}) {
    for (const char* precision : {"/float", "/double"}) {
      EXPECT_THAT(finished.text,
                  ContainsRegex(kernel + std::string(precision) + "/baseline/cache .*each=.*roof="));
    }
  }
  EXPECT_THAT(finished.text, Not(HasSubstr("ERROR")));
}

TEST(KernelBench, WrongKernels_AreNotTimed) {
  for (const char* kernel :
       {"scatter", "trial", "return_map_per_particle", "first_failed", "strengthen", "add_arena", "bound"}) {
    const Finished finished = kernel_bench(kSome, std::string("REPOSE_BENCH_BREAK=") + kernel);
    EXPECT_EQ(finished.code, 1) << finished.text;
    std::istringstream lines(finished.text);
    int wrong = 0, right = 0;
    for (std::string line; std::getline(lines, line);) {
      if (line.find("/cache ") == std::string::npos) continue;
      const bool broken = line.starts_with(kernel);
      EXPECT_EQ(line.find(" ns ") == std::string::npos, broken) << line;
      EXPECT_EQ(line.find("differs from the reference") != std::string::npos, broken) << line;
      ++(broken ? wrong : right);
    }
    EXPECT_GT(wrong, 0) << kernel;
    EXPECT_GT(right, 0) << kernel;
  }
}

TEST(KernelBench, Table_HasARowPerKernelAndItsPeaks) {
  const auto file =
      std::filesystem::temp_directory_path() / ("repose_kernel_bench_" + std::to_string(getpid()));
  const Finished finished = kernel_bench(
      "--benchmark_filter='^(advance|bound)/float/baseline/cache' --table '" + file.string() + "'");
  ASSERT_EQ(finished.code, 0) << finished.text;
  std::stringstream table;
  table << std::ifstream(file).rdbuf();
  std::filesystem::remove(file);
  EXPECT_THAT(table.str(), ContainsRegex("\\| float \\| baseline \\|( [0-9]+ \\|){5}"));
  EXPECT_THAT(table.str(),
              ContainsRegex("\\| advance \\| float \\| baseline \\| cache \\| [0-9.]+ \\| 84 \\|.*%"));
  EXPECT_THAT(table.str(),
              ContainsRegex("\\| bound \\| float \\| baseline \\| cache \\| [0-9.]+ \\| 16 \\|.*%"));
}

TEST(KernelBench, NamesThatDoNotExist_AreRefused) {
  EXPECT_EQ(kernel_bench("--benchmark_filter=no_such_kernel").code, 64);
  EXPECT_EQ(kernel_bench("--no_such_option").code, 64);
  EXPECT_EQ(kernel_bench("--table").code, 64);
  EXPECT_EQ(kernel_bench("--benchmark_filter='^bound/float/baseline' --table /no/such/folder/table.md").code,
            73);
}

}  // namespace
}  // namespace repose
