#include "tests/stability/battery.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

namespace repose::battery {
namespace {

using figures::Band;
using figures::Verdict;

constexpr double kNoMargin = std::numeric_limits<double>::quiet_NaN();

}  // namespace

Case::Case(int number, std::string name) : number_(number), name_(std::move(name)) {}

void Case::line(const std::string& what, const std::string& measured, const std::string& asked, double margin,
                Verdict verdict) const {
  char head[16], times[16] = "";
  std::snprintf(head, sizeof head, "%02d", number_);
  if (std::isfinite(margin)) std::snprintf(times, sizeof times, "%.3g", margin);
  figures::print("case", {head, name_, what, asked, measured, times, word(verdict, "holds")});
}

void Case::figure(const std::string& what, double measured, const Band& asked, double margin,
                  const std::string& unit, const Missed* missed) const {
  const Verdict verdict =
      figures::judge("case " + std::to_string(number_) + ", " + what, measured, asked, unit, missed);
  line(what, figures::text(measured, unit), asked.text(unit), margin, verdict);
}

void Case::at_most(const std::string& what, double measured, double asked, const std::string& unit) {
  figure(what, measured, Band::up_to(asked), asked / measured, unit);
}
void Case::at_most(const std::string& what, double measured, double asked, const std::string& unit,
                   const Missed& missed) {
  figure(what, measured, Band::up_to(asked), asked / measured, unit, &missed);
}
void Case::at_least(const std::string& what, double measured, double asked, const std::string& unit) {
  figure(what, measured, Band::from(asked), measured / asked, unit);
}
void Case::at_least(const std::string& what, double measured, double asked, const std::string& unit,
                    const Missed& missed) {
  figure(what, measured, Band::from(asked), measured / asked, unit, &missed);
}

void Case::within(const std::string& what, double measured, double low, double high, const std::string& unit) {
  figure(what, measured, {low, high}, 0.5 * (high - low) / std::abs(measured - 0.5 * (low + high)), unit);
}

void Case::holds(const std::string& what, bool does) {
  line(what, does ? "yes" : "no", "yes", kNoMargin, does ? Verdict::kHolds : Verdict::kFails);
  EXPECT_TRUE(does) << "case " << number_ << ", " << what;
}

}  // namespace repose::battery
