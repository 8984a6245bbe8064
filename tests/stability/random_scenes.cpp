// Repose tests: random scenes, each in a process of its own. None may crash, hang, show a value that is not
// finite, lose a particle, make energy from nowhere, or be refused without saying why.
//   random_scenes --seed N --count N [--seconds-each S] [--most-cells N] [--keep FOLDER] [--only N] [--list]
//   random_scenes --scene FILE [--seconds-each S]
// A line for each scene that fails, then a summary that tells gains of energy that the run told of from those
// that it did not; the exit code is 1 if any failed.
#include <signal.h>

#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>

#include "tests/stability/child.h"
#include "tests/stability/scene_judge.h"
#include "tests/stability/scene_maker.h"

namespace repose::stability {
namespace {

struct Options {
  std::uint64_t seed = 1, count = 200, only = 0;
  bool only_one = false, list = false;
  SceneSize size;
  ChildLimits limits;
  std::string keep, scene;
};

/// What a child tells at last: one line "end: KIND | steps | energy | why".
struct Told {
  std::string kind = "FAULT", why, last_phase;
  long steps = 0;
  double energy = -1.0;

  bool failed() const { return kind == "FAULT" || kind == end_name(Judgement::End::kTold); }
};

std::atomic<Simulation*> at_work{nullptr};

void interrupt_it() {
  if (Simulation* const simulation = at_work.load()) simulation->interrupt();
}

int run(const std::string& scene, int threads) {
  JudgeOptions options;
  options.threads = threads;
  options.stop = asked_to_stop;
  options.started = [](Simulation& simulation) { at_work = &simulation; };
  options.ended = [] { at_work = nullptr; };
  when_asked_to_stop(interrupt_it);
  options.tell = [](const std::string& phase) {
    std::printf("at: %s\n", phase.c_str());
    std::fflush(stdout);
  };
  const Judgement result = judge(scene, options);
  std::printf("end: %s | %ld | %.3g | %s\n", end_name(result.end), result.steps, result.energy_excess,
              result.why.c_str());
  return 0;
}

Told understand(const ChildEnd& end) {
  Told told;
  std::string other;
  bool ended = false;
  std::istringstream lines(end.told);
  for (std::string line; std::getline(lines, line);) {
    if (line.rfind("at: ", 0) == 0) {
      told.last_phase = line.substr(4);
    } else if (line.rfind("end: ", 0) == 0) {
      ended = true;
      std::istringstream parts(line.substr(5));
      std::string steps, energy;
      std::getline(parts, told.kind, '|');
      std::getline(parts, steps, '|');
      std::getline(parts, energy, '|');
      std::getline(parts, told.why);
      told.kind.erase(told.kind.find_last_not_of(' ') + 1);
      told.steps = std::atol(steps.c_str());
      told.energy = std::atof(energy.c_str());
    } else if (other.size() < 400) {
      other += line + " ";
    }
  }
  if (end.hung || end.signal != 0 || end.code != 0 || !ended) {
    told.kind = "FAULT";
    const std::string how = end.hung          ? "hangs: does not stop when it is asked to"
                            : end.signal != 0 ? std::string("killed by ") + strsignal(end.signal)
                                              : "ended with code " + std::to_string(end.code);
    told.why = how + ", at: " + told.last_phase + (other.empty() ? "" : "; it said: " + other);
  }
  return told;
}

Told run_alone(const std::string& scene, int threads, const ChildLimits& limits) {
  return understand(run_in_child([&] { return run(scene, threads); }, limits));
}

int run_all(const Options& options) {
  std::map<std::string, int> ends;
  long steps = 0;
  int judged = 0, spoilt_and_ran = 0, failures = 0;
  double largest = 0.0;
  for (std::uint64_t n = 0; n < options.count; ++n) {
    if (options.only_one && n != options.only) continue;
    const MadeScene made = make_scene(options.seed, n, options.size);
    const Told told = run_alone(made.text, 1 + static_cast<int>(n % 2), options.limits);
    ++ends[told.kind];
    steps += told.steps;
    if (told.energy >= 0.0) ++judged;
    if (told.energy >= 0.0 && !told.failed()) largest = std::max(largest, told.energy);
    if (made.spoilt && told.steps > 0) ++spoilt_and_ran;
    if (told.failed()) ++failures;
    if (told.failed() || options.list || options.only_one) {
      std::printf("seed %llu scene %llu: %s:%s (%ld steps, energy %.3g of what is allowed)\n",
                  static_cast<unsigned long long>(options.seed), static_cast<unsigned long long>(n),
                  told.kind.c_str(), told.why.c_str(), told.steps, told.energy);
      std::fflush(stdout);
    }
    if (!options.keep.empty() && (told.failed() || options.only_one)) {
      std::filesystem::create_directories(options.keep);
      const std::string name = "seed" + std::to_string(options.seed) + "_scene" + std::to_string(n) + ".json";
      std::ofstream(std::filesystem::path(options.keep) / name) << made.text << '\n';
    }
  }
  std::printf("random scenes:");
  for (const auto& [kind, count] : ends) std::printf(" %d %s,", count, kind.c_str());
  std::printf(
      " %ld steps; energy judged in %d, the largest surplus of those that pass %.3g of what is allowed; "
      "%d of the spoilt ran\n",
      steps, judged, largest, spoilt_and_ran);
  return failures > 0 ? 1 : 0;
}

int run_file(const Options& options) {
  std::ifstream in(options.scene, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(in), {}};
  const Told told = run_alone(text, 2, options.limits);
  std::printf("%s: %s:%s (%ld steps, energy %.3g of what is allowed)\n", options.scene.c_str(),
              told.kind.c_str(), told.why.c_str(), told.steps, told.energy);
  return told.failed() ? 1 : 0;
}

int usage() {
  std::fputs(
      "usage: random_scenes --seed N --count N [--seconds-each S] [--most-cells N] [--keep FOLDER] [--only N] "
      "[--list]\n       random_scenes --scene FILE [--seconds-each S]\n",
      stderr);
  return 64;
}

}  // namespace
}  // namespace repose::stability

int main(int count, char** words) {
  using namespace repose::stability;
  Options options;
  for (int k = 1; k < count; ++k) {
    const std::string word = words[k];
    if (word == "--list") {
      options.list = true;
      continue;
    }
    if (k + 1 >= count) return usage();
    const char* value = words[++k];
    if (word == "--seed")
      options.seed = std::strtoull(value, nullptr, 10);
    else if (word == "--count")
      options.count = std::strtoull(value, nullptr, 10);
    else if (word == "--seconds-each")
      options.limits.seconds = std::atof(value);
    else if (word == "--most-cells")
      options.size.most_cells = std::max(4, std::atoi(value));
    else if (word == "--keep")
      options.keep = value;
    else if (word == "--scene")
      options.scene = value;
    else if (word == "--only")
      options.only = std::strtoull(value, nullptr, 10), options.only_one = true;
    else
      return usage();
  }
  return options.scene.empty() ? run_all(options) : run_file(options);
}
