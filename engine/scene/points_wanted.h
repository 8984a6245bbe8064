// Repose: what points may carry beside position, velocity, id and radius; computed from the state when it is
// written.
#pragma once

#include <vector>

namespace repose {

enum class OutputAttribute { kStress, kPressure, kElasticStrain, kDensity, kSpeed, kChannels, kAge };

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

}  // namespace repose
