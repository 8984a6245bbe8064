// Repose: figures of a state: energies, momenta, ledger, and how deep the deepest particle is in a solid. Sums
// run per block in double and then over blocks in their order, so they do not depend on threads.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/effect/solid.h"
#include "engine/scene/scene.h"
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

struct MemoryUse {
  std::size_t particle_bytes = 0;  ///< channels
  std::size_t order_bytes = 0;     ///< ordering, and the stepper's numbers per block
  std::size_t scratch_bytes = 0;   ///< of the threads, whatever the scene
  std::size_t grid_bytes = 0;      ///< tree, tables and node fields
  std::size_t blocks = 0;
  std::uint64_t active_nodes = 0;
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

/// How far a particle of a block can be from the block's middle, m.
inline double block_radius(double spacing) {
  return 0.5 * std::sqrt(3.0) * kArenaSide * spacing;
}

template <class Real>
Diagnostics diagnose(const Scene& scene, const std::vector<Solid>& solids, const State<Real>& state,
                     Threads& threads);

template <class Real>
LedgerReport ledger_report(const Scene& scene, const State<Real>& state);

}  // namespace repose
