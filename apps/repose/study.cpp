// Repose: `repose study`: makes the runs that a study asks for, each as a process of its own (figures.cpp says
// why), and writes what they came to. What is done lies in the folder, a file per run: a study that was ended,
// however, goes on.
#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <thread>
#include <tuple>
#include <utility>

#include "apps/repose/child_runs.h"
#include "apps/repose/output_folder.h"
#include "apps/repose/progress.h"
#include "apps/repose/study/report.h"
#include "apps/repose/study_jobs.h"
#include "engine/reading/study_reader.h"

namespace repose {
namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;

volatile std::sig_atomic_t g_signal = 0;

void on_signal(int signal) {
  if (g_signal != 0) std::_Exit(128 + signal);
  g_signal = signal;
}

std::string machine() {
  std::ifstream file("/proc/cpuinfo");
  std::string line, model = "unknown processor";
  while (std::getline(file, line)) {
    if (!line.starts_with("model name")) continue;
    model = line.substr(std::min(line.size(), line.find(':') + 2));
    break;
  }
  return model + ", " + std::to_string(std::thread::hardware_concurrency()) + " cores";
}

/// Whether a run that ended so would end so again: then it is not made again when a study goes on.
bool is_final(int code) {
  return code == 0 || code == kTookTooLong || code == static_cast<int>(ErrorKind::kBadScene) ||
         code == static_cast<int>(ErrorKind::kPhysics);
}

class Study {
 public:
  Study(const StudyArguments& arguments, const Scene& scene, StudySetup setup, OutputFolder folder)
      : arguments_(arguments), scene_(scene), setup_(std::move(setup)), folder_(std::move(folder)) {}

  int go();

 private:
  std::string file_of(const Job& job) const { return folder_.path() + "/runs/" + job.key + ".json"; }
  bool take_finished(const Job& job);
  std::vector<std::string> words_of(const Job& job) const;
  void keep(const Job& job, RunResult result);
  void ended(const ChildEnd& end);
  void tell(const Job& job, const RunResult& result);
  Result<void> run_all();
  Result<void> write() const;
  double left_seconds() const;

  const StudyArguments& arguments_;
  const Scene& scene_;
  StudySetup setup_;
  OutputFolder folder_;
  std::optional<Progress> progress_;
  std::vector<std::size_t> waiting_;  // positions of jobs
  std::vector<StudyRun> runs_;
  std::map<std::pair<std::size_t, int>, std::string> hashes_;  // of point and seed
  double done_ = 0.0, all_ = 0.0;                              // cost
  Clock::time_point start_ = Clock::now();
};

bool Study::take_finished(const Job& job) {
  auto result = read_run_result(file_of(job));
  if (!result || !is_final(result->code)) return false;
  if (result->complete() && result->inputs != job.inputs) return false;
  if (result->build != program_build() && !arguments_.any_build) return false;
  keep(job, std::move(*result));
  return true;
}

void Study::keep(const Job& job, RunResult result) {
  if (result.complete()) {
    const auto [first, is_new] = hashes_.try_emplace({job.point, job.seed}, result.hash);
    if (!is_new && first->second != result.hash)
      std::fprintf(stderr, "repose: warning: %s: ended with other bits than the same run before\n",
                   job.text.c_str());
  }
  runs_.push_back({job.point, job.seed, job.repeat, std::move(result)});
}

std::vector<std::string> Study::words_of(const Job& job) const {
  SceneArguments scene = arguments_.scene;
  if (scene.threads == 0 && arguments_.parallel > 1)
    scene.threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) / arguments_.parallel);
  std::vector<std::string> words{"figures", scene.scene, "--json", file_of(job)};
  for (const std::string& word : scene_words(scene)) words.push_back(word);
  if (arguments_.most_seconds > 0.0) {
    words.emplace_back("--most-seconds");
    words.push_back(short_number(arguments_.most_seconds, 12));
  }
  for (const auto* list : {&std::as_const(scene.set), &job.overrides}) {
    for (const std::string& word : *list) {
      words.emplace_back("--set");
      words.push_back(word);
    }
  }
  return words;
}

double Study::left_seconds() const {
  const double taken = std::chrono::duration<double>(Clock::now() - start_).count();
  return done_ > 0.0 ? (all_ - done_) * taken / done_ : -1.0;
}

void Study::tell(const Job& job, const RunResult& result) {
  if (arguments_.quiet || progress_->visible()) return;
  const double left = left_seconds();
  const std::string came = result.complete() ? short_number(result.seconds) + " s" : result.words;
  std::printf("%zu/%zu  %s: %s%s\n", runs_.size(), setup_.jobs.size(), job.text.c_str(), came.c_str(),
              left > 0.5 ? ("  (" + clock_text(left) + " left)").c_str() : "");
  std::fflush(stdout);
}

void Study::ended(const ChildEnd& end) {
  const Job& job = setup_.jobs[end.job];
  auto read = read_run_result(file_of(job));
  RunResult result;
  if (read) {
    result = std::move(*read);
  } else {
    result.code = -1;
    result.words = status_text(end.status) + (end.words.empty() ? "" : ": " + end.words);
  }
  // A run reads the scene and its files by itself.
  if (result.complete() && result.inputs != job.inputs) {
    result = RunResult();
    result.code = -1;
    result.words =
        "the scene's file, or one that it names, has changed since the study began; give the command again";
  }
  std::error_code ignored;
  if (!is_final(result.code)) fs::remove(file_of(job), ignored);
  done_ += job.cost;
  keep(job, result);
  tell(job, result);
}

Result<void> Study::run_all() {
  ChildRuns children(arguments_.parallel);
  auto next = waiting_.begin();
  auto written = Clock::now();
  while (g_signal == 0 && (next != waiting_.end() || !children.empty())) {
    while (next != waiting_.end() && !children.full()) {
      const Job& job = setup_.jobs[*next];
      std::error_code ignored;
      fs::remove(file_of(job), ignored);  // of another build; else a run that dies would be taken for it
      if (!children.start(*next, words_of(job), file_of(job) + ".err"))
        return Error{ErrorKind::kIo, "no process can be started for a run", folder_.path()};
      ++next;
    }
    ChildEnd end;
    progress_->update(done_, std::to_string(runs_.size()) + "/" + std::to_string(setup_.jobs.size()) + " runs");
    if (!children.next(end)) continue;
    if (g_signal != 0) break;  // it may have died of the same signal
    ended(end);
    if (Clock::now() - written < std::chrono::seconds(5)) continue;
    if (auto report = write(); !report) return report;
    written = Clock::now();
  }
  return {};
}

Result<void> Study::write() const {
  std::vector<StudyRun> runs = runs_;
  std::sort(runs.begin(), runs.end(), [](const StudyRun& a, const StudyRun& b) {
    return std::tie(a.point, a.seed, a.repeat) < std::tie(b.point, b.seed, b.repeat);
  });
  const Summary summary = summarize(setup_.plan, runs);
  StudyHead head{scene_.name, setup_.vary, {}};
  for (const Vary& vary : setup_.vary) head.written.push_back(value_at(scene_, vary.key));
  const StudyReport report{head,
                           setup_.plan,
                           runs,
                           summary,
                           REPOSE_VERSION,
                           program_build(),
                           machine(),
                           scene_hash(scene_),
                           arguments_.parallel,
                           setup_.jobs.size() - runs.size()};
  return write_report(report, folder_.path());
}

int Study::go() {
  std::error_code failed;
  fs::create_directories(folder_.path() + "/runs", failed);
  if (failed) return fail({ErrorKind::kCannotCreate, failed.message(), folder_.path() + "/runs"});
  for (std::size_t k = 0; k < setup_.jobs.size(); ++k) {
    if (take_finished(setup_.jobs[k])) continue;
    waiting_.push_back(k);
    all_ += setup_.jobs[k].cost;
  }
  if (!arguments_.quiet && !runs_.empty())
    std::printf("%zu of %zu runs have been made before\n", runs_.size(), setup_.jobs.size());
  struct sigaction action {};
  action.sa_handler = on_signal;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  progress_.emplace(scene_.name, all_, !arguments_.quiet);
  if (auto made = run_all(); !made) return fail(made.error());
  const bool whole = runs_.size() == setup_.jobs.size();
  if (whole) progress_->finish(std::to_string(runs_.size()) + " runs");
  progress_->leave();
  if (auto written = write(); !written) return fail(written.error());
  if (!whole) {
    std::fprintf(stderr, "repose: interrupted after %zu of %zu runs; the same command goes on\n", runs_.size(),
                 setup_.jobs.size());
    return 128 + g_signal;
  }
  if (!arguments_.quiet) std::printf("%s/index.html\n", folder_.path().c_str());
  return 0;
}

}  // namespace

int study_command(const StudyArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  if (auto options = simulation_options(arguments.scene); !options) return fail(options.error());
  auto setup = set_up(arguments, *scene);
  if (!setup) return fail(setup.error());
  auto folder =
      OutputFolder::open(arguments.out.empty() ? "out/" + scene->name + "-study" : arguments.out, scene->name);
  if (!folder) return fail(folder.error());
  return Study(arguments, *scene, std::move(*setup), std::move(*folder)).go();
}

}  // namespace repose
