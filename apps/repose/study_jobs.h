// Repose: which runs a study asks for, and what each is called: a run of equal scene, figures and threads is
// made once, whichever points and studies ask for it.
#pragma once

#include <string>
#include <vector>

#include "apps/repose/command.h"
#include "apps/repose/study/summary.h"

namespace repose {

/// Exit code of a run that was ended because of --most-seconds; it is no fault of anything.
inline constexpr int kTookTooLong = 1;

/// The figures that a study measures: those it names, else where the centre of mass is, how matter is spread
/// along up, and energy from nowhere.
std::vector<Figure> figures_of(const StudyDescription& study, const Scene& scene);

/// Fingerprint of this program.
const std::string& program_build();

/// Fingerprint of a scene and of what the files that it names held when this process first asked.
std::string inputs_of(const Scene& scene);

/// One run to make.
struct Job {
  std::size_t point = 0;
  int seed = 0, repeat = 0;
  std::string key;                     ///< by which it is found again
  std::string inputs;                  ///< inputs_of() the scene that it shall run
  std::vector<std::string> overrides;  ///< as --set has them
  double cost = 1.0;                   ///< about, over that of the others
  std::string text;                    ///< point and seed, for people
};

/// A study, put together from the scene and the command line.
struct StudySetup {
  StudyPlan plan;
  std::vector<Vary> vary;
  std::vector<Job> jobs;
};
/// Errors: 64 wrong arguments, 65 a study in which every point is refused, or a reference that is.
Result<StudySetup> set_up(const StudyArguments& arguments, const Scene& scene);

}  // namespace repose
