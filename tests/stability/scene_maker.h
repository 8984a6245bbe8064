// Repose tests: random scenes, from a seed alone: most are valid, some are off by a value, a key or a name.
#pragma once

#include <cstdint>
#include <string>

namespace repose::stability {

/// How large the scenes are.
struct SceneSize {
  int most_cells = 12;  ///< along the longest side of what is filled
  int frames = 4;
  int steps_a_frame = 40;  ///< about so many explicit ones
};

struct MadeScene {
  std::string text;  ///< JSON
  bool spoilt;       ///< something in it may be wrong
};

/// Scene `number` of those of a seed; the same for ever.
MadeScene make_scene(std::uint64_t seed, std::uint64_t number, const SceneSize& size);

}  // namespace repose::stability
