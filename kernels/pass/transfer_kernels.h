// Repose: the kernels between particles and nodes, one table for each stencil, and one for each of its
// transfers.
#pragma once

#include <cstddef>
#include <cstdint>

#include "kernels/layout/node_block.h"
#include "kernels/layout/particle_span.h"

namespace repose {

/// What both transfers need to know of the lattice.
template <class Real>
struct Lattice {
  Real spacing;        ///< dx, m
  Real axis_scale[3];  ///< D^-1 dx in 1/m per axis; 0 on the single-node axis of plane strain
  int flat_axis;       ///< that axis, or -1
};

/// Particles to nodes.
template <class Real>
struct ScatterInput {
  ParticleSpan<Real> particles;
  const Real* stress[kStrainComponents];  ///< Kirchhoff stress tau, Pa
  Real mass;                              ///< m of a particle, kg
  Real impulse_volume;                    ///< dt V0, s m^3
  Real kept_stretching;                   ///< RPIC's share of (C + C^T)/2, in [0, 1]
  Lattice<Real> lattice;
  // Where what particles have for themselves is measured: mass and momentum that have felt no force.
  const Real* own_velocity[3];  ///< that of the particles, m/s, where their `velocity` holds a push too
  Real* before;                 ///< the arena that they go to
};

/// What the next pass reads, values * count numbers from `from` on: a pass that computes much and reads little
/// asks memory for it, as many with each particle. No values: nothing to ask for.
template <class Real>
struct Soon {
  const Real* from = nullptr;
  std::size_t values = 0;  ///< a particle
};

/// Nodes to particles. What is a null pointer is not wanted; a pointer may be that of the particles' own
/// channel.
template <class Real>
struct GatherInput {
  ParticleSpan<Real> particles;  ///< positions are read, and velocities where what is their own is measured
  Lattice<Real> lattice;
  Real* velocity[3];                  ///< out: v that the particle keeps, m/s
  Real* affine[kAffineComponents];    ///< out: C that it keeps, 1/s; only where the transfer keeps one
  Real* moving[3];                    ///< out: sum w v_i, which moves it, m/s
  Real* gradient[kAffineComponents];  ///< out: gradient of velocity, which strains it, 1/s; with forces by
                                      ///< moments it is C
  Real* mass;  ///< out: sum w m_i, kg
  // Where the transfer keeps velocity:
  Real* own[3];        ///< what particles have for themselves, m/s: read, or measured, and written
  const Real* before;  ///< arena of v_i before forces, m/s, to measure it against
  Real kept_velocity;  ///< share of it that is kept, in [0, 1]
  Real dt;             ///< of the step, s
  Soon<Real> soon;     ///< asked for meanwhile
};

/// Pushes of particles on nodes: node i receives -scale S g_i, g_i the gradient of its weight.
template <class Real>
struct PushInput {
  ParticleSpan<Real> particles;           ///< positions are read
  const Real* matrix[kAffineComponents];  ///< S by rows, Pa
  Real scale;                             ///< such as dt V0, s m^3
  Lattice<Real> lattice;
};

/// The 3x3 blocks of nodes that the tangents of particles add up to.
template <class Real>
struct StiffnessInput {
  ParticleSpan<Real> particles;  ///< positions are read
  const Real* tangent;           ///< of the first
  Real scale;                    ///< such as dt^2 V0
  Lattice<Real> lattice;
};

template <class Real>
struct TransferKernels {
  /// Adds mass and momentum to the arena; sets the bit x * 8 + y of `rows` for each row touched; returns the
  /// segments.
  std::size_t (*scatter)(const ScatterInput<Real>&, Real* arena, std::uint64_t& rows);
  void (*gather)(const GatherInput<Real>&, const Real* arena);
  /// The same, and what particles have for themselves is measured; null unless the transfer keeps velocity.
  std::size_t (*scatter_measuring)(const ScatterInput<Real>&, Real* arena, std::uint64_t& rows);
  void (*gather_measuring)(const GatherInput<Real>&, const Real* arena);
  /// The gradient alone, and the push that is its transpose: momentum and rows as in scatter.
  void (*gradient)(const GatherInput<Real>&, const Real* arena);
  void (*push)(const PushInput<Real>&, Real* arena, std::uint64_t& rows);
  /// Adds the symmetric blocks of nodes to two arenas, [0, xx, yy, zz] and [0, xy, xz, yz] a node.
  void (*add_stiffness)(const StiffnessInput<Real>&, Real* diagonal, Real* side);
};

template <class Real>
struct StencilKernels {
  /// Adds the rows of an arena to the blocks around it, or loads them; null blocks are passed over.
  void (*add_arena)(const Real* arena, std::uint64_t rows, Real* const blocks[kNeighbours]);
  void (*load_arena)(Real* arena, std::uint64_t rows, const Real* const blocks[kNeighbours]);
};

}  // namespace repose
