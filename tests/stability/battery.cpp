#include "tests/stability/battery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <limits>
#include <utility>

namespace repose::battery {
namespace {

std::string text(double value, const std::string& unit) {
  char number[32];
  std::snprintf(number, sizeof number, "%.3g", value);
  return unit.empty() ? number : number + (" " + unit);
}

constexpr double kNoMargin = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Case::Case(int number, std::string name) : number_(number), name_(std::move(name)) {}

void Case::line(const std::string& what, const std::string& measured, const std::string& asked, double margin,
                const char* verdict) const {
  char head[16], times[16] = "";
  std::snprintf(head, sizeof head, "%02d", number_);
  if (std::isfinite(margin)) std::snprintf(times, sizeof times, "%.3g", margin);
  std::cout << "[ case     ] " << head << " | " << name_ << " | " << what << " | " << asked << " | " << measured
            << " | " << times << " | " << verdict << std::endl;
}

void Case::bound(const std::string& what, double measured, double asked, bool above, const std::string& unit,
                 const Missed* missed) {
  const auto keeps = [&](double limit) { return above ? measured <= limit : measured >= limit; };
  const bool holds = keeps(asked);
  const double margin = above ? asked / measured : measured / asked;
  const std::string bar = (above ? "<= " : ">= ") + text(asked, unit);
  line(what, text(measured, unit), bar, margin, holds ? "holds" : missed ? "missed" : "FAILS");
  if (missed == nullptr) {
    EXPECT_TRUE(holds) << "case " << number_ << ", " << what << ": " << text(measured, unit) << ", asked "
                       << bar;
    return;
  }
  EXPECT_FALSE(holds) << "case " << number_ << ", " << what << " holds now: strike out that it is missed";
  EXPECT_TRUE(keeps(missed->worst)) << "case " << number_ << ", " << what << ": " << text(measured, unit)
                                    << ", worse than the known " << text(missed->worst, unit) << " ("
                                    << missed->why << ")";
}

void Case::at_most(const std::string& what, double measured, double asked, const std::string& unit) {
  bound(what, measured, asked, true, unit, nullptr);
}
void Case::at_most(const std::string& what, double measured, double asked, const std::string& unit,
                   const Missed& missed) {
  bound(what, measured, asked, true, unit, &missed);
}
void Case::at_least(const std::string& what, double measured, double asked, const std::string& unit) {
  bound(what, measured, asked, false, unit, nullptr);
}
void Case::at_least(const std::string& what, double measured, double asked, const std::string& unit,
                    const Missed& missed) {
  bound(what, measured, asked, false, unit, &missed);
}

void Case::within(const std::string& what, double measured, double low, double high, const std::string& unit) {
  const bool holds = low <= measured && measured <= high;
  const double middle = 0.5 * (low + high);
  line(what, text(measured, unit), text(low, "") + " to " + text(high, unit),
       0.5 * (high - low) / std::abs(measured - middle), holds ? "holds" : "FAILS");
  EXPECT_TRUE(holds) << "case " << number_ << ", " << what << ": " << text(measured, unit) << ", asked "
                     << text(low, "") << " to " << text(high, unit);
}

void Case::holds(const std::string& what, bool does) {
  line(what, does ? "yes" : "no", "yes", kNoMargin, does ? "holds" : "FAILS");
  EXPECT_TRUE(does) << "case " << number_ << ", " << what;
}

}  // namespace repose::battery
