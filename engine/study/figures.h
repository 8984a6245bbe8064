// Repose: the figures of merit. One list: scenes, the schema, `repose figures`, studies and their pages go
// through it, so a new figure is a pair of files and a line here.
#pragma once

#include <string>
#include <variant>
#include <vector>

#include "engine/study/angle.h"
#include "engine/study/center_of_mass.h"
#include "engine/study/damping.h"
#include "engine/study/density_error.h"
#include "engine/study/energy_residual.h"
#include "engine/study/flow_rate.h"
#include "engine/study/heap_profile.h"
#include "engine/study/manufactured_error.h"
#include "engine/study/marginal.h"
#include "engine/study/period.h"
#include "engine/study/run_out.h"
#include "engine/study/solid_force.h"
#include "engine/study/solid_impulse.h"

namespace repose {

using FigureKind = std::variant<RunOut, HeapProfile, CenterOfMass, EnergyResidual, Period, Damping, SolidForce,
                                SolidImpulse, Angle, FlowRate, DensityError, Marginal, ManufacturedError>;

/// A figure that a scene asks for.
struct Figure {
  std::string name;
  FigureKind kind;

  const char* type() const;
  std::string unit() const;
  CurveAxes axes() const;
  Compares compares() const;
  std::vector<std::string> series() const;
  FigureValue measure(const RunRecord& record) const;
};

void describe(Fields& fields, Figure& figure);

/// How far a run's figure is from that of a reference, and by curves also the largest distance; not a number
/// where one of them has none.
struct FigureError {
  double value = 0.0, largest = 0.0;
};
FigureError error_of(Compares compares, const FigureValue& run, const FigureValue& reference);

/// Whether errors are shares of the reference, and so without a unit.
inline bool is_share(Compares compares) {
  return compares != Compares::kItself;
}

}  // namespace repose
