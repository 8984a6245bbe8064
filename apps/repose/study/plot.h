// Repose: plots as SVG, drawn here and not in a browser: the picture on the page is the file that goes into a
// paper.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "engine/base/wording.h"

namespace repose {

struct Axis {
  std::string label;
  bool log = false;
};

/// A point of a study in a plot. Whatever carries the number of a point is tied to it on the page.
struct Mark {
  std::size_t point = 0;
  double x = 0.0, y = 0.0;
  double x_low = 0.0, x_high = 0.0;  ///< quartiles; equal to x: none
  int colour = 0, shape = 0;
  bool pale = false;  ///< below twice the noise floor
  bool front = false;
  bool reference = false;
  std::string title{};  ///< what hovering tells where there is no page
};

struct Line {
  std::vector<std::pair<double, double>> points;
  int colour = 0;
  std::size_t point = kNoPoint;
  bool front = false;  ///< the Pareto front
  bool reference = false;
  double opacity = 0.75;
  static constexpr std::size_t kNoPoint = static_cast<std::size_t>(-1);
};

struct LegendEntry {
  std::string text;
  int colour = 0, shape = kAnyShape;
  static constexpr int kAnyShape = -1, kHeading = -2;  ///< a heading is a word without a mark
};

struct Plot {
  std::string name;  ///< of the file
  std::string title;
  Axis x, y;
  std::vector<Line> lines{};
  std::vector<Mark> marks{};
  std::vector<Mark> margin{};  ///< points that gave out: x alone counts; not a number: they never began
  std::vector<LegendEntry> legend{};
  double floor = 0.0;  ///< noise floor, of y; 0: none
  double level = 0.0;  ///< of the reference, if has_level
  bool has_level = false;
  bool from_zero = false;  ///< y begins at 0
};

/// A whole SVG file. It stands by itself: no style, font or script from elsewhere.
std::string svg(const Plot& plot);

/// The text as SVG, HTML and XML have it.
std::string escaped(const std::string& text);

/// Places of ticks between two values.
std::vector<double> ticks(double low, double high, bool log);
/// What stands at each of them: digits enough to tell neighbours apart.
std::vector<std::string> tick_texts(const std::vector<double>& ticks);

inline constexpr int kColours = 8, kShapes = 5;
const char* colour_of(int index);

}  // namespace repose
