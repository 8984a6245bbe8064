// Repose: runs a step plan on a state. A step is refused before any particle is written when it would break:
// the velocities of the nodes bound what particles can do, and only blocks whose bound is not enough gather on
// trial.
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "engine/base/parallel.h"
#include "engine/base/profile.h"
#include "engine/implicit/implicit_step.h"
#include "engine/plan/step_plan.h"
#include "engine/plan/time_step.h"
#include "engine/state/block_order.h"
#include "engine/state/state.h"

namespace repose {

/// The particle for whose sake a step was refused.
struct Offender {
  std::string set;
  std::uint32_t id = 0;
  Index3 block{0, 0, 0};
  Vec3 position{0, 0, 0};        ///< m
  Vec3 velocity{0, 0, 0};        ///< m/s, before the step
  Vec3 trial_velocity{0, 0, 0};  ///< m/s, that the step would have moved it with
  double determinant = 0.0;      ///< det(I + dt grad v)
  std::string reason;            ///< what would happen to it, such as "would move over a cell"
};

struct StepReport {
  bool accepted = false;
  double dt = 0.0;  ///< s; of the step made, or of the last one refused
  Limit limit = Limit::kMaxStep;
  int redone = 0;                          ///< how often it was refused
  std::string first_refusal;               ///< why, the first time; empty where it was not
  std::optional<Offender> offender;        ///< of the last refusal
  std::optional<Error> error;              ///< an event could not be carried out; no step was then tried
  std::optional<ImplicitReport> implicit;  ///< of the last try, where steps are implicit
};

/// Why a step was refused: "particle 7 of 'pile' would move over a cell"; "it needs more than
/// implicit.newton_iterations".
std::string refusal_text(const Offender& offender);
std::string unsolved_text(const ImplicitReport& report);

template <class Real>
class Stepper {
 public:
  Stepper(StepPlan<Real> plan, int threads);

  /// One step of at most what the limits allow and `remaining` seconds (infinity: no frame to end on). If it is
  /// not accepted after three halvings, no particle has changed.
  StepReport step(State<Real>& state, double remaining);

  const StepPlan<Real>& plan() const { return plan_; }
  const Profile& profile() const { return profile_; }
  void reset_profile() { profile_ = {}; }
  Threads& threads() { return threads_; }
  /// Memory that grows with the particles, and with the blocks: ordering, and numbers per block.
  std::size_t bytes() const;
  /// Memory of the threads, whatever the scene.
  std::size_t scratch_bytes() const;
  /// Lets what measures begin anew.
  void begin_frame(State<Real>& state);
  /// Rebuilds what follows the topology, after a state has been loaded.
  void follow(State<Real>& state);
  /// Brings the order up to date, if it is due; a step does so by itself.
  void order_if_due(State<Real>& state);
  /// Carries out the events that are due, then brings the order up to date if there were any; a step does the
  /// first by itself. Error 78: no ids are left.
  Result<void> end_frame(State<Real>& state);

 private:
  Result<bool> carry_out_events(State<Real>& state, Moment moment);
  void scatter(State<Real>& state, Real dt);
  void scatter_block(State<Real>& state, std::size_t owner, std::size_t next, Real dt);
  void update_nodes(State<Real>& state, Real dt);
  void hold_block(NodeBlock<Real>& nodes);
  bool solve(State<Real>& state, Real dt, StepReport& report);
  std::optional<Offender> inspect(State<Real>& state, Real dt);
  std::optional<Offender> inspect_block(State<Real>& state, std::size_t owner, Real dt);
  std::span<const std::int32_t> scattering(const State<Real>& state, int colour) const;
  template <class Visit>
  void for_each_block(const State<Real>& state, Visit visit);
  template <class Visit>
  void for_each_awake(const State<Real>& state, Visit visit);
  void wake(State<Real>& state, Real dt);
  Stir stir_of_nodes(const State<Real>& state, std::size_t owner);
  void clear_nodes(State<Real>& state);
  bool bounded(const State<Real>& state, std::size_t owner, Real dt) const;
  void gather(State<Real>& state, Real dt);
  Motion<Real> gather_block(State<Real>& state, std::size_t owner, Real dt);
  bool load_arenas(const State<Real>& state, std::size_t owner, Scratch<Real>& scratch) const;
  Offender accuse(const State<Real>& state, std::size_t owner, const Chunk<Real>& chunk, std::size_t p,
                  const GatherInput<Real>& trial) const;
  Offender fastest(const State<Real>& state) const;
  void finish(State<Real>& state, Real dt);
  Scratch<Real>& scratch() { return scratch_[static_cast<std::size_t>(Threads::index())]; }
  StepPlan<Real> plan_;
  Threads threads_;
  BlockOrder<Real> order_;
  std::optional<Rest<Real>> rest_;          // where blocks may sleep
  std::vector<Stir> stirs_, margin_stirs_;  // per owner; per owner of the margin
  std::vector<Scratch<Real>> scratch_;
  std::optional<ImplicitStep<Real>> implicit_;
  std::vector<VelocityBounds<Real>> bounds_;    // per block
  std::vector<Motion<Real>> motion_;            // per owner
  std::vector<std::size_t> runs_;               // per owner
  std::vector<std::int32_t> suspects_;          // owners that must gather on trial
  std::vector<std::optional<Offender>> found_;  // per suspect
  bool topology_known_ = false;                 // to the passes that follow it
  Profile profile_;
};

}  // namespace repose
