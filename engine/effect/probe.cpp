#include "engine/effect/probe.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"
#include "engine/effect/flow_probe.h"
#include "engine/effect/particle_energy.h"
#include "engine/effect/surface_probe.h"
#include "engine/plan/contact_log.h"

namespace repose {
namespace {

using Type = ProbeDescription::Type;

void describe_force(Fields& fields, ProbeDescription& probe) {
  fields.text("collider", probe.collider, "name of the collider that the material acts on", true);
  fields.vector("about", probe.about, {.unit = "m", .meaning = "the point that the torque is about"});
}

void describe_flow(Fields& fields, ProbeDescription& probe) {
  fields.vector("point", probe.plane.point, {.unit = "m", .meaning = "a point of the plane"});
  fields.vector("normal", probe.plane.normal, {.meaning = "direction that counts as forth, of any length"});
  const double length = probe.plane.normal.norm();
  fields.check(std::isfinite(length) && length > 1e-12, "normal", "must not be zero, for example [0, 1, 0]");
}

void describe_surface(Fields& fields, ProbeDescription& probe) {
  fields.vector("from", probe.line.from, {.unit = "m", .meaning = "where the line begins", .required = true});
  fields.vector("to", probe.line.to, {.unit = "m", .meaning = "where it ends", .required = true});
  fields.number("width", probe.line.width,
                {.unit = "m", .meaning = "of the columns across the line; 0: the grid's spacing", .low = 0.0});
  fields.integer("samples", probe.line.samples,
                 {.meaning = "columns from end to end; 0: one each spacing", .low = 0.0, .high = 10000.0});
}

void describe(Fields& fields, ProbeDescription& probe) {
  fields.text("name", probe.name, "what reports call it; no two probes share a name", true);
  const Alternative kinds[] = {
      {"force", "mean force (N), torque (N m) and impulse (N s) of the material on a collider",
       [&](Fields& f) { describe_force(f, probe); }},
      {"flow", "particles and mass that cross a plane, each way", [&](Fields& f) { describe_flow(f, probe); }},
      {"surface", "height of the free surface along a line", [&](Fields& f) { describe_surface(f, probe); }},
      {"energy", "energies, the work of moving solids, and what was dissipated", [](Fields&) {}},
  };
  int chosen = static_cast<int>(probe.type);
  fields.alternatives(chosen, kinds, "what is measured");
  probe.type = static_cast<Type>(chosen);
}

/// Of a probe of force: s; impulse of the solid on the material, its moment about the origin.
constexpr std::size_t kForceTallies = 7;

PassName name_of(const ProbeDescription& probe) {
  return {"probe " + probe.name, "probes"};
}

/// Impulse and moment of a solid on the material, summed over steps, to what the material does to it.
void report_force(const ProbeDescription& probe, const double* tallies, std::vector<Measurement>& report) {
  const double time = tallies[0] > 0.0 ? tallies[0] : 1.0;
  // Less than nothing rather than a minus sign, which would report -0 where nothing touches.
  const Vec3 impulse(0.0 - tallies[1], 0.0 - tallies[2], 0.0 - tallies[3]);
  const Vec3 moment = Vec3(0.0 - tallies[4], 0.0 - tallies[5], 0.0 - tallies[6]) - probe.about.cross(impulse);
  const auto add = [&](const char* quantity, const char* unit, const Vec3& value) {
    for (int axis = 0; axis < 3; ++axis) {
      report.push_back({probe.name, std::string(quantity) + "." + "xyz"[axis], unit, value[axis]});
    }
  };
  add("force", "N", impulse / time);
  add("torque", "N m", moment / time);
  add("impulse", "N s", impulse);
}

template <class Real>
void add_force(MeasureSlot<Real>& measures, const ProbeDescription& probe, std::size_t solid) {
  measures.add(name_of(probe), reads(kContactLog), writes(kReport), [&](auto at) {
    MeasurePass<Real> pass{.tallies = kForceTallies};
    pass.begin_frame = [](const State<Real>&, double* tallies) { std::fill_n(tallies, kForceTallies, 0.0); };
    pass.after_step = [at, solid](const State<Real>&, double dt, double* tallies) {
      const ContactSums sums = at.read(kContactLog).total(solid);
      tallies[0] += dt;
      for (int axis = 0; axis < 3; ++axis) {
        tallies[1 + axis] += sums.impulse[axis];
        tallies[4 + axis] += sums.moment[axis];
      }
    };
    pass.report = [probe](const State<Real>&, const double* tallies, std::vector<Measurement>& report) {
      report_force(probe, tallies, report);
    };
    return pass;
  });
}

template <class Real>
void add_flow(MeasureSlot<Real>& measures, const ProbeDescription& probe, std::size_t plane) {
  measures.add(name_of(probe), reads(kFlows), writes(kFlows, kReport), [&](auto at) {
    MeasurePass<Real> pass{.tallies = FlowCounts::kTallies};
    pass.begin_frame = [](const State<Real>&, double* tallies) {
      std::fill_n(tallies, FlowCounts::kTallies, 0.0);
    };
    pass.after_step = [at, plane](const State<Real>& state, double, double* tallies) {
      at.write(kFlows).take(state, plane, tallies);
    };
    pass.report = [name = probe.name](const State<Real>&, const double* tallies,
                                      std::vector<Measurement>& report) {
      report.push_back({name, "particles_forth", "", tallies[0]});
      report.push_back({name, "mass_forth", "kg", tallies[1]});
      report.push_back({name, "particles_back", "", tallies[2]});
      report.push_back({name, "mass_back", "kg", tallies[3]});
    };
    return pass;
  });
}

template <class Real>
void add_surface(MeasureSlot<Real>& measures, const ProbeDescription& probe, const Vec3& up) {
  measures.add(name_of(probe), reads(kPosition), writes(kReport), [&](auto) {
    MeasurePass<Real> pass;
    pass.report = [name = probe.name, line = probe.line, up](const State<Real>& state, const double*,
                                                             std::vector<Measurement>& report) {
      const std::vector<double> heights = surface_heights(state, line, up);
      for (std::size_t k = 0; k < heights.size(); ++k) {
        report.push_back({name, "height." + std::to_string(k), "m", heights[k]});
      }
    };
    return pass;
  });
}

/// Sums over the particles of a state: kinetic, affine, elastic and potential energy.
template <class Real>
struct EnergySum {
  std::vector<MaterialParameters> laws;  // per set
  Vec3 gravity;
  double affine_inertia;

  std::array<double, 4> operator()(const State<Real>& state) const {
    std::array<double, 4> all{};
    for (std::size_t k = 0; k < state.sets.size(); ++k) {
      const ParticleSet<Real>& set = state.sets[k];
      for (std::size_t occupied = 0; occupied < state.grid.occupied_blocks().size(); ++occupied) {
        const Index3& block = state.grid.occupied_coordinates(occupied);
        for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
          const Vec3 x = state.world(block, set, p);
          const ParticleEnergy energy = particle_energy(set, p, laws[k], affine_inertia);
          all[0] += energy.kinetic;
          all[1] += energy.affine;
          all[2] += energy.elastic;
          all[3] -= set.particle_mass * gravity.dot(x);
        }
      }
    }
    return all;
  }
};

template <class Real>
void add_energy(MeasureSlot<Real>& measures, const ProbeDescription& probe, bool solids,
                const EnergySum<Real>& sum) {
  const auto log = when(solids, kContactLog);
  measures.add(name_of(probe), reads(kPosition, kParticleVelocity, kHenckyStrain, log), writes(kReport),
               [&](auto at) {
                 MeasurePass<Real> pass{.tallies = 2};  // all that there was; work of solids
                 pass.begin_frame = [sum](const State<Real>& state, double* tallies) {
                   const auto energy = sum(state);
                   tallies[0] = energy[0] + energy[1] + energy[2] + energy[3];
                   tallies[1] = 0.0;
                 };
                 if (solids) {
                   pass.after_step = [at](const State<Real>&, double, double* tallies) {
                     const ContactLog& contacts = at.read(kContactLog);
                     for (std::size_t solid = 0; solid < contacts.solids(); ++solid)
                       tallies[1] += contacts.total(solid).work;
                   };
                 }
                 pass.report = [name = probe.name, sum](const State<Real>& state, const double* tallies,
                                                        std::vector<Measurement>& report) {
                   const auto energy = sum(state);
                   constexpr const char* kNames[] = {"kinetic", "affine", "elastic", "potential"};
                   for (std::size_t k = 0; k < energy.size(); ++k)
                     report.push_back({name, kNames[k], "J", energy[k]});
                   report.push_back({name, "work_of_solids", "J", tallies[1]});
                   const double now = energy[0] + energy[1] + energy[2] + energy[3];
                   report.push_back({name, "dissipated", "J", tallies[0] + tallies[1] - now});
                 };
                 return pass;
               });
}

}  // namespace

std::vector<Example> Probes::examples() {
  return {{"probes: force", {}, {R"(probes=[{"name": "weight", "type": "force", "collider": "floor"}])"}},
          {"probes: flow",
           {},
           {R"(probes=[{"name": "gate", "type": "flow", "point": [0, 0.3, 0], "normal": [0, 1, 0]}])"}}};
}

void Probes::declare(Fields& fields, const SceneOutline&) {
  fields.list("probes", false, "figures that are measured and reported per frame", [this](Fields& f) {
    ProbeDescription probe;
    describe(f, probe);
    check_name(f, list, probe, "probe");
    list.push_back(probe);
  });
}

namespace {

template <class Real>
class Measuring : public Effect<Real> {
 public:
  explicit Measuring(const Probes& probes) : list_(probes.list) {}

  /// Errors: 65, a force on a solid that is not there, a line that cannot be measured.
  Result<void> prepare(const Surroundings& surroundings) override {
    up_ = surroundings.up;
    gravity_ = surroundings.gravity;
    for (const ProbeDescription& probe : list_) {
      const auto refuse = [&](const std::string& key, const std::string& message) {
        return Error{ErrorKind::kBadScene, message, surroundings.where("probes." + probe.name + key)};
      };
      solids_of_.push_back(0);
      const auto& solids = surroundings.solids;
      while (solids_of_.back() < solids.size() && solids[solids_of_.back()].name != probe.collider)
        ++solids_of_.back();
      if (probe.type == Type::kForce && solids_of_.back() == solids.size())
        return refuse(".collider", "no collider is called \"" + probe.collider + "\"; name one of 'colliders'");
      if (probe.type == Type::kSurface) {
        const Vec3 line = probe.line.to - probe.line.from;
        if (!(line.cross(surroundings.up).norm() > 1e-9))
          return refuse(".to", "must not lie above or below \"from\"; the line runs along the ground");
      }
    }
    return {};
  }

  bool reads_contact_log() const override { return any(Type::kForce) || any(Type::kEnergy); }

  void add_to(PlanBuilder<Real>& plan) const override {
    if (any(Type::kFlow)) follow_flows(plan);
    const bool solids = plan.find(kContactLog) != nullptr;
    const double dx = plan.state().spacing;
    EnergySum<Real> energy{{}, gravity_, dx * dx / plan.transfer().nodes().inverse_d};
    for (const SetSlots<Real>& set : plan.sets) energy.laws.push_back(set.description.parameters);
    std::size_t flow = 0;
    for (std::size_t k = 0; k < list_.size(); ++k) {
      switch (list_[k].type) {
        case Type::kForce:
          add_force(plan.measures, list_[k], solids_of_[k]);
          break;
        case Type::kFlow:
          add_flow(plan.measures, list_[k], flow++);
          break;
        case Type::kSurface:
          add_surface(plan.measures, list_[k], up_);
          break;
        case Type::kEnergy:
          add_energy(plan.measures, list_[k], solids, energy);
          break;
      }
    }
  }

 private:
  bool any(Type type) const {
    return std::any_of(list_.begin(), list_.end(),
                       [type](const ProbeDescription& probe) { return probe.type == type; });
  }

  /// On which side of planes particles are, before they move and after.
  void follow_flows(PlanBuilder<Real>& plan) const {
    std::vector<FlowPlane> planes;
    for (const ProbeDescription& probe : list_) {
      if (probe.type == Type::kFlow) planes.push_back(probe.plane);
    }
    plan.make(kFlows, std::move(planes)).expect_sets(plan.sets.size());
    plan.after_sort.add({"blocks near planes of flow", "probes"}, reads(kTopology), writes(kFlows),
                        [](const auto& at) { at.write(kFlows).follow_topology(at.state()); });
    for (SetSlots<Real>& set : plan.sets) {
      set.before_motion.add({"places before motion", "probes"}, reads(kPosition, kFlows), writes(kPlacesBefore),
                            [](const auto& at) {
                              at.read(kFlows).note_places(at.occupied(), at.read(kPosition), at.count(),
                                                          at.write(kPlacesBefore));
                            });
      set.after_motion.add({"count flow", "probes"}, reads(kPosition, kPlacesBefore), writes(kFlows),
                           [k = set.index](const auto& at) {
                             at.write(kFlows).count(at.occupied(), k, at.read(kPosition), at.count(),
                                                    at.read(kPlacesBefore));
                           });
    }
  }

  std::vector<ProbeDescription> list_;
  std::vector<std::size_t> solids_of_;  // per probe: the solid that its force acts on
  Vec3 up_{0, 1, 0}, gravity_{0, 0, 0};
};

}  // namespace

REPOSE_EFFECT(Probes, Measuring)

}  // namespace repose
