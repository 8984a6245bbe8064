// Repose: the progress line of long work: one line that is redrawn, on a terminal only.
#pragma once

#include <chrono>
#include <string>

namespace repose {

class Progress {
 public:
  /// `total` units of work; silent unless standard error is a terminal and `wanted`.
  Progress(std::string label, double total, bool wanted);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// Redraws at most ten times a second: bar, share done, time left, then `detail`.
  void update(double done, const std::string& detail);
  /// Draws the line full, with `detail`, and leaves it.
  void finish(const std::string& detail);
  /// Leaves the line as it is: what is printed next starts a line of its own.
  void leave();
  bool visible() const { return visible_; }

 private:
  using Clock = std::chrono::steady_clock;
  void draw(double done, const std::string& detail);

  std::string label_;
  double total_;
  bool visible_;
  double first_done_ = -1.0;
  Clock::time_point start_ = Clock::now();
  Clock::time_point drawn_{};
};

/// 75 -> "1:15", 3700 -> "1:01:40".
std::string clock_text(double seconds);

}  // namespace repose
