// Repose: what a scene will take, told before anything of it is built.
#pragma once

#include <string>
#include <vector>

#include "engine/scene/scene.h"

namespace repose {

/// An effect that scenes can call for, and whether this one does.
struct EffectStatus {
  std::string name;
  bool on = false;
  std::string reason;  ///< the key that asked for it, or what would
  std::size_t bytes_per_particle = 0;
  double nanoseconds = 0.0;  ///< per particle and step, about (engine/base/costs.h); 0 where it is off
};
std::vector<EffectStatus> effect_status(const Scene& scene);

/// Channels of laws and of effects, of the set that has most of each.
std::size_t channels_per_particle(const Scene& scene);

/// ns per particle and step, about: an explicit step with the scene's effects, and the effects alone.
double step_cost(const Scene& scene);
double effects_cost(const Scene& scene);

/// When the scene's last frame ends, s.
double last_frame_time(const Scene& scene);
/// How many particles inlets will have made by a time (s).
double emitted_by(const Scene& scene, double time);

/// Cells along the edge of a cube, in plane strain of a square, of all matter: `volume` (m^3) at the start, and
/// what inlets make in all frames.
double cells_along_an_edge(const Scene& scene, double volume);
/// What a grid errs by in the outline of a heap with so many cells along an edge, as a share, at most about
/// (engine/base/accuracy.h); 0 where nothing can be heaped up, since no material has a cone.
double outline_error(const Scene& scene, double cells);

/// Numbers per particle that an implicit solve keeps: a tangent, gradients, trial states, linear models.
inline constexpr std::size_t kSolverNumbers = 75 + kMostLawChannels;

/// Bytes per particle of all channels and of what ordering keeps beside them.
std::size_t bytes_per_particle(const Scene& scene);

}  // namespace repose
