// Repose: the impulse on a solid as a probe of force tells it: summed over a time, and its course.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct SolidImpulse : FigureTraits {
  static constexpr const char* kName = "impulse";
  static constexpr const char* kMeaning = "impulse on a solid, summed, from a probe of force";
  std::string probe;
  int axis = 1;
  double from = 0.0, to = 0.0;  ///< s; to 0: the end

  void describe(Fields& fields);
  std::vector<std::string> series() const { return {name()}; }
  std::string unit() const { return "N s"; }
  CurveAxes axes() const { return {"time [s]", "impulse so far [N s]"}; }
  FigureValue measure(const RunRecord& record) const;

 private:
  std::string name() const { return probe + ".impulse." + "xyz"[axis]; }
};

}  // namespace repose
