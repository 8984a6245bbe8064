// Repose: the period of what swings: twice the mean time between two passages of its middle.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct Period : FigureTraits {
  static constexpr const char* kName = "period";
  static constexpr const char* kMeaning = "of a series that swings, s";
  std::string of;      ///< name of the series
  double level = 0.0;  ///< in its unit

  void describe(Fields& fields);
  std::vector<std::string> series() const { return {of}; }
  std::string unit() const { return "s"; }
  CurveAxes axes() const { return {"time [s]", of}; }
  FigureValue measure(const RunRecord& record) const;
};

/// The keys of a figure of a series that swings.
void describe_swinging(Fields& fields, std::string& of, double& level);

}  // namespace repose
