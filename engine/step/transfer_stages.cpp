#include "engine/step/transfer_stages.h"

namespace repose {
namespace {

template <class Real>
MaterialInput<Real> material_input(const MaterialRuntime<Real>& material, Chunk<Real>& chunk) {
  MaterialInput<Real> in{};
  in.constants = material.constants.get();
  in.dt = chunk.dt;
  in.count = chunk.particles.count;
  in.ahead = chunk.particles.ahead;
  for (int k = 0; k < kStrainComponents; ++k) {
    in.strain[k] = chunk.particles.strain[k];
    in.stress[k] = chunk.scratch.stress.data() + static_cast<std::size_t>(k) * kChunk;
  }
  for (int k = 0; k < kAffineComponents; ++k) in.affine[k] = chunk.moving_gradient[k];
  return in;
}

}  // namespace

template <class Real>
Lattice<Real> make_lattice(const State<Real>& state, const TransferConstants& transfer) {
  Lattice<Real> lattice{};
  lattice.spacing = static_cast<Real>(state.spacing);
  lattice.flat_axis = state.topology.flat_axis;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = axis == state.topology.flat_axis;
    lattice.axis_scale[axis] = flat ? Real(0) : static_cast<Real>(transfer.inverse_d / state.spacing);
  }
  return lattice;
}

template <class Real>
ParticlePass<Real> stress_pass(const MaterialRuntime<Real>& material) {
  return {{"stress", "", {"strain"}, {"stress"}},
          [material](Chunk<Real>& chunk) { material.kernels.stress(material_input(material, chunk)); }};
}

template <class Real>
ParticlePass<Real> scatter_pass(const StepPlan<Real>& plan, const Lattice<Real>& lattice) {
  const auto kernel = plan.kernels->transfer[plan.transfer.stencil][plan.transfer.transfer].scatter;
  return {{"scatter", "", {"position", "velocity", "affine", "stress"}, {"node mass", "node momentum"}},
          [kernel, lattice](Chunk<Real>& chunk) {
            ScatterInput<Real> in{};
            in.particles = chunk.particles;
            for (int k = 0; k < kStrainComponents; ++k) {
              in.stress[k] = chunk.scratch.stress.data() + static_cast<std::size_t>(k) * kChunk;
            }
            in.mass = static_cast<Real>(chunk.set.particle_mass);
            in.impulse_volume = static_cast<Real>(static_cast<double>(chunk.dt) * chunk.set.particle_volume);
            in.lattice = lattice;
            chunk.runs += kernel(in, chunk.scratch.arena.data(), chunk.rows);
          }};
}

template <class Real>
ParticlePass<Real> gather_pass(const StepPlan<Real>& plan, const Lattice<Real>& lattice) {
  const auto kernel = plan.kernels->transfer[plan.transfer.stencil][plan.transfer.transfer].gather;
  return {{"gather", "", {"position", "node velocity"}, {"velocity", "affine", "moving velocity", "gradient"}},
          [kernel, lattice](Chunk<Real>& chunk) {
            GatherInput<Real> in{};
            in.particles = chunk.particles;
            in.lattice = lattice;
            const auto target = [&](bool scratch) {
              for (std::size_t axis = 0; axis < 3; ++axis) {
                in.velocity[axis] =
                    scratch ? chunk.scratch.velocity.data() + axis * kChunk : chunk.particles.velocity[axis];
              }
              for (std::size_t k = 0; k < kAffineComponents; ++k) {
                in.affine[k] = scratch ? chunk.scratch.affine.data() + k * kChunk : chunk.particles.affine[k];
              }
            };
            // What moves the particle first; where it keeps another velocity, the first is needed beside it.
            target(chunk.two_velocities);
            kernel(in, chunk.scratch.arena.data());
            for (int axis = 0; axis < 3; ++axis) chunk.moving_velocity[axis] = in.velocity[axis];
            for (int k = 0; k < kAffineComponents; ++k) chunk.moving_gradient[k] = in.affine[k];
            if (!chunk.two_velocities) return;
            target(false);
            kernel(in, chunk.scratch.kept_arena.data());
          }};
}

template <class Real>
ParticlePass<Real> advance_pass(const StepPlan<Real>& plan) {
  const auto kernel = plan.kernels->advance;
  return {{"advance", "", {"position", "moving velocity"}, {"position"}}, [kernel](Chunk<Real>& chunk) {
            const Real per_cell = static_cast<Real>(static_cast<double>(chunk.dt) / chunk.spacing);
            kernel(chunk.particles, chunk.moving_velocity, per_cell, chunk.motion);
          }};
}

template <class Real>
ParticlePass<Real> trial_pass(const MaterialRuntime<Real>& material) {
  return {{"trial strain", "", {"strain", "gradient"}, {"trial strain"}},
          [material](Chunk<Real>& chunk) { material.kernels.trial(material_input(material, chunk)); }};
}

template <class Real>
ParticlePass<Real> project_pass(const MaterialRuntime<Real>& material) {
  return {{"return map", "", {"trial strain"}, {"strain"}},
          [material](Chunk<Real>& chunk) { material.kernels.project(material_input(material, chunk)); }};
}

template <class Real>
NodePass<Real> normalize_pass(const StepPlan<Real>& plan) {
  const auto kernel = plan.kernels->normalize;
  const Real least_mass = plan.least_mass;
  return {{"node velocity", "", {"node mass", "node momentum"}, {"node velocity", "active nodes"}},
          [kernel, least_mass](NodeBlock<Real>& block) {
            block.state.grid.active(block.block) = kernel(block.nodes, least_mass);
          }};
}

#define REPOSE_INSTANTIATE(Real)                                                         \
  template Lattice<Real> make_lattice(const State<Real>&, const TransferConstants&);     \
  template ParticlePass<Real> stress_pass(const MaterialRuntime<Real>&);                 \
  template ParticlePass<Real> scatter_pass(const StepPlan<Real>&, const Lattice<Real>&); \
  template ParticlePass<Real> gather_pass(const StepPlan<Real>&, const Lattice<Real>&);  \
  template ParticlePass<Real> advance_pass(const StepPlan<Real>&);                       \
  template ParticlePass<Real> trial_pass(const MaterialRuntime<Real>&);                  \
  template ParticlePass<Real> project_pass(const MaterialRuntime<Real>&);                \
  template NodePass<Real> normalize_pass(const StepPlan<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
