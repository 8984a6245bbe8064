// Repose: the subcommands. Each takes its parsed arguments and returns the exit code of the process.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/reading/reader.h"
#include "engine/simulation/simulation.h"

namespace repose {

/// What every command that takes a scene understands.
struct SceneArguments {
  std::string scene;
  std::vector<std::string> set;  ///< --set a.b=value
  std::string quality = kQualityNames[static_cast<int>(Quality::kStandard)];
  bool allow_outside_paths = false;
  int threads = 0;           ///< 0: all
  std::string target;        ///< avx512, avx2, baseline; empty: the best
  std::uint64_t memory = 0;  ///< bytes that may be used; 0: 85 % of the machine's
};

struct RunArguments {
  SceneArguments scene;
  std::string out;     ///< folder; empty: out/NAME
  std::string frames;  ///< "A-B" or "N"; empty: as the scene says
  bool resume = false;
  bool overwrite = false;  ///< remove what an earlier run has left in the folder
  bool json = false;
  bool quiet = false;
};

struct BenchArguments {
  SceneArguments scene;
  std::int64_t steps = 100;
  std::string json;  ///< file; empty: none
};

struct RecordArguments {
  SceneArguments scene;
  std::int64_t steps = 100;
  std::string out;  ///< folder
};

struct MovieArguments {
  std::string folder;
  std::string out;  ///< film; empty: FOLDER/NAME.mp4
  int width = 1280, height = 720;
  int first = 1, last = 0;
  bool pictures = false;  ///< keep a PNG per frame
  int threads = 0;
};

struct FiguresArguments {
  SceneArguments scene;
  std::string json;           ///< file; empty: none
  double most_seconds = 0.0;  ///< of steps, after which the run ends; 0: as long as it takes
};

struct StudyArguments {
  SceneArguments scene;
  std::string out;                ///< folder; empty: out/NAME-study
  std::vector<std::string> vary;  ///< "key=a,b,c"; none: as the scene's "study" says
  bool one_by_one = false;
  std::int64_t seeds = 0, repeat = 0;  ///< 0: as the scene says
  std::vector<std::string> reference;  ///< "finest", "finest:key=value; key=value", "FIGURE=VALUE"
  std::int64_t reference_seeds = 0;    ///< of "finest"; 0: as the scene says
  int parallel = 1;                    ///< runs at once
  double most_seconds = 0.0;
  bool any_build = false;  ///< runs that another build of the program made count
  bool quiet = false;
};

struct ElementArguments {
  SceneArguments scene;
  std::string material;  ///< its name; empty: the only one
  std::string path;      ///< triaxial, triaxial_extension, oedometric, simple_shear, or a CSV file
  std::string out;       ///< folder; empty: out/NAME-element
  std::string hold;      ///< of simple_shear: stress (or empty), volume
  std::optional<double> pressure, strain, rate;  ///< Pa, log strain, 1/s
  std::optional<int> steps;
  bool quiet = false;
};

int run_command(const RunArguments& arguments);
int plan_command(const SceneArguments& arguments);
int check_command(const SceneArguments& arguments);
int bench_command(const BenchArguments& arguments);
int record_command(const RecordArguments& arguments);
int compare_command(const std::string& one, const std::string& other);
int info_command(const std::vector<std::string>& files);
int movie_command(const MovieArguments& arguments);
int figures_command(const FiguresArguments& arguments);
int study_command(const StudyArguments& arguments);
int element_command(const ElementArguments& arguments);
int schema_command(bool reference);

/// Prints "repose: error: ..." and gives the exit code.
int fail(const Error& error);

/// Reads the scene that the arguments name.
Result<Scene> read_scene(const SceneArguments& arguments);
/// How these are written as words of a command line, of everything but the scene and its overrides.
std::vector<std::string> scene_words(const SceneArguments& arguments);
/// Options for the engine; error 64 for an unknown or unsupported target, or too little --memory.
Result<SimulationOptions> simulation_options(const SceneArguments& arguments);

}  // namespace repose
