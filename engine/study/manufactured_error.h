// Repose: how far particles are from where an exact motion has them: the error of manufactured solutions.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct ManufacturedError : FigureTraits {
  static constexpr const char* kName = "manufactured_error";
  static constexpr const char* kMeaning =
      "root mean square distance of particles from where the scene's manufactured solution has them";
  static constexpr Compares kCompares = Compares::kItself;

  void describe(Fields&) {}
  std::string unit() const { return "m"; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
