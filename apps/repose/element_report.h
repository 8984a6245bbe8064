// Repose: what `repose element` writes: element.csv, plots as SVG, and a page that holds them.
#pragma once

#include <string>
#include <vector>

#include "apps/repose/study/plot.h"
#include "engine/element/loading.h"

namespace repose {

/// Which strain a path goes by, and what is drawn over it.
enum class ElementPlots { kAxial, kOedometric, kShear, kAny };

struct ElementReport {
  std::string scene, material, law, path;  ///< their names; the path with its pressure, length and rate
  ElementPlots plots = ElementPlots::kAny;
  const std::vector<ElementState>& states;
  std::vector<std::string> channels;
  std::vector<std::string> left_out;  ///< effects of the scene that are no part of an element
  ElementCone cone;

  std::string csv() const;
  std::vector<Plot> charts() const;
  std::string page() const;
};

/// All files, into a folder. Errors: 73, 74.
Result<void> write_report(const ElementReport& report, const std::string& folder);

}  // namespace repose
