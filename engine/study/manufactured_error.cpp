#include "engine/study/manufactured_error.h"

#include <cmath>

namespace repose {

FigureValue ManufacturedError::measure(const RunRecord& record) const {
  if (record.expected.empty())
    return FigureValue::none(
        "the scene has no \"manufactured\" motion, or more bodies than the one that has it");
  double squares = 0.0;
  for (std::size_t p = 0; p < record.expected.size(); ++p) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (static_cast<int>(axis) == record.flat) continue;
      double way = record.end.position[p][axis] - record.expected[p][axis];
      if (record.period[axis] > 0.0) way -= record.period[axis] * std::round(way / record.period[axis]);
      squares += way * way;
    }
  }
  return {std::sqrt(squares / static_cast<double>(record.expected.size())), "", {}};
}

}  // namespace repose
