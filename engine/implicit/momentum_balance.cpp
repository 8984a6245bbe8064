#include "engine/implicit/momentum_balance.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>

#include "engine/implicit/inversion.h"

namespace repose {
namespace {

template <class Real>
double square(const Real* v) {
  double sum = 0.0;
  for (int axis = 1; axis < kNodeValues; ++axis)
    sum += static_cast<double>(v[axis]) * static_cast<double>(v[axis]);
  return sum;
}

}  // namespace

template <class Real>
MomentumBalance<Real>::MomentumBalance(const ImplicitPlan<Real>& plan, BlockSweep<Real>& sweep,
                                       ContactSet<Real>& contacts, TangentSystem<Real>& system)
    : plan_(plan),
      returns_(plan.settings.mode == TangentMode::kExact || plan.settings.mode == TangentMode::kProjected),
      sweep_(sweep),
      contacts_(contacts),
      system_(system) {}

template <class Real>
void MomentumBalance<Real>::follow_topology() {
  residual_ = system_.vector();
  at_begin_.reserve_uninitialized(sweep_.room() * kAffineComponents);
  at_trial_.reserve_uninitialized(sweep_.room() * kTrialValues);
}

template <class Real>
void MomentumBalance<Real>::begin() {
  scale_ = std::numeric_limits<double>::infinity();
  sweep_.over_particles({.from = &sweep_.state().before_forces},
                        [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>&) {
                          Real* gradient[kAffineComponents];
                          gradient_at_begin(set, chunk, gradient);
                          sweep_.gather_gradient(chunk, chunk.scratch.arena.data(), gradient);
                        });
}

template <class Real>
void MomentumBalance<Real>::gradient_at_begin(std::size_t set, const Chunk<Real>& chunk,
                                              Real* (&gradient)[kAffineComponents]) {
  Real* const from = at_begin_.data() + sweep_.place(set, chunk) * kAffineComponents;
  for (std::size_t k = 0; k < kAffineComponents; ++k) gradient[k] = from + k * sweep_.stride(chunk);
}

template <class Real>
typename MomentumBalance<Real>::Trial MomentumBalance<Real>::trial_of(std::size_t set,
                                                                      const Chunk<Real>& chunk) {
  Real* const from = at_trial_.data() + sweep_.place(set, chunk) * kTrialValues;
  const std::size_t stride = sweep_.stride(chunk);
  Trial trial;
  for (std::size_t k = 0; k < kAffineComponents; ++k) trial.gradient[k] = from + k * stride;
  for (std::size_t k = 0; k < kStrainComponents; ++k) trial.strain[k] = from + (kAffineComponents + k) * stride;
  return trial;
}

/// Keeps the gradient and the trial strain of a chunk, of dv in its arena.
template <class Real>
void MomentumBalance<Real>::try_strain(std::size_t set, Chunk<Real>& chunk) {
  const Trial trial = trial_of(set, chunk);
  sweep_.gather_gradient(chunk, chunk.scratch.arena.data(), trial.gradient);
  Real* begin[kAffineComponents];
  gradient_at_begin(set, chunk, begin);
  const std::size_t count = chunk.particles.count;
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    for (std::size_t p = 0; p < count; ++p) trial.gradient[k][p] += begin[k][p];
  }
  for (std::size_t k = 0; k < kStrainComponents; ++k)
    std::copy_n(chunk.particles.strain[k], count, trial.strain[k]);
  MaterialInput<Real> in{};
  in.constants = plan_.sets[set].constants.get();
  in.dt = sweep_.dt();
  in.count = count;
  std::copy_n(trial.strain, kStrainComponents, in.strain);
  std::copy_n(trial.gradient, kAffineComponents, in.gradient);
  plan_.sets[set].kernels.trial(in);
}

/// What was kept of a chunk, as kernels take it: the strain in own.strain, for the return map to work on,
/// stress to go to scratch. Where particles yield by numbers of their own, those are found, and the strain is
/// what the passes that find them make of it.
template <class Real>
TangentInput<Real> MomentumBalance<Real>::at_trial(std::size_t set, Chunk<Real>& chunk,
                                                   ImplicitScratch<Real>& own) {
  const SetResponse<Real>& response = plan_.sets[set];
  const Trial trial = trial_of(set, chunk);
  TangentInput<Real> in{{}, {}, response.unilateral, system_.tangent(set, chunk)};
  in.material.constants = response.constants.get();
  in.material.dt = sweep_.dt();
  in.material.count = chunk.particles.count;
  for (std::size_t k = 0; k < kStrainComponents; ++k) {
    in.material.strain[k] = chunk.particles.strain[k] = own.strain.data() + k * kChunk;
    in.material.stress[k] = chunk.scratch.stress.data() + k * kChunk;
    std::copy_n(trial.strain[k], in.material.count, in.material.strain[k]);
  }
  std::copy_n(trial.gradient, kAffineComponents, in.material.gradient);
  std::copy_n(trial.gradient, kAffineComponents, chunk.moving_gradient);
  if (returns_ && response.shaped) {
    for (const auto& pass : response.surface) pass.run(chunk);
    auto& yield = chunk.scratch.yield;
    in.surface = {yield.cone.data(),    yield.cohesion.data(), yield.dilatancy.data(),
                  yield.plastic.data(), yield.sheared.data(),  yield.dilated.data()};
  }
  return in;
}

/// S of a chunk, in own.matrix; false where a particle would be turned inside out.
template <class Real>
bool MomentumBalance<Real>::stress(std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
  const MaterialKernels<Real>& kernels = plan_.sets[set].kernels;
  try_strain(set, chunk);
  const TangentInput<Real> trial = at_trial(set, chunk, own);
  const MaterialInput<Real>& in = trial.material;
  if (trial.surface.cone != nullptr) {
    kernels.project_shaped(in, trial.surface);
  } else if (returns_ && kernels.project != nullptr) {
    kernels.project(in);
  }
  if (plan_.settings.mode == TangentMode::kUnilateral && kernels.fading_stress != nullptr) {
    kernels.fading_stress(in, trial.unilateral);
  } else {
    kernels.stress(in);
  }
  Real* matrix[kAffineComponents];
  for (std::size_t k = 0; k < kAffineComponents; ++k) matrix[k] = own.matrix.data() + k * kChunk;
  return sweep_.kernels().turn(in.stress, in.gradient, sweep_.dt(), matrix, in.count);
}

template <class Real>
std::optional<double> MomentumBalance<Real>::evaluate(const Vector& dv) {
  std::atomic<bool> sound = true;
  sweep_.over_particles({.from = &dv, .to = &residual_},
                        [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
                          if (!stress(set, chunk, own)) sound.store(false, std::memory_order_relaxed);
                          sweep_.push(chunk, own, static_cast<double>(sweep_.dt()) * chunk.set.particle_volume);
                        });
  if (!sound) return std::nullopt;
  const auto [sum, outer, inner] =
      sweep_.sums_of_blocks([&](std::size_t b) { return finish_residual(b, dv.block(b), residual_.block(b)); });
  if (!std::isfinite(sum)) return std::nullopt;
  scale_ = std::min(scale_, std::sqrt(std::max(inner, outer)));
  return std::sqrt(sum);
}

/// dt f -> r = m (dv - (v^free - v^n)) - dt f, less what contacts bear. Returns the squares of what of r counts
/// and of the outer and inner impulses, in the norm of the inverse mass.
template <class Real>
std::array<double, 3> MomentumBalance<Real>::finish_residual(std::size_t block, const Real* dv, Real* r) {
  const Real* const nodes = sweep_.state().nodes.block(block);
  const Real* const begin = sweep_.state().before_forces.block(block);
  Real inner[kBlockValues], outer[kBlockValues];
  std::copy_n(r, kBlockValues, inner);
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    const Real mass = nodes[at];
    r[at] = outer[at] = Real(0);
    for (std::size_t c = 1; c < kNodeValues; ++c) {
      outer[at + c] = nodes[at + c] - begin[at + c];
      r[at + c] = mass > Real(0) ? mass * (dv[at + c] - outer[at + c]) - r[at + c] : Real(0);
    }
  }
  Real left[kBlockValues];
  std::copy_n(r, kBlockValues, left);
  contacts_.bear(block, nodes, dv, r, left);
  for (Real* const vector : {outer, inner}) contacts_.project(block, vector);
  std::array<double, 3> squares{};
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    if (!(nodes[at] > Real(0))) continue;
    const auto mass = static_cast<double>(nodes[at]);
    squares[0] += square(left + at) / mass;
    squares[1] += square(outer + at) * mass;
    squares[2] += square(inner + at) / mass;
  }
  return squares;
}

template <class Real>
void MomentumBalance<Real>::linearize() {
  const auto mode = static_cast<std::size_t>(plan_.settings.mode);
  sweep_.over_particles({}, [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
    plan_.sets[set].kernels.linearize[mode](at_trial(set, chunk, own));
  });
  sweep_.for_each_block([&](std::size_t b) { contacts_.linearize(b, sweep_.state().nodes.block(b)); });
  system_.prepare();
}

/// Each particle's own bound, from the gradient there and its change along the step.
template <class Real>
double MomentumBalance<Real>::reach(const Vector& step, double length) {
  std::vector<double> least(sweep_.state().grid.owners().size(), 1.0);
  sweep_.over_particles({.from = &step}, [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>&) {
    Real* along[kAffineComponents];
    for (std::size_t k = 0; k < kAffineComponents; ++k) along[k] = chunk.scratch.gradient.data() + k * kChunk;
    sweep_.gather_gradient(chunk, chunk.scratch.arena.data(), along);
    const Trial trial = trial_of(set, chunk);
    const double dt = static_cast<double>(sweep_.dt());
    double& bound = least[chunk.owner];
    for (std::size_t p = 0; p < chunk.particles.count; ++p) {
      Mat3 a = Mat3::Identity(), b = Mat3::Zero();
      for (std::size_t k = 0; k < kAffineComponents; ++k) {
        const auto row = static_cast<Eigen::Index>(k / 3), column = static_cast<Eigen::Index>(k % 3);
        b(row, column) = dt * static_cast<double>(along[k][p]);
        a(row, column) += dt * static_cast<double>(trial.gradient[k][p]) - length * b(row, column);
      }
      bound = std::min(bound, length_to_determinant(a, b, kLeastDeterminant));
    }
  });
  return *std::min_element(least.begin(), least.end());
}

template class MomentumBalance<float>;
template class MomentumBalance<double>;

}  // namespace repose
