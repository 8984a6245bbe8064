#include "engine/plan/transfer_passes.h"

#include <algorithm>

namespace repose {
namespace {

/// The channels of a material's law, where it has some.
template <class Real>
auto law_of(const MaterialRuntime<Real>& material) {
  return when(material.channels > 0, kLawChannels);
}

/// What kernels of materials take. They have one struct for those that read the strain and those that write it.
template <class Real, class Access>
MaterialInput<Real> material_input(const MaterialRuntime<Real>& material, const Access& at) {
  MaterialInput<Real> in{};
  in.constants = material.constants.get();
  in.dt = at.dt();
  in.count = at.count();
  in.ahead = at.ahead();
  return in;
}
template <class Strain, class Real>
void take_strain(const Strain& strain, MaterialInput<Real>& in) {
  for (std::size_t k = 0; k < strain.size(); ++k) in.strain[k] = const_cast<Real*>(strain[k]);
}
template <class Channels, class Real>
void take_channels(const Channels& channels, MaterialInput<Real>& in) {
  for (std::size_t k = 0; k < channels.size(); ++k) in.channels[k] = const_cast<Real*>(channels[k]);
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
void add_stress(const MaterialRuntime<Real>& material, SetPasses<Real> passes) {
  passes.add({"stress"}, reads(kHenckyStrain, law_of(material)), writes(kKirchhoffStress),
             [material](const auto& at) {
               MaterialInput<Real> in = material_input(material, at);
               take_strain(at.read(kHenckyStrain), in);
               take_channels(at.read(kLawChannels), in);
               std::copy_n(at.write(kKirchhoffStress).begin(), kStrainComponents, in.stress);
               material.kernels.stress(in);
             });
}

template <class Real>
void add_scatter(const StepPlan<Real>& plan, const Lattice<Real>& lattice, SetPasses<Real> passes) {
  const TransferKernels<Real>& kernels = plan.kernels->transfer[plan.transfer.stencil][plan.transfer.transfer];
  const bool keeps_velocity = plan.transfer.figures().keeps_velocity, pushed = passes.provides(kP2gVelocity);
  const bool forces = !plan.implicit;  // stress is one; a solve finds its own
  const auto stress = when(forces, kKirchhoffStress);
  const auto no_stress = when(!forces, kNoStress);
  const auto told = when(pushed, kP2gVelocity);
  const auto velocity = when(keeps_velocity || !pushed, kParticleVelocity);
  const auto affine = when(plan.transfer.keeps_affine(), kAffine);
  const auto before = when(keeps_velocity, kMomentumBeforeForces);
  passes.add({"scatter"}, reads(kPosition, velocity, told, affine, stress),
             writes(kNodeMomentum, before, no_stress, kTouched),
             [=, &kernels, choice = plan.transfer](const auto& at) {
               ScatterInput<Real> in{};
               in.particles = at.span();
               if (pushed) {
                 const auto v = at.read(kP2gVelocity);
                 for (std::size_t axis = 0; axis < 3; ++axis)
                   in.particles.velocity[axis] = const_cast<Real*>(v[axis]);
               }
               std::copy_n((forces ? at.read(kKirchhoffStress) : at.read(kNoStress)).begin(), kStrainComponents,
                           in.stress);
               in.mass = static_cast<Real>(at.mass());
               in.impulse_volume =
                   forces ? static_cast<Real>(static_cast<double>(at.dt()) * at.volume()) : Real(0);
               in.kept_stretching = static_cast<Real>(choice.kept_stretching);
               in.lattice = lattice;
               const bool measures = choice.measures_own(at.step());
               if (measures) {
                 // What is a particle's own is measured against nodes that no force, stress or push, has
                 // changed.
                 std::copy_n(at.span().velocity, 3, in.own_velocity);
                 in.before = at.write(kMomentumBeforeForces);
               }
               auto& touched = at.write(kTouched);
               touched.segments += (measures ? kernels.scatter_measuring : kernels.scatter)(
                   in, at.write(kNodeMomentum), touched.rows);
             });
}

namespace {

/// What gathers the velocities of nodes around a block for its particles.
template <class Real>
struct Gather {
  TransferChoice choice;
  Lattice<Real> lattice;
  const TransferKernels<Real>& kernels;
  bool keeps_velocity;

  template <class Access>
  GatherInput<Real> input(const Access& at) const {
    GatherInput<Real> in{};
    in.particles = at.span();
    in.lattice = lattice;
    in.mass = at.write(kMassAround);
    if (!keeps_velocity) return in;
    in.kept_velocity = static_cast<Real>(choice.kept_over(static_cast<double>(at.dt())));
    in.dt = at.dt();
    in.own[0] = at.write(kOwnVelocityX);
    in.own[1] = at.write(kOwnVelocityY);
    in.own[2] = at.write(kOwnVelocityZ);
    if (choice.measures_own(at.step())) in.before = at.read(kVelocityBeforeForces);
    return in;
  }

  /// What particles keep comes out in their own channels.
  template <class Access>
  static void keep(const Access& at, GatherInput<Real>& in) {
    std::copy_n(at.write(kParticleVelocity).begin(), 3, in.velocity);
    std::copy_n(at.write(kAffine).begin(), kAffineComponents, in.affine);
  }

  /// What moves a particle is what it keeps, unless the transfer or friction tell two velocities.
  template <class Access>
  void operator()(const Access& at) const {
    GatherInput<Real> in = input(at);
    const bool two = at.two_velocities();
    if (!two) keep(at, in);
    const bool apart = two || keeps_velocity, gradient_apart = two || choice.separate_gradient();
    if (apart) std::copy_n(at.write(kVelocityRoom).begin(), 3, in.moving);
    if (gradient_apart) std::copy_n(at.write(kGradientRoom).begin(), kAffineComponents, in.gradient);
    const auto kernel = in.before == nullptr ? kernels.gather : kernels.gather_measuring;
    kernel(in, at.read(kNodeVelocity));
    at.put(kMovingVelocity, apart ? in.moving : in.velocity);
    at.put(kGradient, gradient_apart ? in.gradient : in.affine);
    if (!two) return;
    keep(at, in);
    in.mass = nullptr;
    std::fill_n(in.moving, 3, nullptr);
    std::fill_n(in.gradient, kAffineComponents, nullptr);
    kernel(in, at.read(kVTilde));
  }
};

}  // namespace

template <class Real>
void add_gather(const StepPlan<Real>& plan, const Lattice<Real>& lattice, GatherWishes wishes,
                SetPasses<Real> passes) {
  const TransferChoice& choice = plan.transfer;
  const bool keeps_velocity = choice.figures().keeps_velocity;
  const Gather<Real> gather{choice, lattice, plan.kernels->transfer[choice.stencil][choice.transfer],
                            keeps_velocity};
  const auto velocity = when(keeps_velocity, kParticleVelocity);
  const auto before = when(keeps_velocity, kVelocityBeforeForces);
  const auto tilde = when(wishes.friction, kVTilde);
  const auto mass = when(wishes.mass_around, kMassAround);
  const auto own_x = when(keeps_velocity, kOwnVelocityX);
  const auto own_y = when(keeps_velocity, kOwnVelocityY);
  const auto own_z = when(keeps_velocity, kOwnVelocityZ);
  const auto affine = when(choice.keeps_affine(), kAffine);
  passes.add({"gather"}, reads(kPosition, velocity, kNodeVelocity, tilde, before, own_x, own_y, own_z),
             writes(kParticleVelocity, affine, kMovingVelocity, kGradient, kVelocityRoom, kGradientRoom, own_x,
                    own_y, own_z, mass),
             gather);
}

template <class Real>
void add_advance(const StepPlan<Real>& plan, SetPasses<Real> passes) {
  passes.add({"advance"}, reads(kPosition, kParticleVelocity, kMovingVelocity, kGradient),
             writes(kPosition, kMotion), [kernel = plan.kernels->particle.advance](const auto& at) {
               const Real per_cell = static_cast<Real>(static_cast<double>(at.dt()) / at.spacing());
               kernel(at.span(), at.read(kMovingVelocity).data(), at.read(kGradient).data(), per_cell,
                      at.write(kMotion));
             });
}

namespace {

template <class Real, class To>
void add_trial_as(const MaterialRuntime<Real>& material, To to, SetPasses<Real> passes) {
  const auto law = law_of(material);
  passes.add({"trial strain"}, reads(kHenckyStrain, kGradient, law), writes(to, law),
             [material, to](const auto& at) {
               MaterialInput<Real> in = material_input(material, at);
               take_strain(at.write(to), in);
               take_channels(at.write(kLawChannels), in);
               std::copy_n(at.read(kGradient).begin(), kAffineComponents, in.gradient);
               material.kernels.trial(in);
             });
}

}  // namespace

template <class Real>
void add_trial(const MaterialRuntime<Real>& material, bool yields, SetPasses<Real> passes) {
  if (yields) {
    add_trial_as(material, kTrialStrain, passes);
  } else {
    add_trial_as(material, kHenckyStrain, passes);
  }
}

template <class Real>
void add_return_map(const MaterialRuntime<Real>& material, SetPasses<Real> passes) {
  const auto law = law_of(material);
  passes.add({"return map"}, reads(kTrialStrain, law), writes(kHenckyStrain, law), [material](const auto& at) {
    MaterialInput<Real> in = material_input(material, at);
    take_strain(at.write(kHenckyStrain), in);
    take_channels(at.write(kLawChannels), in);
    material.kernels.return_map(in);
  });
}

template <class Real>
void add_yield_surface(const MaterialRuntime<Real>& material, SetPasses<Real> passes) {
  passes.add({"yield surface"}, reads(), writes(kYieldSlope, kCohesion, kDilatancy),
             [slope = material.yield_slope](const auto& at) {
               std::fill_n(at.write(kYieldSlope), at.count(), slope);
               std::fill_n(at.write(kCohesion), at.count(), Real(0));
               std::fill_n(at.write(kDilatancy), at.count(), Real(0));
             });
}

template <class Real>
void add_return_map_per_particle(const MaterialRuntime<Real>& material, SetPasses<Real> passes) {
  passes.add({"return map, per particle"}, reads(kTrialStrain, kYieldSlope, kCohesion, kDilatancy),
             writes(kHenckyStrain, kPlastic, kSheared, kDilated), [material](const auto& at) {
               MaterialInput<Real> in = material_input(material, at);
               take_strain(at.write(kHenckyStrain), in);
               material.kernels.return_map_per_particle(
                   in, {at.read(kYieldSlope), at.read(kCohesion), at.read(kDilatancy), at.write(kPlastic),
                        at.write(kSheared), at.write(kDilated)});
             });
}

template <class Real>
void add_normalize(StepPlan<Real>& plan) {
  plan.nodes.push_back(plan.passes().over_nodes(
      {"node velocity"}, reads(kNodeMomentum), writes(kNodeVelocity, kActiveNodes),
      [kernel = plan.kernels->node.normalize, least_mass = plan.least_mass](const auto& at) {
        at.write(kActiveNodes) = kernel(at.write(kNodeVelocity), least_mass);
      }));
}

template <class Real>
void add_velocity_before_forces(StepPlan<Real>& plan) {
  const char* const key = plan.transfer.figures().keeps_velocity ? "grid.transfer" : "time.integrator";
  plan.sort.push_back(plan.passes().after_sort(
      {"room for velocity before forces", key}, reads(kTopology), writes(),
      [](const auto& at) { at.state().before_forces.resize(at.state().grid.size()); }));
  if (plan.transfer.figures().keeps_velocity) {
    plan.nodes.push_back(plan.passes().over_nodes(
        {"velocity before forces", key}, reads(kMomentumBeforeForces), writes(kVelocityBeforeForces),
        [kernel = plan.kernels->node.normalize, least_mass = plan.least_mass,
         choice = plan.transfer](const auto& at) {
          if (choice.measures_own(at.step())) kernel(at.write(kVelocityBeforeForces), least_mass);
        }));
    return;
  }
  plan.nodes.push_back(plan.passes().over_nodes(
      {"velocity at the begin", key}, reads(kNodeVelocity), writes(kVelocityBeforeForces), [](const auto& at) {
        std::copy_n(at.read(kNodeVelocity), kBlockValues, at.write(kVelocityBeforeForces));
      }));
}

#define REPOSE_INSTANTIATE(Real)                                                                        \
  template Lattice<Real> make_lattice(const State<Real>&, const TransferChoice&);                       \
  template void add_stress(const MaterialRuntime<Real>&, SetPasses<Real>);                              \
  template void add_scatter(const StepPlan<Real>&, const Lattice<Real>&, SetPasses<Real>);              \
  template void add_gather(const StepPlan<Real>&, const Lattice<Real>&, GatherWishes, SetPasses<Real>); \
  template void add_advance(const StepPlan<Real>&, SetPasses<Real>);                                    \
  template void add_trial(const MaterialRuntime<Real>&, bool, SetPasses<Real>);                         \
  template void add_return_map(const MaterialRuntime<Real>&, SetPasses<Real>);                          \
  template void add_yield_surface(const MaterialRuntime<Real>&, SetPasses<Real>);                       \
  template void add_return_map_per_particle(const MaterialRuntime<Real>&, SetPasses<Real>);             \
  template void add_normalize(StepPlan<Real>&);                                                         \
  template void add_velocity_before_forces(StepPlan<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
