// Repose: what a scene value means. Materials (kernels) and effects (engine) declare their fields
// with it; the scene reader, the JSON Schema and the parameter reference all read the same declaration.
#pragma once

#include <limits>

namespace repose {

/// Unit, meaning and admissible range of one scene value. Bounds are closed unless marked open.
struct Quantity {
  const char* unit = "";
  const char* meaning = "";
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = false;
  bool high_open = false;
  bool required = false;
};

/// One value of an enumerated key.
struct Choice {
  const char* name;
  const char* meaning;
};

}  // namespace repose
