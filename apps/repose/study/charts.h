// Repose: from what a study came to, to its plots: which point has which colour and shape, what is joined by
// lines, and which plots there are.
#pragma once

#include <string>
#include <vector>

#include "apps/repose/study/plot.h"
#include "apps/repose/study/summary.h"

namespace repose {

/// What a study is about, for its plots and its page.
struct StudyHead {
  std::string name;  ///< of the scene
  std::vector<Vary> vary;
  std::vector<std::string> written;  ///< per key of `vary`: its value as the scene is written; empty: not there
};

/// The plots of a figure, in the order of the page: error against time, value against time, curves; those that
/// have nothing to show are left out.
std::vector<Plot> charts_of(const StudyHead& head, const StudyPlan& plan, const Summary& summary,
                            std::size_t figure);

/// "3.2 %" of a share, "0.0012 m" of another error.
std::string error_text(const Figure& figure, double error);

/// One line a fact: settings, time, particles, figure, error; for hovering.
std::string point_text(const StudyPlan& plan, const Summary& summary, std::size_t point, std::size_t figure);

}  // namespace repose
