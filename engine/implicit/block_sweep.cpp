#include "engine/implicit/block_sweep.h"

#include "engine/plan/transfer_stages.h"

namespace repose {

template <class Real>
void BlockSweep<Real>::begin(State<Real>& state, Real dt) {
  state_ = &state;
  dt_ = dt;
  lattice_ = make_lattice(state, plan_.transfer);
}

template <class Real>
void BlockSweep<Real>::follow_topology() {
  room_ = 0;
  places_.resize(state_->sets.size());
  for (std::size_t set = 0; set < places_.size(); ++set) {
    const auto& begin = state_->sets[set].begin;
    places_[set].clear();
    for (std::size_t owner = 0; owner + 1 < begin.size(); ++owner) {
      places_[set].push_back(room_);
      room_ += whole_groups(begin[owner + 1] - begin[owner]);
    }
  }
}

template <class Real>
void BlockSweep<Real>::clear(Vector& nodes) {
  for_each_block([&](std::size_t block) { std::memset(nodes.block(block), 0, kBlockValues * sizeof(Real)); });
}

template <class Real>
void BlockSweep<Real>::gather_gradient(const Chunk<Real>& chunk, const Real* arena,
                                       Real* const gradient[9], const Soon<Real>& soon) const {
  GatherInput<Real> in{};
  in.particles = chunk.particles;
  in.lattice = lattice_;
  std::copy_n(gradient, kAffineComponents, in.gradient);
  in.soon = soon;
  plan_.kernels->transfer[plan_.transfer.stencil][plan_.transfer.transfer].gradient(in, arena);
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
