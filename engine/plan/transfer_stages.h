// Repose: the core of every explicit step, as passes: stress and scatter on the way to the nodes; gather,
// advance, trial strain and return map on the way back. Where there is friction two node velocities exist,
// v-bar (after collisions) and v-tilde (after friction); particles keep v-tilde, and Advection says which one
// moves them.
#pragma once

#include <memory>

#include "engine/plan/step_plan.h"

namespace repose {

/// A material ready for the kernels: its table and its constants.
template <class Real>
struct MaterialRuntime {
  MaterialKernels<Real> kernels;
  std::shared_ptr<const void> constants;  ///< the material's Constants<Real>
  Real cone = 0;                          ///< of a material that yields: bc
};

template <class Real>
Lattice<Real> make_lattice(const State<Real>& state, const TransferChoice& transfer);

template <class Real>
ParticlePass<Real> stress_pass(const MaterialRuntime<Real>& material);
template <class Real>
ParticlePass<Real> scatter_pass(const StepPlan<Real>& plan, const Lattice<Real>& lattice);
template <class Real>
ParticlePass<Real> gather_pass(const StepPlan<Real>& plan, const Lattice<Real>& lattice);
template <class Real>
ParticlePass<Real> advance_pass(const StepPlan<Real>& plan);
template <class Real>
ParticlePass<Real> trial_pass(const MaterialRuntime<Real>& material);
/// Only for materials that yield.
template <class Real>
ParticlePass<Real> project_pass(const MaterialRuntime<Real>& material);

/// The same in two passes for particles that yield by numbers of their own: those of the material, on which
/// effects then work, and the return map that reads them.
template <class Real>
ParticlePass<Real> yield_surface_pass(const MaterialRuntime<Real>& material);
template <class Real>
ParticlePass<Real> project_shaped_pass(const MaterialRuntime<Real>& material);

/// p -> v = p/m, and which nodes are active.
template <class Real>
NodePass<Real> normalize_pass(const StepPlan<Real>& plan);

/// For transfers whose particles keep velocity: room for the nodes' velocity before forces, and p/m there. The
/// scatter pass fills it by a second scatter, without stress: stress is a force.
template <class Real>
OrderPass<Real> before_forces_room_pass();
template <class Real>
NodePass<Real> before_forces_pass(const StepPlan<Real>& plan);

/// For implicit steps: the same velocity, kept from the nodes before any force acts.
template <class Real>
NodePass<Real> begin_pass();

}  // namespace repose
