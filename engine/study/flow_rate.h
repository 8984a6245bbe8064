// Repose: mass that passes a plane of a probe of flow in a time, forth less back.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct FlowRate : FigureTraits {
  static constexpr const char* kName = "flow_rate";
  static constexpr const char* kMeaning = "mass that passes a plane per second, from a probe of flow";
  std::string probe;
  double from = 0.0, to = 0.0;  ///< s; to 0: the end

  void describe(Fields& fields);
  std::vector<std::string> series() const { return {probe + ".mass_forth", probe + ".mass_back"}; }
  std::string unit() const { return "kg/s"; }
  CurveAxes axes() const { return {"time [s]", "mass that has passed [kg]"}; }
  FigureValue measure(const RunRecord& record) const;
};

/// What probes tell per frame, added up over the frames that lie between two times (s; to 0: the end), each
/// series times its sign.
struct Summed {
  double total = 0.0, time = 0.0;
  Curve course;  ///< what had come together by the end of each frame
};
Summed sum_over(const RunRecord& record, const std::vector<std::string>& series,
                const std::vector<double>& signs, double from, double to);

}  // namespace repose
