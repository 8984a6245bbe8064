// Repose: glass over a finished picture: each surface lets most light through, takes some where it is seen edge
// on, and mirrors the surroundings. Surfaces hardly depend on their order, so they are not sorted; refraction
// is left out, since sand behind glass must stay readable.
#pragma once

#include <span>
#include <vector>

#include "apps/repose/render/local_scene.h"
#include "apps/repose/render/tiles.h"
#include "apps/repose/render/visibility.h"

namespace repose {

/// What glass makes of the light behind it: seen = through * behind + mirrored.
struct GlassSample {
  Color through{1, 1, 1};
  Color mirrored{0, 0, 0};
};

class Glass {
 public:
  /// Keeps references to all but `up`, the world's unit up.
  Glass(const LocalScene& scene, std::span<const SolidMesh> solids, const View& view, const Light& light,
        const Eigen::Vector3f& up);

  const TileBins& tiles() const { return bins_; }

  /// The samples of one tile, row by row: all glass before what `visible` sees. Empty where the tile has no
  /// glass.
  std::vector<GlassSample> draw(int tile, const Visibility& visible) const;

 private:
  GlassSample surface(const Triangle& triangle, const Eigen::Vector3f& ray,
                      const Eigen::Vector3f& weights) const;

  const LocalScene& scene_;
  std::span<const SolidMesh> solids_;
  const View& view_;
  const Light& light_;
  Eigen::Vector3f up_;
  std::vector<SeenTriangle> seen_;
  TileBins bins_;
};

}  // namespace repose
