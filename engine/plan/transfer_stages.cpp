#include "engine/plan/transfer_stages.h"

#include <algorithm>

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
  for (int k = 0; k < kAffineComponents; ++k) in.gradient[k] = chunk.moving_gradient[k];
  return in;
}

}  // namespace

template <class Real>
Lattice<Real> make_lattice(const State<Real>& state, const TransferChoice& transfer) {
  Lattice<Real> lattice{};
  lattice.spacing = static_cast<Real>(state.spacing);
  lattice.flat_axis = state.topology.flat_axis;
  for (int axis = 0; axis < 3; ++axis) {
    const bool flat = axis == state.topology.flat_axis;
    lattice.axis_scale[axis] = flat ? Real(0) : static_cast<Real>(transfer.nodes().inverse_d / state.spacing);
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
  const auto kept_stretching = static_cast<Real>(plan.transfer.kept_stretching);
  const bool keeps_velocity = plan.transfer.figures().keeps_velocity, implicit = plan.implicit.has_value();
  PassDescription description{"scatter", "", {"position", "velocity"}, {"node mass", "node momentum"}};
  if (!implicit) description.reads.push_back("stress");
  if (plan.transfer.keeps_affine()) description.reads.push_back("affine");
  if (keeps_velocity) description.writes.push_back("node momentum before forces");
  return {description, [=](Chunk<Real>& chunk) {
            ScatterInput<Real> in{};
            in.particles = chunk.particles;
            for (int k = 0; k < kStrainComponents; ++k) {
              in.stress[k] = chunk.scratch.stress.data() + static_cast<std::size_t>(k) * kChunk;
            }
            in.mass = static_cast<Real>(chunk.set.particle_mass);
            in.impulse_volume =
                implicit ? Real(0)
                         : static_cast<Real>(static_cast<double>(chunk.dt) * chunk.set.particle_volume);
            in.kept_stretching = kept_stretching;
            in.lattice = lattice;
            chunk.runs += kernel(in, chunk.scratch.arena.data(), chunk.rows);
            if (!keeps_velocity) return;
            // What particles keep their velocity against must have felt no force: neither stress nor a push.
            in.particles = chunk.set.span(chunk.first, chunk.particles.count);
            in.particles.ahead = chunk.particles.ahead;
            in.impulse_volume = Real(0);
            kernel(in, chunk.scratch.before_arena.data(), chunk.rows);
          }};
}

template <class Real>
ParticlePass<Real> gather_pass(const StepPlan<Real>& plan, const Lattice<Real>& lattice) {
  const TransferChoice choice = plan.transfer;
  const auto kernel = plan.kernels->transfer[choice.stencil][choice.transfer].gather;
  const auto interpolate = plan.kernels->stencil[choice.stencil].interpolate;
  const bool keeps_velocity = choice.figures().keeps_velocity;
  PassDescription description{
      "gather", "", {"position", "node velocity"}, {"velocity", "moving velocity", "gradient"}};
  if (choice.keeps_affine()) description.writes.push_back("affine");
  if (keeps_velocity) description.reads.push_back("node velocity before forces");
  return {description, [=](Chunk<Real>& chunk) {
            Scratch<Real>& scratch = chunk.scratch;
            GatherInput<Real> in{};
            in.particles = chunk.particles;
            in.lattice = lattice;
            in.kept_velocity = static_cast<Real>(choice.kept_velocity);
            if (keeps_velocity) {
              Real* const before[3] = {scratch.before.data(), scratch.before.data() + kChunk,
                                       scratch.before.data() + 2 * kChunk};
              interpolate(in.particles, lattice.flat_axis, scratch.before_arena.data(), before);
              std::copy_n(before, 3, in.before);
            }
            // What moves a particle is what it keeps, unless the transfer or friction tell two velocities.
            const auto keep = [&] {
              std::copy_n(chunk.particles.velocity, 3, in.velocity);
              std::copy_n(chunk.particles.affine, kAffineComponents, in.affine);
            };
            const bool two = chunk.two_velocities;
            if (!two) keep();
            const bool apart = two || keeps_velocity, gradient_apart = two || choice.separate_gradient();
            for (std::size_t axis = 0; apart && axis < 3; ++axis) {
              in.moving[axis] = scratch.velocity.data() + axis * kChunk;
            }
            for (std::size_t k = 0; gradient_apart && k < kAffineComponents; ++k) {
              in.gradient[k] = scratch.gradient.data() + k * kChunk;
            }
            kernel(in, scratch.arena.data());
            std::copy_n(apart ? in.moving : in.velocity, 3, chunk.moving_velocity);
            std::copy_n(gradient_apart ? in.gradient : in.affine, kAffineComponents, chunk.moving_gradient);
            if (!two) return;
            keep();
            std::fill_n(in.moving, 3, nullptr);
            std::fill_n(in.gradient, kAffineComponents, nullptr);
            kernel(in, scratch.kept_arena.data());
          }};
}

template <class Real>
ParticlePass<Real> advance_pass(const StepPlan<Real>& plan) {
  const auto kernel = plan.kernels->advance;
  return {{"advance", "", {"position", "velocity", "moving velocity", "gradient"}, {"position"}},
          [kernel](Chunk<Real>& chunk) {
            const Real per_cell = static_cast<Real>(static_cast<double>(chunk.dt) / chunk.spacing);
            kernel(chunk.particles, chunk.moving_velocity, chunk.moving_gradient, per_cell, chunk.motion);
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
ParticlePass<Real> yield_surface_pass(const MaterialRuntime<Real>& material) {
  return {{"yield surface", "", {}, {"cone", "cohesion", "dilatancy"}},
          [cone = material.cone](Chunk<Real>& chunk) {
            auto& yield = chunk.scratch.yield;
            const std::size_t count = chunk.particles.count;
            std::fill_n(yield.cone.data(), count, cone);
            std::fill_n(yield.cohesion.data(), count, Real(0));
            std::fill_n(yield.dilatancy.data(), count, Real(0));
          }};
}

template <class Real>
ParticlePass<Real> project_shaped_pass(const MaterialRuntime<Real>& material) {
  return {{"return map, shaped",
           "",
           {"trial strain", "cone", "cohesion", "dilatancy"},
           {"strain", "plastic strain", "dilated"}},
          [material](Chunk<Real>& chunk) {
            auto& yield = chunk.scratch.yield;
            const YieldInput<Real> surface{yield.cone.data(),    yield.cohesion.data(), yield.dilatancy.data(),
                                           yield.plastic.data(), yield.sheared.data(),  yield.dilated.data()};
            material.kernels.project_shaped(material_input(material, chunk), surface);
          }};
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

template <class Real>
OrderPass<Real> before_forces_room_pass() {
  return {{"room for velocity before forces", "grid.transfer", {"topology"}, {}},
          [](State<Real>& state) { state.before_forces.resize(state.grid.size()); }};
}

template <class Real>
NodePass<Real> before_forces_pass(const StepPlan<Real>& plan) {
  const auto kernel = plan.kernels->normalize;
  const Real least_mass = plan.least_mass;
  return {{"velocity before forces",
           "grid.transfer",
           {"node momentum before forces"},
           {"node velocity before forces"}},
          [kernel, least_mass](NodeBlock<Real>& block) {
            kernel(block.state.before_forces.block(block.block), least_mass);
          }};
}

template <class Real>
NodePass<Real> begin_pass() {
  return {{"velocity at the begin", "", {"node velocity"}, {"node velocity before forces"}},
          [](NodeBlock<Real>& block) {
            std::copy_n(block.nodes, kBlockValues, block.state.before_forces.block(block.block));
          }};
}

#define REPOSE_INSTANTIATE(Real)                                                         \
  template Lattice<Real> make_lattice(const State<Real>&, const TransferChoice&);        \
  template ParticlePass<Real> stress_pass(const MaterialRuntime<Real>&);                 \
  template ParticlePass<Real> scatter_pass(const StepPlan<Real>&, const Lattice<Real>&); \
  template ParticlePass<Real> gather_pass(const StepPlan<Real>&, const Lattice<Real>&);  \
  template ParticlePass<Real> advance_pass(const StepPlan<Real>&);                       \
  template ParticlePass<Real> trial_pass(const MaterialRuntime<Real>&);                  \
  template ParticlePass<Real> project_pass(const MaterialRuntime<Real>&);                \
  template ParticlePass<Real> yield_surface_pass(const MaterialRuntime<Real>&);          \
  template ParticlePass<Real> project_shaped_pass(const MaterialRuntime<Real>&);         \
  template NodePass<Real> normalize_pass(const StepPlan<Real>&);                         \
  template OrderPass<Real> before_forces_room_pass();                                    \
  template NodePass<Real> begin_pass();                                                  \
  template NodePass<Real> before_forces_pass(const StepPlan<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
