// Repose: where the centre of mass is at the end, and its way there.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct CenterOfMass : FigureTraits {
  static constexpr const char* kName = "center_of_mass";
  static constexpr const char* kMeaning = "a coordinate of the centre of mass, at the end and over time";
  int axis = 1;

  void describe(Fields& fields) { fields.choice("axis", axis, kAxisChoices, "which coordinate"); }
  std::string unit() const { return "m"; }
  CurveAxes axes() const { return {"time [s]", std::string("centre of mass, ") + "xyz"[axis] + " [m]"}; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
