#include "engine/implicit/particle_response.h"

#include <algorithm>

namespace repose {

template <class Real>
ParticleResponse<Real>::ParticleResponse(const ImplicitPlan<Real>& plan, ParticleSweep<Real>& sweep,
                                         TangentSystem<Real>& system)
    : plan_(plan),
      returns_(plan.settings.mode == TangentMode::kExact || plan.settings.mode == TangentMode::kProjected),
      sweep_(sweep),
      system_(system) {
  const bool unilateral = plan.settings.mode == TangentMode::kUnilateral;
  ScratchLayout layout = sweep.plan().scratch;
  for (std::size_t k = 0; k < kYieldHandles.size(); ++k) yield_[k] = layout.place(kYieldHandles[k]);
  for (const SetResponse<Real>& set : plan.sets) {
    models_ = models_ || (returns_ && set.material.kernels.linearization_point);
    fades_ = fades_ || (unilateral && set.material.kernels.unilateral_stress);
  }
}

template <class Real>
void ParticleResponse<Real>::follow_topology() {
  at_begin_.reserve_uninitialized(sweep_.room() * kAffineComponents);
  at_trial_.reserve_uninitialized(sweep_.room() * kTrialValues);
  if (models_) model_.reserve_uninitialized(sweep_.room() * kModelValues);
}

/// Numbers `first` and on of the chunk's particles, of those kept for each.
template <class Real>
template <class Found>
void ParticleResponse<Real>::find(AlignedArray<Real>& kept, std::size_t values_of_all, std::size_t first,
                                  std::size_t set, const Chunk<Real>& chunk, Found& found) const {
  Real* const from = kept.data() + sweep_.place(set, chunk) * values_of_all;
  for (std::size_t k = 0; k < std::size(found); ++k) found[k] = from + (first + k) * sweep_.stride(chunk);
}

template <class Real>
typename ParticleResponse<Real>::Trial ParticleResponse<Real>::trial_of(std::size_t set,
                                                                        const Chunk<Real>& chunk) {
  Trial trial;
  find(at_trial_, kTrialValues, 0, set, chunk, trial.gradient);
  find(at_trial_, kTrialValues, kAffineComponents, set, chunk, trial.strain);
  find(at_trial_, kTrialValues, kAffineComponents + kStrainComponents, set, chunk, trial.law);
  return trial;
}

template <class Real>
typename ParticleResponse<Real>::Model ParticleResponse<Real>::model_of(std::size_t set,
                                                                        const Chunk<Real>& chunk) {
  Model model;
  find(model_, kModelValues, 0, set, chunk, model.stress);
  find(model_, kModelValues, kAffineComponents, set, chunk, model.map);
  return model;
}

template <class Real>
std::array<const Real*, kAffineComponents> ParticleResponse<Real>::gradient(std::size_t set,
                                                                            const Chunk<Real>& chunk) {
  std::array<const Real*, kAffineComponents> gradient;
  std::copy_n(trial_of(set, chunk).gradient, kAffineComponents, gradient.begin());
  return gradient;
}

template <class Real>
void ParticleResponse<Real>::keep_begin(std::size_t set, const Chunk<Real>& chunk,
                                        const ImplicitScratch<Real>& own) {
  Real* begin[kAffineComponents];
  find(at_begin_, kAffineComponents, 0, set, chunk, begin);
  sweep_.gather_gradient(chunk, own.arena, begin);
}

/// What the law of the material keeps of a chunk's particles, for kernels to work on.
template <class Real>
void ParticleResponse<Real>::copy_law_channels(const Chunk<Real>& chunk, const LawChannels& to) {
  for (std::size_t k = 0; k < chunk.set.law_channels; ++k)
    std::copy_n(chunk.set.extra[k].values.data() + chunk.first, chunk.particles.count, to[k]);
}

/// Keeps the gradient and the trial strain of a chunk, of dv in its arena.
template <class Real>
void ParticleResponse<Real>::try_strain(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
  const Trial trial = trial_of(set, chunk);
  Real* begin[kAffineComponents];
  find(at_begin_, kAffineComponents, 0, set, chunk, begin);
  sweep_.gather_gradient(chunk, own.arena, trial.gradient, {begin[0], kAffineComponents});
  const std::size_t count = chunk.particles.count;
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    for (std::size_t p = 0; p < count; ++p) trial.gradient[k][p] += begin[k][p];
  }
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    std::copy_n(chunk.particles.strain[k], count, trial.strain[k]);
  copy_law_channels(chunk, trial.law);
  MaterialInput<Real> in{};
  in.constants = plan_.sets[set].material.constants.get();
  in.channels = trial.law;
  in.dt = sweep_.dt();
  in.count = count;
  std::copy_n(trial.strain, kStrainComponents, in.strain);
  std::copy_n(trial.gradient, kAffineComponents, in.gradient);
  plan_.sets[set].material.kernels.trial(in);
}

/// What kernels take: strain in own.strain, for them to work on, stress to go to scratch.
template <class Real>
TangentInput<Real> ParticleResponse<Real>::input(std::size_t set, Chunk<Real>& chunk,
                                                 const ImplicitScratch<Real>& own) const {
  const SetResponse<Real>& response = plan_.sets[set];
  TangentInput<Real> in{{}, {}, response.unilateral, system_.tangent(set, chunk)};
  in.material.constants = response.material.constants.get();
  in.material.dt = sweep_.dt();
  in.material.count = chunk.particles.count;
  for (std::size_t k = 0; k < kMostLawChannels; ++k) in.material.channels[k] = own.law + k * kChunk;
  for (std::size_t k = 0; k < kStrainComponents; ++k) {
    in.material.strain[k] = own.strain + k * kChunk;
    in.material.stress[k] = own.stress + k * kChunk;
  }
  return in;
}

/// Runs the passes that stand before the return map: the strain is what they make of it, and where particles
/// yield by numbers of their own, those are found.
template <class Real>
void ParticleResponse<Real>::prepare_return(std::size_t set, Chunk<Real>& chunk, TangentInput<Real>& in) const {
  const SetResponse<Real>& response = plan_.sets[set];
  if (!returns_ || response.before_return.empty()) return;
  std::copy_n(in.material.strain, kStrainComponents, chunk.particles.strain);
  std::copy_n(in.material.gradient, kAffineComponents, chunk.moving_gradient);
  for (const auto& pass : response.before_return) pass.run(chunk);
  if (!response.per_particle) return;
  Real* yield[kYieldHandles.size()];
  for (std::size_t k = 0; k < kYieldHandles.size(); ++k) yield[k] = chunk.scratch.at(yield_[k]);
  in.surface = {yield[0], yield[1], yield[2], yield[3], yield[4], yield[5]};
}

/// Where the velocities of the last stress() put the particles of a chunk.
template <class Real>
TangentInput<Real> ParticleResponse<Real>::at_trial(std::size_t set, Chunk<Real>& chunk,
                                                    const ImplicitScratch<Real>& own) {
  const Trial trial = trial_of(set, chunk);
  TangentInput<Real> in = input(set, chunk, own);
  std::copy_n(trial.gradient, kAffineComponents, in.material.gradient);
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    std::copy_n(trial.strain[k], in.material.count, in.material.strain[k]);
  for (std::size_t k = 0; k < chunk.set.law_channels; ++k)
    std::copy_n(trial.law[k], in.material.count, in.material.channels[k]);
  prepare_return(set, chunk, in);
  return in;
}

/// Where their own rate of deformation puts them: C, where that is a gradient, or grad v^n.
template <class Real>
TangentInput<Real> ParticleResponse<Real>::at_rate(std::size_t set, Chunk<Real>& chunk,
                                                   const ImplicitScratch<Real>& own) {
  Real* begin[kAffineComponents];
  find(at_begin_, kAffineComponents, 0, set, chunk, begin);
  const bool keeps = sweep_.keeps_gradient();
  TangentInput<Real> in = input(set, chunk, own);
  std::copy_n(keeps ? chunk.particles.affine : begin, kAffineComponents, in.material.gradient);
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    std::copy_n(chunk.particles.strain[k], in.material.count, in.material.strain[k]);
  copy_law_channels(chunk, in.material.channels);
  plan_.sets[set].material.kernels.trial(in.material);
  prepare_return(set, chunk, in);
  return in;
}

/// S of the strain and the gradient in `in`; false where a particle would be turned inside out.
template <class Real>
bool ParticleResponse<Real>::stress_of(std::size_t set, const TangentInput<Real>& in,
                                       Real* const (&matrix)[kAffineComponents]) const {
  const MaterialKernels<Real>& kernels = plan_.sets[set].material.kernels;
  const MaterialInput<Real>& material = in.material;
  if (in.surface.yield_slope != nullptr) {
    kernels.return_map_per_particle(material, in.surface);
  } else if (returns_ && kernels.return_map != nullptr) {
    kernels.return_map(material);
  }
  if (plan_.settings.mode == TangentMode::kUnilateral && kernels.unilateral_stress != nullptr) {
    kernels.unilateral_stress(material, in.unilateral);
  } else {
    kernels.stress(material);
  }
  return sweep_.kernels().tangent.pull_back(material.stress, material.gradient, material.dt, matrix,
                                            material.count);
}

template <class Real>
bool ParticleResponse<Real>::stress(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
  try_strain(set, chunk, own);
  Real* matrix[kAffineComponents];
  for (std::size_t k = 0; k < kAffineComponents; ++k) matrix[k] = own.matrix + k * kChunk;
  return stress_of(set, at_trial(set, chunk, own), matrix);
}

/// Puts the strain of `in` where the next model is to be made, and into `ahead` how far dt grad v is from
/// there.
template <class Real>
void ParticleResponse<Real>::move_to_linearization_point(std::size_t set, Chunk<Real>& chunk,
                                                         const ImplicitScratch<Real>& own,
                                                         const TangentInput<Real>& in,
                                                         Real* const (&ahead)[kAffineComponents]) {
  const Model model = model_of(set, chunk);
  const std::size_t count = in.material.count;
  Real* predicted[kAffineComponents];
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    predicted[k] = own.matrix + k * kChunk;
    for (std::size_t p = 0; p < count; ++p)
      ahead[k][p] = in.material.dt * in.material.gradient[k][p] - model.map[k][p];
  }
  sweep_.kernels().tangent.apply(in.tangent, ahead, predicted, count);
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    for (std::size_t p = 0; p < count; ++p) predicted[k][p] += model.stress[k][p];
  }
  plan_.sets[set].material.kernels.linearization_point(in, predicted, ahead);
}

/// Where the next model of a chunk is made, and into `ahead` how far dt grad v is from there.
template <class Real>
TangentInput<Real> ParticleResponse<Real>::place_model(std::size_t set, Chunk<Real>& chunk,
                                                       const ImplicitScratch<Real>& own, bool near,
                                                       Real* const (&ahead)[kAffineComponents]) {
  const std::size_t count = chunk.particles.count;
  if (near && !modelled_) {
    const Trial trial = trial_of(set, chunk);
    const TangentInput<Real> in = at_rate(set, chunk, own);
    for (std::size_t k = 0; k < kAffineComponents; ++k) {
      for (std::size_t p = 0; p < count; ++p)
        ahead[k][p] = in.material.dt * (trial.gradient[k][p] - in.material.gradient[k][p]);
    }
    return in;
  }
  const TangentInput<Real> in = at_trial(set, chunk, own);
  if (near) {
    move_to_linearization_point(set, chunk, own, in, ahead);
  } else {
    for (Real* const one : ahead) std::fill_n(one, count, Real(0));
  }
  return in;
}

template <class Real>
void ParticleResponse<Real>::linearize(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own,
                                       bool near) {
  const MaterialKernels<Real>& kernels = plan_.sets[set].material.kernels;
  const auto make_tangents = kernels.linearize[static_cast<std::size_t>(plan_.settings.mode)];
  if (!models_) {
    make_tangents(at_trial(set, chunk, own));
    return;
  }
  const Trial trial = trial_of(set, chunk);
  const Model model = model_of(set, chunk);
  Real *ahead[kAffineComponents], *matrix[kAffineComponents];
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    ahead[k] = own.gradient + k * kChunk;
    matrix[k] = own.matrix + k * kChunk;
  }
  TangentInput<Real> in = place_model(set, chunk, own, near && kernels.linearization_point != nullptr, ahead);
  make_tangents(in);
  if (!stress_of(set, in, model.stress)) {  // at its own rate a particle would be turned inside out
    in = place_model(set, chunk, own, false, ahead);
    make_tangents(in);
    stress_of(set, in, model.stress);
  }
  const std::size_t count = chunk.particles.count;
  sweep_.kernels().tangent.apply(in.tangent, ahead, matrix, count);
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    for (std::size_t p = 0; p < count; ++p) {
      model.map[k][p] = sweep_.dt() * trial.gradient[k][p] - ahead[k][p];
      matrix[k][p] += model.stress[k][p];
    }
  }
}

template class ParticleResponse<float>;
template class ParticleResponse<double>;

}  // namespace repose
