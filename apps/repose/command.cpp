// Repose: what the subcommands share.
#include "apps/repose/command.h"

#include <algorithm>
#include <cstdio>
#include <iterator>

#include "apps/repose/measure.h"

namespace repose {

int fail(const Error& error) {
  std::fprintf(stderr, "repose: error: %s\n", error.text().c_str());
  return static_cast<int>(error.kind);
}

Result<Scene> read_scene(const SceneArguments& arguments) {
  ReadOptions options{arguments.set, arguments.allow_outside_paths, Quality::kStandard};
  const auto* name = std::find(std::begin(kQualityNames), std::end(kQualityNames), arguments.quality);
  if (name == std::end(kQualityNames)) {
    return Error{ErrorKind::kUsage, "'" + arguments.quality + "' is not one of draft, standard, reference",
                 "--quality"};
  }
  options.quality = static_cast<Quality>(name - std::begin(kQualityNames));
  return read_scene(arguments.scene, options);
}

std::vector<std::string> scene_words(const SceneArguments& arguments) {
  std::vector<std::string> words{"--quality", arguments.quality};
  const auto add = [&words](const char* option, const std::string& value) {
    words.emplace_back(option);
    words.push_back(value);
  };
  if (arguments.allow_outside_paths) words.emplace_back("--allow-outside-paths");
  if (arguments.threads > 0) add("--threads", std::to_string(arguments.threads));
  if (!arguments.target.empty()) add("--target", arguments.target);
  if (arguments.memory > 0) add("--memory", std::to_string(arguments.memory));
  return words;
}

Result<SimulationOptions> simulation_options(const SceneArguments& arguments) {
  SimulationOptions options;
  options.threads = arguments.threads;
  options.allow_outside_paths = arguments.allow_outside_paths;
  if (arguments.memory > 0) {
    const double left = static_cast<double>(arguments.memory) - static_cast<double>(resident_bytes());
    if (left <= 0.0)
      return Error{ErrorKind::kUsage, "is less than the program itself takes; 100MB is little, 2GB is usual",
                   "--memory"};
    options.memory_limit = left;
  }
  if (arguments.target.empty()) return options;
  for (int k = 0; k < kTargets; ++k) {
    if (arguments.target == target_name(static_cast<Target>(k))) {
      options.target = static_cast<Target>(k);
      return options;
    }
  }
  return Error{ErrorKind::kUsage, "'" + arguments.target + "' is not one of avx512, avx2, baseline",
               "--target"};
}

}  // namespace repose
