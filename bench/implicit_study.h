// Repose: the studies of implicit steps, each of them a table of docs/implicit.md. They know the solver by
// scene keys and reports of steps alone, so they stay what they are while it changes.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "bench/implicit_run.h"
#include "bench/page.h"

namespace repose {

/// What a study may be told; it has its own where there is nothing, or 0.
struct ImplicitStudyArguments {
  std::vector<std::string> modes;  ///< implicit.mode
  std::vector<double> steps;       ///< time.max_step of implicit runs, s
  std::int64_t cells = 0;          ///< across what is studied
  double until = 0.0;              ///< s of the scene
  double most_seconds = 20.0;      ///< of computing, for one run
  std::vector<std::string> set;    ///< overrides of every scene

  double until_or(double own) const { return until > 0.0 ? until : own; }
  std::int64_t cells_or(std::int64_t own) const { return cells > 0 ? cells : own; }
  std::vector<double> steps_or(std::vector<double> own) const { return steps.empty() ? own : steps; }
  std::vector<std::string> modes_or(std::vector<std::string> own) const { return modes.empty() ? own : modes; }
};

struct ImplicitStudy {
  const char* name;
  const char* meaning;
  Result<Table> (*run)(const ImplicitStudyArguments&);
};

/// All of them, in the order of the page.
const std::vector<ImplicitStudy>& studies();

/// All ways in which sand can answer within a solve.
inline const std::vector<std::string> kAllModes{"exact", "projected", "lagged", "unilateral"};
/// Those in which it yields there.
inline const std::vector<std::string> kYieldingModes{"exact", "projected"};

/// Overrides: implicit steps of a mode and a length.
std::vector<std::string> implicit_steps(const std::string& mode, double step);
/// "key=value", with all digits that a double has.
std::string assign(const std::string& key, double value);

/// Puts a row under a table, and tells whoever waits.
void add_row(Table& table, std::vector<std::string> row);

// The studies.

/// Run-out of a column in all modes and steps, beside that of explicit steps of several lengths and seeds.
Result<Table> study_modes(const ImplicitStudyArguments& arguments);
/// What sand without cohesion takes from sand that moves away from it.
Result<Table> study_parting(const ImplicitStudyArguments& arguments);
/// The steepest slope on which a layer of sand stays.
Result<Table> study_slope(const ImplicitStudyArguments& arguments);
/// Seconds to a run-out that is right to 5 %, against Young's modulus.
Result<Table> study_stiffness(const ImplicitStudyArguments& arguments);
/// A plate that sinks slowly into a bed: force and seconds.
Result<Table> study_pile(const ImplicitStudyArguments& arguments);
/// What each key of the solver is worth.
Result<Table> study_ablation(const ImplicitStudyArguments& arguments);
/// What an iteration of each linear method takes, beside an explicit step.
Result<Table> study_iteration(const ImplicitStudyArguments& arguments);
/// Run-out and seconds against implicit.tolerance.
Result<Table> study_tolerance(const ImplicitStudyArguments& arguments);

}  // namespace repose
