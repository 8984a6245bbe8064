#include "engine/study/angle.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace repose {

double slope_degrees(const Curve& heights, double from, double to) {
  double n = 0.0, sum_r = 0.0, sum_h = 0.0, sum_rr = 0.0, sum_rh = 0.0;
  for (std::size_t k = 0; k < heights.x.size(); ++k) {
    const double r = heights.x[k], h = heights.y[k];
    if (r < from || r > to) continue;
    n += 1.0;
    sum_r += r;
    sum_h += h;
    sum_rr += r * r;
    sum_rh += r * h;
  }
  if (n < 2.0) return NAN;
  const double slope = (n * sum_rh - sum_r * sum_h) / (n * sum_rr - sum_r * sum_r);
  return -std::atan(slope) * 180.0 / std::numbers::pi;
}

void Angle::describe(Fields& fields) {
  repose::describe(fields, heap);
  fields.number(
      "low", low,
      {.meaning = "share of the top height below which the foot is left out", .low = 0.0, .high = 1.0});
  fields.number("high", high, {.meaning = "share above which the top is left out", .low = 0.0, .high = 1.0});
  fields.check(low < high, "high", "must be more than \"low\"");
}

FigureValue Angle::measure(const RunRecord& record) const {
  const Curve height = heights(heap, record.end, record);
  if (height.empty())
    return FigureValue::none("nothing lies there, or how deep the heap is, is not known: give \"depth\"");
  const auto peak = std::max_element(height.y.begin(), height.y.end());
  auto k = static_cast<std::size_t>(peak - height.y.begin());
  while (k < height.y.size() && height.y[k] > high * *peak) ++k;
  const std::size_t first = k;
  while (k < height.y.size() && height.y[k] >= low * *peak) ++k;
  if (k < first + 2)
    return FigureValue::none(
        "fewer than two rings lie on the slope; a finer grid, or more between low and high");
  return {slope_degrees(height, height.x[first], height.x[k - 1]), "", {}};
}

}  // namespace repose
