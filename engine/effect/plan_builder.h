// Repose: where effects add to a step. A slot is a kind of pass and its time within the step; which slot it is
// says whether a pass comes before an implicit solve or holds within it, so that nobody can get that wrong by
// the order of a list. The compiler (engine/compiler/plan_compiler.cpp) puts the slots into the plan.
//
//   events          particles begin and end, between two steps
//   after_sort     what follows the topology
//   each_try        what is the same for all blocks, such as where solids stand
//   per set:        before_scatter, before_motion, after_motion, before_return, after_return
//   forces          change the velocity of nodes, before anything holds them
//   constraints     what keeps nodes from moving freely
//   measures        figures of a frame
//   rest            whether blocks sleep, and what wakes them
//   speeds          of what is no particle
//   drives          what gives energy to matter
#pragma once

#include <vector>

#include "engine/effect/description.h"
#include "engine/effect/slot.h"
#include "engine/plan/step_plan.h"

namespace repose {

template <class Real>
struct Newcomers;

/// Passes of one set.
template <class Real>
struct SetSlots {
  std::size_t index;  ///< of the set, in the state
  const SetDescription& description;
  /// Before it tells the nodes: what pushes particles themselves has them tell another velocity, and leaves
  /// their own, for a step may be tried again.
  ParticleSlot<Real> before_scatter;
  ParticleSlot<Real> before_motion;
  /// After its particles have moved and before their trial strain is formed.
  ParticleSlot<Real> after_motion;
  /// Just before and just after the return map, of a set that yields. Those after run in the reverse order of
  /// effects: an effect's two halves enclose those of the effects that follow it in the list. An implicit step
  /// runs those before in every evaluation: of a particle they may change nothing but its trial strain. What
  /// they and those after read and write decides whether particles yield by numbers of their own (kYieldSlope
  /// and what follows it in engine/plan/handle.h), rather than by those of their material alone.
  ParticleSlot<Real> before_return, after_return;

  bool yields() const { return description.yields(); }

  /// To be called before a pass of before_scatter that pushes particles, which adds to what they tell:
  /// kP2gVelocity is then their own velocity, and what earlier passes have added.
  void scatter_own_velocity() {
    if (before_scatter.provides(kP2gVelocity)) return;
    before_scatter.add({"velocity to be told"}, reads(kParticleVelocity), writes(kP2gVelocity),
                       [](const auto& at) {
                         const auto own = at.read(kParticleVelocity);
                         const auto told = at.write(kP2gVelocity);
                         for (std::size_t axis = 0; axis < 3; ++axis)
                           std::copy_n(own[axis], at.count(), told[axis]);
                       });
  }
};

/// What stands in the slots of a set.
template <class Real>
struct SetLists {
  using List = std::vector<ParticlePass<Real>>;
  List before_scatter, before_motion, after_motion, before_return, after_return;
  std::vector<std::size_t> begin;  ///< of each effect, in after_return

  /// After the return map the last effect comes first.
  List after_return_in_turn() const {
    List list;
    for (std::size_t e = begin.size(); e-- > 0;) {
      const std::size_t end = e + 1 < begin.size() ? begin[e + 1] : after_return.size();
      for (std::size_t k = begin[e]; k < end; ++k) list.push_back(after_return[k]);
    }
    return list;
  }
};

/// Where what begins through an inlet goes.
struct InletPlace {
  std::size_t entry;  ///< in Ledger::emitted
  std::size_t set;    ///< in State::sets
};

template <class Real>
class PlanBuilder {
 public:
  using Initialize = std::function<void(Newcomers<Real>&)>;

  /// The plan has its kernels, its transfer, and whether it is implicit.
  PlanBuilder(StepPlan<Real>& plan, const State<Real>& all, const std::vector<SetDescription>& of_sets,
              Initialize make_ready)
      : events(plan.events, author_, plan.passes()),
        after_sort(plan.sort, author_, plan.passes()),
        each_try(plan.prepare, author_, plan.passes()),
        forces(plan.nodes, author_, plan.passes()),
        constraints(plan, author_),
        measures(plan.measures, author_, plan.passes()),
        rest(plan),
        speeds(plan.speeds),
        drives(plan.energy),
        plan_(plan),
        state_(all),
        initialize_(std::move(make_ready)),
        lists_(of_sets.size()) {
    for (std::size_t k = 0; k < of_sets.size(); ++k) {
      const auto slot = [&](std::vector<ParticlePass<Real>>& list) {
        return ParticleSlot<Real>(list, author_, plan.passes_of(all.sets[k]));
      };
      SetLists<Real>& of = lists_[k];
      sets.push_back({k, of_sets[k], slot(of.before_scatter), slot(of.before_motion), slot(of.after_motion),
                      slot(of.before_return), slot(of.after_return)});
    }
  }
  PlanBuilder(const PlanBuilder&) = delete;

  EventSlot<Real> events;
  SortSlot<Real> after_sort;
  TrySlot<Real> each_try;
  std::vector<SetSlots<Real>> sets;  ///< in the order of the state's
  NodeSlot<Real> forces;
  ConstraintSlot<Real> constraints;
  MeasureSlot<Real> measures;
  RestSlot<Real> rest;
  SpeedSlot speeds;
  DriveSlot drives;

  /// Calls visit(slots, parameters) for each set whose material has an entry in a ConeDescription.
  template <class From, class Visit>
  void for_each_set_of(const From& description, Visit visit) {
    for (SetSlots<Real>& set : sets) {
      if (const auto* parameters = description.find(set.description)) visit(set, *parameters);
    }
  }

  /// Makes the object of a table's handle, which must be new.
  template <class Handle, class... Arguments>
  typename Handle::template Of<Real>& make(Handle handle, Arguments&&... arguments) {
    return plan_.tables.template make<Real>(handle, std::forward<Arguments>(arguments)...);
  }
  /// Null where none was made.
  template <class Handle>
  typename Handle::template Of<Real>* find(Handle handle) const {
    return plan_.tables.template get<Real>(handle);
  }

  bool implicit() const { return plan_.implicit.has_value(); }
  Advection advection() const { return plan_.advection; }
  const TransferChoice& transfer() const { return plan_.transfer; }
  Target target() const { return plan_.target; }
  const Kernels<Real>& kernels() const { return *plan_.kernels; }
  const State<Real>& state() const { return state_; }

  /// Of the effect that adds: where what begins through its inlet k goes, and where in Ledger::removed its
  /// outlets begin.
  InletPlace inlet(std::size_t k) const {
    const std::size_t entry = author_.first_inlet + k;
    return {entry, state_.sets.size() - state_.ledger.emitted.size() + entry};  // inlets follow the bodies
  }
  std::size_t first_outlet() const { return author_.first_outlet; }
  /// Makes particles that begin during the run ready, as those of bodies were: the channels and the hooks
  /// `initialize` of all effects. It may be kept.
  const Initialize& initialize() const { return initialize_; }

  // For the compiler.

  void turn_to(Author author) {
    author_ = std::move(author);
    for (SetLists<Real>& of : lists_) of.begin.push_back(of.after_return.size());
  }
  const SetLists<Real>& lists(std::size_t set) const { return lists_[set]; }

 private:
  Author author_;
  StepPlan<Real>& plan_;
  const State<Real>& state_;
  Initialize initialize_;
  std::vector<SetLists<Real>> lists_;
};

}  // namespace repose
