// Repose: figures of a state: energies, momenta, ledger, and how deep the deepest particle is in a solid. Sums
// run per block in double and then over blocks in their order, so they do not depend on threads.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/effect/solid.h"
#include "engine/scene/scene.h"
#include "engine/state/block_extent.h"
#include "engine/state/state.h"

namespace repose {

struct Diagnostics {
  std::uint64_t particles = 0;
  double mass = 0.0;               ///< kg
  double volume = 0.0;             ///< sum of V0 exp(tr eps): the volume as the elastic strain leaves it, m^3
  double kinetic_energy = 0.0;     ///< of particle velocities, J
  double affine_energy = 0.0;      ///< of the matrices C that particles keep, J
  double elastic_energy = 0.0;     ///< J
  double potential_energy = 0.0;   ///< -m g . x with the scene's full gravity, J
  Vec3 momentum{0, 0, 0};          ///< kg m/s
  Vec3 angular_momentum{0, 0, 0};  ///< about the scene's origin, with the affine part, kg m^2/s
  Vec3 center_of_mass{0, 0, 0};    ///< m
  Vec3 lower{0, 0, 0}, upper{0, 0, 0};  ///< bounds of the particles, m; zero if there are none
  double max_speed = 0.0;               ///< m/s
  double deepest = 0.0;                 ///< largest depth of a particle inside a solid, m; 0 if none is inside
  std::string deepest_solid;            ///< which solid
  std::uint32_t deepest_id = 0;         ///< which particle
};

/// What has begun and what has ended so far. In particles: initial + emitted - removed = held, exactly.
struct LedgerReport {
  struct Entry {
    std::string name;
    std::uint64_t particles = 0;
    double mass = 0.0;  ///< kg
  };
  std::uint64_t initial = 0;
  Entry emitted, removed, held;
  std::vector<Entry> emitters, sinks;  ///< by name
};

/// Whether particles of a block may be within one of the solids, which stand still.
template <class Real>
bool any_near(const std::vector<Solid>& solids, const State<Real>& state, const Index3& block) {
  const Vec3 middle = state.world(block, kMiddleOfParticles);
  return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.distance(middle) < radius_of_particles() * state.spacing;
  });
}

template <class Real>
Diagnostics diagnose(const Scene& scene, const std::vector<Solid>& solids, const State<Real>& state,
                     Threads& threads);

template <class Real>
LedgerReport ledger_report(const Scene& scene, const State<Real>& state);

}  // namespace repose
