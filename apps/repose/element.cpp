// Repose: `repose element`: one element of a scene's material along a path of the laboratory, or of a file.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/repose/command.h"
#include "apps/repose/element_report.h"
#include "apps/repose/output_folder.h"
#include "engine/base/wording.h"

namespace repose {
namespace {

constexpr std::array<const char*, 4> kPaths{"triaxial", "triaxial_extension", "oedometric", "simple_shear"};
constexpr double kStrain = 0.1, kRate = 1e-2;
constexpr int kSteps = 1000;
/// Of Young's modulus: the pressure that is taken where none is given, so that soft sand is not crushed.
constexpr double kPressure = 1e-3;

Error usage(const char* option, const std::string& what) {
  return {ErrorKind::kUsage, what, option};
}

struct Chosen {
  Path path;
  ElementPlots plots = ElementPlots::kAny;
  std::string text;
};

Result<Chosen> chosen_file(const ElementArguments& arguments) {
  if (!std::filesystem::is_regular_file(arguments.path)) {
    return usage("--path", "'" + arguments.path + "' is no file of steps, and no path that is known; " +
                               did_you_mean(arguments.path, {kPaths.begin(), kPaths.end()}));
  }
  for (const auto& [given, option] : {std::pair(arguments.strain.has_value(), "--strain"),
                                      std::pair(arguments.steps.has_value(), "--steps")}) {
    if (given) return usage(option, "is what the file " + arguments.path + " says, step by step; leave it out");
  }
  auto path = read_path(arguments.path, arguments.pressure.value_or(0.0), arguments.rate.value_or(kRate));
  if (!path) return path.error();
  return Chosen{std::move(*path), ElementPlots::kAny,
                std::filesystem::path(arguments.path).filename().string()};
}

Result<Chosen> chosen_path(const ElementArguments& arguments, const Elasticity& elasticity) {
  const bool shear = arguments.path == "simple_shear";
  if (!shear && !arguments.hold.empty())
    return usage("--hold", "is for --path simple_shear; the others say what they hold");
  if (shear && !arguments.hold.empty() && arguments.hold != "stress" && arguments.hold != "volume")
    return usage("--hold", "'" + arguments.hold + "' is not one of stress, volume");
  bool known = false;
  for (const char* name : kPaths) known = known || arguments.path == name;
  if (!known) return chosen_file(arguments);

  const PathLength length{arguments.strain.value_or(kStrain), arguments.steps.value_or(kSteps),
                          arguments.rate.value_or(kRate)};
  if (length.strain / length.steps > 0.5)
    return usage("--steps", "steps of " + number_text(length.strain / length.steps) +
                                " are too long for a step of strain; take steps of at most 0.5");
  const bool from_rest = arguments.path == "oedometric";
  const double pressure = arguments.pressure.value_or(from_rest ? 0.0 : kPressure * elasticity.youngs_modulus);
  Chosen chosen;
  chosen.text = arguments.path;
  if (from_rest) {
    chosen.path = oedometric_path(pressure, length);
    chosen.plots = ElementPlots::kOedometric;
  } else if (shear) {
    chosen.path = simple_shear_path(pressure, length, arguments.hold == "volume");
    chosen.plots = ElementPlots::kShear;
    chosen.text += arguments.hold == "volume" ? " at constant volume" : " under constant normal stress";
  } else {
    chosen.path = triaxial_path(pressure, length, arguments.path == "triaxial_extension");
    chosen.plots = ElementPlots::kAxial;
  }
  chosen.text += ", " + short_number(pressure, 4) + " Pa, strain " + short_number(length.strain, 4) + " in " +
                 std::to_string(length.steps) + " steps at " + short_number(length.rate, 4) + "/s";
  return chosen;
}

}  // namespace

int element_command(const ElementArguments& arguments) {
  auto scene = read_scene(arguments.scene);
  if (!scene) return fail(scene.error());
  auto options = simulation_options(arguments.scene);
  if (!options) return fail(options.error());
  std::vector<std::string> left_out;
  auto only = element_scene(*scene, arguments.material, left_out);
  if (!only) return fail(only.error());
  auto chosen = chosen_path(arguments, only->materials[0].elasticity());
  if (!chosen) return fail(chosen.error());
  auto element = Element::create(*only, options->target);
  if (!element) return fail(element.error());
  auto folder = OutputFolder::open(arguments.out.empty() ? "out/" + scene->name + "-element" : arguments.out,
                                   scene->name);
  if (!folder) return fail(folder.error());
  auto states = drive(*element, chosen->path);
  if (!states) return fail(states.error());
  const MaterialDescription& material = element->material();
  const char* const law =
      std::visit([](const auto& parameters) { return parameters.kName; }, material.parameters);
  const ElementReport report{scene->name, material.name,       law,      chosen->text,          chosen->plots,
                             *states,     element->channels(), left_out, cone_of_element(*only)};
  if (auto written = write_report(report, folder->path()); !written) return fail(written.error());
  if (arguments.quiet) return 0;
  double most = 0.0, strength = 0.0;
  for (const ElementState& state : *states) {
    most = std::max(most, state.q());
    if (state.p() > 0.0) strength = std::max(strength, state.q() / state.p());
  }
  if (!left_out.empty())
    std::printf("no part of an element, and left out: %s\n", plain_list_text(left_out).c_str());
  std::printf("%s, %s: %zu steps, largest q %.6g Pa, largest q/p %.6g\n%s/index.html\n", material.name.c_str(),
              chosen->text.c_str(), states->size() - 1, most, strength, folder->path().c_str());
  return 0;
}

}  // namespace repose
