// Repose: the force on a solid as a probe of force tells it: its mean over a time, and its course.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct SolidForce : FigureTraits {
  static constexpr const char* kName = "force";
  static constexpr const char* kMeaning = "mean force on a solid, from a probe of force";
  std::string probe;
  int axis = 1;
  double from = 0.0, to = 0.0;  ///< s; to 0: the end

  void describe(Fields& fields);
  std::vector<std::string> series() const { return {name()}; }
  std::string unit() const { return "N"; }
  CurveAxes axes() const { return {"time [s]", name() + " [N]"}; }
  FigureValue measure(const RunRecord& record) const;

 private:
  std::string name() const { return probe + ".force." + "xyz"[axis]; }
};

/// The keys of a figure that is read off a probe over a time.
void describe_time(Fields& fields, double& from, double& to);

}  // namespace repose
