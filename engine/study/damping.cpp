#include "engine/study/damping.h"

#include <cmath>

#include "engine/study/period.h"
#include "engine/study/series.h"

namespace repose {

void Damping::describe(Fields& fields) {
  describe_swinging(fields, of, level);
}

FigureValue Damping::measure(const RunRecord& record) const {
  const std::vector<Swing> all = swings(series_of(record, of), level);
  if (all.size() < 3) return FigureValue::none("it makes fewer than three half swings; let it run longer");
  Curve heights;
  double n = 0.0, sum = 0.0, logs = 0.0, squares = 0.0, products = 0.0;
  for (std::size_t k = 0; k < all.size(); ++k) {
    if (!(all[k].height > 0.0)) return FigureValue::none("a half swing has no height");
    heights.x.push_back(all[k].time);
    heights.y.push_back(all[k].height);
    const auto half = static_cast<double>(k);
    const double log = std::log(all[k].height);
    n += 1.0;
    sum += half;
    logs += log;
    squares += half * half;
    products += half * log;
  }
  const double slope = (n * products - sum * logs) / (n * squares - sum * sum);  // per half period
  return {1.0 - std::exp(2.0 * slope), "", std::move(heights)};
}

}  // namespace repose
