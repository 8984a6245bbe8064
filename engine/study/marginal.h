// Repose: how matter is spread along one coordinate: its quantiles. Two runs are compared by the Wasserstein-1
// distance, the mean way that mass would have to go from one to the other; a run alone tells that from its
// start to its end.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct Marginal : FigureTraits {
  static constexpr const char* kName = "marginal";
  static constexpr const char* kMeaning = "spread along a coordinate; compared by the Wasserstein-1 distance";
  static constexpr Compares kCompares = Compares::kQuantiles;
  int along = 1;         ///< x, y, z, or the distance from the axis that goes up through the origin
  Vec3 origin{0, 0, 0};  ///< m

  void describe(Fields& fields);
  std::string unit() const { return "m"; }
  CurveAxes axes() const;
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
