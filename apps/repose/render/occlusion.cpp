// Repose: ambient occlusion after McGuire et al. 2011 (the Alchemy screen-space obscurance): each probe that
// lies above the surface's horizon and within range hides a part of the sky.
#include "apps/repose/render/occlusion.h"

#include <algorithm>
#include <cmath>

namespace repose {
namespace {

struct Surface {
  const Visibility& visible;
  const View& view;
  int x;
  int y;
  Eigen::Vector3f position;  // view coordinates
  Eigen::Vector3f normal;
};

// Mean over N probes of the hidden share.
template <int N>
float hidden(const Surface& s, float range, const Turn& turn) {
  // Never so wide that the probes miss what is near, nor so narrow that they all fall on one sample.
  const float widest = 0.12f * static_cast<float>(s.view.height);
  const float radius = std::clamp(s.view.focal * range / s.position[2], 2.5f, widest);
  const float reach = radius * s.position[2] / s.view.focal;
  float sum = 0.0f;
  for (const Eigen::Vector2f& probe : vogel_disc<N>()) {
    const Eigen::Vector2f offset = radius * turned(turn, probe);
    // The cast rounds toward zero: a probe may fall half a sample short, but never on the sample itself by a
    // sign.
    const int x = std::clamp(s.x + static_cast<int>(offset[0]), 0, s.visible.width - 1);
    const int y = std::clamp(s.y + static_cast<int>(offset[1]), 0, s.visible.height - 1);
    const float depth = s.visible.depth[s.visible.at(x, y)];
    if (!(depth < s.position[2] + 2.0f * reach)) continue;
    const Eigen::Vector3f away = depth * s.view.ray(x, y) - s.position;
    const float distance2 = away.squaredNorm();
    if (distance2 <= 0.0f) continue;
    // A slow fall, not a cut at the range: grains deep in a gap are darkened by those far above them, too.
    const float fall = 1.0f / (1.0f + distance2 / (reach * reach));
    sum += fall * std::max(0.0f, away.dot(s.normal) / std::sqrt(distance2) - 0.1f);
  }
  return sum / N;
}

}  // namespace

float open_sky(const Visibility& visible, const View& view, const OcclusionRanges& ranges, int x, int y,
               const Eigen::Vector3f& normal, const Turn& turn) {
  const Surface surface{visible, view, x, y, visible.depth[visible.at(x, y)] * view.ray(x, y), normal};
  const float crevice = hidden<6>(surface, ranges.crevice, turn);
  const float hollow = hidden<8>(surface, ranges.hollow, turn);
  return std::max(0.0f, 1.0f - 2.6f * crevice) * std::max(0.0f, 1.0f - 2.4f * hollow);
}

}  // namespace repose
