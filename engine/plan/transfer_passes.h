// Repose: the core of every explicit step, as passes: stress and scatter on the way to the nodes; gather,
// advance, trial strain and return map on the way back. Where there is friction two node velocities exist,
// v-bar (after collisions) and v-tilde (after friction); particles keep v-tilde, and Advection says which one
// moves them.
#pragma once

#include <memory>

#include "engine/plan/step_plan.h"
#include "kernels/pass/pass.h"

namespace repose {

template <class Real>
Lattice<Real> make_lattice(const State<Real>& state, const TransferChoice& transfer);

/// Add to the passes of a set.
template <class Real>
void add_stress(const MaterialRuntime<Real>& material, SetPasses<Real> passes);
/// Tells what kP2gVelocity holds, where a pass before it provides that.
template <class Real>
void add_scatter(const StepPlan<Real>& plan, const Lattice<Real>& lattice, SetPasses<Real> passes);
/// What a gather is asked for beside velocities.
struct GatherWishes {
  bool friction = false;     ///< whether there is a v-tilde beside the nodes' velocity
  bool mass_around = false;  ///< whether kMassAround is wanted
};
template <class Real>
void add_gather(const StepPlan<Real>& plan, const Lattice<Real>& lattice, GatherWishes wishes,
                SetPasses<Real> passes);
template <class Real>
void add_advance(const StepPlan<Real>& plan, SetPasses<Real> passes);
/// Of a material that does not yield, the trial strain is the strain.
template <class Real>
void add_trial(const MaterialRuntime<Real>& material, bool yields, SetPasses<Real> passes);
/// Only for materials that yield.
template <class Real>
void add_return_map(const MaterialRuntime<Real>& material, SetPasses<Real> passes);

/// The same in two passes for particles that yield by numbers of their own: those of the material, on which
/// effects then work, and the return map that reads them.
template <class Real>
void add_yield_surface(const MaterialRuntime<Real>& material, SetPasses<Real> passes);
template <class Real>
void add_return_map_per_particle(const MaterialRuntime<Real>& material, SetPasses<Real> passes);

/// p -> v = p/m, and which nodes are active.
template <class Real>
void add_normalize(StepPlan<Real>& plan);

/// For transfers whose particles keep velocity: room for the nodes' velocity before forces, and p/m there. The
/// scatter fills it beside the first, without stress: stress is a force. For other implicit steps, the same
/// velocity, kept from the nodes before any force acts.
template <class Real>
void add_velocity_before_forces(StepPlan<Real>& plan);

}  // namespace repose
