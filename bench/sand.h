// Repose: what kernels are timed on: particles as a column of sand has them, eight a cell and in order, with
// strains of sand, and everything else that a pass hands on. A workpiece is one call's data; where its channels
// lie, in one small chunk or in a set larger than the caches, is what "cache" and "memory" mean.
#pragma once

#include <span>
#include <vector>

#include "engine/base/aligned_array.h"
#include "kernels/pass/pass.h"

namespace repose {

/// The numbers of a step. A particle has 1 kg and hardly any density, so that what it tells nodes by its
/// momentum and by its stress is as large as what is there: an error in either is seen.
struct SandNumbers {
  static constexpr double kSpacing = 0.01;              // m
  static constexpr double kDt = 1e-4;                   // s
  static constexpr double kMass = 1.0;                  // kg
  static constexpr double kImpulseVolume = kDt / 22.0;  // dt V0, s m^3
  static constexpr double kKeptVelocity = 0.95;
  static constexpr double kKeptStretching = 0.25;
};

/// One chunk of particles with its scratch, an arena, and 27 blocks of nodes.
template <class Real>
struct Workpiece {
  static constexpr int kChannels = 22;  ///< position, velocity, affine, strain, volume gained
  /// Stress, moving velocity, own velocity, gradient, trace; yield surface and what yielding did.
  static constexpr int kNear = 28;

  Real* channel[kChannels];  ///< kChunk numbers each
  Real* near[kNear];         ///< the same
  Real* arena;
  Real* nodes;  ///< 27 blocks
  std::ptrdiff_t ahead = 0;
  Real dt = Real(SandNumbers::kDt);
  double result[16] = {};  ///< what kernels return beside arrays

  Real* const* velocity() const { return channel + 3; }
  Real* const* affine() const { return channel + 6; }
  Real* const* strain() const { return channel + 15; }
  Real* gained() const { return channel[21]; }
  Real* const* stress() const { return near; }
  Real* const* moving() const { return near + 6; }
  Real* const* own() const { return near + 9; }
  Real* const* gradient() const { return near + 12; }
  Real* trace() const { return near[21]; }
  Real* yield_slope() const { return near[22]; }
  Real* cohesion() const { return near[23]; }

  ParticleSpan<Real> particles() const;
  Lattice<Real> lattice(std::size_t stencil) const;
  MaterialInput<Real> material(const void* constants) const;
  YieldInput<Real> surface() const;
  /// Everything that a kernel may write but `result`.
  std::vector<std::span<Real>> arrays() const;
};

/// Particles one after another, block by block.
template <class Real>
struct Sand {
  AlignedArray<Real> channel[Workpiece<Real>::kChannels];
  std::size_t count = 0;

  /// As many blocks of 512 particles, ordered for a stencil; after a number of them they repeat.
  void fill(std::size_t stencil, std::size_t blocks);
};

/// A workpiece that owns its memory: the second chunk of a block.
template <class Real>
class Chunk {
 public:
  explicit Chunk(std::size_t stencil);
  Workpiece<Real>& piece() { return piece_; }
  /// Takes the numbers of another one, in all arrays or in those listed.
  void copy(const Workpiece<Real>& from);
  void copy(const Workpiece<Real>& from, const std::vector<std::size_t>& arrays);

 private:
  AlignedArray<Real> channels_, near_, arena_, nodes_;
  Workpiece<Real> piece_;
};

/// Rows of the arena that the particles of a block in order reach.
std::uint64_t rows_of_block(std::size_t stencil);
/// Particles a segment, in the mean, of a block in order.
double particles_per_segment(std::size_t stencil);

/// The set that no cache holds, filled for a stencil. Only the precision asked for last has memory.
template <class Real>
Sand<Real>& memory_sand(std::size_t stencil);
/// Bytes of its channels. So many, because the fifth that a light kernel reads of it must not fit either: with
/// half of this a 32 MB share of the last cache still made such kernels faster than memory.
inline constexpr std::size_t kMemoryBytes = std::size_t{2} << 30;

}  // namespace repose
