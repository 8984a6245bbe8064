// Repose: the command.
#include <poll.h>
#include <tbb/global_control.h>
#include <unistd.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <exception>
#include <thread>

#include "apps/repose/base/memory_reserve.h"
#include "apps/repose/command.h"
#include "engine/base/caught.h"
#include "engine/base/wording.h"

namespace repose {
namespace {

void add_scene_options(CLI::App& command, SceneArguments& arguments) {
  command.add_option("scene", arguments.scene, "scene file (JSON)")->required();
  // One word each: `--set a=1 scene.json` must not take the scene for a second override.
  command.add_option("--set", arguments.set, "override a key: a.b=value; may be given again")
      ->allow_extra_args(false);
  command.add_option("--quality", arguments.quality,
                     "draft: grid.spacing x 2, so 8 times fewer particles; standard: the scene as written; "
                     "reference: grid.spacing x 0.5, so 8 times more; --set wins over it");
  command.add_flag("--allow-outside-paths", arguments.allow_outside_paths,
                   "allow meshes outside the scene's folder");
  command.add_option("--threads", arguments.threads, "threads (default: all)")->check(CLI::Range(1, 1024));
  command
      .add_option(
          "--memory", arguments.memory,
          "what may be used, such as 2GB (default: 85 % of the machine's); a run that would need more ends "
          "with its state saved")
      ->transform(CLI::AsSizeValue(true));
  command
      .add_option("--target", arguments.target, "instruction set: avx512, avx2, baseline (default: the best)")
      ->envname("REPOSE_TARGET");
}

void add_study_options(CLI::App& command, StudyArguments& study) {
  add_scene_options(command, study.scene);
  command.add_option("--out", study.out, "folder (default: out/NAME-study); a study that lies there goes on");
  command.add_option("--vary", study.vary, "key=a,b,c; may be given again; in place of the scene's study.vary")
      ->allow_extra_args(false);
  command.add_flag("--one-by-one", study.one_by_one,
                   "each value alone, all else as the scene is written, in place of all with all");
  command.add_option("--seeds", study.seeds, "runs of each point, by other places of particles")
      ->check(CLI::Range(1, 1000));
  command.add_option("--repeat", study.repeat, "times that each run is timed")->check(CLI::Range(1, 1000));
  command
      .add_option("--reference", study.reference,
                  "finest: the point of the smallest grid.spacing; finest:key=value;key=value: that run; "
                  "FIGURE=VALUE: what is known; may be given again")
      ->allow_extra_args(false);
  command
      .add_option("--reference-seeds", study.reference_seeds,
                  "runs of the finest, whose scatter is the noise floor")
      ->check(CLI::Range(1, 1000));
  command.add_option("--parallel", study.parallel, "runs at once (default 1); they slow one another")
      ->check(CLI::Range(1, 1024));
  command.add_option("--most-seconds", study.most_seconds, "end runs whose steps take longer")
      ->check(CLI::PositiveNumber);
  command.add_flag("--any-build", study.any_build, "runs that another build of the program made count too");
  command.add_flag("--quiet", study.quiet, "say nothing but errors");
}

void add_element_options(CLI::App& command, ElementArguments& element) {
  add_scene_options(command, element.scene);
  command.add_option("--material", element.material, "name of the material (default: the only one)");
  command
      .add_option(
          "--path", element.path,
          "triaxial, triaxial_extension: along z under constant pressure from the sides; oedometric: along z, "
          "sides held; simple_shear: dv_x/dz; or a CSV file of steps (docs/element.md)")
      ->required();
  command.add_option("--out", element.out, "folder (default: out/NAME-element)");
  command
      .add_option(
          "--pressure", element.pressure,
          "Pa, all around before the path begins (default: youngs_modulus / 1000; oedometric and files: 0)")
      ->check(CLI::NonNegativeNumber);
  command
      .add_option("--strain", element.strain,
                  "how far: log strain of the axis, or slope of shear (default 0.1)")
      ->check(CLI::PositiveNumber);
  command.add_option("--steps", element.steps, "in how many steps (default 1000)")
      ->check(CLI::Range(1, 10000000));
  command.add_option("--rate", element.rate, "how fast, 1/s, which rate_friction alone feels (default 0.01)")
      ->check(CLI::PositiveNumber);
  command.add_option("--hold", element.hold,
                     "simple_shear: stress (default), the normal stress across its planes, or volume");
  command.add_flag("--quiet", element.quiet, "say nothing but errors");
}

/// " (did you mean run?)", where a command is called much like `word`.
std::string meant(const CLI::App& app, const std::string& word) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  const std::string name = nearest(word, names);
  return alike(word, name) ? " (did you mean " + name + "?)" : "";
}

/// An option that the command does not have, and one that is called much like it.
std::string unknown_option(const CLI::App& command) {
  for (const std::string& word : command.remaining()) {
    if (word.size() < 2 || word[0] != '-') continue;
    std::vector<std::string> names;
    for (const CLI::Option* option : command.get_options()) {
      for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    }
    const std::string given = word.substr(0, word.find('=')), name = nearest(given, names);
    return "'" + given + "' is no option of " + command.get_name() +
           (alike(given, name) ? " (did you mean " + name + "?)" : "");
  }
  return "";
}

/// One message for whatever is wrong with the words, in the form of all others.
std::string word_failure(const CLI::App* app, const CLI::Error& error) {
  const std::vector<std::string> unknown = app->remaining();
  const bool no_command = app->get_subcommands().empty();
  std::string text = no_command ? "name a command" : error.what();
  if (no_command && !unknown.empty())
    text = "'" + unknown.front() + "' is no command" + meant(*app, unknown.front());
  if (!no_command) {
    const std::string option = unknown_option(*app->get_subcommands().front());
    if (!option.empty()) text = option;
  }
  std::replace(text.begin(), text.end(), '\n', ' ');
  return "repose: error: " + text + "; see repose " +
         (no_command ? "" : app->get_subcommands().front()->get_name() + " ") + "--help\n";
}

/// Lets the engine's arenas have the threads that were asked for, even beyond the cores.
class Workers {
 public:
  explicit Workers(int threads)
      : control_(tbb::global_control::max_allowed_parallelism,
                 static_cast<std::size_t>(
                     std::max(threads, static_cast<int>(std::thread::hardware_concurrency())))) {}

 private:
  tbb::global_control control_;
};

/// Whether what was said could be: /dev/full takes nothing. A reader that has gone has read what it wanted.
int told_all() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return 0;
  pollfd output{STDOUT_FILENO, POLLOUT, 0};
  if (poll(&output, 1, 0) > 0 && (output.revents & POLLERR) != 0) return 0;
  return fail({ErrorKind::kIo, "cannot be written; is its disk full?", "standard output"});
}

int main(int count, char** words) {
  // A limit on the size of files is an error of writing, and names the file.
  std::signal(SIGXFSZ, SIG_IGN);
  CLI::App app{"Repose: sand by the Material Point Method", "repose"};
  app.require_subcommand(1);
  app.failure_message(word_failure);
  app.set_version_flag("--version", REPOSE_VERSION);
  int code = 0;

  RunArguments run;
  CLI::App& run_app =
      *app.add_subcommand("run", "simulate a scene; caches, log and checkpoints go to a folder");
  add_scene_options(run_app, run.scene);
  run_app.add_option("--out", run.out, "folder (default: out/NAME)");
  run_app.add_option("--frames", run.frames, "A-B: write frames A to B; B: all up to B");
  CLI::Option* const resume = run_app.add_flag(
      "--resume", run.resume,
      "go on after the newest checkpoint in the folder; frames, output and camera may have changed");
  run_app
      .add_flag("--overwrite", run.overwrite,
                "begin anew where a run lies: removes what that run wrote, and nothing else")
      ->excludes(resume);
  run_app.add_flag("--json", run.json, "one line of JSON per frame on standard output");
  run_app.add_flag("--quiet", run.quiet, "say nothing but errors");
  run_app.callback([&] {
    const Workers workers(run.scene.threads);
    code = run_command(run);
  });

  SceneArguments plan;
  CLI::App& plan_app =
      *app.add_subcommand("plan", "the step that a scene compiles to; effects, memory and time");
  add_scene_options(plan_app, plan);
  plan_app.callback([&] { code = plan_command(plan); });

  SceneArguments check;
  CLI::App& check_app = *app.add_subcommand("check", "validate a scene and its meshes");
  add_scene_options(check_app, check);
  check_app.callback([&] { code = check_command(check); });

  FiguresArguments figures;
  CLI::App& figures_app = *app.add_subcommand(
      "figures",
      "one run without any output: the figures of merit that the scene's \"study\" names, and its time");
  add_scene_options(figures_app, figures.scene);
  figures_app.add_option("--json", figures.json, "write them to a file");
  figures_app.add_option("--most-seconds", figures.most_seconds, "end a run whose steps take longer")
      ->check(CLI::PositiveNumber);
  figures_app.callback([&] {
    const Workers workers(figures.scene.threads);
    code = figures_command(figures);
  });

  StudyArguments study;
  CLI::App& study_app = *app.add_subcommand(
      "study",
      "accuracy against time: varies keys of a scene, measures each run, and writes a page with the curves");
  add_study_options(study_app, study);
  study_app.callback([&] { code = study_command(study); });

  ElementArguments element;
  CLI::App& element_app = *app.add_subcommand(
      "element", "one element of a material without a grid along a laboratory's path: CSV, plots and a page");
  add_element_options(element_app, element);
  element_app.callback([&] { code = element_command(element); });

  BenchArguments bench;
  CLI::App& bench_app =
      *app.add_subcommand("bench", "time per phase, particle and step; hash of the end state");
  add_scene_options(bench_app, bench.scene);
  bench_app.add_option("--steps", bench.steps, "steps (default 100)")->check(CLI::Range(1, 1000000000));
  bench_app.add_option("--json", bench.json, "write the figures to a file");
  bench_app.callback([&] {
    const Workers workers(bench.scene.threads);
    code = bench_command(bench);
  });

  RecordArguments record;
  CLI::App& record_app = *app.add_subcommand(
      "record", "some steps, with a hash of every channel after each and the last state: for compare");
  add_scene_options(record_app, record.scene);
  record_app.add_option("--steps", record.steps, "steps (default 100)")->check(CLI::Range(1, 1000000));
  record_app.add_option("--out", record.out, "folder of the recording")->required();
  record_app.callback([&] {
    const Workers workers(record.scene.threads);
    code = record_command(record);
  });

  std::vector<std::string> recordings;
  CLI::App& compare_app = *app.add_subcommand(
      "compare", "two recordings, or two runs: the first step, block, particle and channel that differ");
  compare_app.add_option("folders", recordings, "two folders of record, or two of run")
      ->required()
      ->expected(2);
  compare_app.callback([&] { code = compare_command(recordings[0], recordings[1]); });

  std::vector<std::string> files;
  CLI::App& info_app = *app.add_subcommand("info", "what a cache, a checkpoint or a run's folder holds");
  info_app.add_option("files", files, ".vdb, .ply, .vtp, .checkpoint, or the folder of a run")->required();
  info_app.callback([&] { code = info_command(files); });

  MovieArguments movie;
  CLI::App& movie_app = *app.add_subcommand("movie", "a film of a run");
  movie_app.add_option("folder", movie.folder, "the folder of the run")->required();
  movie_app.add_option("--out", movie.out, "film (default: FOLDER/NAME.mp4)");
  movie_app.add_option("--width", movie.width, "pixels (default 1280)")->check(CLI::Range(16, 8192));
  movie_app.add_option("--height", movie.height, "pixels (default 720)")->check(CLI::Range(16, 8192));
  movie_app.add_option("--first", movie.first, "first frame (default 1)")->check(CLI::Range(1, 1000000000));
  movie_app.add_option("--last", movie.last, "last frame (default: all)")->check(CLI::Range(1, 1000000000));
  movie_app.add_flag("--pictures", movie.pictures, "keep a PNG of each frame beside its cache");
  movie_app.callback([&] { code = movie_command(movie); });

  bool reference = false;
  CLI::App& schema_app = *app.add_subcommand("schema", "the JSON Schema of scene files");
  schema_app.add_flag("--reference", reference, "the same as a Markdown table");
  schema_app.callback([&] { code = schema_command(reference); });

  try {
    app.parse(count, words);
  } catch (const CLI::ParseError& error) {
    const int status = app.exit(error);
    if (status != 0) return static_cast<int>(ErrorKind::kUsage);
  }
  return code != 0 ? code : told_all();
}

}  // namespace
}  // namespace repose

int main(int count, char** words) {
  try {
    repose::keep_memory_reserve();
    return repose::main(count, words);
  } catch (const std::exception& failure) {
    return repose::fail(repose::error_of(failure, ""));
  }
}
