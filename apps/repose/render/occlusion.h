// Repose: how much of the sky the surroundings of a sample hide, from the depths of the picture alone. Two
// ranges: the crevices between grains, and the hollows of the pile.
#pragma once

#include <Eigen/Core>

#include "apps/repose/render/probes.h"
#include "apps/repose/render/visibility.h"

namespace repose {

struct OcclusionRanges {
  float crevice = 0;  ///< metres
  float hollow = 0;   ///< metres
};

/// Share of the sky that is open, 0 to 1, at sample (x, y), which sees a surface of unit normal `normal` (view
/// coordinates). `turn` rotates the pattern of probes.
float open_sky(const Visibility& visible, const View& view, const OcclusionRanges& ranges, int x, int y,
               const Eigen::Vector3f& normal, const Turn& turn);

}  // namespace repose
