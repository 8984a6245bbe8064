#include "engine/implicit/particle_sweep.h"

#include <cstring>

namespace repose {

template <class Real>
ParticleSweep<Real>::Places::Places(ScratchLayout layout)
    : arena(layout.place_arena(kArena)),
      push(layout.place_arena(kPushArena)),
      second(layout.place_arena(kSecondArena)),
      strain(layout.place(kSolveStrain.kInfo)),
      law(layout.place(kSolveLaw.kInfo)),
      matrix(layout.place(kSolveMatrix.kInfo)),
      gradient(layout.place(kGradientRoom.kInfo)),
      stress(layout.place(kKirchhoffStress.kInfo)) {}

template <class Real>
void ParticleSweep<Real>::claim_scratch(ScratchLayout& layout) {
  for (const std::string_view arena : {kArena, kPushArena, kSecondArena}) layout.place_arena(arena);
  for (const HandleInfo& handle :
       {kSolveStrain.kInfo, kSolveLaw.kInfo, kSolveMatrix.kInfo, kGradientRoom.kInfo, kKirchhoffStress.kInfo})
    layout.place(handle);
}

template <class Real>
ParticleSweep<Real>::ParticleSweep(BlockSweep<Real>& blocks) : blocks_(blocks), in_scratch_(plan().scratch) {}

template <class Real>
ImplicitScratch<Real> ParticleSweep<Real>::own(Scratch<Real>& scratch) const {
  return {scratch.at(in_scratch_.arena),    scratch.at(in_scratch_.push),  scratch.at(in_scratch_.second),
          scratch.at(in_scratch_.strain),   scratch.at(in_scratch_.law),   scratch.at(in_scratch_.matrix),
          scratch.at(in_scratch_.gradient), scratch.at(in_scratch_.stress)};
}

template <class Real>
void ParticleSweep<Real>::follow_topology() {
  room_ = 0;
  places_.resize(state().sets.size());
  for (std::size_t set = 0; set < places_.size(); ++set) {
    const auto& begin = state().sets[set].begin;
    places_[set].clear();
    for (std::size_t occupied = 0; occupied + 1 < begin.size(); ++occupied) {
      places_[set].push_back(room_);
      room_ += whole_groups(begin[occupied + 1] - begin[occupied]);
    }
  }
}

template <class Real>
std::size_t ParticleSweep<Real>::bytes() const {
  std::size_t entries = 0;
  for (const auto& places : places_) entries += places.capacity();
  return entries * sizeof(std::size_t);
}

template <class Real>
void ParticleSweep<Real>::clear(Vector& nodes) {
  for_each_block([&](std::size_t block) { std::memset(nodes.block(block), 0, kBlockValues * sizeof(Real)); });
}

template <class Real>
void ParticleSweep<Real>::gather_gradient(const Chunk<Real>& chunk, const Real* arena, Real* const gradient[9],
                                          const Soon<Real>& soon) const {
  GatherInput<Real> in{};
  in.particles = chunk.particles;
  in.lattice = lattice_;
  std::copy_n(gradient, kAffineComponents, in.gradient);
  in.soon = soon;
  transfer().gradient(in, arena);
}

template <class Real>
void ParticleSweep<Real>::push(Chunk<Real>& chunk, const ImplicitScratch<Real>& own, double scale) const {
  PushInput<Real> in{};
  in.particles = chunk.particles;
  in.scale = static_cast<Real>(scale);
  in.lattice = lattice_;
  for (std::size_t k = 0; k < kAffineComponents; ++k) in.matrix[k] = own.matrix + k * kChunk;
  transfer().push(in, own.push, chunk.touched.rows);
}

template <class Real>
void ParticleSweep<Real>::add_stiffness(const Chunk<Real>& chunk, const ImplicitScratch<Real>& own,
                                        const Real* tangent, double scale) const {
  const StiffnessInput<Real> in{chunk.particles, tangent, static_cast<Real>(scale), lattice_};
  transfer().add_stiffness(in, own.push, own.second);
}

template class ParticleSweep<float>;
template class ParticleSweep<double>;

}  // namespace repose
