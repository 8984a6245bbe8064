// Repose tests: what the tests of implicit steps share: steps as multiples of the explicit limit, and runs of
// which energy and the solver's effort are kept step by step.
#pragma once

#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"

namespace repose {

/// Kinetic energy with the affine part that particles keep, elastic and potential energy, J.
double energy(const Diagnostics& figures);

/// What the limits of explicit steps allow of a scene while nothing moves, s.
double explicit_limit(const std::string& text, const std::vector<std::string>& overrides = {});

/// A scene in steps of so many explicit ones, as far as cells crossed and gradients allow it.
Scene in_long_steps(const std::string& text, double multiple, std::vector<std::string> overrides);

struct Ride {
  int steps = 0;
  int full = 0;                  ///< steps that neither speed, gradients nor halvings have made shorter
  int clean = 0;                 ///< steps solved to the tolerance at once
  double newton = 0.0;           ///< iterations per step
  double linear = 0.0;           ///< of the linear solver, per step
  double first = 0.0;            ///< energy, J
  double last = 0.0;             ///< energy, J
  double scale = 0.0;            ///< max(|first|, weight times height of what there is), J
  double rise = -1e300;          ///< the most that a step had above the first energy, over scale
  double largest_gain = -1e300;  ///< of one step, over scale
  bool refused = false;          ///< the physics gave out

  double full_share() const { return static_cast<double>(full) / steps; }
  double clean_share() const { return static_cast<double>(clean) / steps; }
};

/// Steps until `time` (s), at most `most_steps`.
Ride ride(Simulation& simulation, double time, int most_steps);

/// For controls: how much energy explicit steps of `dt` seconds add to a scene whatever their limits say, over
/// the scale of a ride; infinity where the physics gives out. In single precision.
double explicit_rise(const std::string& text, std::vector<std::string> overrides, double dt, int steps);

/// Prints a ride's figures.
void report(const std::string& name, const Ride& ride);

}  // namespace repose
