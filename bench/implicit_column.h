// Repose: the column of several studies: sand in plane strain beside a smooth wall, twice as high as wide, that
// collapses. Its sand keeps its own velocities (aflip): apic loses a share of them at each step, whatever the
// integrator, so that shorter steps alone would bring the front nearer by a third and hide what is studied.
#pragma once

#include "bench/implicit_study.h"

namespace repose {

constexpr double kColumnWidth = 0.1;        ///< m
constexpr double kColumnModulus = 3.537e5;  ///< Pa
constexpr double kColumnTime = 0.5;         ///< s; the front rests from about 0.4 s on

/// The column with so many cells across.
RunRequest column(const ImplicitStudyArguments& arguments, std::int64_t cells, std::vector<std::string> set);

/// Where the front is over the width that the column had, less 1. The front is where 98 of 100 particles lie
/// behind: beyond it sand is thinner than a cell, and a few particles would decide.
double run_out(const Simulation& simulation);
/// The same of the mean of all, twice: 0 for the column as it stood.
double mean_run_out(const Simulation& simulation);

/// The run-out as a table has it: of a run that came to its end, else why it did not.
std::string run_out_or_reason(const Run& run);

}  // namespace repose
