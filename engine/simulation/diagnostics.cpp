#include "engine/simulation/diagnostics.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/particle_energy.h"

namespace repose {
namespace {

/// Sums over particles.
struct Sums : Diagnostics {
  Vec3 momentum{0, 0, 0}, angular_momentum{0, 0, 0}, first_moment{0, 0, 0};
  Bounds box;

  Diagnostics finish(const Vec3& gravity) {
    Diagnostics& report = *this;
    report.momentum = to_triple(momentum);
    report.angular_momentum = to_triple(angular_momentum);
    if (particles > 0) {
      report.lower = to_triple(box.lower);
      report.upper = to_triple(box.upper);
    }
    const Vec3 center = mass > 0.0 ? Vec3(first_moment / mass) : first_moment;
    report.center_of_mass = to_triple(center);
    report.potential_energy = -mass * gravity.dot(center);
    return report;
  }
};

/// Adds one particle to the sums of its block.
template <class Real>
void add_particle(const ParticleSet<Real>& set, std::size_t p, const MaterialDescription& material,
                  const Vec3& x, double affine_inertia, Sums& sums) {
  const double mass = set.particle_mass;
  Vec3 v;
  Mat3 c;
  for (int axis = 0; axis < 3; ++axis) v[axis] = set.velocity[axis][p];
  for (int k = 0; k < kAffineComponents; ++k) c(k / 3, k % 3) = set.keeps_affine ? set.affine[k][p] : Real(0);
  const double trace = double(set.strain[0][p]) + double(set.strain[3][p]) + double(set.strain[5][p]);
  const ParticleEnergy energy = particle_energy(set, p, material.parameters, affine_inertia);
  ++sums.particles;
  sums.mass += mass;
  sums.volume += set.particle_volume * std::exp(trace);
  sums.kinetic_energy += energy.kinetic;
  sums.affine_energy += energy.affine;
  sums.elastic_energy += energy.elastic;
  sums.momentum += mass * v;
  // B = C D; its axial part is the angular momentum that the particle carries within (Jiang et al. 2015).
  const Vec3 axial(c(2, 1) - c(1, 2), c(0, 2) - c(2, 0), c(1, 0) - c(0, 1));
  sums.angular_momentum += mass * (x.cross(v) + affine_inertia * axial);
  sums.first_moment += mass * x;
  sums.box.lower = sums.box.lower.cwiseMin(x);
  sums.box.upper = sums.box.upper.cwiseMax(x);
  sums.max_speed = std::max(sums.max_speed, v.norm());
}

void note_depth(const std::vector<Solid>& solids, const Vec3& x, std::uint32_t id, Sums& sums) {
  for (const Solid& solid : solids) {
    const double depth = -solid.distance(x);
    if (depth <= sums.deepest) continue;
    sums.deepest = depth;
    sums.deepest_solid = solid.name;
    sums.deepest_id = id;
  }
}

void merge(const Sums& block, Sums& sums) {
  if (block.particles == 0) return;
  sums.particles += block.particles;
  sums.mass += block.mass;
  sums.volume += block.volume;
  sums.kinetic_energy += block.kinetic_energy;
  sums.affine_energy += block.affine_energy;
  sums.elastic_energy += block.elastic_energy;
  sums.momentum += block.momentum;
  sums.angular_momentum += block.angular_momentum;
  sums.first_moment += block.first_moment;
  sums.box.lower = sums.box.lower.cwiseMin(block.box.lower);
  sums.box.upper = sums.box.upper.cwiseMax(block.box.upper);
  sums.max_speed = std::max(sums.max_speed, block.max_speed);
  if (block.deepest > sums.deepest) {
    sums.deepest = block.deepest;
    sums.deepest_solid = block.deepest_solid;
    sums.deepest_id = block.deepest_id;
  }
}

}  // namespace

template <class Real>
Diagnostics diagnose(const Scene& scene, const std::vector<Solid>& solids, const State<Real>& state,
                     Threads& threads) {
  const auto occupied_blocks = state.grid.occupied_blocks();
  std::vector<Sums> blocks(occupied_blocks.size());
  // D, the second moment of a stencil about its particle.
  const double inverse_d = kStencilFigures[static_cast<std::size_t>(scene.grid.stencil)].inverse_d;
  const double affine_inertia = state.spacing * state.spacing / inverse_d;
  threads.for_each(occupied_blocks.size(), [&](std::size_t occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    const bool near = any_near(solids, state, block);
    for (const auto& set : state.sets) {
      const MaterialDescription& material = scene.materials[static_cast<std::size_t>(set.material)];
      for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
        const Vec3 x = state.world(block, set, p);
        add_particle(set, p, material, x, affine_inertia, blocks[occupied]);
        if (near) note_depth(solids, x, set.id[p], blocks[occupied]);
      }
    }
  });
  Sums sums;
  for (const Sums& block : blocks) merge(block, sums);
  return sums.finish(scene.effect<Gravity>().acceleration);
}

template <class Real>
LedgerReport ledger_report(const Scene& scene, const State<Real>& state) {
  LedgerReport report;
  report.initial = state.ledger.initial;
  const std::size_t sets = state.sets.size();
  const auto add = [&state](LedgerReport::Entry& entry, std::size_t set, std::uint64_t particles) {
    entry.particles += particles;
    entry.mass += static_cast<double>(particles) * state.sets[set].particle_mass;
  };
  const std::vector<std::uint64_t>& emitted = state.ledger.emitted;
  for (std::size_t e = 0; e < emitted.size(); ++e) {
    const std::size_t set = sets - emitted.size() + e;
    add(report.emitters.emplace_back(LedgerReport::Entry{state.sets[set].name}), set, emitted[e]);
    add(report.emitted, set, emitted[e]);
  }
  const std::vector<std::string> names = outlets(scene);
  for (std::size_t s = 0; s < names.size(); ++s) {
    LedgerReport::Entry& sink = report.sinks.emplace_back(LedgerReport::Entry{names[s]});
    for (std::size_t k = 0; k < sets; ++k) {
      add(sink, k, state.ledger.removed[s * sets + k]);
      add(report.removed, k, state.ledger.removed[s * sets + k]);
    }
  }
  LedgerReport::Entry strayed{"edge of the lattice"};
  for (std::size_t k = 0; k < sets; ++k) {
    add(strayed, k, state.ledger.strayed[k]);
    add(report.removed, k, state.ledger.strayed[k]);
    add(report.held, k, state.sets[k].count);
  }
  if (strayed.particles > 0) report.sinks.push_back(strayed);
  return report;
}

template LedgerReport ledger_report(const Scene&, const State<float>&);
template LedgerReport ledger_report(const Scene&, const State<double>&);
template Diagnostics diagnose(const Scene&, const std::vector<Solid>&, const State<float>&, Threads&);
template Diagnostics diagnose(const Scene&, const std::vector<Solid>&, const State<double>&, Threads&);

}  // namespace repose
