// Repose: one number over the frames of a run, by name: "PROBE.QUANTITY" of a probe of the scene, or what every
// run tells: "center_of_mass.x", "momentum.x", "velocity.x" (of the mean; y, z), "energy.kinetic" (affine,
// elastic, potential, total).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/study/curve.h"
#include "engine/study/record.h"

namespace repose {

/// All names that a moment answers to.
std::vector<std::string> series_names(const RunMoment& moment);
/// Its number; nothing where it has none of that name, or no number there.
std::optional<double> number_of(const RunMoment& moment, const std::string& name);
/// Over time, of the moments that have the number.
Curve series_of(const RunRecord& record, const std::string& name);

/// Where a series passes `level`, s: straight lines between its points.
std::vector<double> crossings(const Curve& series, double level);
/// The largest |y - level| between each two crossings, by a parabola through the three points about it; what
/// comes before the first crossing and after the last is no half swing.
struct Swing {
  double time = 0.0, height = 0.0;
};
std::vector<Swing> swings(const Curve& series, double level);

/// The part of a series between two times, s; to <= from: to its end.
Curve within(const Curve& series, double from, double to);

}  // namespace repose
