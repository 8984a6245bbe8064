// Repose: the floating-point environment in which all arithmetic is done, whatever a host has set.
#pragma once

#include <cfenv>

namespace repose {

/// Sets the default floating-point environment and puts the caller's back.
class CleanFloatingPoint {
 public:
  CleanFloatingPoint() {
    std::fegetenv(&saved_);
    std::fesetenv(FE_DFL_ENV);
  }
  ~CleanFloatingPoint() { std::fesetenv(&saved_); }
  CleanFloatingPoint(const CleanFloatingPoint&) = delete;
  CleanFloatingPoint& operator=(const CleanFloatingPoint&) = delete;

 private:
  std::fenv_t saved_;
};

}  // namespace repose
