#include "engine/plan/clock.h"

#include <algorithm>

namespace repose {

double Clock::at(std::int64_t frame) const {
  const double film = static_cast<double>(frame) / frames_per_second_;
  if (scale_.empty()) return film;
  double sum = std::min(film, scale_.front()[0]) * scale_.front()[1];
  for (std::size_t k = 0; k + 1 < scale_.size(); ++k) {
    const double begin = scale_[k][0], end = scale_[k + 1][0];
    if (film <= begin) break;
    const double share = std::min(1.0, (film - begin) / (end - begin));
    const double reached = scale_[k][1] + share * (scale_[k + 1][1] - scale_[k][1]);
    sum += 0.5 * (scale_[k][1] + reached) * share * (end - begin);
  }
  return sum + std::max(0.0, film - scale_.back()[0]) * scale_.back()[1];
}

}  // namespace repose
