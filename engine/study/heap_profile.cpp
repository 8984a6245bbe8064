#include "engine/study/heap_profile.h"

#include <algorithm>

namespace repose {

FigureValue HeapProfile::measure(const RunRecord& record) const {
  Curve curve = heights(heap, record.end, record);
  if (curve.empty())
    return FigureValue::none("nothing lies there, or how deep the heap is, is not known: give \"depth\"");
  const double top = *std::max_element(curve.y.begin(), curve.y.end());
  return {top, "", std::move(curve)};
}

}  // namespace repose
