#include "tests/physics/validation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

namespace repose {
namespace {

/// One more than the battery's: 1 % of a law is told.
constexpr int kDigits = 4;

}  // namespace

Validation::Validation(std::string law, std::string source)
    : law_(std::move(law)), source_(std::move(source)) {}

Validation::~Validation() {
  if (!what_.empty()) ADD_FAILURE() << law_ << ", " << what_ << ": has no control";
}

void Validation::figure(const std::string& what, double measured, const figures::Band& asked,
                        const std::string& unit, const figures::Missed* missed) {
  if (!what_.empty()) ADD_FAILURE() << law_ << ", " << what_ << ": has no control";
  what_ = what;
  unit_ = unit;
  measured_ = measured;
  asked_ = asked;
  verdict_ = figures::judge(law_ + ", " + what, measured, asked, unit, missed);
}

void Validation::within(const std::string& what, double measured, double low, double high,
                        const std::string& unit) {
  figure(what, measured, {low, high}, unit);
}
void Validation::within(const std::string& what, double measured, double low, double high,
                        const std::string& unit, const figures::Missed& missed) {
  figure(what, measured, {low, high}, unit, &missed);
}
void Validation::at_most(const std::string& what, double measured, double high, const std::string& unit) {
  figure(what, measured, figures::Band::up_to(high), unit);
}

void Validation::control(const std::string& changed, double measured) {
  const bool told = !std::isnan(measured) && !asked_.holds(measured);
  EXPECT_TRUE(told) << law_ << ", " << what_ << ": the control, " << changed << ", has "
                    << figures::text(measured, unit_) << ", within " << asked_.text(unit_);
  figures::print("law",
                 {law_, source_, what_, asked_.text(unit_, kDigits), figures::text(measured_, unit_, kDigits),
                  changed, figures::text(measured, unit_, kDigits),
                  figures::word(told ? verdict_ : figures::Verdict::kFails, "within")});
  what_.clear();
}

}  // namespace repose
