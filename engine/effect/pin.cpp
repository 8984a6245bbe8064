#include "engine/effect/pin.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace repose {
namespace {

void describe(Fields& fields, PinDescription& pin) {
  fields.text("name", pin.name, "what messages and overrides call it; no two pins share a name", true);
  bool present = false;
  fields.object("shape", present, true, "the region", [&](Fields& f) { describe(f, pin.shape); });
  fields.vector("velocity", pin.velocity, {.unit = "m/s", .meaning = "of what lies in the region"});
  fields.number("start", pin.start, {.unit = "s", .meaning = "when it takes hold", .low = 0.0});
  fields.number("end", pin.end, {.unit = "s", .meaning = "when it lets go", .low = 0.0, .low_open = true});
  fields.check(pin.end > pin.start, "end", "must be later than \"start\"");
}

/// Of one block: a bit per node, x*16 + y*4 + z, for one pin.
struct Held {
  std::uint32_t pin;
  std::uint64_t nodes;
};

template <class Real>
class PinnedNodes {
 public:
  PinnedNodes(std::vector<PinDescription> pins, double spacing, int flat_axis)
      : pins_(std::move(pins)), spacing_(spacing), flat_axis_(flat_axis) {}

  void follow_topology(const State<Real>& state) {
    begin_.assign(1, 0);
    held_.clear();
    for (const Index3& block : state.grid.blocks()) {
      for (std::uint32_t k = 0; k < pins_.size(); ++k) {
        if (const std::uint64_t nodes = within(state, block, *pins_[k].solid)) held_.push_back({k, nodes});
      }
      begin_.push_back(static_cast<std::uint32_t>(held_.size()));
    }
  }

  /// Calls visit(node, pin) for the nodes with mass that are held.
  template <class Visit>
  void for_each_held(const NodeBlock<Real>& block, Visit visit) const {
    for (std::size_t i = begin_[block.block]; i < begin_[block.block + 1]; ++i) {
      const PinDescription& pin = pins_[held_[i].pin];
      if (block.time < pin.start || block.time >= pin.end) continue;
      for (std::uint64_t rest = held_[i].nodes; rest != 0; rest &= rest - 1) {
        const int node = std::countr_zero(rest);
        if (block.nodes[node * kNodeValues] > Real(0)) visit(node, pin);
      }
    }
  }

  void hold(NodeBlock<Real>& block) const {
    for_each_held(block, [&block](int node, const PinDescription& pin) {
      Real* const v = block.nodes + node * kNodeValues + 1;
      for (int axis = 0; axis < 3; ++axis) v[axis] = static_cast<Real>(pin.velocity[axis]);
    });
  }

  void list(const NodeBlock<Real>& block, std::vector<Hold<Real>>& holds) const {
    for_each_held(block, [&holds](int node, const PinDescription& pin) {
      Hold<Real> hold;
      hold.node = node;
      for (int axis = 0; axis < 3; ++axis) hold.velocity[axis] = static_cast<Real>(pin.velocity[axis]);
      holds.push_back(hold);
    });
  }

 private:
  std::uint64_t within(const State<Real>& state, const Index3& block, const Shape& shape) const {
    // The single node across plane strain stands for the plane through the origin.
    const auto place = [&](double x, double y, double z) {
      Vec3 at = state.world(block, {x, y, z});
      if (flat_axis_ >= 0) at[flat_axis_] = 0.0;
      return at;
    };
    if (shape.signed_distance(place(1.5, 1.5, 1.5)) > 1.5 * std::sqrt(3.0) * spacing_) return 0;
    std::uint64_t nodes = 0;
    for (int node = 0; node < kBlockNodes; ++node) {
      const bool inside = shape.signed_distance(place(node / 16, node / 4 % 4, node % 4)) <= 0.0;
      nodes |= std::uint64_t{inside} << node;
    }
    return nodes;
  }

  std::vector<PinDescription> pins_;
  double spacing_;
  int flat_axis_;
  std::vector<std::uint32_t> begin_;  // per block, in held_
  std::vector<Held> held_;
};

}  // namespace

std::vector<Example> Pins::examples() {
  return {{"pins",
           {},
           {R"(pins=[{"name": "foot", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.1, 1]}}])"}}};
}

void Pins::declare(Fields& fields) {
  fields.list("pins", false, "regions whose nodes are held, or drawn along, at a velocity", [this](Fields& f) {
    PinDescription pin;
    describe(f, pin);
    const bool taken =
        std::any_of(list.begin(), list.end(), [&](const PinDescription& p) { return p.name == pin.name; });
    f.check(!taken, "name", "\"" + pin.name + "\" is taken by another pin; choose another");
    list.push_back(pin);
  });
}

Result<void> Pins::prepare(const Surroundings& surroundings) {
  for (PinDescription& pin : list) {
    auto shape = surroundings.shape(pin.shape, "pins." + pin.name + ".shape");
    if (!shape) return shape.error();
    pin.solid = *shape;
    if (surroundings.flat_axis >= 0 && pin.velocity[surroundings.flat_axis] != 0.0) {
      return Error{ErrorKind::kBadScene, "must be zero along the flat axis (plane_strain)",
                   surroundings.where("pins." + pin.name + ".velocity")};
    }
  }
  return {};
}

double Pins::fastest(double from, double to) const {
  double most = 0.0;
  for (const PinDescription& pin : list) {
    if (pin.start < to && pin.end > from) most = std::max(most, pin.velocity.norm());
  }
  return most;
}

template <class Real>
void Pins::add_to_nodes(Assembly<Real>& assembly) const {
  const auto nodes =
      std::make_shared<PinnedNodes<Real>>(list, assembly.surroundings.spacing, assembly.surroundings.flat_axis);
  assembly.plan.order.push_back({{"pinned nodes", "pins", {"topology"}, {"pinned nodes"}},
                                 [nodes](State<Real>& state) { nodes->follow_topology(state); }});
  assembly.plan.speeds.push_back([pins = *this](double from, double to) { return pins.fastest(from, to); });
  assembly.plan.disturbances.push_back(
      {"pins", [pins = list](const State<Real>& state, const Index3& block, double from, double to) {
         return std::any_of(pins.begin(), pins.end(), [&](const PinDescription& pin) {
           const bool draws = pin.velocity.norm() > 0.0 && pin.start < to && pin.end > from;
           const bool changes = within_step(pin.start, from, to) || within_step(pin.end, from, to);
           return (draws || changes) &&
                  pin.solid->signed_distance(state.world(block, {1.5, 1.5, 1.5})) <= block_reach(state.spacing);
         });
       }});
  if (assembly.plan.implicit) {
    assembly.plan.contacts.push_back(
        {{"pinned nodes", "pins", {"pinned nodes"}, {}},
         [nodes](const NodeBlock<Real>& block, std::vector<Hold<Real>>& holds) { nodes->list(block, holds); }});
  }
  assembly.plan.holds.push_back({{"pins", "pins", {"node velocity", "pinned nodes"}, {"node velocity"}},
                                 [nodes](NodeBlock<Real>& block) { nodes->hold(block); }});
}

template void Pins::add_to_nodes(Assembly<float>&) const;
template void Pins::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
