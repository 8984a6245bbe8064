// Repose: how well a grid knows how sand comes to rest, for forecasts: the error of a heap's outline by the
// number of cells that its sand has along an edge. Measured by studies (bench/studies) against a grid that is
// finer than all; `python3 bench/accuracy.py` writes the rows between the marks.
#pragma once

#include <span>

#include "engine/base/powers.h"

namespace repose {

struct OutlineError {
  double cells;  ///< along the edge of a cube (in plane strain: a square) of as much sand
  double error;  ///< root mean square of heights, as a share of that of heights themselves
};

inline constexpr OutlineError kOutlineErrors[] = {
    // accuracy: begin
    {5.9, 0.219},
    {8.8, 0.137},
    {11.3, 0.107},
    {14.6, 0.084},
    {22.6, 0.041},
    {45.3, 0.016},
    // accuracy: end
};

/// Other scenes are not that column: what is told is this many times what was measured there, and in the scenes
/// that were tried the error was less than told, and more than a quarter of it (docs/accuracy.md).
inline constexpr double kOutlineMargin = 2.0;

/// As a share, at most about.
inline double expected_outline_error(double cells) {
  const std::span<const OutlineError> rows(kOutlineErrors);
  return kOutlineMargin * along_powers(rows, &OutlineError::cells, &OutlineError::error, cells);
}

}  // namespace repose
