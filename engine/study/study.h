// Repose: what a scene says of its study: which of its keys are varied, what is measured, and against what. It
// is no part of what is simulated: a state does not depend on it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/study/figures.h"

namespace repose {

/// A key and the values that it takes, as the words of --vary have them: "0.02, 0.01" or "apic, aflip".
struct VariedKey {
  std::string key;     ///< as --set understands it
  std::string values;  ///< separated by commas
};

/// How values of several keys are put together.
enum class Design {
  kProduct,   ///< each value of one with each of all others
  kOneByOne,  ///< each value alone, all else as the scene is written
};
inline constexpr Choice kDesigns[] = {{"product", "each value of a key with each of all others"},
                                      {"one_by_one", "each value alone, all else as the scene is written"}};

/// What a figure is known to be, from outside this study.
struct KnownFigure {
  std::string figure;
  double value = 0.0;
  std::vector<std::vector<double>> curve;  ///< rows (x, y)
  std::string source;
};

/// The run that stands in for the truth.
struct FinestRun {
  bool given = false;
  std::string set;  ///< "key=value; key=value"; empty: the point of the sweep with the smallest spacing
  std::int64_t seeds = 8;
};

struct StudyDescription {
  bool given = false;
  std::vector<VariedKey> vary;
  Design design = Design::kProduct;
  std::int64_t seeds = 1;
  std::int64_t repeat = 1;
  std::vector<Figure> figures;
  FinestRun finest;
  std::vector<KnownFigure> known;
};

/// The scene's key "study".
void describe(Fields& fields, StudyDescription& study);

}  // namespace repose
