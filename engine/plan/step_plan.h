// Repose: the step as data. The scene compiler lists the passes that a scene calls for; the plan checks that
// each reads only what an earlier one, or the initial state, provides, and knows how much scratch they need;
// `repose plan` prints it. Passes of one list run one after the other over a span of a block's particles, or
// over a block's nodes, while they are in cache.
#pragma once

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/plan/energy_alarm.h"
#include "engine/plan/implicit_plan.h"
#include "engine/plan/pass.h"
#include "engine/plan/sleep.h"
#include "engine/plan/transfer_choice.h"
#include "kernels/pass/target.h"

namespace repose {

/// What bounds the step (see time_step.h); per set, in the order of the state's sets.
struct StepLimits {
  double max_step = 1.0;  ///< s
  double cfl = 0.6, sound = 0.5, isolated = 0.9, strain = 0.5;
  struct Stiffness {
    double sound_speed;     ///< m/s
    double dilation_speed;  ///< sqrt((3 lambda + 2 mu)/rho), m/s: the pulse of a particle alone
  };
  // Of explicit steps alone:
  std::vector<Stiffness> sets{};
  double acceleration = 0.0;  ///< of all matter, m/s^2: what lies still may be falling when the step ends
};

/// How much memory a simulation may take, bytes; and what of it writing a frame takes, beside what lasts: the
/// points, then one after the other what files of points and of volumes are made from.
struct MemoryBound {
  double limit = std::numeric_limits<double>::infinity();
  double per_point = 0.0, per_point_in_file = 0.0, volumes_per_block = 0.0;

  double writing(std::size_t particles, std::size_t blocks) const {
    const auto points = static_cast<double>(particles);
    return per_point * points +
           std::max(per_point_in_file * points, volumes_per_block * static_cast<double>(blocks));
  }
};

template <class Real>
struct Kernels;

template <class Real>
struct StepPlan {
  Target target = Target::kBaseline;
  const Kernels<Real>* kernels = nullptr;  ///< of the target
  TransferChoice transfer;
  StepLimits limits;
  Real least_mass = 0;  ///< kg; a node below it is empty
  Advection advection = Advection::kAfterFriction;

  ScratchLayout scratch;  ///< of what passes hand on within a chunk
  Tables tables;          ///< of what follows the topology
  MemoryBound memory;

  std::vector<EventPass<Real>> events;
  std::vector<SortPass<Real>> sort;
  std::vector<PreparePass<Real>> prepare;
  std::vector<std::vector<ParticlePass<Real>>> scatter;  ///< per set
  std::vector<NodePass<Real>> nodes;                     ///< forces
  std::vector<NodePass<Real>> applied;                   ///< constraints, applied after all forces
  std::vector<std::vector<ParticlePass<Real>>> gather;   ///< per set

  std::vector<MeasurePass<Real>> measures;

  /// Where steps are implicit: between forces and the gather, instead of `applied`, nodes are solved for within
  /// their constraints.
  std::optional<ImplicitPlan<Real>> implicit;
  std::vector<ConstraintPass<Real>> constraints;

  std::optional<SleepRule> sleep;               ///< whether, and when, blocks sleep
  std::vector<Disturbance<Real>> disturbances;  ///< what wakes them from outside

  std::optional<EnergyAlarm> energy;  ///< whether, and how, energy is watched

  /// How fast, in m/s, what is no particle moves at most between two times (s): it must not cross more cells in
  /// a step than particles may.
  std::vector<std::function<double(double from, double to)>> speeds;

  /// Calls visit(phase, set, description) for every pass, in the order in which they run; set is -1 where a
  /// phase has none.
  template <class Plan, class Visit>
  static void for_each_pass(Plan& plan, Visit visit) {
    const auto each = [&visit](const char* phase, int set, auto& passes) {
      for (auto& pass : passes) visit(phase, set, pass.description);
    };
    each("events", -1, plan.events);
    each("sort", -1, plan.sort);
    each("each step", -1, plan.prepare);
    for (std::size_t k = 0; k < plan.scatter.size(); ++k) each("scatter", static_cast<int>(k), plan.scatter[k]);
    each("nodes", -1, plan.nodes);
    each("solve", -1, plan.constraints);
    if (plan.implicit) visit("solve", -1, plan.implicit->description);
    each("nodes", -1, plan.applied);
    for (std::size_t k = 0; k < plan.gather.size(); ++k) each("gather", static_cast<int>(k), plan.gather[k]);
    each("measure", -1, plan.measures);
  }

  /// Room for the tallies of all measures.
  std::size_t tallies() const {
    std::size_t sum = 0;
    for (const auto& measure : measures) sum += measure.tallies;
    return sum;
  }
  /// Calls visit(measure, tallies) with each measure and its part of `tallies`.
  template <class Number, class Visit>
  void for_each_measure(Number* tallies, Visit visit) const {
    for (const auto& measure : measures) {
      visit(measure, tallies);
      tallies += measure.tallies;
    }
  }

  PassMaker<Real> passes() { return {scratch, tables}; }
  PassMaker<Real> passes_of(const ParticleSet<Real>& set) { return {scratch, tables, &set}; }
  /// Passes of set k, before and after the nodes.
  SetPasses<Real> scatter_of(const State<Real>& state, std::size_t k) {
    return {passes_of(state.sets[k]), scatter[k]};
  }
  SetPasses<Real> gather_of(const State<Real>& state, std::size_t k) {
    return {passes_of(state.sets[k]), gather[k]};
  }

  /// What is wrong with the plan, empty where nothing is: a pass reads what nothing before it provides, or a
  /// step leaves out what the next begins with; with the names of pass and handle. A plan that a scene brings
  /// about is never wrong: whoever compiled it was. `state` holds the sets, whose channels are there from the
  /// start.
  std::string fault(const State<Real>& state) const;
};

}  // namespace repose
