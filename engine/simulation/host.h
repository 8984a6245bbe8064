// Repose: what passes between a simulation and its host, beside reports: plain types alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/triple.h"

namespace repose {

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

/// Of the material on a collider, mean over a time.
struct ContactFigures {
  double seconds = 0.0;  ///< that it is the mean of; 0: no step was made
  Triple force{};        ///< N
  Triple moment{};       ///< about the scene's origin, N m
  double power = 0.0;    ///< that the collider gives to the material, W
};

}  // namespace repose
