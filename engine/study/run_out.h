// Repose: how far a heap has run: where its height ceases to be half a cell on the mean of three rings.
#pragma once

#include "engine/study/figure.h"
#include "engine/study/heap.h"

namespace repose {

struct RunOut : FigureTraits {
  static constexpr const char* kName = "run_out";
  static constexpr const char* kMeaning = "how far a heap has run, over its first length";
  Heap heap;
  double start = 0.0;  ///< m; 0: the distance of the front itself
  double cover = 0.0;  ///< m; 0: half of dx

  void describe(Fields& fields);
  std::string unit() const { return start > 0.0 ? "" : "m"; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
