#include "engine/study/flow_rate.h"

#include "engine/study/series.h"
#include "engine/study/solid_force.h"

namespace repose {

Summed sum_over(const RunRecord& record, const std::vector<std::string>& series,
                const std::vector<double>& signs, double from, double to) {
  Summed sum;
  for (std::size_t k = 1; k < record.moments.size(); ++k) {
    const double begin = record.moments[k - 1].time, end = record.moments[k].time;
    const double slack = 1e-9 * (end - begin);
    if (begin < from - slack || (to > 0.0 && end > to + slack)) continue;
    if (sum.course.empty()) {
      sum.course.x.push_back(begin);
      sum.course.y.push_back(0.0);
    }
    for (std::size_t i = 0; i < series.size(); ++i) {
      sum.total += signs[i] * number_of(record.moments[k], series[i]).value_or(0.0);
    }
    sum.time += end - begin;
    sum.course.x.push_back(end);
    sum.course.y.push_back(sum.total);
  }
  return sum;
}

void FlowRate::describe(Fields& fields) {
  fields.text("probe", probe, "name of a probe of flow", true);
  describe_time(fields, from, to);
}

FigureValue FlowRate::measure(const RunRecord& record) const {
  Summed passed = sum_over(record, series(), {1.0, -1.0}, from, to);
  if (!(passed.time > 0.0)) return FigureValue::none("no frame lies between \"from\" and \"to\"");
  return {passed.total / passed.time, "", std::move(passed.course)};
}

}  // namespace repose
