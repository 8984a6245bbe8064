// Repose: when frames are. With a time scale (slow motion) a frame spans less of the scene's time than of the
// film's; the scale is linear between its keys, and its integral is taken exactly, so frames are functions of
// their number alone.
#pragma once

#include <cstdint>
#include <vector>

namespace repose {

class Clock {
 public:
  /// `scale`: rows (time of the film in s, scale), ascending; constant before the first and after the last;
  /// empty: 1.
  Clock(double frames_per_second, std::vector<std::vector<double>> scale)
      : frames_per_second_(frames_per_second), scale_(std::move(scale)) {}

  /// Time of the scene, in s, at the end of a frame; 0 at frame 0.
  double at(std::int64_t frame) const;
  double length(std::int64_t frame) const {
    return scale_.empty() ? 1.0 / frames_per_second_ : at(frame + 1) - at(frame);
  }

 private:
  double frames_per_second_;
  std::vector<std::vector<double>> scale_;
};

}  // namespace repose
