// Repose tests: laws that motion and stress must follow. A row has a law, where it is from, a figure with its
// band, and a control: the same figure where something was changed so that the law must not hold, which has to
// lie outside of the band. A band whose control lies within tells nothing. `bash tests/run.sh --validation`
// gathers the rows into the table of docs/validation.md.
#pragma once

#include <string>

#include "tests/figures.h"

namespace repose {

class Validation {
 public:
  /// `law` in a few words, with its formula; `source`: paper, and equation or section.
  Validation(std::string law, std::string source);
  Validation(const Validation&) = delete;
  Validation& operator=(const Validation&) = delete;
  /// Fails the test if a figure was left without a control.
  ~Validation();

  /// A figure of the law; `unit` stands behind the numbers. Its control comes next.
  void within(const std::string& what, double measured, double low, double high, const std::string& unit = "");
  void at_most(const std::string& what, double measured, double high, const std::string& unit = "");
  /// What is known to miss its band.
  void within(const std::string& what, double measured, double low, double high, const std::string& unit,
              const figures::Missed& missed);

  /// The last figure again, after `changed`. Prints the row.
  void control(const std::string& changed, double measured);

 private:
  void figure(const std::string& what, double measured, const figures::Band& asked, const std::string& unit,
              const figures::Missed* missed = nullptr);

  std::string law_, source_;
  std::string what_;  ///< empty where no figure waits for its control
  std::string unit_;
  double measured_ = 0.0;
  figures::Band asked_;
  figures::Verdict verdict_ = figures::Verdict::kFails;
};

}  // namespace repose
