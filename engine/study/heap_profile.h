// Repose: the outline of a heap: its height over the distance from its middle, and as its number the largest
// height.
#pragma once

#include "engine/study/figure.h"
#include "engine/study/heap.h"

namespace repose {

struct HeapProfile : FigureTraits {
  static constexpr const char* kName = "profile";
  static constexpr const char* kMeaning = "height over distance; its number is the largest height";
  static constexpr Compares kCompares = Compares::kCurve;
  Heap heap;

  void describe(Fields& fields) { repose::describe(fields, heap); }
  std::string unit() const { return "m"; }
  CurveAxes axes() const { return {"distance [m]", "height [m]"}; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
