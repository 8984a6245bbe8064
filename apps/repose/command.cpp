// Repose: what the subcommands share.
#include "apps/repose/command.h"

#include <cstdio>

namespace repose {

int fail(const Error& error) {
  std::fprintf(stderr, "repose: error: %s\n", error.text().c_str());
  return static_cast<int>(error.kind);
}

Result<Scene> read_scene(const SceneArguments& arguments) {
  return read_scene(arguments.scene, ReadOptions{arguments.set, arguments.allow_outside_paths});
}

Result<SimulationOptions> simulation_options(const SceneArguments& arguments) {
  SimulationOptions options;
  options.threads = arguments.threads;
  options.allow_outside_paths = arguments.allow_outside_paths;
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
