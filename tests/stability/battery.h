// Repose tests: the battery of hard cases. Each case has a number, a name, and figures: what is asked of it and
// what was measured. A figure that does not hold fails the test. `bash tests/run.sh --stability` gathers the
// lines that they print into one table.
#pragma once

#include <string>

#include "tests/figures.h"

namespace repose::battery {

using figures::Missed;

class Case {
 public:
  /// `number` is that of the list in docs/stability.md, `name` a few words.
  Case(int number, std::string name);

  /// Figures. `what` tells several of one case apart; `unit` stands behind both numbers. Not a number holds
  /// nowhere.
  void at_most(const std::string& what, double measured, double asked, const std::string& unit = "");
  void at_most(const std::string& what, double measured, double asked, const std::string& unit,
               const Missed& missed);
  void at_least(const std::string& what, double measured, double asked, const std::string& unit = "");
  void at_least(const std::string& what, double measured, double asked, const std::string& unit,
                const Missed& missed);
  void within(const std::string& what, double measured, double low, double high, const std::string& unit = "");
  /// What has no number: "refused with the line", say.
  void holds(const std::string& what, bool does);

 private:
  /// `margin`: how many times the asked the measured could still grow, or shrink.
  void line(const std::string& what, const std::string& measured, const std::string& asked, double margin,
            figures::Verdict verdict) const;
  void figure(const std::string& what, double measured, const figures::Band& asked, double margin,
              const std::string& unit, const Missed* missed = nullptr) const;

  int number_;
  std::string name_;
};

}  // namespace repose::battery
