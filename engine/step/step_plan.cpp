#include "engine/step/step_plan.h"

#include <set>

namespace repose {
namespace {

/// What a state holds before its first step.
const std::set<std::string> kInitial{"position", "velocity", "affine", "strain", "topology", "volume_gained"};

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
Result<void> StepPlan<Real>::validate() const {
  std::set<std::string> after_order = kInitial;
  if (auto result = follow_all(order, after_order); !result) return result;
  std::set<std::string> on_nodes = after_order;
  for (const auto& passes : scatter) {
    std::set<std::string> known = after_order;
    if (auto result = follow_all(passes, known); !result) return result;
    // What a chunk hands on in scratch ends with it; what it left on the nodes stays.
    for (const std::string& quantity : known) {
      if (quantity.starts_with("node ")) on_nodes.insert(quantity);
    }
  }
  if (auto result = follow_all(nodes, on_nodes); !result) return result;
  for (const auto& passes : gather) {
    std::set<std::string> known = on_nodes;
    if (auto result = follow_all(passes, known); !result) return result;
  }
  return {};
}

template struct StepPlan<float>;
template struct StepPlan<double>;

}  // namespace repose
