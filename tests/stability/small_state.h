// Repose tests: a state whose particles a test sets itself before it runs, step by step and on one thread.
#pragma once

#include <limits>
#include <optional>
#include <stdexcept>

#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"

namespace repose::battery {

template <class Real>
class SmallState {
 public:
  explicit SmallState(const Scene& scene, Target target = best_target()) : scene_(scene) {
    auto compiled = compile_scene<Real>(scene, {.target = target});
    if (!compiled) throw std::runtime_error(compiled.error().text());
    state_ = std::move(compiled->state);
    plan_ = std::move(compiled->plan);
  }

  const Scene& scene() const { return scene_; }
  State<Real>& state() { return state_; }
  ParticleSet<Real>& set() { return state_.sets[0]; }

  /// Calls visit(set, p, x); particles may change, but must not leave their block.
  template <class Visit>
  void for_each(Visit visit) {
    for_each_particle(state_, [&](const ParticleSet<Real>& set, std::size_t p, const Vec3& x) {
      visit(const_cast<ParticleSet<Real>&>(set), p, x);
    });
  }

  /// No limit but this, s: steps that no scene could ask for.
  void limit_steps_only_by(double dt) {
    plan_->limits.cfl = plan_->limits.sound = plan_->limits.isolated = plan_->limits.strain = 1e6;
    plan_->limits.max_step = dt;
  }

  StepReport step() {
    if (plan_) {
      stepper_.emplace(std::move(*plan_), 1);
      plan_.reset();
    }
    const StepReport report = stepper_->step(state_, std::numeric_limits<double>::infinity());
    if (report.accepted) FrameClock::advance_freely(state_.counters, report.dt);
    return report;
  }

 private:
  Scene scene_;
  State<Real> state_;
  std::optional<StepPlan<Real>> plan_;
  std::optional<Stepper<Real>> stepper_;
};

}  // namespace repose::battery
