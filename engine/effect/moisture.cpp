#include "engine/effect/moisture.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"
#include "engine/effect/near_shape.h"

namespace repose {

std::vector<Example> Moisture::examples() {
  return {
      {"moisture", {}, {R"(materials.sand.moisture={"cohesion_change": 500, "initial": 0.5})"}},
      {"moisture, wetting",
       {},
       {R"(materials.sand.moisture={"cohesion_change": 500})",
        R"(wetting=[{"name": "rain", "shape": {"type": "box", "lower": [-9, -9, -9], "upper": [0.5, 9, 9]}}])"}}};
}

void Moisture::declare(Fields& fields, const SceneOutline&) {
  fields.list("wetting", false, "regions that wet sand which has \"moisture\", or dry it", [this](Fields& f) {
    Source source;
    bool present = false;
    f.text("name", source.name, "what messages call it", true);
    f.object("shape", present, true, "where", [&](Fields& shape) { describe(shape, source.shape); });
    f.number("rate", source.rate, {.unit = "1/s", .meaning = "change of saturation; negative dries"});
    f.number("start", source.start, {.unit = "s", .meaning = "time of the first drop", .low = 0.0});
    f.number("end", source.end, {.unit = "s", .meaning = "time of the last; without it, never", .low = 0.0});
    f.check(source.end > source.start, "end", "must come after \"start\"");
    sources.push_back(source);
  });
}

void Moisture::declare_in_cone(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, MoistureParameters& p) {
    f.number("initial", p.initial, {.meaning = "saturation at the start", .low = 0.0, .high = 1.0});
    f.number("cohesion_change", p.cohesion_change,
             {.unit = "Pa",
              .meaning = "what full saturation adds to the cohesion, linearly below; negative weakens, and no "
                         "cohesion falls under zero"});
  };
  declare_entry(fields, kName, "a saturation per particle that changes its cohesion", material, describe);
}

std::vector<Channel> Moisture::channels(const SetDescription& set) const {
  const MoistureParameters* p = find(set);
  return p == nullptr ? std::vector<Channel>{} : std::vector<Channel>{{kSaturation, p->initial}};
}

namespace {

struct Wetting {
  std::shared_ptr<const Shape> shape;
  double rate, start, end;
};

/// w changes in particles that lie within a source now. Blocks out of its reach are passed over by one
/// distance.
template <class Access>
void wet(const Wetting& source, const Access& at) {
  if (at.time() < source.start || at.time() >= source.end) return;
  const Vec3 middle(kMiddleOfParticles.data());
  if (source.shape->signed_distance(at.world(middle)) > radius_of_particles() * at.spacing()) return;
  auto* const w = at.write(Moisture::kSaturation);
  using Real = std::remove_pointer_t<std::remove_const_t<decltype(w)>>;
  const auto change = static_cast<Real>(source.rate * static_cast<double>(at.dt()));
  const auto x = at.read(kPosition);
  for (std::size_t i = 0; i < at.count(); ++i) {
    if (source.shape->signed_distance(at.world({double(x[0][i]), double(x[1][i]), double(x[2][i])})) > 0.0)
      continue;
    w[i] = std::clamp(w[i] + change, Real(0), Real(1));
  }
}

template <class Real>
class WettingOfSand : public Effect<Real> {
 public:
  explicit WettingOfSand(const Moisture& moisture) : moisture_(moisture) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    for (const Moisture::Source& source : moisture_.sources) {
      auto shape = surroundings.shape(source.shape, "wetting." + source.name + ".shape");
      if (!shape) return shape.error();
      sources_.push_back({*shape, source.rate, source.start, source.end});
    }
    return {};
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(moisture_, [&](SetSlots<Real>& set, const MoistureParameters& p) {
      add_wetting(set);
      add_cohesion(set, p);
    });
    if (sources_.empty()) return;
    // Sand that grows wet or dry may give way, so it does not sleep.
    plan.rest.wake(
        "wetting", [sources = sources_](const State<Real>& state, const Index3& block, double from, double to) {
          return std::any_of(sources.begin(), sources.end(), [&](const Wetting& source) {
            return source.start < to && source.end > from && may_hold_particles(*source.shape, state, block);
          });
        });
  }

 private:
  /// Not just before the return map: what stands there an implicit step runs as often as it evaluates.
  void add_wetting(SetSlots<Real>& set) const {
    if (sources_.empty()) return;
    set.after_motion.add({"wetting", "wetting"}, reads(kPosition, Moisture::kSaturation),
                         writes(Moisture::kSaturation), [sources = sources_](const auto& at) {
                           for (const Wetting& source : sources) wet(source, at);
                         });
  }

  void add_cohesion(SetSlots<Real>& set, const MoistureParameters& p) const {
    const SetDescription& of = set.description;
    const auto change = static_cast<Real>(of.cone()->cohesion_strain(of.elasticity(), p.cohesion_change));
    set.before_return.add({"moisture", moisture_.why()}, reads(Moisture::kSaturation, kCohesion),
                          writes(kCohesion), [change](const auto& at) {
                            const Real* const w = at.read(Moisture::kSaturation);
                            Real* const cohesion = at.write(kCohesion);
                            for (std::size_t i = 0; i < at.count(); ++i) {
                              cohesion[i] = std::max(cohesion[i] + change * w[i], Real(0));
                            }
                          });
  }

  Moisture moisture_;
  std::vector<Wetting> sources_;
};

}  // namespace

REPOSE_EFFECT(Moisture, WettingOfSand)

}  // namespace repose
