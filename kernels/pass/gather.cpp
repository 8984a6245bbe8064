// Repose: nodes to particles (Klar et al. 2016, eqs. 11-12, and the gradient of eq. 16).
//   v = sum w v_i,   C = D^-1 sum w v_i (x_i - x_p)^T,   grad v = C by moments, sum v_i grad w^T by gradients
// Segments keep their rows of nodes in registers; the sums over the four nodes of a row are taken in the order
// that simd.h writes down.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/gather.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/base/targets.h"

#include "kernels/base/simd-inl.h"
#include "kernels/layout/stencil.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/for_each_transfer.h"
#include "kernels/transfer/transfers.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// What decides the shape of the loops: many transfers share it.
template <class Stencil, Affine affine, Force force>
struct Loops {
  static constexpr int kWidth = Stencil::kWidth;
  static constexpr int kCenter = Stencil::kCenter;
  static constexpr bool kAffine = affine != Affine::kNone;
  static constexpr bool kSlopes = force == Force::kGradients;  ///< sums with the weights' slopes are wanted
  static constexpr bool kMoments = !kSlopes || (kAffine && Stencil::kConstantD);
};

template <class T>
struct Staged {
  static constexpr std::size_t kValues = 4 * Pack<T>::size();
  StencilPack<T> stencil;
  alignas(64) T sum[kValues];        // sum w (m, v)
  alignas(64) T moment[3][kValues];  // its first moments along x, y, z about the centre node, in cells
  alignas(64) T slope[3][kValues];   // sum w' (m, v) along x, y, z, in 1/dx
};

/// Sums along one axis over the nodes of a stencil: with the weights, with their first moments and with their
/// slopes.
template <class T>
struct AxisSums {
  Row<T> sum, moment, slope;
};

template <class S, class T>
REPOSE_INLINE AxisSums<T> sum_axis(const Row<T>* rows, const T* weight, const T* slope) {
  AxisSums<T> out;
  if constexpr (S::kWidth == 2) {
    out.sum = fma(rows[0], Pack<T>(weight[0]), rows[1] * Pack<T>(weight[1]));
  } else {  // the centre node has no moment
    const Row<T> low = rows[0] * Pack<T>(weight[0]), high = rows[2] * Pack<T>(weight[2]);
    Row<T> sides = low + high;
    if constexpr (S::kMoments) out.moment = high - low;
    if constexpr (S::kWidth == 4) {
      const Row<T> far = rows[3] * Pack<T>(weight[3]);
      sides = sides + far;
      if constexpr (S::kMoments) out.moment = fma(far, Pack<T>(T(2)), out.moment);
    }
    out.sum = fma(rows[1], Pack<T>(weight[1]), sides);
  }
  if constexpr (S::kSlopes) {
    out.slope = rows[0] * Pack<T>(slope[0]);
    HWY_UNROLL(4)
    for (int k = 1; k < S::kWidth; ++k) out.slope = fma(rows[k], Pack<T>(slope[k]), out.slope);
  }
  return out;
}

/// sum of weight[i] rows[i]
template <class S, class T>
REPOSE_INLINE Row<T> weigh(const Row<T>* rows, const T* weight) {
  Row<T> sum = rows[S::kWidth - 1] * Pack<T>(weight[S::kWidth - 1]);
  HWY_UNROLL(4)
  for (int k = S::kWidth - 2; k >= 0; --k) sum = fma(rows[k], Pack<T>(weight[k]), sum);
  return sum;
}

/// Sums over the stencil of the node values, first along y, then x, then z.
template <class S, class T>
REPOSE_INLINE void sum_stencil(const Row<T> (&rows)[S::kWidth * S::kWidth], const Row<T>& z_positions,
                               std::size_t lane, Staged<T>& staged) {
  const std::size_t at = 4 * lane;
  const StencilPack<T>& stencil = staged.stencil;
  Row<T> plane[S::kWidth], moment_y[S::kWidth], slope_y[S::kWidth];
  HWY_UNROLL(4)
  for (int i = 0; i < S::kWidth; ++i) {
    const AxisSums<T> y = sum_axis<S>(rows + S::kWidth * i, stencil.weight[1] + at, stencil.slope[1] + at);
    plane[i] = y.sum;
    moment_y[i] = y.moment;
    slope_y[i] = y.slope;
  }
  const Row<T> weight_z = spread_over_values(stencil.weight[2] + at);
  const AxisSums<T> x = sum_axis<S>(plane, stencil.weight[0] + at, stencil.slope[0] + at);
  const Row<T> sum = x.sum * weight_z;
  if constexpr (S::kMoments) {
    const Row<T> along_y = weigh<S>(moment_y, stencil.weight[0] + at) * weight_z;
    sum_over_nodes(sum, x.moment * weight_z, along_y, sum * z_positions, staged.sum + at, staged.moment[0] + at,
                   staged.moment[1] + at, staged.moment[2] + at);
  }
  if constexpr (S::kSlopes) {
    const Row<T> along_y = weigh<S>(slope_y, stencil.weight[0] + at) * weight_z;
    sum_over_nodes(sum, x.slope * weight_z, along_y, x.sum * spread_over_values(stencil.slope[2] + at),
                   staged.sum + at, staged.slope[0] + at, staged.slope[1] + at, staged.slope[2] + at);
  }
}

/// Writes the nine numbers of D^-1 (moments - v (x_p - x_c)^T), or of the slopes by dx, where they are wanted.
template <class T>
REPOSE_INLINE void store_matrix(const Pack<T> (&column)[3], int axis, T* const to[9], std::size_t first,
                                std::size_t lanes) {
  if (to[0] == nullptr) return;
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) column[row].store_first(to[3 * row + axis] + first, lanes);
}

template <class S, class T>
REPOSE_INLINE void finish_matrices(const GatherInput<T>& in, const Staged<T>& staged, const Pack<T> (&v)[3],
                                   std::size_t first, std::size_t lanes) {
  using P = Pack<T>;
  const P per_cell(T(1) / in.lattice.spacing);
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    P mass, column[3];
    if constexpr (S::kMoments) {
      P moment[3];
      load_interleaved(staged.moment[axis], mass, moment[0], moment[1], moment[2]);
      const P scale(in.lattice.axis_scale[axis]);
      HWY_UNROLL(3)
      for (int row = 0; row < 3; ++row) {
        column[row] = scale * fnma(staged.stencil.from_center[axis], v[row], moment[row]);
      }
      if constexpr (S::kAffine) store_matrix(column, axis, in.affine, first, lanes);
      if constexpr (!S::kSlopes) store_matrix(column, axis, in.gradient, first, lanes);
    }
    if constexpr (S::kSlopes) {
      load_interleaved(staged.slope[axis], mass, column[0], column[1], column[2]);
      HWY_UNROLL(3)
      for (int row = 0; row < 3; ++row) column[row] = per_cell * column[row];
      if constexpr (S::kAffine && !S::kMoments) store_matrix(column, axis, in.affine, first, lanes);
      store_matrix(column, axis, in.gradient, first, lanes);
    }
  }
}

template <class S, class T>
REPOSE_INLINE void finish(const GatherInput<T>& in, const Staged<T>& staged, std::size_t first,
                          std::size_t lanes) {
  using P = Pack<T>;
  const auto next = static_cast<std::ptrdiff_t>(first) + in.particles.ahead;
  P mass, v[3];
  load_interleaved(staged.sum, mass, v[0], v[1], v[2]);
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    P::prefetch(in.particles.position[row] + next);
    P::prefetch(in.particles.velocity[row] + next);
    if (in.moving[row] != nullptr) v[row].store_first(in.moving[row] + first, lanes);
    if (in.velocity[row] == nullptr) continue;
    P kept = v[row];
    if (in.before[row] != nullptr) {
      const P own = P::load_first(in.particles.velocity[row] + first, lanes);
      kept = fma(P(in.kept_velocity), own - P::load_first(in.before[row] + first, lanes), kept);
    }
    kept.store_first(in.velocity[row] + first, lanes);
  }
  if constexpr (S::kAffine) {
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) P::prefetch(in.particles.affine[k] + next);
  }
  finish_matrices<S>(in, staged, v, first, lanes);
}

template <class Stencil, class T>
REPOSE_INLINE void load_rows(const T* arena, std::int32_t node,
                             Row<T> (&rows)[Stencil::kWidth * Stencil::kWidth]) {
  constexpr int kWidth = Stencil::kWidth;
  const T* corner = arena + node * kNodeValues;
  HWY_UNROLL(16)
  for (int r = 0; r < kWidth * kWidth; ++r) {
    rows[r] = load_row(corner + ((r / kWidth) * kArenaSide + r % kWidth) * kArenaRow);
  }
}

/// A particle's share of what is read soon.
template <class T>
REPOSE_INLINE void ask_for(const Soon<T>& soon, std::size_t particle) {
  constexpr std::size_t kLine = 64 / sizeof(T);
  for (std::size_t k = 0; k < soon.values; k += kLine) {
    Pack<T>::prefetch(soon.from + particle * soon.values + k);
  }
}

template <class Stencil, Affine affine, Force force, class T>
void gather(const GatherInput<T>& in, const T* arena) {
  using S = Loops<Stencil, affine, force>;
  Staged<T> staged;
  Row<T> rows[S::kWidth * S::kWidth];
  const Row<T> z_positions = node_positions(T(S::kCenter));
  std::int32_t node = -1;
  for (const auto [first, lanes] : packs<T>(in.particles.count)) {
    locate<Stencil, force>(in.particles.position, first, lanes, in.lattice.flat_axis, staged.stencil);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (staged.stencil.node[lane] != node) {
        node = staged.stencil.node[lane];
        load_rows<Stencil>(arena, node, rows);
      }
      sum_stencil<S>(rows, z_positions, lane, staged);
      ask_for(in.soon, first + lane);
    }
    finish<S>(in, staged, first, lanes);
  }
}

/// sum w v_i alone.
template <class Stencil, class T>
void interpolate(const ParticleSpan<T>& particles, int flat_axis, const T* arena, T* const velocity[3]) {
  constexpr int kWidth = Stencil::kWidth;
  StencilPack<T> stencil;
  alignas(64) T sums[4 * Pack<T>::size()];
  Row<T> rows[kWidth * kWidth];
  std::int32_t node = -1;
  for (const auto [first, lanes] : packs<T>(particles.count)) {
    locate<Stencil, Force::kMoments>(particles.position, first, lanes, flat_axis, stencil);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const std::size_t at = 4 * lane;
      if (stencil.node[lane] != node) {
        node = stencil.node[lane];
        load_rows<Stencil>(arena, node, rows);
      }
      Row<T> plane[kWidth];
      HWY_UNROLL(4)
      for (int i = 0; i < kWidth; ++i) plane[i] = weigh<Stencil>(rows + kWidth * i, stencil.weight[1] + at);
      const Row<T> sum = weigh<Stencil>(plane, stencil.weight[0] + at);
      sum_over_nodes(sum * spread_over_values(stencil.weight[2] + at), sums + at);
    }
    Pack<T> mass, v[3];
    load_interleaved(sums, mass, v[0], v[1], v[2]);
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) v[axis].store_first(velocity[axis] + first, lanes);
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    // A skew matrix goes to the nodes, but all of C is kept: RPIC gathers as APIC does.
    constexpr Affine kAffine = Transfer::kAffine == Affine::kNone ? Affine::kNone : Affine::kFull;
    table.transfer[s][t].gather = gather<Stencil, kAffine, force_of<Stencil, Transfer>(), T>;
    table.transfer[s][t].gradient = gather<Stencil, Affine::kNone, force_of<Stencil, Transfer>(), T>;
    table.stencil[s].interpolate = interpolate<Stencil, T>;
  });
}

void fill(KernelTables& tables) {
  fill_precision(tables.single);
  fill_precision(tables.dual);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace repose {
REPOSE_DEFINE_FILL(gather, Kernels)
}  // namespace repose
#endif
