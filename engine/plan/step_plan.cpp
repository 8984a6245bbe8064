#include "engine/plan/step_plan.h"

namespace repose {
namespace {

/// Whether two handles name one memory.
bool share_memory(const HandleInfo& a, const HandleInfo& b) {
  if (a.place != b.place) return false;
  return a.name == b.name || (a.place != Place::kExtra && a.place != Place::kScratch &&
                              a.place != Place::kTable && a.place != Place::kFact);
}

constexpr std::array kEveryParticle{kPosition.kInfo, kParticleVelocity.kInfo, kHenckyStrain.kInfo};

/// What is known at a point of the step.
class Known {
 public:
  void learn(const HandleInfo& handle) {
    std::erase_if(handles_, [&](const HandleInfo& other) { return share_memory(handle, other); });
    handles_.push_back(handle);
  }
  bool has(const HandleInfo& handle) const {
    return std::find(handles_.begin(), handles_.end(), handle) != handles_.end();
  }
  /// What is wrong with a pass that comes now, if anything is; else what it writes is known.
  std::string follow(const PassDescription& pass) {
    for (const HandleInfo& handle : pass.reads) {
      if (!has(handle))
        return "pass '" + pass.name + "' reads '" + std::string(handle.name) +
               "', which no earlier pass provides";
    }
    for (const HandleInfo& handle : pass.writes) {
      if (handle.place == Place::kExtra && !has(handle))
        return "pass '" + pass.name + "' writes '" + std::string(handle.name) +
               "', a channel that its set lacks";
      learn(handle);
    }
    return "";
  }
  template <class Passes>
  std::string follow_all(const Passes& passes) {
    for (const auto& pass : passes) {
      if (std::string fault = follow(pass.description); !fault.empty()) return fault;
    }
    return "";
  }
  template <class Real>
  void learn_channels(const ParticleSet<Real>& set) {
    for (const HandleInfo& handle : kEveryParticle) learn(handle);
    if (set.keeps_affine) learn(kAffine.kInfo);
    if (set.law_channels > 0) learn(kLawChannels.kInfo);
    for (const auto& channel : set.extra) learn({channel.name, Place::kExtra, 1});
  }
  /// What `other` has of nodes: what a chunk hands on in scratch ends with it.
  void learn_nodes(const Known& other) {
    for (const HandleInfo& handle : other.handles_) {
      if (over_nodes(handle.place)) learn(handle);
    }
  }

 private:
  std::vector<HandleInfo> handles_;
};

/// What the next step begins with and this one has left in another meaning, if anything.
std::string unfinished(const Known& known, const std::string& set) {
  for (const HandleInfo& handle : kEveryParticle) {
    if (!known.has(handle)) return "a step of '" + set + "' leaves no '" + std::string(handle.name) + "'";
  }
  return "";
}

}  // namespace

template <class Real>
std::string StepPlan<Real>::fault(const State<Real>& state) const {
  Known known;
  known.learn(kTopology.kInfo);
  for (const HandleInfo& handle : kEveryParticle) known.learn(handle);
  Known at_events = known;
  std::string fault = at_events.follow_all(events);
  if (fault.empty()) fault = known.follow_all(sort);
  if (fault.empty()) fault = known.follow_all(prepare);
  const auto of_set = [&](const Known& before, std::size_t k) {
    Known own = before;
    if (k < state.sets.size()) own.learn_channels(state.sets[k]);
    return own;
  };
  Known on_nodes = known;
  for (std::size_t k = 0; k < scatter.size() && fault.empty(); ++k) {
    Known own = of_set(known, k);
    fault = own.follow_all(scatter[k]);
    on_nodes.learn_nodes(own);
  }
  if (fault.empty()) fault = on_nodes.follow_all(nodes);
  if (fault.empty()) fault = on_nodes.follow_all(constraints);
  if (fault.empty() && implicit) fault = on_nodes.follow(implicit->description);
  if (fault.empty()) fault = on_nodes.follow_all(applied);
  for (std::size_t k = 0; k < gather.size() && fault.empty(); ++k) {
    Known own = of_set(on_nodes, k);
    fault = own.follow_all(gather[k]);
    if (fault.empty() && k < state.sets.size()) fault = unfinished(own, state.sets[k].name);
  }
  if (fault.empty()) fault = on_nodes.follow_all(measures);
  return fault;
}

template struct StepPlan<float>;
template struct StepPlan<double>;

}  // namespace repose
