#include "engine/study/center_of_mass.h"

#include "engine/study/series.h"

namespace repose {

FigureValue CenterOfMass::measure(const RunRecord& record) const {
  Curve curve = series_of(record, std::string("center_of_mass.") + "xyz"[axis]);
  if (curve.empty()) return FigureValue::none("the run has no frame");
  const double end = curve.y.back();
  return {end, "", std::move(curve)};
}

}  // namespace repose
