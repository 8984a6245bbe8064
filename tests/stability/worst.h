// Repose tests: the worst of many figures and where it was met, for cases that go over samples and instruction
// sets.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

#include "tests/stability/battery.h"

namespace repose::battery {

/// Not a number is worse than any.
class Worst {
 public:
  void add(double figure, const std::string& where) {
    if (!(figure > figure_) && !std::isnan(figure)) return;
    if (std::isnan(figure_)) return;
    figure_ = figure;
    where_ = where;
  }
  double figure() const { return figure_; }
  const std::string& where() const { return where_; }

 private:
  double figure_ = 0.0;
  std::string where_ = "nowhere";
};

inline void at_most(Case& asked, const std::string& what, const Worst& worst, double bar,
                    const std::string& unit = "") {
  SCOPED_TRACE("worst at " + worst.where());
  asked.at_most(what, worst.figure(), bar, unit);
}

template <class Real>
inline constexpr const char* kPrecision = sizeof(Real) == 4 ? "float" : "double";
template <class Real>
inline constexpr double kEpsilon = std::numeric_limits<Real>::epsilon();

}  // namespace repose::battery
