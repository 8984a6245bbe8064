// Repose: runs a step plan on a state. The body of step() and of the parts that it calls is the step's table of
// contents; order, the set of active blocks, acceptance and the implicit solve have headers of their own.
#pragma once

#include <optional>

#include "engine/implicit/implicit_step.h"
#include "engine/step/acceptance.h"
#include "engine/step/between_steps.h"
#include "engine/step/energy_watch.h"
#include "engine/step/memory_use.h"

namespace repose {

template <class Real>
class Stepper {
 public:
  /// `wish`, where there is one: said by any thread, it leaves the step at hand, and no particle has changed.
  Stepper(StepPlan<Real> plan, int threads, const StopWish* wish = nullptr);
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// One step of at most what the limits allow and `remaining` seconds (infinity: no frame to end on). If it is
  /// not accepted after three halvings, no particle has changed. Time is moved by the clock of frames
  /// (engine/plan/frame_clock.h).
  StepReport step(State<Real>& state, double remaining);

  const StepPlan<Real>& plan() const { return plan_; }
  const Profile& profile() const { return profile_; }
  void reset_profile() { profile_ = {}; }
  Threads& threads() { return threads_; }
  /// What the state, and stepping it, takes.
  MemoryUse memory(const State<Real>& state) const;
  /// Makes room for the first step, which else would: so that what memory() tells is all.
  void reserve(State<Real>& state);
  /// Lets what measures begin anew.
  void begin_frame(State<Real>& state);
  /// Rebuilds what follows the topology, and makes room, after a state has been loaded. Error 78: it needs more
  /// memory than the plan's bound.
  Result<void> follow(State<Real>& state);
  /// Brings the order, and what follows it, up to date, if that is due; a step does so by itself. Error 78:
  /// that would need more memory than the plan's bound; the state is sound and can be saved.
  Result<void> sort_if_due(State<Real>& state);
  /// Carries out the events that are due, then brings the order up to date if there were any; a step does so by
  /// itself. Error 78: no ids are left.
  Result<void> end_frame(State<Real>& state);
  /// Lets a host say what begins and what ends, and brings the order up to date. Error 78: no ids are left;
  /// nothing has then changed.
  Result<void> edit_particles(State<Real>& state,
                              const std::function<void(State<Real>&, ParticleEdit<Real>&)>& say);

 private:
  struct Count {
    std::size_t particles = 0, blocks = 0;
  };

  Result<void> change_particles(State<Real>& state, Moment moment);
  void follow_topology(State<Real>& state);
  std::optional<Error> outgrown(const State<Real>& state) const;
  bool try_step(StepReport& report);
  void scatter();
  void scatter_block(OccupiedBlock<Real>& block);
  void update_nodes();
  bool solve(StepReport& report);
  void gather();
  Motion<Real> gather_block(OccupiedBlock<Real>& block);
  void finish(double dt);
  void count_segments(Counters& counters) const;

  StepPlan<Real> plan_;
  Threads threads_;
  Profile profile_;
  StopWish nobody_;
  ActiveBlocks<Real> active_;
  BetweenSteps<Real> between_;
  MovingNodes<Real> moving_;
  Acceptance<Real> acceptance_;
  EnergyWatch<Real> energy_;
  BlockSweep<Real> sweep_;  // after all that ask the plan for scratch
  std::optional<ImplicitStep<Real>> implicit_;
  std::size_t arena_, before_forces_;  // in scratch
  std::vector<Motion<Real>> motion_;   // per occupied block
  std::vector<std::size_t> segments_;  // per occupied block
  Count begun_with_, room_;            // of the first state; that there is room for
  bool unmeasured_ = false;            // particles have begun, and nobody has asked whether there is memory
};

}  // namespace repose
