// Repose: the passes that a step is made of: what each declares, and how it is made from handles and a body. A
// pass acts on a chunk of a block's particles or on a block's nodes, and keeps nothing between calls.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/plan/access.h"
#include "engine/plan/constraint.h"
#include "engine/plan/report.h"
#include "engine/state/particle_edit.h"

namespace repose {

struct PassName {
  std::string name;
  std::string reason{};  ///< which scene key asked for it; empty for the core
};

/// What every pass declares.
struct PassDescription {
  std::string name;
  std::string reason;
  std::vector<HandleInfo> reads;
  std::vector<HandleInfo> writes;
  std::string effect{};  ///< that added it; empty for the core
};

template <class... Arguments>
struct Pass {
  PassDescription description;
  std::function<void(Arguments...)> run;
};

template <class Real>
using ParticlePass = Pass<Chunk<Real>&>;
template <class Real>
using NodePass = Pass<const NodeBlock<Real>&>;
/// Lists what may keep the nodes of a block from moving freely in this step, whether or not it does yet.
template <class Real>
using ConstraintPass = Pass<const NodeBlock<Real>&, std::vector<Constraint<Real>>&>;
/// Rebuilds what follows the topology, after each sort event.
template <class Real>
using SortPass = Pass<State<Real>&>;
/// What changes with time and is the same for all blocks, such as where solids stand: before the node passes,
/// once for each try of a step.
template <class Real>
using PreparePass = Pass<State<Real>&, Real>;

/// When events are asked for.
enum class Moment {
  kBeforeStep,
  kEndOfFrame,  ///< before anything is written of the frame: nothing that is due by its time may be left over
};

/// Begins and ends particles. Asked before each step; an edit that is not empty is carried out at once, and an
/// sort event follows.
template <class Real>
struct EventPass {
  PassDescription description;
  std::function<bool(const State<Real>&, Moment)> due;              ///< costs nothing per particle
  std::function<void(State<Real>&, ParticleEdit<Real>& edit)> run;  ///< keeps the ledger
};

/// Measures while frames pass and changes nothing. What it sums over steps it keeps in its part of
/// State::tallies, so that a frame goes on where it was interrupted; a hook that is not needed is left empty.
template <class Real>
struct MeasurePass {
  PassDescription description{};
  std::size_t tallies = 0;  ///< how many numbers it keeps
  std::function<void(const State<Real>&, double* tallies)> begin_frame{};
  std::function<void(const State<Real>&, double dt, double* tallies)>
      after_step{};  ///< of accepted steps, dt in s
  std::function<void(const State<Real>&, const double* tallies, std::vector<Measurement>&)> report{};
};

/// Objects that follow the topology, by the names of their handles; each has bytes(). Copies of a plan share
/// them.
class Tables {
 public:
  /// Makes the object of a handle, which must be new.
  template <class Real, class Handle, class... Arguments>
  typename Handle::template Of<Real>& make(Handle, Arguments&&... arguments) {
    auto made = std::make_shared<typename Handle::template Of<Real>>(std::forward<Arguments>(arguments)...);
    auto& object = *made;
    using Object = typename Handle::template Of<Real>;
    objects_[Handle::kInfo.name] = {std::move(made),
                                    [](const void* any) { return static_cast<const Object*>(any)->bytes(); }};
    return object;
  }
  /// Null where none was made.
  void* find(const HandleInfo& handle) const {
    const auto found = objects_.find(handle.name);
    return found == objects_.end() ? nullptr : found->second.object.get();
  }
  std::size_t bytes() const {
    std::size_t sum = 0;
    for (const auto& [name, entry] : objects_) sum += entry.bytes(entry.object.get());
    return sum;
  }
  template <class Real, class Handle>
  typename Handle::template Of<Real>* get(Handle) const {
    return static_cast<typename Handle::template Of<Real>*>(find(Handle::kInfo));
  }

 private:
  struct Entry {
    std::shared_ptr<void> object;
    std::size_t (*bytes)(const void*);
  };
  std::map<std::string_view, Entry> objects_;
};

/// Makes passes: finds the place of each handle. What is not there to be found, the check of the plan tells.
template <class Real>
class PassMaker {
 public:
  /// `set`: of passes over particles.
  PassMaker(ScratchLayout& scratch, const Tables& tables, const ParticleSet<Real>* set = nullptr)
      : scratch_(&scratch), tables_(&tables), set_(set) {}

  template <class... R, class... W, class Body>
  ParticlePass<Real> over_particles(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    using Access = ChunkAccess<Real, Reads<R...>, Writes<W...>>;
    return bind<ParticlePass<Real>, Access>(std::move(name), reads, writes, std::move(body));
  }
  template <class... R, class... W, class Body>
  NodePass<Real> over_nodes(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    using Access = NodeAccess<Real, Reads<R...>, Writes<W...>>;
    return bind<NodePass<Real>, Access>(std::move(name), reads, writes, std::move(body));
  }
  template <class... R, class Body>
  ConstraintPass<Real> constraints(PassName name, Reads<R...> reads, Body body) {
    using Access = NodeAccess<Real, Reads<R...>, Writes<>>;
    return bind<ConstraintPass<Real>, Access>(std::move(name), reads, Writes<>{}, std::move(body));
  }
  template <class... R, class... W, class Body>
  SortPass<Real> after_sort(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    using Access = StateAccess<Real, Reads<R...>, Writes<W...>>;
    return bind<SortPass<Real>, Access>(std::move(name), reads, writes, std::move(body));
  }
  template <class... R, class... W, class Body>
  PreparePass<Real> each_try(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    using Access = StateAccess<Real, Reads<R...>, Writes<W...>>;
    return bind<PreparePass<Real>, Access>(std::move(name), reads, writes, std::move(body));
  }

  template <class R, class W>
  static PassDescription describe(PassName name, const R& reads, const W& writes) {
    PassDescription description{std::move(name.name), std::move(name.reason), {}, {}};
    reads.for_each([&](auto handle, bool declared) {
      if (declared) description.reads.push_back(decltype(handle)::kInfo);
    });
    writes.for_each([&](auto handle, bool declared) {
      if (declared && decltype(handle)::kPlace != Place::kRoom)
        description.writes.push_back(decltype(handle)::kInfo);
    });
    return description;
  }

  /// `make(at)` fills the hooks, with objects that it gets from `at` and that they may keep.
  template <class... R, class... W, class Make>
  MeasurePass<Real> measure(PassName name, Reads<R...> reads, Writes<W...> writes, Make make) {
    using Access = TableAccess<Real, Reads<R...>, Writes<W...>>;
    MeasurePass<Real> made =
        make(Access(std::make_shared<const typename Access::Places>(places<Access>(reads, writes))));
    made.description = describe(std::move(name), reads, writes);
    return made;
  }

 private:
  template <class Access, class R, class W>
  typename Access::Places places(const R& reads, const W& writes) {
    typename Access::Places places;
    std::size_t k = 0;
    const auto find = [&](auto handle, bool declared) {
      places[k++] = declared ? locate(decltype(handle)::kInfo) : Located{Access::kAbsent, nullptr};
    };
    reads.for_each(find);
    writes.for_each(find);
    return places;
  }
  template <class Made, class Access, class R, class W, class Body>
  Made bind(PassName name, const R& reads, const W& writes, Body body) {
    return {describe(std::move(name), reads, writes),
            [places = places<Access>(reads, writes), body = std::move(body)](auto& subject, auto&&... more) {
              body(Access(subject, places), std::forward<decltype(more)>(more)...);
            }};
  }
  Located locate(const HandleInfo& handle) {
    switch (handle.place) {
      case Place::kExtra:
        return {set_->extra_index(handle.name), nullptr};
      case Place::kScratch:
      case Place::kRoom:
        return {scratch_->place(handle), nullptr};
      case Place::kNodes:
        return {set_ == nullptr ? 0 : scratch_->place_arena(kArena), nullptr};
      case Place::kBeforeForces:
        return {set_ == nullptr ? 0 : scratch_->place_arena(kArenaBeforeForces), nullptr};
      case Place::kAfterFriction:
        return {set_ == nullptr ? 0 : scratch_->place_arena(kArenaAfterFriction), nullptr};
      case Place::kTable:
        REPOSE_ASSERT(tables_->find(handle) != nullptr);  // made before passes name it
        return {0, tables_->find(handle)};
      default:
        return {};
    }
  }

  ScratchLayout* scratch_;
  const Tables* tables_;
  const ParticleSet<Real>* set_;
};

/// Whether a pass of a list writes a handle, or reads it.
template <class Passes>
bool provided(const Passes& list, const HandleInfo& handle) {
  return std::any_of(list.begin(), list.end(), [&](const auto& pass) {
    const auto& writes = pass.description.writes;
    return std::find(writes.begin(), writes.end(), handle) != writes.end();
  });
}
template <class Passes>
bool asked_for(const Passes& list, const HandleInfo& handle) {
  return std::any_of(list.begin(), list.end(), [&](const auto& pass) {
    const auto& reads = pass.description.reads;
    return std::find(reads.begin(), reads.end(), handle) != reads.end();
  });
}

/// The passes of one set in one phase, in the order in which they are added.
template <class Real>
class SetPasses {
 public:
  SetPasses(PassMaker<Real> maker, std::vector<ParticlePass<Real>>& list) : maker_(maker), list_(list) {}

  template <class... R, class... W, class Body>
  void add(PassName name, Reads<R...> reads, Writes<W...> writes, Body body) {
    list_.push_back(maker_.over_particles(std::move(name), reads, writes, std::move(body)));
  }
  /// Whether a pass that was added writes a handle.
  template <class Handle>
  bool provides(Handle) const {
    return provided(list_, Handle::kInfo);
  }

 private:
  PassMaker<Real> maker_;
  std::vector<ParticlePass<Real>>& list_;
};

}  // namespace repose
