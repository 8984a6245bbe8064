// Repose: what pictures of a run show: its points as grains, its solids as meshes.
#pragma once

#include <vector>

#include "apps/repose/render/grains.h"
#include "engine/effect/solid.h"
#include "engine/io/point_cloud.h"
#include "engine/scene/scene.h"

namespace repose {

std::vector<Grain> grains_of(const PointCloud& points);

/// Solids as meshes. `extent` is how far an endless plane is drawn, m.
std::vector<SolidMesh> draw_solids(const Scene& scene, const std::vector<Solid>& solids, double extent);

}  // namespace repose
