// Repose: from the state to the cloud that files hold: particles in the order of their ids, with what a scene
// asks for computed at that moment. The step knows nothing of it.
#pragma once

#include "engine/io/point_cloud.h"
#include "engine/scene/points_wanted.h"
#include "engine/scene/scene.h"
#include "engine/state/state.h"
#include "kernels/pass/pass.h"

namespace repose {

/// How many numbers of a point an attribute is; not of channels, which scenes decide.
int components_of(OutputAttribute attribute);

/// The cloud, sorted by id; ids may have gaps. With several materials the attribute "material" is the place of
/// a particle's law in the list of materials.
template <class Real>
PointCloud make_points(const Scene& scene, const State<Real>& state, const Kernels<Real>& kernels,
                       const PointsWanted& wanted = {});

}  // namespace repose
