#include "engine/effect/sink.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"

namespace repose {
namespace {

void describe(Fields& fields, Sink& sink) {
  fields.text("name", sink.name, "what messages and the ledger call it; no two sinks share a name", true);
  bool present = false;
  fields.object("shape", present, true, "particles within it end", [&](Fields& f) { describe(f, sink.shape); });
  fields.flag("outside", sink.outside, "particles outside the shape end: it is a domain");
  fields.number("start", sink.start, {.unit = "s", .meaning = "from when on", .low = 0.0});
  fields.number("end", sink.end, {.unit = "s", .meaning = "until when; without it, always", .low = 0.0});
  fields.check(sink.end > sink.start, "end", "must come after \"start\"");
}

struct BuiltSink {
  std::shared_ptr<const Shape> shape;
  bool outside;
  double start, end;  // s

  bool works(double time) const { return time >= start && time <= end; }
  /// Negative in the sink; its size is never more than the distance to the surface.
  double distance(const Vec3& x) const {
    return outside ? -shape->signed_distance(x) : shape->signed_distance(x);
  }
};

template <class Real>
class SinkRuntime {
 public:
  SinkRuntime(std::vector<BuiltSink> sinks, std::size_t first_outlet, int flat_axis)
      : sinks_(std::move(sinks)), first_outlet_(first_outlet), flat_axis_(flat_axis) {}

  bool due(const State<Real>& state, Moment moment) const {
    const bool look = moment == Moment::kEndOfFrame || state.counters.unseen_motion >= state.spacing;
    return look && std::any_of(sinks_.begin(), sinks_.end(),
                               [&](const BuiltSink& sink) { return sink.works(state.counters.time); });
  }

  void run(State<Real>& state, ParticleEdit<Real>& edit) const;

 private:
  struct Found {
    std::uint32_t place;
    std::uint32_t sink;
  };
  /// Of one block, per set.
  using FoundInBlock = std::vector<std::vector<Found>>;

  void look(const State<Real>& state, std::size_t occupied, FoundInBlock& found) const;

  std::vector<BuiltSink> sinks_;
  std::size_t first_outlet_;  // where they begin in the ledger
  int flat_axis_;
};

/// Particles of a block that lie in sinks; most blocks are far from all.
template <class Real>
void SinkRuntime<Real>::look(const State<Real>& state, std::size_t occupied, FoundInBlock& found) const {
  const Index3 block = state.grid.occupied_coordinates(occupied);
  const double reach = radius_of_particles() * state.spacing;
  const Vec3 middle = in_plane(state.world(block, kMiddleOfParticles), flat_axis_);
  std::vector<std::uint32_t> near;
  for (std::size_t s = 0; s < sinks_.size(); ++s) {
    if (sinks_[s].works(state.counters.time) && sinks_[s].distance(middle) < reach)
      near.push_back(static_cast<std::uint32_t>(s));
  }
  if (near.empty()) return;
  found.resize(state.sets.size());
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const ParticleSet<Real>& set = state.sets[k];
    for (std::uint32_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
      const Vec3 x = in_plane(state.world(block, set, p), flat_axis_);
      const auto in =
          std::find_if(near.begin(), near.end(), [&](std::uint32_t s) { return sinks_[s].distance(x) < 0.0; });
      if (in != near.end()) found[k].push_back({p, *in});
    }
  }
}

template <class Real>
void SinkRuntime<Real>::run(State<Real>& state, ParticleEdit<Real>& edit) const {
  state.counters.unseen_motion = 0.0;
  std::vector<FoundInBlock> blocks(state.grid.occupied_blocks().size());
  edit.threads.for_each(
      blocks.size(), [&](std::size_t occupied) { look(state, occupied, blocks[occupied]); }, 8);
  for (const FoundInBlock& found : blocks) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (const Found& particle : found[k]) {
        edit.sets[k].removed.push_back(particle.place);
        ++state.ledger.removed[(first_outlet_ + particle.sink) * state.sets.size() + k];
      }
    }
  }
}

}  // namespace

std::vector<Example> Sinks::examples() {
  return {
      {"sinks",
       {},
       {R"(sinks=[{"name": "drain", "shape": {"type": "box", "lower": [9, 9, 9], "upper": [10, 10, 10]}}])"}}};
}

void Sinks::declare(Fields& fields, const SceneOutline&) {
  fields.list("sinks", false, "where particles end", [this](Fields& f) {
    Sink sink;
    describe(f, sink);
    check_name(f, list, sink, "sink");
    list.push_back(sink);
  });
}

std::vector<std::string> Sinks::outlets() const {
  std::vector<std::string> names;
  for (const Sink& sink : list) names.push_back(sink.name);
  return names;
}

namespace {

template <class Real>
class Drains : public Effect<Real> {
 public:
  explicit Drains(const Sinks& sinks) : list_(sinks.list) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    for (const Sink& sink : list_) {
      auto shape = surroundings.shape(sink.shape, "sinks." + sink.name + ".shape");
      if (!shape) return shape.error();
      sinks_.push_back({*shape, sink.outside, sink.start, sink.end});
    }
    return {};
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.events.add({"sinks", "sinks"}, reads(kPosition), writes(kParticles),
                    std::make_shared<const SinkRuntime<Real>>(sinks_, plan.first_outlet(),
                                                              plan.state().topology.flat_axis));
  }

 private:
  std::vector<Sink> list_;
  std::vector<BuiltSink> sinks_;
};

}  // namespace

REPOSE_EFFECT(Sinks, Drains)

}  // namespace repose
