// Repose: how much of its height what swings loses in a period, by a straight line through the logarithms of
// the heights of its half swings.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct Damping : FigureTraits {
  static constexpr const char* kName = "damping";
  static constexpr const char* kMeaning = "share of the height that a series that swings loses in a period";
  std::string of;      ///< name of the series
  double level = 0.0;  ///< in its unit

  void describe(Fields& fields);
  std::vector<std::string> series() const { return {of}; }
  std::string unit() const { return ""; }
  CurveAxes axes() const { return {"time [s]", "height of half swings"}; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
