// Repose: what a plan knows of energy that may come into matter, for the watch that warns when there is more
// (engine/step/energy_watch.h). Gravity is a potential; solids that move tell what they do (contact_log.h); of
// all else bounds are enough, for what a step that is too long makes grows beyond every bound.
#pragma once

#include <cmath>
#include <functional>
#include <vector>

#include "engine/base/vector.h"
#include "kernels/material/materials.h"

namespace repose {

/// Matter as a whole.
struct MatterInMotion {
  double mass = 0.0;      ///< kg
  double kinetic = 0.0;   ///< J
  double momentum = 0.0;  ///< N s, its size
  double time = 0.0;      ///< s

  /// No less than the sum of the sizes of all momenta, N s.
  double momenta() const { return std::sqrt(2.0 * mass * kinetic); }
};

struct EnergyAlarm {
  bool stops = false;                      ///< else it warns
  double share = 0.0;                      ///< of the energy at hand: by how much it may seem to grow
  int steps = 0;                           ///< between two looks
  std::vector<MaterialParameters> laws{};  ///< per set
  Vec3 gravity{0, 0, 0};                   ///< m/s^2, along axes that do not repeat: a potential
  double affine_inertia = 0.0;             ///< D, m^2

  /// The most power with which a force drives matter, W.
  using Power = std::function<double(const MatterInMotion&)>;
  std::vector<Power> powers{};
  /// m/s, with which matter is drawn by what tells no work: of kinetic energy that much is let pass.
  double drawn = 0.0;
  bool beyond_account = false;  ///< something works for which there is no bound
};

}  // namespace repose
