#include "tests/figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <iostream>

namespace repose::figures {

double further(double one, double other, double law) {
  if (std::isnan(one)) return one;
  return std::abs(other - law) <= std::abs(one - law) ? one : other;
}

std::string text(double value, const std::string& unit, int digits) {
  char number[32];
  std::snprintf(number, sizeof number, "%.*g", digits, value);
  return unit.empty() ? number : number + (" " + unit);
}

std::string Band::text(const std::string& unit, int digits) const {
  if (std::isinf(low)) return "<= " + figures::text(high, unit, digits);
  if (std::isinf(high)) return ">= " + figures::text(low, unit, digits);
  return figures::text(low, "", digits) + " to " + figures::text(high, unit, digits);
}

std::string word(Verdict verdict, const std::string& holds) {
  return verdict == Verdict::kHolds ? holds : verdict == Verdict::kMissed ? "missed" : "FAILS";
}

Verdict judge(const std::string& name, double measured, const Band& asked, const std::string& unit,
              const Missed* missed) {
  const bool holds = asked.holds(measured);
  if (missed == nullptr) {
    EXPECT_TRUE(holds) << name << ": " << text(measured, unit) << ", asked " << asked.text(unit);
    return holds ? Verdict::kHolds : Verdict::kFails;
  }
  EXPECT_FALSE(holds) << name << " holds now: strike out that it is missed";
  const Band known{std::min(asked.low, missed->worst), std::max(asked.high, missed->worst)};
  EXPECT_TRUE(known.holds(measured)) << name << ": " << text(measured, unit) << ", worse than the known "
                                     << text(missed->worst, unit) << " (" << missed->why << ")";
  return holds ? Verdict::kHolds : Verdict::kMissed;
}

void print(const std::string& kind, const std::vector<std::string>& cells) {
  std::string line;
  for (const std::string& cell : cells) line += (line.empty() ? "" : " | ") + cell;
  char head[16];
  std::snprintf(head, sizeof head, "%-9s", kind.c_str());
  std::cout << "[ " << head << "] " << line << std::endl;
}

}  // namespace repose::figures
