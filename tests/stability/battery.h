// Repose tests: the battery of hard cases. Each case has a number, a name, and figures: what is asked of it and
// what was measured. A figure that does not hold fails the test. `bash tests/run.sh --stability` gathers the
// lines that they print into one table.
#pragma once

#include <string>

namespace repose::battery {

/// A bar that the engine is known to miss: the figure is shown as missed, and fails only where it is worse than
/// it was when it was written down, or holds: then the miss is to be struck out.
struct Missed {
  double worst;     ///< what is measured must not be worse
  const char* why;  ///< and where it says which remedies were tried
};

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
            const char* verdict) const;
  void bound(const std::string& what, double measured, double asked, bool above, const std::string& unit,
             const Missed* missed);

  int number_;
  std::string name_;
};

}  // namespace repose::battery
