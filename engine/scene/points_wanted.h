// Repose: what points may carry beside position, velocity, id and radius; computed from the state when it is
// written.
#pragma once

#include <string>
#include <vector>

namespace repose {

enum class OutputAttribute {
  kStress,
  kPressure,
  kElasticStrain,
  kDensity,
  kSpeed,
  kChannels,
  kAge,
  kShearRate,
  kInertialNumber,
  kPlasticStrain,
  kVelocityGradient
};

/// What a cloud holds beside positions, velocities, ids and radii.
struct PointsWanted {
  /// In the order of the cloud's attributes. Tensors have 6 components, xx yy zz xy yz xz.
  ///  stress          sigma = tau / J, tau of the material's law, J = exp(tr eps), Pa; tension is positive
  ///  pressure        -tr sigma / 3, Pa
  ///  elastic_strain  eps = log(b) / 2
  ///  density         rho exp(-tr eps - v_c), kg/m^3: what flow at constant volume and the return to the tip
  ///                  have done to the volume is in v_c alone (volume_correction), so that without it sand
  ///                  that has come apart shows the density at which it last held together
  ///  speed           |v|, m/s
  ///  age             time of the state less that at which the particle began, s; not a number where the
  ///                  scene has no key "age"
  ///  velocity_gradient
  ///                  L_ij = d v_i / d x_j by rows, xx xy xz yx yy yz zx zy zz, 1/s: the affine matrix C that
  ///                  particles keep; not a number where the transfer keeps none
  ///  shear_rate      sqrt(2 D' : D'), D' = dev sym L, 1/s, which in simple shear is the slope of velocity
  ///                  (Jop et al. 2006 write it sqrt(1/2 g : g), g = 2 D); as velocity_gradient
  ///  inertial_number
  ///                  I = shear_rate d / sqrt(p / rho_s), d and rho_s of the material's grains (grains_of); 0
  ///                  where nothing shears, else infinite where p <= 0; not a number where a material has no
  ///                  grains
  ///  plastic_strain  sum over steps of sqrt(2/3) |dev(trial - returned)|; 0 for what does not yield; not a
  ///                  number for sand where the scene has no key "plastic_strain"
  ///  channels        each number that an effect keeps, under its own name, and what hosts keep; 0 where a
  ///                  set has none
  std::vector<OutputAttribute> attributes;
  bool mass = false;                    ///< PointCloud::mass
  std::vector<std::string> channels{};  ///< some of the channels, by name, in the order of the sets
};

}  // namespace repose
