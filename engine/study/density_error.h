// Repose: how evenly matter lies at the end: the root mean square of density over that of seeding, less 1, in
// cells whose neighbours hold matter too.
#pragma once

#include "engine/study/figure.h"

namespace repose {

struct DensityError : FigureTraits {
  static constexpr const char* kName = "density_error";
  static constexpr const char* kMeaning =
      "root mean square of density over seeded density, less 1, away from surfaces";
  static constexpr Compares kCompares = Compares::kItself;
  double width = 0.0;  ///< m, of a cell; 0: 2 dx

  void describe(Fields& fields);
  std::string unit() const { return ""; }
  FigureValue measure(const RunRecord& record) const;
};

}  // namespace repose
