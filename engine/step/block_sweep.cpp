#include "engine/step/block_sweep.h"

#include "engine/step/transfer_stages.h"

namespace repose {

template <class Real>
void BlockSweep<Real>::begin(State<Real>& state, Real dt) {
  state_ = &state;
  dt_ = dt;
  lattice_ = make_lattice(state, plan_.transfer);
}

template <class Real>
void BlockSweep<Real>::gather(const Chunk<Real>& chunk, const Real* arena, Real* gradient) const {
  GatherInput<Real> in{};
  in.particles = chunk.particles;
  in.lattice = lattice_;
  for (std::size_t k = 0; k < kAffineComponents; ++k) in.gradient[k] = gradient + k * kChunk;
  plan_.kernels->transfer[plan_.transfer.stencil][plan_.transfer.transfer].gradient(in, arena);
}

template <class Real>
void BlockSweep<Real>::gather_gradient(Chunk<Real>& chunk) const {
  gather(chunk, chunk.scratch.arena.data(), chunk.scratch.gradient.data());
  for (std::size_t k = 0; k < kAffineComponents; ++k) {
    chunk.moving_gradient[k] = chunk.scratch.gradient.data() + k * kChunk;
  }
}

template <class Real>
void BlockSweep<Real>::gather_base_gradient(const Chunk<Real>& chunk, ImplicitScratch<Real>& own) const {
  gather(chunk, own.base.data(), own.gradient.data());
}

template <class Real>
void BlockSweep<Real>::push(Chunk<Real>& chunk, ImplicitScratch<Real>& own, double scale) const {
  PushInput<Real> in{};
  in.particles = chunk.particles;
  in.scale = static_cast<Real>(scale);
  in.lattice = lattice_;
  for (std::size_t k = 0; k < kAffineComponents; ++k) in.matrix[k] = own.matrix.data() + k * kChunk;
  plan_.kernels->transfer[plan_.transfer.stencil][plan_.transfer.transfer].push(in, own.arena.data(),
                                                                                chunk.rows);
}

template <class Real>
void BlockSweep<Real>::add_stiffness(const Chunk<Real>& chunk, ImplicitScratch<Real>& own, const Real* tangent,
                                     double scale) const {
  const StiffnessInput<Real> in{chunk.particles, tangent, static_cast<Real>(scale), lattice_};
  plan_.kernels->transfer[plan_.transfer.stencil][plan_.transfer.transfer].add_stiffness(in, own.arena.data(),
                                                                                         own.second.data());
}

template class BlockSweep<float>;
template class BlockSweep<double>;

}  // namespace repose
