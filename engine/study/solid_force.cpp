#include "engine/study/solid_force.h"

#include "engine/study/series.h"

namespace repose {

void describe_time(Fields& fields, double& from, double& to) {
  fields.number("from", from, {.unit = "s", .meaning = "when it begins to be measured", .low = 0.0});
  fields.number("to", to, {.unit = "s", .meaning = "when it ceases; 0: with the run", .low = 0.0});
  fields.check(to == 0.0 || to > from, "to", "must be later than \"from\"");
}

void SolidForce::describe(Fields& fields) {
  fields.text("probe", probe, "name of a probe of force", true);
  fields.choice("axis", axis, kAxisChoices, "which component");
  describe_time(fields, from, to);
}

/// Frames may differ in length, so that means are by the time that each covers.
FigureValue SolidForce::measure(const RunRecord& record) const {
  Curve course;
  double impulse = 0.0, time = 0.0;
  for (std::size_t k = 1; k < record.moments.size(); ++k) {
    const double begin = record.moments[k - 1].time, end = record.moments[k].time;
    const auto value = number_of(record.moments[k], name());
    if (!value) continue;
    course.x.push_back(0.5 * (begin + end));
    course.y.push_back(*value);
    // A frame counts from its begin to its end, or not at all: what it told is a mean of the whole.
    const double slack = 1e-9 * (end - begin);
    if (begin < from - slack || (to > 0.0 && end > to + slack)) continue;
    impulse += *value * (end - begin);
    time += end - begin;
  }
  if (!(time > 0.0)) return FigureValue::none("no frame lies between \"from\" and \"to\"");
  return {impulse / time, "", std::move(course)};
}

}  // namespace repose
