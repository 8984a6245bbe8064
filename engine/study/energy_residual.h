// Repose: energy that nobody accounts for. Matter that yields may lose energy, and then only what it gains is a
// residual; matter that does not may neither.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct EnergyResidual : FigureTraits {
  static constexpr const char* kName = "energy_residual";
  static constexpr const char* kMeaning =
      "energy from nowhere, over the largest kinetic energy and fall of potential";
  static constexpr Compares kCompares = Compares::kItself;
  enum class Counts { kGain, kChange };
  Counts counts = Counts::kGain;
  std::string probe;  ///< of energy, that knows the work of moving solids; empty: none move

  void describe(Fields& fields);
  std::vector<std::string> series() const;
  std::string unit() const { return ""; }
  CurveAxes axes() const { return {"time [s]", "energy less work [J]"}; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
