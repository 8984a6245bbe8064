#include "engine/study/period.h"

#include "engine/study/series.h"

namespace repose {

void describe_swinging(Fields& fields, std::string& of, double& level) {
  fields.text("of", of,
              "the series: PROBE.QUANTITY, or center_of_mass.x, velocity.x, energy.kinetic and the like", true);
  fields.number("level", level, {.meaning = "about which it swings, in its unit"});
}

void Period::describe(Fields& fields) {
  describe_swinging(fields, of, level);
}

FigureValue Period::measure(const RunRecord& record) const {
  Curve series = series_of(record, of);
  const std::vector<double> times = crossings(series, level);
  if (times.size() < 3)
    return FigureValue::none("it passes its level fewer than three times; let it run longer");
  return {2.0 * (times.back() - times.front()) / static_cast<double>(times.size() - 1), "", std::move(series)};
}

}  // namespace repose
