#include "engine/effect/emitter.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"
#include "engine/effect/host_inlet.h"

namespace repose {
namespace {

/// Places are drawn in the bounds of a shape until one lies inside.
constexpr double kLeastShare = 1e-3;
/// Coordinates of cells have 32 bits.
constexpr double kMostCells = 1e9;

/// Of what makes particles by itself.
void describe_flow(Fields& fields, Emitter& emitter) {
  fields.integer("seed", emitter.seed, {.meaning = "of the random numbers that place particles", .low = 0.0});
  fields.number("start", emitter.start, {.unit = "s", .meaning = "when it begins", .low = 0.0});
  fields.number("end", emitter.end, {.unit = "s", .meaning = "when it ends; without it, never", .low = 0.0});
  fields.check(emitter.end > emitter.start, "end", "must come after \"start\"");
  fields.number(
      "spread", emitter.spread,
      {.meaning = "largest random velocity of a particle, as a share of its speed", .low = 0.0, .high = 1.0});
  fields.integer("most_particles", emitter.most_particles,
                 {.meaning = "it ends when it has made so many; 0: no limit", .low = 0.0, .high = 4.0e9});
  fields.number("most_volume", emitter.most_volume,
                {.unit = "m^3", .meaning = "it ends when it has made so much; 0: no limit", .low = 0.0});
}

void describe_column(Fields& fields, Emitter& emitter) {
  fields.vector("center", emitter.center, {.unit = "m", .meaning = "middle of the mouth", .required = true});
  fields.vector("normal", emitter.normal,
                {.meaning = "direction of any length that the column moves in, across the mouth"});
  fields.number("speed", emitter.speed,
                {.unit = "m/s", .meaning = "of the column", .low = 0.0, .low_open = true, .required = true});
  fields.check(emitter.normal.norm() > 1e-12, "normal", "must not be zero, for example [0, -1, 0]");
}

void describe_disc(Fields& fields, Emitter& emitter) {
  describe_column(fields, emitter);
  fields.number("radius", emitter.radius,
                {.unit = "m", .meaning = "of the mouth", .low = 0.0, .low_open = true, .required = true});
}

void describe_rectangle(Fields& fields, Emitter& emitter) {
  describe_column(fields, emitter);
  fields.vector("direction", emitter.direction, {.meaning = "of the mouth's first side, of any length"});
  fields.number("half_width", emitter.half_width,
                {.unit = "m",
                 .meaning = "from the middle of the mouth to its edge along \"direction\"",
                 .low = 0.0,
                 .low_open = true,
                 .required = true});
  fields.number("half_depth", emitter.half_depth,
                {.unit = "m",
                 .meaning = "the same across \"direction\"",
                 .low = 0.0,
                 .low_open = true,
                 .required = true});
  fields.check(emitter.direction.cross(emitter.normal).norm() > 1e-9 * emitter.normal.norm(), "direction",
               "must not be zero, nor along \"normal\"");
}

void describe_volume(Fields& fields, Emitter& emitter) {
  bool present = false;
  fields.object("shape", present, true, "the solid in which particles appear at random",
                [&](Fields& f) { describe(f, emitter.shape); });
  fields.number("rate", emitter.rate,
                {.unit = "m^3/s",
                 .meaning = "material per second, at the density that it is seeded with",
                 .low = 0.0,
                 .low_open = true,
                 .required = true});
  fields.vector("velocity", emitter.velocity, {.unit = "m/s", .meaning = "of particles that begin"});
}

void describe(Fields& fields, Emitter& emitter) {
  fields.text("name", emitter.name, "what messages and the ledger call it; no two emitters share a name", true);
  fields.text("material", emitter.material, "name of one of the materials", true);
  const Alternative kinds[] = {
      {"disc", "a column moves through a disc",
       [&](Fields& f) {
         describe_disc(f, emitter);
         describe_flow(f, emitter);
       }},
      {"rectangle", "a column moves through a rectangle",
       [&](Fields& f) {
         describe_rectangle(f, emitter);
         describe_flow(f, emitter);
       }},
      {"volume", "a solid is filled at random",
       [&](Fields& f) {
         describe_volume(f, emitter);
         describe_flow(f, emitter);
       }},
      {"host", "nothing begins by itself: a program that embeds the engine adds particles", [](Fields&) {}},
  };
  int chosen = static_cast<int>(emitter.type);
  fields.alternatives(chosen, kinds, "what kind of emitter");
  emitter.type = static_cast<Emitter::Type>(chosen);
  fields.integer("particles_per_cell", emitter.particles_per_cell,
                 {.meaning = "particles in a full cell", .low = 1.0, .high = 512.0});
}

/// What no key can say alone, and what a host may have filled in; empty if all is right.
std::string wrong_with(const Emitter& emitter, const Flow& flow, const Surroundings& around) {
  const bool volume = emitter.type == Emitter::Type::kVolume;
  const Vec3 motion = volume ? emitter.velocity : emitter.normal;
  if (!volume && !(motion.norm() > 1e-12 && emitter.speed > 0.0))
    return "needs a normal and a speed that are not zero";
  if (around.flat_axis >= 0) {
    if (std::abs(motion[around.flat_axis]) > 1e-9 * motion.norm())
      return "must not move along the flat axis (plane_strain)";
    const double along = std::abs(emitter.direction.normalized()[around.flat_axis]);
    if (emitter.type == Emitter::Type::kRectangle && along > 1e-9 && along < 1.0 - 1e-9)
      return "the rectangle's direction must lie in the plane, or across it (plane_strain)";
  }
  if (!(std::isfinite(flow.rate) && flow.rate > 0.0))
    return "makes no particles; is its size or its rate zero?";
  const double reach =
      emitter.center.cwiseAbs().maxCoeff() + emitter.radius + emitter.half_width + emitter.half_depth;
  if (!volume && !(reach < kMostCells * around.spacing)) return "reaches beyond 1e9 cells from the origin";
  return "";
}

/// The share of its bounds that a shape fills; 0 if it is endless.
Result<double> share_of_bounds(const Shape& shape, int flat_axis) {
  Vec3 size = shape.bounds().upper - shape.bounds().lower;
  if (!size.allFinite()) return 0.0;
  if (flat_axis < 0) return shape.volume() / size.prod();
  const auto area = shape.section_area(flat_axis);
  if (!area) return area.error();
  size[flat_axis] = 1.0;
  return *area / size.prod();
}

/// One emitter at work.
template <class Real>
struct Working {
  Stream stream;
  InletPlace place;
  SetDescription description;
  double patience;  ///< s that a particle may wait
};

/// The time in which what begins goes about a cell, at its speed and as it falls; where nothing moves it, that
/// in which a cell's worth has come together.
double patience_of(const Emitter& emitter, const Flow& flow, const Surroundings& around) {
  const double speed = emitter.type == Emitter::Type::kVolume ? emitter.velocity.norm() : emitter.speed;
  const double leaving = speed + std::sqrt(2.0 * around.gravity.norm() * around.spacing);
  return leaving > 0.0 ? around.spacing / leaving : static_cast<double>(emitter.particles_per_cell) / flow.rate;
}

template <class Real>
class EmitterRuntime {
 public:
  EmitterRuntime(std::vector<Working<Real>> working, const Surroundings& surroundings,
                 std::function<void(Newcomers<Real>&)> initialize)
      : working_(std::move(working)), surroundings_(surroundings), initialize_(std::move(initialize)) {}

  bool due(const State<Real>& state, Moment moment) const {
    const double now = state.counters.time;
    return std::any_of(working_.begin(), working_.end(), [&](const Working<Real>& working) {
      const Flow& flow = working.stream.flow();
      const std::uint64_t made = state.ledger.emitted[working.place.entry];
      if (flow.count(now) <= made) return false;
      return moment == Moment::kEndOfFrame || now - flow.crossing(made) >= working.patience;
    });
  }

  /// All that has crossed by now, of all emitters: the sort event has to be paid for anyway.
  void run(State<Real>& state, ParticleEdit<Real>& edit) const {
    for (const Working<Real>& working : working_) {
      std::uint64_t& made = state.ledger.emitted[working.place.entry];
      const std::uint64_t all = working.stream.flow().count(state.counters.time);
      if (all > made) emit(working, made, all, state, edit);
      made = std::max(made, all);
    }
  }

 private:
  void emit(const Working<Real>& working, std::uint64_t first, std::uint64_t last, const State<Real>& state,
            ParticleEdit<Real>& edit) const;

  std::vector<Working<Real>> working_;
  Surroundings surroundings_;
  std::function<void(Newcomers<Real>&)> initialize_;
};

/// Serials [first, last), each where free flight has brought it since it crossed.
template <class Real>
void EmitterRuntime<Real>::emit(const Working<Real>& working, std::uint64_t first, std::uint64_t last,
                                const State<Real>& state, ParticleEdit<Real>& edit) const {
  const double now = state.counters.time, ramp = surroundings_.gravity_ramp;
  const Vec3 gravity = surroundings_.gravity * (ramp > 0.0 ? std::min(1.0, now / ramp) : 1.0);
  SetEdit<Real>& added = edit.add(state, working.place.set, last - first);
  ParticleSet<Real>& set = added.newcomers;
  std::vector<Vec3> places(set.count);
  for (std::size_t p = 0; p < set.count; ++p) {
    const Stream::Birth birth = working.stream.birth(first + p);
    const double age = std::max(0.0, now - working.stream.flow().crossing(first + p));
    const Vec3 v = birth.velocity + age * gravity;
    places[p] = birth.position + age * (birth.velocity + 0.5 * age * gravity);
    put_at(places[p], surroundings_, p, added);
    for (int axis = 0; axis < 3; ++axis) set.velocity[axis][p] = static_cast<Real>(v[axis]);
  }
  Newcomers<Real> newcomers{
      set,
      0,
      set.count,
      working.description,
      surroundings_,
      [&places](std::size_t p) { return places[p]; },
      [&working, first](std::size_t p) { return working.stream.flow().crossing(first + p); }};
  initialize_(newcomers);
}

}  // namespace

std::vector<Example> Emitters::examples() {
  return {{"emitters",
           {},
           {R"(emitters=[{"name": "spout", "material": "sand", "type": "disc", "center": [0.5, 1.5, 0.5],
               "normal": [0, -1, 0], "radius": 0.05, "speed": 1}])"}}};
}

void Emitters::declare(Fields& fields, const SceneOutline& outline) {
  fields.list("emitters", false, "where particles begin during the run", [&](Fields& f) {
    Emitter emitter;
    describe(f, emitter);
    check_name(f, list, emitter, "emitter");
    std::string names;
    for (const std::string& name : outline.materials) names += (names.empty() ? "\"" : ", \"") + name + "\"";
    const auto& materials = outline.materials;
    const bool known = std::find(materials.begin(), materials.end(), emitter.material) != materials.end();
    f.check(materials.empty() || known, "material",
            "no material \"" + emitter.material + "\"; choose among " + names);
    list.push_back(emitter);
  });
}

bool Emitters::any_host() const {
  return std::any_of(list.begin(), list.end(), [](const Emitter& e) { return e.type == Emitter::Type::kHost; });
}

std::vector<Inlet> Emitters::inlets() const {
  std::vector<Inlet> inlets;
  for (const Emitter& e : list) {
    const double moves = e.type == Emitter::Type::kVolume ? e.velocity.norm()
                         : e.type == Emitter::Type::kHost ? 0.0
                                                          : e.speed;
    const double speed = (1.0 + e.spread) * moves;
    inlets.push_back({e.name, "emitters", e.material, e.particles_per_cell, speed});
  }
  return inlets;
}

double Emitters::particles_by(double time, double spacing, int flat_axis) const {
  double particles = 0.0;
  for (const Emitter& emitter : list) {
    particles += static_cast<double>(flow_of(emitter, spacing, flat_axis).count(time));
  }
  return particles;
}

namespace {

template <class Real>
class Sources : public Effect<Real> {
 public:
  explicit Sources(const Emitters& emitters) : list_(emitters.list) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    surroundings_ = surroundings;
    for (const Emitter& emitter : list_) {
      const std::string key = "emitters." + emitter.name;
      const Flow flow = flow_of(emitter, surroundings.spacing, surroundings.flat_axis);
      const std::string wrong =
          emitter.type == Emitter::Type::kHost ? "" : wrong_with(emitter, flow, surroundings);
      if (!wrong.empty()) return Error{ErrorKind::kBadScene, wrong, surroundings.where(key)};
      shapes_.emplace_back();
      if (emitter.type == Emitter::Type::kHost) continue;
      if (emitter.type != Emitter::Type::kVolume) continue;
      auto shape = volume_of(emitter, key + ".shape", surroundings);
      if (!shape) return shape.error();
      shapes_.back() = *shape;
    }
    return {};
  }

  Bounds mouths() const override {
    Bounds all;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      if (list_[k].type == Emitter::Type::kHost) continue;
      const Vec3& center = list_[k].center;
      const Bounds mouth = shapes_[k] != nullptr ? shapes_[k]->bounds() : Bounds{center, center};
      all.lower = all.lower.cwiseMin(mouth.lower);
      all.upper = all.upper.cwiseMax(mouth.upper);
    }
    return all;
  }

  /// An event: when the oldest particle that has crossed has gone about a cell, and at the end of a frame.
  void add_to(PlanBuilder<Real>& plan) const override {
    std::vector<Working<Real>> working;
    std::vector<typename HostInlets<Real>::Inlet> of_host;
    for (std::size_t e = 0; e < list_.size(); ++e) {
      const InletPlace place = plan.inlet(e);
      if (list_[e].type == Emitter::Type::kHost) {
        of_host.push_back({list_[e].name, place, plan.sets[place.set].description});
        continue;
      }
      Stream stream(list_[e], shapes_[e], surroundings_.spacing, surroundings_.flat_axis);
      const double patience = patience_of(list_[e], stream.flow(), surroundings_);
      working.push_back({std::move(stream), place, plan.sets[place.set].description, patience});
    }
    if (!of_host.empty())
      plan.make(kHostInlets, std::move(of_host), plan.first_outlet(), surroundings_, plan.initialize());
    if (working.empty()) return;
    plan.events.add(
        {"emit", "emitters"}, reads(), writes(kParticles),
        std::make_shared<const EmitterRuntime<Real>>(std::move(working), surroundings_, plan.initialize()));
  }

 private:
  /// A solid in which places can be drawn at random.
  static Result<std::shared_ptr<const Shape>> volume_of(const Emitter& emitter, const std::string& key,
                                                        const Surroundings& surroundings) {
    auto shape = surroundings.shape(emitter.shape, key);
    if (!shape) return shape.error();
    const auto share = share_of_bounds(**shape, surroundings.flat_axis);
    if (!share) return Error{share.error().kind, share.error().text(), surroundings.where(key)};
    const Bounds bounds = (*shape)->bounds();
    const double reach = std::max(bounds.lower.cwiseAbs().maxCoeff(), bounds.upper.cwiseAbs().maxCoeff());
    if (*share > kLeastShare && reach < kMostCells * surroundings.spacing) return *shape;
    return Error{ErrorKind::kBadScene,
                 "is endless, too far away, or too thin for places to be drawn in it at random; a box or a "
                 "sphere will do",
                 surroundings.where(key)};
  }

  std::vector<Emitter> list_;
  std::vector<std::shared_ptr<const Shape>> shapes_;  // per emitter; null where it has none
  Surroundings surroundings_;
};

}  // namespace

REPOSE_EFFECT(Emitters, Sources)

}  // namespace repose
