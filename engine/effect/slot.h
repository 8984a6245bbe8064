// Repose: the slots of a plan builder: each makes passes of one kind, notes which effect added them, and puts
// them into its list.
#pragma once

#include <algorithm>
#include <iterator>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/plan/contact_law.h"
#include "engine/plan/step_plan.h"

namespace repose {

/// Who adds passes at the moment; the compiler turns it from effect to effect.
struct Author {
  std::string effect{};
  std::size_t first_inlet = 0, first_outlet = 0;  ///< of the effect, in the ledger
};

template <class Real, class Made>
class Slot {
 public:
  Slot(std::vector<Made>& list, const Author& author, PassMaker<Real> maker)
      : list_(&list), author_(&author), maker_(maker) {}

 protected:
  /// What is added for no key is the core's, whoever asked for it.
  void put(Made pass) {
    if (!pass.description.reason.empty()) pass.description.effect = author_->effect;
    list_->push_back(std::move(pass));
  }

  std::vector<Made>* list_;
  const Author* author_;
  PassMaker<Real> maker_;
};

/// Passes over the chunks of a set.
template <class Real>
class ParticleSlot : public Slot<Real, ParticlePass<Real>> {
 public:
  using Slot<Real, ParticlePass<Real>>::Slot;

  template <class... R, class... W, class Body>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    this->put(this->maker_.over_particles(std::move(name), reads, writes, std::move(body)));
  }
  /// Whether a pass that was added writes a handle.
  template <class Handle>
  bool provides(Handle) const {
    return provided(*this->list_, Handle::kInfo);
  }
};

/// Passes over the nodes of blocks.
template <class Real>
class NodeSlot : public Slot<Real, NodePass<Real>> {
 public:
  using Slot<Real, NodePass<Real>>::Slot;

  template <class... R, class... W, class Body>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    this->put(this->maker_.over_nodes(std::move(name), reads, writes, std::move(body)));
  }
};

template <class Real>
class SortSlot : public Slot<Real, SortPass<Real>> {
 public:
  using Slot<Real, SortPass<Real>>::Slot;

  template <class... R, class... W, class Body>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    this->put(this->maker_.after_sort(std::move(name), reads, writes, std::move(body)));
  }
};

template <class Real>
class TrySlot : public Slot<Real, PreparePass<Real>> {
 public:
  using Slot<Real, PreparePass<Real>>::Slot;

  template <class... R, class... W, class Body>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    this->put(this->maker_.each_try(std::move(name), reads, writes, std::move(body)));
  }
};

template <class Real>
class EventSlot : public Slot<Real, EventPass<Real>> {
 public:
  using Slot<Real, EventPass<Real>>::Slot;

  /// `runtime` has due() and run(), as EventPass says.
  template <class... R, class... W, class Runtime>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, std::shared_ptr<Runtime> runtime) {
    this->put({PassMaker<Real>::describe(std::move(name), reads, writes),
               [runtime](const State<Real>& state, Moment moment) { return runtime->due(state, moment); },
               [runtime](State<Real>& state, ParticleEdit<Real>& edit) { runtime->run(state, edit); }});
  }
};

template <class Real>
class MeasureSlot : public Slot<Real, MeasurePass<Real>> {
 public:
  using Slot<Real, MeasurePass<Real>>::Slot;

  /// `make(at)` fills the hooks, with objects that it gets from `at` and that they may keep.
  template <class... R, class... W, class Make>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Make make) {
    this->put(this->maker_.measure(std::move(name), reads, writes, std::move(make)));
  }
};

/// What keeps nodes from moving freely. An implicit step solves within what is listed; an explicit one applies
/// it at once, after all forces.
template <class Real>
class ConstraintSlot {
 public:
  ConstraintSlot(StepPlan<Real>& plan, const Author& author)
      : implicit_(plan.implicit.has_value()),
        listed_(plan.constraints, author, plan.passes()),
        applied_(plan.applied, author, plan.passes()),
        listed_last_(last_.constraints, author, plan.passes()),
        applied_last_(last_.applied, author, plan.passes()) {}

  /// `list(at, constraints)` lists those of a block's nodes in this step, whether or not they act yet.
  template <class... R, class List>
  void add(PassName name, Reads<R...> reads, List list) {
    if (implicit_) {
      listed_.add(std::move(name), reads, std::move(list));
    } else {
      applied_.add(std::move(name), reads, writes(kNodeVelocity),
                   [list = std::move(list)](const auto& at) { apply(list, at); });
    }
  }
  /// The same for what comes after all others, and has a faster way in explicit steps than to list and apply:
  /// `at_once` adds that to the slot that it is given. Solids do so: whatever else holds a node, none enters
  /// them.
  template <class... R, class List, class AtOnce>
  void add_last(PassName name, Reads<R...> reads, List list, AtOnce at_once) {
    if (implicit_) {
      listed_last_.add(std::move(name), reads, std::move(list));
    } else {
      at_once(applied_last_);
    }
  }

  /// For the compiler: all effects have added.
  void finish(StepPlan<Real>& plan) {
    std::move(last_.constraints.begin(), last_.constraints.end(), std::back_inserter(plan.constraints));
    std::move(last_.applied.begin(), last_.applied.end(), std::back_inserter(plan.applied));
  }

 private:
  class Listed : public Slot<Real, ConstraintPass<Real>> {
   public:
    using Slot<Real, ConstraintPass<Real>>::Slot;

    template <class... R, class List>
    void add(PassName name, Reads<R...> reads, List list) {
      this->put(this->maker_.constraints(std::move(name), reads, std::move(list)));
    }
  };

  template <class List, class Access>
  static void apply(const List& list, const Access& at) {
    static thread_local std::vector<Constraint<Real>> constraints;  // a warm step asks the heap for nothing
    constraints.clear();
    list(at, constraints);
    Real* const nodes = at.write(kNodeVelocity);
    for (const Constraint<Real>& constraint : constraints) {
      Real* const v = nodes + constraint.node * kNodeValues + 1;
      Real impulse;
      const bool acts =
          constrain(constraint.contact, beside(constraint), constraint.velocity, at.dt(), v, impulse);
      if (acts && constraint.friction > Real(0))
        rub(constraint.normal, constraint.velocity, constraint.friction * impulse, v);
    }
  }

  bool implicit_;
  Listed listed_;
  NodeSlot<Real> applied_;
  struct {
    std::vector<ConstraintPass<Real>> constraints;
    std::vector<NodePass<Real>> applied;
  } last_;
  Listed listed_last_;
  NodeSlot<Real> applied_last_;
};

/// Whether blocks sleep, and what wakes them from outside: whatever may move material that rests says so,
/// whether or not the scene has `sleep`.
template <class Real>
class RestSlot {
 public:
  explicit RestSlot(StepPlan<Real>& plan) : plan_(&plan) {}

  void sleep_by(const SleepRule& rule) { plan_->sleep = rule; }
  /// `reaches(state, block, from, to)`: whether it reaches a block between two times.
  template <class Reaches>
  void wake(std::string name, Reaches reaches) {
    plan_->disturbances.push_back({std::move(name), std::move(reaches)});
  }

 private:
  StepPlan<Real>* plan_;
};

/// What gives energy to matter, for the alarm that tells of energy from nowhere: whatever does so says it,
/// whether or not there is an alarm. Gravity, solids and what begins are known.
class DriveSlot {
 public:
  explicit DriveSlot(std::optional<EnergyAlarm>& alarm) : alarm_(&alarm) {}

  /// A force, by its most power.
  void by_force(EnergyAlarm::Power power) {
    if (*alarm_) (*alarm_)->powers.push_back(std::move(power));
  }
  /// Something that draws matter at a speed (m/s), with whatever force that takes.
  void by_drawing(double speed) {
    if (*alarm_) (*alarm_)->drawn = std::max((*alarm_)->drawn, speed);
  }
  /// Something that no bound is known of: nothing is watched.
  void beyond_account() {
    if (*alarm_) (*alarm_)->beyond_account = true;
  }

 private:
  std::optional<EnergyAlarm>* alarm_;
};

/// How fast, in m/s, what is no particle moves at most between two times (s).
class SpeedSlot {
 public:
  using Speed = std::function<double(double from, double to)>;

  explicit SpeedSlot(std::vector<Speed>& list) : list_(&list) {}
  void add(Speed speed) { list_->push_back(std::move(speed)); }

 private:
  std::vector<Speed>* list_;
};

}  // namespace repose
