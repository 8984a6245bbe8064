// Repose: the kernels as the engine calls them: plain function pointers, one table per instruction set and
// precision. The unit is a span of particles of one block, or one block of nodes; data stay in cache from pass
// to pass, so materials, transfers and stencils multiply here as calls and not as templates. Nothing in
// kernels/ allocates, throws, logs or knows of threads.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <variant>

#include "kernels/layout/node_block.h"
#include "kernels/layout/particle_span.h"
#include "kernels/layout/stencil.h"
#include "kernels/material/materials.h"
#include "kernels/transfer/transfers.h"

namespace repose {

/// Instruction sets, best last.
enum class Target { kBaseline, kAvx2, kAvx512 };
inline constexpr int kTargets = 3;

/// Name for reports and for the option that forces one: "baseline", "avx2", "avx512".
const char* target_name(Target target);
/// Whether this machine can run it.
bool target_supported(Target target);
/// The best one that it can.
Target best_target();

/// Particles per call: what a pass hands to the next through scratch stays in the first cache level.
inline constexpr std::size_t kChunk = 128;

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
  ParticleSpan<Real> particles;  ///< positions are read, and velocities where `before` is given
  Lattice<Real> lattice;
  Real* velocity[3];                  ///< out: v that the particle keeps, m/s
  Real* affine[kAffineComponents];    ///< out: C that it keeps, 1/s; only where the transfer keeps one
  Real* moving[3];                    ///< out: sum w v_i, which moves it, m/s
  Real* gradient[kAffineComponents];  ///< out: gradient of velocity, which strains it, 1/s; with forces by
                                      ///< moments it is C
  const Real* before[3];              ///< sum w v_i before forces, m/s; null unless the transfer keeps velocity
  Real kept_velocity;                 ///< share of its own velocity that a particle keeps, in [0, 1]
  Soon<Real> soon;                    ///< asked for meanwhile
};

/// What moving a span of particles did to it.
template <class Real>
struct Motion {
  Real speed_squared = 0;       ///< largest |v|^2, m^2/s^2
  Real gradient_squared = 0;    ///< largest |grad v|^2 (Frobenius), 1/s^2
  Real lowest = kInEveryBlock;  ///< least and largest position component, cells from the block's origin
  Real highest = kInEveryBlock;

  static constexpr Real kInEveryBlock = 2;  ///< a coordinate that is no drift, whatever the stencil
};

/// One material's passes over a span, all on the strain channel in place.
template <class Real>
struct MaterialInput {
  const void* constants;  ///< the material's Constants<Real>
  Real* strain[kStrainComponents];
  const Real* gradient[kAffineComponents];  ///< of velocity, 1/s; not the stored C
  Real* stress[kStrainComponents];          ///< out, Pa
  Real dt;
  std::size_t count;
  std::ptrdiff_t ahead = 0;  ///< as in ParticleSpan
};

/// The yield surface of each particle of a span, |dev eps| <= cohesion - cone tr(eps), and what yielding did.
template <class Real>
struct YieldInput {
  const Real* cone;       ///< bc = alpha (3 lambda + 2 mu) / (2 mu)
  const Real* cohesion;   ///< k = c_C / (2 mu), c_C the norm of the deviator that holds at no pressure
  const Real* dilatancy;  ///< bD: the flow e/|e| + bD I opens the sand by 3 bD per unit of shear
  Real* plastic;          ///< out: |trial - returned|
  Real* sheared;          ///< out: the same, but 0 where the sand has opened
  Real* dilated;          ///< out: 3 bD dg, the log volume that shear has opened
};

/// Friction that follows the plastic shear q (Klar et al. 2016, eqs. 29-31), in radians:
///   phi = h0 + (h1 q - h3) exp(-h2 q),  cone = cone_over_slope alpha(phi)
template <class Real>
struct HardeningConstants {
  Real h0, h1, h2, h3;
  ConeMatching matching;
  Real cone_over_slope;  ///< bc / alpha
};

/// Friction that follows the rate of shear, mu(I) (Jop et al. 2006), for one step of the return map:
///   mu = mu_s + (mu_2 - mu_s) / (1 + I0 / I),  I = |shear rate| d / sqrt(p / rho_s)
template <class Real>
struct RateConstants {
  Real rise;       ///< bc of mu_2 less that of mu_s
  Real threshold;  ///< I0
  Real inertia;    ///< sqrt(2 rho_s / K) d, in s: I = inertia dg / (dt sqrt(|t|))
};

/// How sand answers within an implicit step (kernels/material/drucker_prager_response.h). Materials that do not
/// yield answer alike in all.
enum class TangentMode { kExact, kProjected, kLagged, kUnilateral };
inline constexpr int kTangentModes = 4;

/// What the change of a particle's stress with the velocities takes (kernels/pass/stiffness.cpp): U and Q by
/// rows, the slopes A by rows, theta and beta of the pairs of axes xy xz yz. Particles lie in groups: number k
/// of particle p at (p / kTangentGroup * kTangentValues + k) * kTangentGroup + p % kTangentGroup.
inline constexpr std::size_t kTangentValues = 33;
inline constexpr std::size_t kTangentGroup = 16;

template <class Real>
struct TangentInput {
  MaterialInput<Real> material;          ///< strain is the trial strain; no stress is written
  YieldInput<Real> surface;              ///< by which it yields; cone null: by the numbers of the material
  UnilateralConstants<Real> unilateral;  ///< of the mode of that name
  Real* tangent;                         ///< out, room for whole groups
};

/// What a trial strain weighs against an elastic strain that was foretold (kernels/pass/stiffness.cpp).
inline constexpr double kTrialWeight = 0.2;

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
struct MaterialKernels {
  void (*trial)(const MaterialInput<Real>&);  ///< strain <- elastic trial strain after dt of the gradient
  void (*project)(
      const MaterialInput<Real>&);  ///< strain <- the strain that the yield surface allows; may be null
  void (*stress)(const MaterialInput<Real>&);  ///< stress <- tau(strain)
  /// As project, by numbers per particle; null where project is.
  void (*project_shaped)(const MaterialInput<Real>&, const YieldInput<Real>&);
  void (*linearize[kTangentModes])(const TangentInput<Real>&);
  /// strain <- the point of the law between the trial strain and S as a linear model foretold it; offset <- the
  /// change of dt grad v from that point to the trial state. Null where project is.
  void (*resolve)(const TangentInput<Real>&, const Real* const foretold[9], Real* const offset[9]);
  /// stress <- that of the unilateral energy, of the trial strain; null where project is.
  void (*fading_stress)(const MaterialInput<Real>&, const UnilateralConstants<Real>&);
};

template <class Real>
struct TransferKernels {
  /// Adds mass and momentum to the arena; sets the bit x * 8 + y of `rows` for each row touched; returns the
  /// runs.
  std::size_t (*scatter)(const ScatterInput<Real>&, Real* arena, std::uint64_t& rows);
  void (*gather)(const GatherInput<Real>&, const Real* arena);
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
  /// velocity <- sum w v_i
  void (*interpolate)(const ParticleSpan<Real>&, int flat_axis, const Real* arena, Real* const velocity[3]);
};

/// On a block of node vectors, four values a node.
template <class Real>
struct VectorKernels {
  /// x^T y, summed in double.
  double (*dot)(const Real* x, const Real* y);
  void (*add)(Real a, const Real* x, Real* y);        ///< y += a x
  void (*scale_add)(const Real* x, Real b, Real* y);  ///< y = x + b y
  /// y = weight m x and y = x / m, m the first value of `nodes`; of y it is zero, and all where m is.
  void (*times_mass)(const Real* nodes, Real weight, const Real* x, Real* y);
  void (*over_mass)(const Real* nodes, const Real* x, Real* y);
};

/// Bounds of the velocities of a block's active nodes.
template <class Real>
struct VelocityBounds {
  Real low[3];
  Real high[3];
  bool empty;   ///< no active node
  bool finite;  ///< every value of every active node is finite
};

/// Every kernel of one instruction set and precision.
template <class Real>
struct Kernels {
  static constexpr int kStencils = std::tuple_size_v<Stencils>;
  static constexpr int kTransfers = std::tuple_size_v<Transfers>;
  static constexpr int kMaterials = std::variant_size_v<MaterialParameters>;
  StencilKernels<Real> stencil[kStencils];
  TransferKernels<Real> transfer[kStencils][kTransfers];
  MaterialKernels<Real> material[kMaterials];
  VectorKernels<Real> vector;

  void (*advance)(const ParticleSpan<Real>&, const Real* const velocity[3], const Real* const gradient[9],
                  Real cells_per_velocity, Motion<Real>&);
  /// Index of the first particle whose trial motion must not be accepted, or count: it would cross more than a
  /// cell, det(I + dt grad v) <= 0, or a value is not finite.
  std::size_t (*inspect)(const Real* const velocity[3], const Real* const gradient[9], std::size_t count,
                         Real dt, Real spacing);
  void (*open_volume)(Real* const strain[6], const Real* gained, Real* trace, std::size_t count);
  /// cone <- that of the plastic shear q of each particle.
  void (*harden)(const Real* q, const HardeningConstants<Real>& law, Real* cone, std::size_t count);
  /// cone <- the cone at which the trial strain comes to rest when friction rises with the rate of its own
  /// plastic shear.
  void (*quicken)(const Real* const strain[6], const Real* cohesion, const RateConstants<Real>& law, Real dt,
                  Real* cone, std::size_t count);
  /// strain <- its image where no principal stress exceeds `limit` (Pa): Rankine's tension cut-off, by flow
  /// along the principal directions that exceed it. A crack is no gap on all sides: by how much it opens is
  /// taken from `trace_of_trial`, so that close_volume does not count it; null where nobody closes.
  void (*cut_tension)(Real* const strain[6], const HenckyConstants<Real>& elastic, Real limit,
                      Real* trace_of_trial, std::size_t count);
  void (*close_volume)(const Real* const strain[6], Real* gained, const Real* trace, std::size_t count);

  /// matrix <- S = tau (I + dt grad v)^-T, by rows. False where a particle would be turned inside out or nearly
  /// so.
  bool (*turn)(const Real* const stress[6], const Real* const gradient[9], Real dt, Real* const matrix[9],
               std::size_t count);
  /// matrix <- the change of S with a change `gradient` of dt grad v.
  void (*apply_tangent)(const Real* tangent, const Real* const gradient[9], Real* const matrix[9],
                        std::size_t count);

  /// Momentum to velocity; nodes lighter than `least_mass` become empty. Returns the active nodes, bit x*16 +
  /// y*4 + z.
  std::uint64_t (*normalize)(Real* nodes, Real least_mass);
  void (*accelerate)(Real* nodes, const Real change[3]);
  void (*bound)(const Real* nodes, VelocityBounds<Real>&);
};

/// The table of an instruction set that the machine supports. Real is float or double.
template <class Real>
const Kernels<Real>& kernels(Target target);

}  // namespace repose
