// Repose tests: whether a run has more energy than it began with and was given.
//
// What there is: kinetic, affine, elastic and potential energy, by a probe. What is given: the work of solids,
// by the same probe, and what particles bring that begin or take that end, kinetic and potential. Newcomers are
// seen a step after they began, so they count as if none had lost any speed since; of those that end, affine
// and elastic energy are not taken off. Both allow a little too much, never too little.
#pragma once

#include <map>
#include <string>

#include "engine/scene/scene.h"
#include "engine/simulation/simulation.h"

namespace repose::stability {

class EnergyAccount {
 public:
  /// Of a scene whose first probe is of type energy.
  EnergyAccount(const Scene& scene, Simulation& simulation);

  /// Not judged where there is no such probe, where space repeats along gravity, and with the linear stencil,
  /// whose forces jump where particles change cells.
  bool judged() const { return judged_; }
  /// After each step; then after each frame, whose end lets particles begin and end.
  void after_step(double dt);
  void after_frame();

  bool finite() const { return finite_; }
  /// The largest surplus so far over the larger of what was there at first, m g H and what was given.
  double worst() const { return worst_; }
  /// What may be: 1e-2 in explicit steps, 1e-4 in implicit ones.
  double allowed() const { return allowed_; }
  std::string text() const;

 private:
  struct Seen {
    double energy = 0.0;  // kinetic and potential, J
  };
  struct Sums {
    double kinetic = 0.0, affine = 0.0, elastic = 0.0, potential = 0.0, work = 0.0;  // J
    double all() const { return kinetic + affine + elastic + potential; }
  };

  Sums sums() const;
  void look_at_extent();
  void count_sources(double dt);
  void weigh();

  Simulation& simulation_;
  Vec3 gravity_;
  bool judged_ = true, sources_ = false, finite_ = true;
  double emitted_speed_ = 0.0;  // m/s, at most
  double allowed_ = 1e-2, worst_ = 0.0;
  double first_ = 0.0, first_motion_ = 0.0;  // J: all, and all but potential
  double past_work_ = 0.0, given_ = 0.0, moved_ = 0.0;
  double low_ = 0.0, high_ = 0.0;  // m, along gravity
  bool extent_known_ = false;
  Sums last_;
  std::map<std::uint32_t, Seen> seen_;
};

}  // namespace repose::stability
