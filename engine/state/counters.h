// Repose: where a simulation has got to.
#pragma once

#include <cstdint>

namespace repose {

/// Scalars that the next step reads; saved with the state.
struct Counters {
  std::int64_t frame = 0;  ///< frames completed
  std::int64_t step = 0;   ///< steps completed
  double time_in_frame =
      0.0;                 ///< s since the last frame; time itself is frame / fps + this, so frames are exact
  double time = 0.0;       ///< s
  double last_dt = 0.0;    ///< s
  double max_speed = 0.0;  ///< m/s, largest particle speed after the last step
  double max_gradient = 0.0;  ///< 1/s, largest |grad v| of the last step
  std::int32_t sort_due = 1;  ///< a particle has drifted as far as its block allows
  std::int64_t segments_when_sorted =
      -1;                            ///< segments in the first step after the last sort; -1: not yet counted
  std::int64_t segments_wasted = 0;  ///< sum over the steps since of the segments beyond that
  std::int64_t sorts = 0;
  double unseen_motion = 0.0;  ///< m, way of the fastest particle since sinks last looked; 0 without sinks
};

}  // namespace repose
