// Repose: what a simulation tells of itself, and what passes between it and its host: plain types alone.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "engine/base/profile.h"
#include "engine/base/triple.h"
#include "engine/plan/report.h"

namespace repose {

/// What a frame took.
struct FrameReport {
  std::int64_t frame = 0;  ///< the frame that is now complete
  double time = 0.0;       ///< s
  bool resumed = false;    ///< it was begun before: what it took until then is in none of the figures below
  std::int64_t steps = 0;
  double least_dt = 0.0, largest_dt = 0.0;                    ///< s
  std::array<std::int64_t, kLimits> limits{};                 ///< steps bound by each Limit
  std::int64_t redone = 0;                                    ///< halvings
  std::string first_refusal;                                  ///< why the first of them; empty without any
  std::int64_t newton_iterations = 0, linear_iterations = 0;  ///< of implicit steps that were made
  double seconds = 0.0;                                       ///< wall time
  Profile profile;                                            ///< wall time per phase
};

/// A pass of the step.
struct PassReport {
  std::string phase;  ///< when it runs, and of which set
  std::string name;
  std::string reason;                      ///< which scene key asked for it; empty for the core
  std::string effect;                      ///< that added it; empty for the core
  std::vector<std::string> reads, writes;  ///< names of handles
};

/// Figures of a state: energies, momenta, and how deep the deepest particle is in a solid.
struct Diagnostics {
  std::uint64_t particles = 0;
  double mass = 0.0;              ///< kg
  double volume = 0.0;            ///< sum of V0 exp(tr eps): the volume as the elastic strain leaves it, m^3
  double kinetic_energy = 0.0;    ///< of particle velocities, J
  double affine_energy = 0.0;     ///< of the matrices C that particles keep, J
  double elastic_energy = 0.0;    ///< J
  double potential_energy = 0.0;  ///< -m g . x with the scene's full gravity, J
  Triple momentum{};              ///< kg m/s
  Triple angular_momentum{};      ///< about the scene's origin, with the affine part, kg m^2/s
  Triple center_of_mass{};        ///< m
  Triple lower{}, upper{};        ///< bounds of the particles, m; zero if there are none
  double max_speed = 0.0;         ///< m/s
  double deepest = 0.0;           ///< largest depth of a particle inside a solid, m; 0 if none is inside
  std::string deepest_solid;      ///< which solid
  std::uint32_t deepest_id = 0;   ///< which particle
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

/// Numbers of the particles of one set, as they lie in memory.
struct ChannelView {
  enum class Type { kFloat, kDouble, kUint32 };
  std::string name;  ///< "position.x" (cells from the corner of the particle's block), "velocity.x", "id", ...
  Type type = Type::kFloat;
  const void* data = nullptr;  ///< of as many numbers as the set has particles
};

/// A set of particles: those of one body or emitter.
struct SetView {
  std::string name, material;
  double particle_mass = 0.0;    ///< kg
  double particle_volume = 0.0;  ///< m^3, at rest
  std::size_t count = 0;
  std::vector<ChannelView> channels;
  /// Particles of block b are [begin[b], begin[b + 1]), for `blocks` blocks.
  const std::uint32_t* begin = nullptr;
  std::size_t blocks = 0;
};

/// x -> rotation x + translation, of the places where a shape was put by its scene.
struct Pose {
  std::array<Triple, 3> rotation{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< rows
  Triple translation{};                                               ///< m
};

/// Numbers of the scene's "channels" for some particles: as many of each as the channel has components.
struct ChannelValues {
  std::string channel;
  std::span<const float> values;
};

/// A velocity of every point x of a surface: velocity + spin x (x - center).
struct SurfaceVelocity {
  Triple velocity{};  ///< m/s
  Triple spin{};      ///< rad/s
  Triple center{};    ///< m
};

/// Of the material on a collider, mean over a time.
struct ContactFigures {
  double seconds = 0.0;  ///< that it is the mean of; 0: no step was made
  Triple force{};        ///< N
  Triple moment{};       ///< about the scene's origin, N m
  double power = 0.0;    ///< that the collider gives to the material, W
};

}  // namespace repose
