#include "engine/effect/pin.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/effect/effect.h"
#include "engine/effect/near_shape.h"

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

/// A pin that is ready to hold.
struct ReadyPin {
  Vec3 velocity;  ///< m/s
  double start, end;
  std::shared_ptr<const Shape> shape;

  /// Whether it holds at some time between two (s).
  bool holds(double from, double to) const { return start < to && end > from; }
};

/// Of one block: a bit per node, x*16 + y*4 + z, for one pin.
struct Held {
  std::uint32_t pin;
  std::uint64_t nodes;
};

template <class Real>
class PinnedNodes {
 public:
  explicit PinnedNodes(std::vector<ReadyPin> pins) : pins_(std::move(pins)) {}

  void follow_topology(const State<Real>& state) {
    begin_.assign(1, 0);
    held_.clear();
    for (const Index3& block : state.grid.blocks()) {
      for (std::uint32_t k = 0; k < pins_.size(); ++k) {
        if (const std::uint64_t nodes = within({state, block}, *pins_[k].shape)) held_.push_back({k, nodes});
      }
      begin_.push_back(static_cast<std::uint32_t>(held_.size()));
    }
  }

  /// Calls visit(node, pin) for the nodes of a block with mass that are held at a time (s).
  template <class Visit>
  void for_each_held(std::size_t block, const Real* nodes, double time, Visit visit) const {
    for (std::size_t i = begin_[block]; i < begin_[block + 1]; ++i) {
      const ReadyPin& pin = pins_[held_[i].pin];
      if (time < pin.start || time >= pin.end) continue;
      for (std::uint64_t rest = held_[i].nodes; rest != 0; rest &= rest - 1) {
        const int node = std::countr_zero(rest);
        if (nodes[node * kNodeValues] > Real(0)) visit(node, pin);
      }
    }
  }

  std::size_t bytes() const {
    return begin_.capacity() * sizeof(std::uint32_t) + held_.capacity() * sizeof(Held);
  }

 private:
  std::uint64_t within(const BlockPlace<Real>& place, const Shape& shape) const {
    if (!may_hold_nodes(shape, place)) return 0;
    std::uint64_t nodes = 0;
    for (std::size_t node = 0; node < kBlockNodes; ++node) {
      const bool inside = shape.signed_distance(place.node(node)) <= 0.0;
      nodes |= std::uint64_t{inside} << node;
    }
    return nodes;
  }

  std::vector<ReadyPin> pins_;
  std::vector<std::uint32_t> begin_;  // per block, in held_
  std::vector<Held> held_;
};

constexpr TableHandle<"pinned nodes", PinnedNodes> kPinnedNodes;

}  // namespace

std::vector<Example> Pins::examples() {
  return {
      {"pins",
       {},
       {R"(pins=[{"name": "foot", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 0.07, 1]}}])"}}};
}

void Pins::declare(Fields& fields, const SceneOutline&) {
  fields.list("pins", false, "regions whose nodes are held, or drawn along, at a velocity", [&](Fields& f) {
    PinDescription pin;
    describe(f, pin);
    check_name(f, list, pin, "pin");
    list.push_back(pin);
  });
}

namespace {

template <class Real>
class HeldNodes : public Effect<Real> {
 public:
  explicit HeldNodes(const Pins& pins) : list_(pins.list) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    for (const PinDescription& pin : list_) {
      const std::string key = "pins." + pin.name;
      auto shape = surroundings.shape(pin.shape, key + ".shape");
      if (!shape) return shape.error();
      pins_.push_back({pin.velocity, pin.start, pin.end, *shape});
      if (surroundings.flat_axis >= 0 && pin.velocity[surroundings.flat_axis] != 0.0) {
        return Error{ErrorKind::kBadScene, "must be zero along the flat axis (plane_strain)",
                     surroundings.where(key + ".velocity")};
      }
    }
    return {};
  }

  double top_speed(const Bounds&) const override { return fastest(pins_, 0.0, kForEver); }

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.make(kPinnedNodes, pins_);
    plan.after_sort.add({"pinned nodes", "pins"}, reads(kTopology), writes(kPinnedNodes),
                        [](const auto& at) { at.write(kPinnedNodes).follow_topology(at.state()); });
    plan.drives.by_drawing(fastest(pins_, 0.0, kForEver));
    plan.speeds.add([pins = pins_](double from, double to) { return fastest(pins, from, to); });
    plan.rest.wake("pins",
                   [pins = pins_](const State<Real>& state, const Index3& block, double from, double to) {
                     return std::any_of(pins.begin(), pins.end(), [&](const ReadyPin& pin) {
                       const bool draws = pin.velocity.norm() > 0.0 && pin.holds(from, to);
                       const bool changes = within_step(pin.start, from, to) || within_step(pin.end, from, to);
                       return (draws || changes) && may_hold_particles(*pin.shape, state, block);
                     });
                   });
    plan.constraints.add(
        {"pins", "pins"}, reads(kNodeVelocity, kPinnedNodes),
        [](const auto& at, std::vector<Constraint<Real>>& constraints) {
          at.read(kPinnedNodes)
              .for_each_held(at.block(), at.read(kNodeVelocity), at.time(), [&](int node, const ReadyPin& pin) {
                Constraint<Real> constraint;
                constraint.node = node;
                for (int axis = 0; axis < 3; ++axis)
                  constraint.velocity[axis] = static_cast<Real>(pin.velocity[axis]);
                constraints.push_back(constraint);
              });
        });
  }

 private:
  static double fastest(const std::vector<ReadyPin>& pins, double from, double to) {
    double most = 0.0;
    for (const ReadyPin& pin : pins) {
      if (pin.holds(from, to)) most = std::max(most, pin.velocity.norm());
    }
    return most;
  }

  std::vector<PinDescription> list_;
  std::vector<ReadyPin> pins_;
};

}  // namespace

REPOSE_EFFECT(Pins, HeldNodes)

}  // namespace repose
