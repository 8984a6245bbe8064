// Repose: from the state to the cloud that files hold: particles in the order of their ids, with what a scene
// asks for computed at that moment. The step knows nothing of it.
#pragma once

#include <vector>

#include "engine/io/point_cloud.h"
#include "engine/scene/scene.h"
#include "engine/state/state.h"
#include "kernels/pass/pass.h"

namespace repose {

/// What a cloud holds beside positions, velocities, ids and radii.
struct PointsWanted {
  /// In the order of the cloud's attributes. Tensors have 6 components, xx yy zz xy yz xz.
  ///  stress          sigma = tau / J, tau of the material's law, J = exp(tr eps), Pa; tension is positive
  ///  pressure        -tr sigma / 3, Pa
  ///  elastic_strain  eps = log(b) / 2
  ///  density         rho exp(-tr eps - v_c), kg/m^3: what flow at constant volume and the return to the tip
  ///  have
  ///                  done to the volume is in v_c alone (volume_correction), so that without it sand that has
  ///                  come apart shows the density at which it last held together
  ///  speed           |v|, m/s
  ///  age             time of the state less that at which the particle began, s; not a number where the scene
  ///  has
  ///                  no key "age"
  ///  channels        each number that an effect keeps, under its own name; 0 where a set keeps none
  std::vector<OutputAttribute> attributes;
  bool mass = false;  ///< PointCloud::mass
};

/// How many numbers of a point an attribute is; not of channels, which scenes decide.
int components_of(OutputAttribute attribute);

/// The cloud, sorted by id; ids may have gaps. With several materials the attribute "material" is the place of
/// a particle's law in the list of materials.
template <class Real>
PointCloud make_points(const Scene& scene, const State<Real>& state, const Kernels<Real>& kernels,
                       const PointsWanted& wanted = {});

}  // namespace repose
