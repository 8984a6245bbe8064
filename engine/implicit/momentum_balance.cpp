#include "engine/implicit/momentum_balance.h"

#include <algorithm>
#include <atomic>
#include <cmath>

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
MomentumBalance<Real>::MomentumBalance(const ImplicitPlan<Real>& plan, ParticleSweep<Real>& sweep,
                                       ContactSet<Real>& contacts, TangentSystem<Real>& system)
    : sweep_(sweep), contacts_(contacts), system_(system), particles_(plan, sweep, system) {}

template <class Real>
void MomentumBalance<Real>::follow_topology() {
  residual_ = system_.vector();
  particles_.follow_topology();
}

template <class Real>
void MomentumBalance<Real>::begin() {
  forget_scale();
  particles_.begin();
  sweep_.over_particles({.from = &sweep_.state().before_forces},
                        [&](std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
                          particles_.keep_begin(set, chunk, own);
                        });
}

/// Of S to impulses.
template <class Real>
double MomentumBalance<Real>::push_scale(const Chunk<Real>& chunk) const {
  return static_cast<double>(sweep_.dt()) * chunk.set.particle_volume;
}

template <class Real>
std::optional<double> MomentumBalance<Real>::evaluate(const Vector& dv) {
  std::atomic<bool> sound = true;
  sweep_.over_particles({.from = &dv, .to = &residual_},
                        [&](std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
                          if (!particles_.stress(set, chunk, own))
                            sound.store(false, std::memory_order_relaxed);
                          sweep_.push(chunk, own, push_scale(chunk));
                        });
  if (!sound) return std::nullopt;
  const auto [sum, outer, inner] = finish_residual(dv);
  if (!std::isfinite(sum)) return std::nullopt;
  scale_ = std::min(scale_, std::sqrt(std::max(inner, outer)));
  return norm_ = std::sqrt(sum);
}

/// dt f -> r = m (dv - (v^free - v^n)) - dt f, less what contacts bear. Returns the squares of what of r counts
/// and of the outer and inner impulses, in the norm of the inverse mass.
template <class Real>
std::array<double, 3> MomentumBalance<Real>::finish_residual(const Vector& dv) {
  return sweep_.sums_of_blocks([&](std::size_t b) { return finish_block(b, dv.block(b), residual_.block(b)); });
}

template <class Real>
std::array<double, 3> MomentumBalance<Real>::finish_block(std::size_t block, const Real* dv, Real* r) {
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
  contacts_.react(block, nodes, dv, r, left);
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
double MomentumBalance<Real>::linearize(const Vector& dv, bool near) {
  const bool models = particles_.models();
  sweep_.over_particles({.to = models ? &residual_ : nullptr},
                        [&](std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
                          particles_.linearize(set, chunk, own, near);
                          if (models) sweep_.push(chunk, own, push_scale(chunk));
                        });
  particles_.end_linearize();
  double norm = norm_;
  if (models) {
    const auto [sum, outer, inner] = finish_residual(dv);
    norm = std::sqrt(sum);
  }
  sweep_.for_each_block([&](std::size_t b) { contacts_.linearize(b, sweep_.state().nodes.block(b)); });
  system_.prepare();
  return norm;
}

/// Each particle's own bound, from the gradient there and its change along the step.
template <class Real>
double MomentumBalance<Real>::longest_step(const Vector& step, double length) {
  std::vector<double> least(sweep_.state().grid.occupied_blocks().size(), 1.0);
  sweep_.over_particles(
      {.from = &step}, [&](std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
        Real* along[kAffineComponents];
        for (std::size_t k = 0; k < kAffineComponents; ++k) along[k] = own.gradient + k * kChunk;
        sweep_.gather_gradient(chunk, own.arena, along);
        const double dt = static_cast<double>(sweep_.dt());
        double& bound = least[chunk.occupied];
        const auto gradient = particles_.gradient(set, chunk);
        for (std::size_t p = 0; p < chunk.particles.count; ++p) {
          Mat3 a = Mat3::Identity(), b = Mat3::Zero();
          for (std::size_t k = 0; k < kAffineComponents; ++k) {
            const auto row = static_cast<Eigen::Index>(k / 3), column = static_cast<Eigen::Index>(k % 3);
            b(row, column) = dt * static_cast<double>(along[k][p]);
            a(row, column) += dt * static_cast<double>(gradient[k][p]) - length * b(row, column);
          }
          bound = std::min(bound, length_to_determinant(a, b, kLeastDeterminant));
        }
      });
  return *std::min_element(least.begin(), least.end());
}

template class MomentumBalance<float>;
template class MomentumBalance<double>;

}  // namespace repose
