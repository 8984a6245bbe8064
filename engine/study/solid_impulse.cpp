#include "engine/study/solid_impulse.h"

#include "engine/study/flow_rate.h"
#include "engine/study/solid_force.h"

namespace repose {

void SolidImpulse::describe(Fields& fields) {
  fields.text("probe", probe, "name of a probe of force", true);
  fields.choice("axis", axis, kAxisChoices, "which component");
  describe_time(fields, from, to);
}

FigureValue SolidImpulse::measure(const RunRecord& record) const {
  Summed summed = sum_over(record, {name()}, {1.0}, from, to);
  if (!(summed.time > 0.0)) return FigureValue::none("no frame lies between \"from\" and \"to\"");
  return {summed.total, "", std::move(summed.course)};
}

}  // namespace repose
