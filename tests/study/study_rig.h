// Repose tests: what the tests of studies share: records whose figures are known, and a study whose results
// are.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "apps/repose/study/report.h"

namespace repose {

/// A particle that stands for so much volume (m^3) at a place.
void add_particle(PointCloud& points, const std::array<double, 3>& at, double volume);

/// In plane strain, spacing 0.1 m: strips along x, in the middle of each one particle whose volume makes the
/// strip as high as `height` says, at half of that.
RunRecord strips(const std::function<double(double)>& height, int count);

/// Moments at the times k dt with one series, "probe.value".
RunRecord series(const std::function<double(double)>& value, double dt, int count);

Figure a_figure(const std::string& name, FigureKind kind);

/// Two keys, cells 10, 20, 40 and transfer apic, flip; the error falls as 1/cells for one and is 0.2 for the
/// other; flip of 40 cells gives out after 3 s, and flip of 10 is refused. 2 seeds, 0.01 apart.
struct MadeStudy {
  StudyPlan plan;
  std::vector<Vary> vary;
  std::vector<StudyRun> runs;

  explicit MadeStudy(int finest_seeds = 4);
  StudyReport report(const Summary& summary) const;
};

}  // namespace repose
