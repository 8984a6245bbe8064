// Repose tests: figures, what is asked of them and what was measured, as lines of cells that tests/table.py
// gathers into tables. The battery of hard cases (tests/stability/battery.h) and the table of laws
// (tests/physics/validation.h) are made of them.
#pragma once

#include <limits>
#include <string>
#include <vector>

namespace repose::figures {

/// Which of two is further from `law`. Not a number is further than any, so that it is not lost among others.
double further(double one, double other, double law = 0.0);

/// A number and its unit, with so many digits in all.
std::string text(double value, const std::string& unit, int digits = 3);

/// What is asked of a figure: that it lies between both ends, either of which may be infinite.
struct Band {
  double low = 0.0, high = 0.0;

  static Band up_to(double most) { return {-std::numeric_limits<double>::infinity(), most}; }
  static Band from(double least) { return {least, std::numeric_limits<double>::infinity()}; }

  /// Not a number lies nowhere.
  bool holds(double value) const { return low <= value && value <= high; }
  /// "<= 2 m", ">= 2 m" or "1 to 2 m".
  std::string text(const std::string& unit, int digits = 3) const;
};

/// A bar that the engine is known to miss: the figure is shown as missed, and fails only where it is worse than
/// it was when it was written down, or holds: then the miss is to be struck out.
struct Missed {
  double worst;     ///< what is measured must not be worse
  const char* why;  ///< and where it says which remedies were tried
};

enum class Verdict { kHolds, kMissed, kFails };
/// "missed", "FAILS", or the word that a table has for what holds.
std::string word(Verdict verdict, const std::string& holds);

/// Compares, and fails the test where the figure neither holds nor misses its bar as it is known to. `name`
/// begins what the test then says.
Verdict judge(const std::string& name, double measured, const Band& asked, const std::string& unit,
              const Missed* missed = nullptr);

/// Prints a line of cells; `kind` tells whose table it belongs to.
void print(const std::string& kind, const std::vector<std::string>& cells);

}  // namespace repose::figures
