#include "engine/plan/step_plan.h"

#include <set>

namespace repose {
namespace {

/// What every state holds before its first step.
const std::set<std::string> kInitial{"position", "velocity", "affine", "strain", "topology"};

Result<void> follow(const PassDescription& pass, std::set<std::string>& known) {
  for (const std::string& quantity : pass.reads) {
    if (!known.contains(quantity)) {
      return Error{ErrorKind::kBadScene,
                   "stage '" + pass.name + "' reads '" + quantity + "', which no earlier stage provides", ""};
    }
  }
  known.insert(pass.writes.begin(), pass.writes.end());
  return {};
}

template <class Passes>
Result<void> follow_all(const Passes& passes, std::set<std::string>& known) {
  for (const auto& pass : passes) {
    if (auto result = follow(pass.description, known); !result) return result;
  }
  return {};
}

}  // namespace

template <class Real>
Result<void> StepPlan<Real>::validate(const State<Real>& state) const {
  std::set<std::string> at_events = kInitial;
  if (auto result = follow_all(events, at_events); !result) return result;
  std::set<std::string> after_order = kInitial;
  if (auto result = follow_all(order, after_order); !result) return result;
  if (auto result = follow_all(prepare, after_order); !result) return result;
  const auto with_channels = [&state](std::set<std::string> known, std::size_t set) {
    if (set >= state.sets.size()) return known;
    for (const auto& channel : state.sets[set].extra) known.insert(channel.name);
    return known;
  };
  std::set<std::string> on_nodes = after_order;
  for (std::size_t k = 0; k < scatter.size(); ++k) {
    std::set<std::string> known = with_channels(after_order, k);
    if (auto result = follow_all(scatter[k], known); !result) return result;
    // What a chunk hands on in scratch ends with it; what it left on the nodes stays.
    for (const std::string& quantity : known) {
      if (quantity.starts_with("node ")) on_nodes.insert(quantity);
    }
  }
  if (auto result = follow_all(nodes, on_nodes); !result) return result;
  if (auto result = follow_all(contacts, on_nodes); !result) return result;
  if (auto result = follow_all(holds, on_nodes); !result) return result;
  for (std::size_t k = 0; k < gather.size(); ++k) {
    std::set<std::string> known = with_channels(on_nodes, k);
    if (auto result = follow_all(gather[k], known); !result) return result;
  }
  if (auto result = follow_all(measures, on_nodes); !result) return result;
  return {};
}

template struct StepPlan<float>;
template struct StepPlan<double>;

}  // namespace repose
