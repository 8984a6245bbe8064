// Repose: how the steps of a scene are made.
#pragma once

#include <string>

namespace repose {

struct IntegratorChoice {
  bool implicit = false;
  std::string reason;        ///< in words, with the figures where they were weighed
  double step = 0.0;         ///< s, of a step, about; 0 where nothing was weighed
  double nanoseconds = 0.0;  ///< per particle and step, about; 0 where nothing was weighed
};

}  // namespace repose
