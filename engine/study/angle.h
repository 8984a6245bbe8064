// Repose: the slope of a heap: of the straight line that fits its heights between two shares of its top.
#pragma once

#include "engine/study/figure.h"
#include "engine/study/heap.h"

namespace repose {

struct Angle : FigureTraits {
  static constexpr const char* kName = "angle";
  static constexpr const char* kMeaning = "slope of a heap, degrees";
  Heap heap;
  double low = 0.2, high = 0.8;  ///< shares of the top height between which the slope is measured

  void describe(Fields& fields);
  std::string unit() const { return "degrees"; }
  FigureValue measure(const RunRecord& record) const;
};

/// Slope, falling outwards, degrees, of the straight line by least squares through the points of a curve
/// between two places; not a number where fewer than two lie there.
double slope_degrees(const Curve& heights, double from, double to);

}  // namespace repose
