// Repose: `repose check`: whether a scene is right, and what in it is most likely not meant.
#include <cstdio>

#include "apps/repose/command.h"

namespace repose {

int check_command(const SceneArguments& arguments) {
  auto scene = read_scene(arguments);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments);
  if (!options) return fail(options.error());
  // Meshes and bodies can be wrong too: build everything, run nothing.
  auto simulation = Simulation::create(*scene, *options);
  if (!simulation) return fail(simulation.error());
  for (const std::string& warning : (*simulation)->warnings()) std::printf("warning: %s\n", warning.c_str());
  std::printf("%s: good; %zu particles\n", arguments.scene.c_str(), (*simulation)->particles());
  return 0;
}

}  // namespace repose
