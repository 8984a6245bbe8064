#include "engine/effect/moisture.h"

#include <algorithm>
#include <cmath>

namespace repose {

std::vector<Example> Moisture::examples() {
  return {
      {"moisture", {}, {R"(materials.sand.moisture={"cohesion_change": 500, "initial": 0.5})"}},
      {"moisture, wetting",
       {},
       {R"(materials.sand.moisture={"cohesion_change": 500})",
        R"(wetting=[{"name": "rain", "shape": {"type": "box", "lower": [-9, -9, -9], "upper": [0.5, 9, 9]}}])"}}};
}

void Moisture::declare(Fields& fields) {
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

void Moisture::declare_in_sand(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, MoistureParameters& p) {
    f.number("initial", p.initial, {.meaning = "saturation at the start", .low = 0.0, .high = 1.0});
    f.number("cohesion_change", p.cohesion_change,
             {.unit = "Pa",
              .meaning = "what full saturation adds to the cohesion, linearly below; negative weakens, and no "
                         "cohesion falls under zero"});
  };
  declare_entry(fields, kName, "a saturation per particle that changes its cohesion", material, describe);
}

Result<void> Moisture::prepare(const Surroundings& surroundings) {
  for (Source& source : sources) {
    auto shape = surroundings.shape(source.shape, "wetting." + source.name + ".shape");
    if (!shape) return shape.error();
    source.solid = *shape;
  }
  return {};
}

std::vector<Channel> Moisture::channels(const SetDescription& set) const {
  const MoistureParameters* p = find(set);
  return p == nullptr ? std::vector<Channel>{} : std::vector<Channel>{{kSaturation, p->initial}};
}

namespace {

/// w changes in particles that lie within a source now. Blocks out of its reach are passed over by one
/// distance.
template <class Access>
void wet(const Moisture::Source& source, const Access& at) {
  if (at.time() < source.start || at.time() >= source.end) return;
  const Vec3 middle(kMiddleOfParticles.data());
  if (source.solid->signed_distance(at.world(middle)) > radius_of_particles() * at.spacing()) return;
  auto* const w = at.write(Moisture::kSaturation);
  using Real = std::remove_pointer_t<std::remove_const_t<decltype(w)>>;
  const auto change = static_cast<Real>(source.rate * static_cast<double>(at.dt()));
  const auto x = at.read(kPosition);
  for (std::size_t i = 0; i < at.count(); ++i) {
    if (source.solid->signed_distance(at.world({double(x[0][i]), double(x[1][i]), double(x[2][i])})) > 0.0)
      continue;
    w[i] = std::clamp(w[i] + change, Real(0), Real(1));
  }
}

}  // namespace

/// Not just before the return map: what stands there an implicit step runs as often as it evaluates.
template <class Real>
void Moisture::add_after_motion(Assembly<Real>& assembly, std::size_t set) const {
  if (sources.empty() || find(assembly.sets[set]) == nullptr) return;
  assembly.gather(set).add({"wetting", "wetting"}, reads(kPosition, kSaturation), writes(kSaturation),
                           [sources = sources](const auto& at) {
                             for (const Source& source : sources) wet(source, at);
                           });
}

template <class Real>
void Moisture::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const MoistureParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  const auto change = static_cast<Real>(assembly.sets[set].sand().cohesion_strain(p->cohesion_change));
  assembly.gather(set).add({"moisture", why()}, reads(kSaturation, kCohesion), writes(kCohesion),
                           [change](const auto& at) {
                             const Real* const w = at.read(kSaturation);
                             Real* const cohesion = at.write(kCohesion);
                             for (std::size_t i = 0; i < at.count(); ++i) {
                               cohesion[i] = std::max(cohesion[i] + change * w[i], Real(0));
                             }
                           });
}

/// Sand that grows wet or dry may give way, so it does not sleep.
template <class Real>
void Moisture::add_to_nodes(Assembly<Real>& assembly) const {
  if (sources.empty()) return;
  assembly.plan.disturbances.push_back(
      {"wetting", [sources = sources](const State<Real>& state, const Index3& block, double from, double to) {
         return std::any_of(sources.begin(), sources.end(), [&](const Source& source) {
           return source.start < to && source.end > from && may_hold_particles(*source.solid, state, block);
         });
       }});
}

template void Moisture::add_to_nodes(Assembly<float>&) const;
template void Moisture::add_to_nodes(Assembly<double>&) const;
template void Moisture::add_after_motion(Assembly<float>&, std::size_t) const;
template void Moisture::add_after_motion(Assembly<double>&, std::size_t) const;
template void Moisture::add_before_return(Assembly<float>&, std::size_t) const;
template void Moisture::add_before_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
