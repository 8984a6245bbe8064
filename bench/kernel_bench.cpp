// Repose: kernel_bench times every kernel that the machine can run, alone, on one core, after comparing it with
// the plain reference, and holds it against the roofline of this machine, measured in the same run.
//   kernel_bench [--table FILE.md] [Google Benchmark's options, such as --benchmark_filter=scatter.*avx512]
// Exit codes: 0; 1 a kernel differs from its reference, which is then not timed; 64 usage; 73 no table written.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "bench/check_case.h"
#include "bench/kernel_case.h"
#include "bench/roofline.h"

namespace repose {
namespace {

constexpr std::size_t kCalls = 512;  ///< of the kernel, between two looks at the clock

Measurements g_measurements;
bool g_differs = false;
std::string g_filled_for;  ///< the benchmark that memory_sand was last filled for

template <class Real>
struct Timed {
  KernelCase<Real> what;
  Target target;
  Storage storage;
  std::string name;
  std::optional<Verdict> verdict;
};

/// One chunk again and again; what the kernel changed is put back while the clock stands.
template <class Real>
void run_in_cache(benchmark::State& state, const Timed<Real>& timed) {
  Chunk<Real> before(timed.what.stencil);
  Chunk<Real> chunk(timed.what.stencil);
  for (auto _ : state) {
    for (std::size_t call = 0; call < kCalls; ++call) timed.what.kernel(chunk.piece());
    state.PauseTiming();
    chunk.copy(before.piece(), timed.verdict->written);
    state.ResumeTiming();
  }
}

/// The set for a benchmark; whenever it is another one than before, it is made anew and memory tried.
template <class Real>
Sand<Real>& sand_for(const Timed<Real>& timed) {
  static Sand<Real>* sand = nullptr;
  if (g_filled_for == timed.name) return *sand;
  sand = &memory_sand<Real>(timed.what.stencil);
  g_filled_for = timed.name;
  try_memory(timed.target, *sand);
  return *sand;
}

/// Chunk after chunk of a set that no cache holds, asking for the next one as the stepper has kernels do.
template <class Real>
void run_in_memory(benchmark::State& state, const Timed<Real>& timed, Sand<Real>& sand) {
  Chunk<Real> scratch(timed.what.stencil);
  Workpiece<Real> piece = scratch.piece();
  piece.ahead = kChunk;
  std::size_t first = 0;
  for (auto _ : state) {
    for (std::size_t call = 0; call < kCalls; ++call) {
      for (int k = 0; k < Workpiece<Real>::kChannels; ++k) piece.channel[k] = sand.channel[k].data() + first;
      timed.what.kernel(piece);
      first = first + kChunk < sand.count ? first + kChunk : 0;
    }
  }
}

template <class Real>
void run(benchmark::State& state, Timed<Real>& timed) {
  if (!timed.verdict) timed.verdict = check_case(timed.what);
  if (!timed.verdict->trouble.empty()) {
    g_differs = true;
    state.SkipWithError(timed.verdict->trouble.c_str());
    return;
  }
  timed.storage == Storage::kCache ? run_in_cache(state, timed) : run_in_memory(state, timed, sand_for(timed));
  const auto find_roof = [work = timed.what.work, target = timed.target, storage = timed.storage] {
    return roofline<Real>(work, target, storage);
  };
  g_measurements.expect(timed.name, find_roof);
  const Roofline roof = find_roof();
  const double items = static_cast<double>(state.iterations()) * static_cast<double>(kCalls * timed.what.items);
  using Counter = benchmark::Counter;
  state.counters["each"] = Counter(items, Counter::kIsRate | Counter::kInvert);
  state.counters["B/s"] = Counter(items * roof.bytes, Counter::kIsRate);
  state.counters["flop/s"] = Counter(items * roof.flops, Counter::kIsRate);
  state.counters["roof"] = Counter(roof.seconds);
}

template <class Real>
void enlist(const char* precision, Target target) {
  for (KernelCase<Real>& what : all_cases<Real>(target)) {
    for (const Storage storage : {Storage::kCache, Storage::kMemory}) {
      if (storage == Storage::kMemory && what.work.far_numbers() == 0) continue;
      const std::string name = what.name + '/' + precision + '/' + target_name(target) +
                               (storage == Storage::kCache ? "/cache" : "/memory");
      auto timed = std::make_shared<Timed<Real>>(Timed<Real>{what, target, storage, name, {}});
      benchmark::RegisterBenchmark(name.c_str(), [timed](benchmark::State& state) { run(state, *timed); });
    }
  }
}

/// Keeps each repetition's time an item, and leaves talking to the reporter that the options ask for.
class Reporter : public benchmark::BenchmarkReporter {
 public:
  bool ReportContext(const Context& context) override { return shown_->ReportContext(context); }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      // With --benchmark_report_aggregates_only the median is all that comes.
      const bool single = run.run_type == Run::RT_Iteration, alone = runs.front().run_type != Run::RT_Iteration;
      const auto each = run.counters.find("each");
      if (each == run.counters.end() || !(single || (alone && run.aggregate_name == "median"))) continue;
      g_measurements.add(run.run_name.function_name, each->second.value, run.repetitions);
    }
    shown_->ReportRuns(runs);
  }
  void Finalize() override { shown_->Finalize(); }

 private:
  std::unique_ptr<BenchmarkReporter> shown_{benchmark::CreateDefaultDisplayReporter()};
};

/// Takes `--table FILE` or `--table=FILE` out of the words; false if the file is missing.
bool take_table(std::vector<char*>& words, std::string& file) {
  for (std::size_t k = 1; k < words.size(); ++k) {
    const std::string word = words[k];
    if (!word.starts_with("--table")) continue;
    const bool apart = word == "--table";
    if (!apart && !word.starts_with("--table=")) continue;
    if (apart && k + 1 == words.size()) return false;
    file = apart ? words[k + 1] : word.substr(8);
    words.erase(words.begin() + static_cast<std::ptrdiff_t>(k),
                words.begin() + static_cast<std::ptrdiff_t>(k + (apart ? 2 : 1)));
    return !file.empty();
  }
  return true;
}

int write_table(const std::string& file) {
  const std::string text = g_measurements.table();
  std::FILE* out = std::fopen(file.c_str(), "w");
  const bool opened = out != nullptr;
  const bool written = opened && std::fwrite(text.data(), 1, text.size(), out) == text.size();
  if (opened && std::fclose(out) == 0 && written) return 0;
  std::fprintf(stderr, "%s: cannot be written\n", file.c_str());
  return 73;
}

int bench(int argc, char** argv) {
  std::vector<char*> words(argv, argv + argc);
  std::string table;
  if (!take_table(words, table)) {
    std::fprintf(stderr, "--table needs the name of a file\n");
    return 64;
  }
  // Shorter than Google's half a second: there are many kernels. Options that follow win.
  std::string min_time = "--benchmark_min_time=0.05";
  words.insert(words.begin() + 1, min_time.data());
  int count = static_cast<int>(words.size());
  benchmark::Initialize(&count, words.data());
  if (benchmark::ReportUnrecognizedArguments(count, words.data())) return 64;
  for (const Target target : {Target::kAvx512, Target::kAvx2, Target::kBaseline}) {
    if (!target_supported(target)) continue;
    enlist<float>("float", target);
    enlist<double>("double", target);
  }
  Reporter reporter;
  if (benchmark::RunSpecifiedBenchmarks(&reporter) == 0) {
    std::fprintf(stderr, "no kernel of this machine has such a name; --benchmark_list_tests lists them\n");
    return 64;
  }
  benchmark::Shutdown();
  if (g_differs) {
    std::fprintf(stderr, "kernels that differ from their reference were not timed\n");
    return 1;
  }
  return table.empty() ? 0 : write_table(table);
}

}  // namespace
}  // namespace repose

int main(int argc, char** argv) {
  return repose::bench(argc, argv);
}
