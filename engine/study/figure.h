// Repose: what a figure of merit is. Each is a pair of files: a struct of the keys by which a scene asks for
// it, and how it is read off a run. figures.h is the list.
//
// A figure has
//   kName, kMeaning           its "type" in scenes
//   kCompares                 by what two runs are compared
//   describe(Fields&)         its keys
//   series()                  the series that it reads (series.h), so that a name that is none is found out
//   before
//                             the run and not after it
//   unit(), axes()            of its number; of its curve, if it has one
//   measure(record)           what it is for a run alone
#pragma once

#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/study/curve.h"
#include "engine/study/record.h"

namespace repose {

/// By what two runs are compared.
enum class Compares {
  kValue,      ///< |a - b|, in shares of the reference's value
  kCurve,      ///< the root mean square between two curves, in shares of that of the reference
  kQuantiles,  ///< the area between curves of quantiles, in shares of the reference's value
  kItself,     ///< the number is an error already: of a perfect run it would be 0
};

struct FigureValue {
  double value = 0.0;
  std::string why;  ///< why there is no value; empty where there is one
  Curve curve;

  static FigureValue none(std::string why) { return {0.0, std::move(why), {}}; }
  bool there() const { return why.empty(); }
};

/// What a curve's x and y are, with units; empty where there is no curve.
struct CurveAxes {
  std::string x, y;
};

/// What most figures have.
struct FigureTraits {
  static constexpr Compares kCompares = Compares::kValue;
  std::vector<std::string> series() const { return {}; }
  CurveAxes axes() const { return {}; }
};

inline constexpr Choice kAxisChoices[] = {{"x", "x"}, {"y", "y"}, {"z", "z"}};

}  // namespace repose
