// Repose: the energy of a particle, for all who report it.
#pragma once

#include "engine/base/vector.h"
#include "engine/state/particle_set.h"
#include "kernels/material/materials.h"

namespace repose {

struct ParticleEnergy {
  double kinetic = 0.0;  ///< of its velocity, J
  double affine = 0.0;   ///< of the matrix C that it keeps, J
  double elastic = 0.0;  ///< V0 times the density of the material's law, J
};

/// `affine_inertia` is D, the second moment of a stencil about its particle, m^2.
template <class Real>
ParticleEnergy particle_energy(const ParticleSet<Real>& set, std::size_t p, const MaterialParameters& law,
                               double affine_inertia) {
  Vec3 v;
  Mat3 c;
  for (int axis = 0; axis < 3; ++axis) v[axis] = set.velocity[axis][p];
  for (int k = 0; k < kAffineComponents; ++k) c(k / 3, k % 3) = set.keeps_affine ? set.affine[k][p] : Real(0);
  double eps[kStrainComponents];
  for (int k = 0; k < kStrainComponents; ++k) eps[k] = set.strain[k][p];
  const double density = std::visit([&eps](const auto& material) { return material.energy_density(eps); }, law);
  const double mass = set.particle_mass;
  return {0.5 * mass * v.squaredNorm(), 0.5 * mass * affine_inertia * c.squaredNorm(),
          set.particle_volume * density};
}

}  // namespace repose
