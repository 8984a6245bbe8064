// Repose: nodes to particles (Klar et al. 2016, eqs. 11-12, and the gradient of eq. 16).
//   v = sum w v_i,   C = D^-1 sum w v_i (x_i - x_p)^T,   grad v = C by moments, sum v_i grad w^T by gradients
// Segments keep their rows of nodes in registers; the sums over the four nodes of a row are taken in the order
// that simd.h writes down.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/gather.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/base/simd-inl.h"
#include "kernels/base/small_matrix-inl.h"
#include "kernels/layout/stencil.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/for_each_transfer.h"
#include "kernels/transfer/transfers.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// What particles have for themselves beside what nodes tell them.
enum class Own {
  kNothing,
  kHeld,      ///< what was found when it was measured last
  kMeasured,  ///< v_p - sum w v_i before forces
};

/// What decides the shape of the loops: many transfers share it.
template <class Stencil, Affine affine, Force force, Own own>
struct Loops {
  static constexpr int kWidth = Stencil::kWidth;
  static constexpr int kCenter = Stencil::kCenter;
  static constexpr bool kAffine = affine != Affine::kNone;
  static constexpr bool kSlopes = force == Force::kGradients;  ///< sums with the weights' slopes are wanted
  static constexpr bool kMoments = !kSlopes || (kAffine && Stencil::kConstantD);
  static constexpr Own kOwn = own;
};

/// Sums over the stencils of a pack of particles.
template <class T>
struct Sums {
  static constexpr std::size_t kValues = 4 * Pack<T>::size();
  alignas(64) T sum[kValues];        // sum w (m, v)
  alignas(64) T moment[3][kValues];  // its first moments along x, y, z about the centre node, in cells
  alignas(64) T slope[3][kValues];   // sum w' (m, v) along x, y, z, in 1/dx
};

template <class T>
struct Staged {
  StencilPack<T> stencil;
  Sums<T> sums;
  alignas(64) T before[Sums<T>::kValues];  // sum w (m, v) before forces
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
                               const StencilPack<T>& stencil, std::size_t lane, Sums<T>& sums) {
  const std::size_t at = 4 * lane;
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
    sum_over_nodes(sum, x.moment * weight_z, along_y, sum * z_positions, sums.sum + at, sums.moment[0] + at,
                   sums.moment[1] + at, sums.moment[2] + at);
  }
  if constexpr (S::kSlopes) {
    const Row<T> along_y = weigh<S>(slope_y, stencil.weight[0] + at) * weight_z;
    sum_over_nodes(sum, x.slope * weight_z, along_y, x.sum * spread_over_values(stencil.slope[2] + at),
                   sums.sum + at, sums.slope[0] + at, sums.slope[1] + at, sums.slope[2] + at);
  }
}

/// D^-1 (moments - v (x_p - x_c)^T).
template <class T>
REPOSE_INLINE Mat3<Pack<T>> matrix_of_moments(const Sums<T>& sums, const StencilPack<T>& stencil,
                                              const Pack<T> (&v)[3], const Lattice<T>& lattice) {
  Mat3<Pack<T>> matrix;
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    Pack<T> mass, moment[3];
    load_interleaved(sums.moment[axis], mass, moment[0], moment[1], moment[2]);
    const Pack<T> scale(lattice.axis_scale[axis]);
    HWY_UNROLL(3)
    for (int row = 0; row < 3; ++row) {
      matrix.m[row][axis] = scale * fnma(stencil.from_center[axis], v[row], moment[row]);
    }
  }
  return matrix;
}
/// The slopes by dx.
template <class T>
REPOSE_INLINE Mat3<Pack<T>> matrix_of_slopes(const Sums<T>& sums, T spacing) {
  const Pack<T> per_cell(T(1) / spacing);
  Mat3<Pack<T>> matrix;
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    Pack<T> mass, slope[3];
    load_interleaved(sums.slope[axis], mass, slope[0], slope[1], slope[2]);
    HWY_UNROLL(3)
    for (int row = 0; row < 3; ++row) matrix.m[row][axis] = per_cell * slope[row];
  }
  return matrix;
}

/// Where it is wanted.
template <class T>
REPOSE_INLINE void store_matrix(const Mat3<Pack<T>>& matrix, T* const to[9], std::size_t first,
                                std::size_t lanes) {
  if (to[0] == nullptr) return;
  HWY_UNROLL(9)
  for (int k = 0; k < 9; ++k) matrix.m[k / 3][k % 3].store_first(to[k] + first, lanes);
}

/// C <- C - dt W W, W the skew part of C: to turn is to be accelerated inwards, and the slopes of velocity at
/// the end of the step are those at its begin less what nodes do not see of that (docs/math.md, section 47).
/// Plane strain turns about its flat axis alone.
template <class T>
REPOSE_INLINE void turn(T dt, int flat_axis, Mat3<Pack<T>>& c) {
  using P = Pack<T>;
  const auto spin = [&](int axis, const P& fore, const P& aft) HWY_ATTR {
    return P(flat_axis < 0 || flat_axis == axis ? T(0.5) : T(0)) * (fore - aft);
  };
  const P x = spin(0, c.m[2][1], c.m[1][2]), y = spin(1, c.m[0][2], c.m[2][0]),
          z = spin(2, c.m[1][0], c.m[0][1]);
  // W W = w w^T - |w|^2
  const P step(dt), dt_x = step * x, dt_y = step * y, dt_z = step * z;
  c.m[0][0] = fma(dt_y, y, fma(dt_z, z, c.m[0][0]));
  c.m[1][1] = fma(dt_x, x, fma(dt_z, z, c.m[1][1]));
  c.m[2][2] = fma(dt_x, x, fma(dt_y, y, c.m[2][2]));
  c.m[0][1] = fnma(dt_x, y, c.m[0][1]), c.m[1][0] = fnma(dt_x, y, c.m[1][0]);
  c.m[0][2] = fnma(dt_x, z, c.m[0][2]), c.m[2][0] = fnma(dt_x, z, c.m[2][0]);
  c.m[1][2] = fnma(dt_y, z, c.m[1][2]), c.m[2][1] = fnma(dt_y, z, c.m[2][1]);
}

template <class S, class T>
REPOSE_INLINE void finish(const GatherInput<T>& in, const Staged<T>& staged, std::size_t first,
                          std::size_t lanes) {
  using P = Pack<T>;
  const auto next = static_cast<std::ptrdiff_t>(first) + in.particles.ahead;
  P mass, v[3], before[3];
  load_interleaved(staged.sums.sum, mass, v[0], v[1], v[2]);
  if (in.mass != nullptr) mass.store_first(in.mass + first, lanes);
  if constexpr (S::kOwn == Own::kMeasured)
    load_interleaved(staged.before, mass, before[0], before[1], before[2]);
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    P::prefetch(in.particles.position[row] + next);
    P::prefetch(in.particles.velocity[row] + next);
    if constexpr (S::kOwn != Own::kNothing) P::prefetch(in.own[row] + next);
    if (in.moving[row] != nullptr) v[row].store_first(in.moving[row] + first, lanes);
    if (in.velocity[row] == nullptr) continue;
    if constexpr (S::kOwn == Own::kNothing) {
      v[row].store_first(in.velocity[row] + first, lanes);
    } else {
      P own;
      if constexpr (S::kOwn == Own::kMeasured) {
        own = P::load_first(in.particles.velocity[row] + first, lanes) - before[row];
      } else {
        own = P::load_first(in.own[row] + first, lanes);
      }
      own = P(in.kept_velocity) * own;
      own.store_first(in.own[row] + first, lanes);
      (v[row] + own).store_first(in.velocity[row] + first, lanes);
    }
  }
  if constexpr (S::kAffine) {
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) P::prefetch(in.particles.affine[k] + next);
  }
  Mat3<P> moments, slopes;
  if constexpr (S::kMoments) moments = matrix_of_moments(staged.sums, staged.stencil, v, in.lattice);
  if constexpr (S::kSlopes) slopes = matrix_of_slopes(staged.sums, in.lattice.spacing);
  store_matrix(S::kSlopes ? slopes : moments, in.gradient, first, lanes);
  if constexpr (S::kAffine) {
    Mat3<P> c = S::kMoments ? moments : slopes;
    if constexpr (S::kOwn != Own::kNothing) turn(in.dt, in.lattice.flat_axis, c);
    store_matrix(c, in.affine, first, lanes);
  }
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

/// sum w v_i alone.
template <class S, class T>
REPOSE_INLINE void interpolate(const Row<T> (&rows)[S::kWidth * S::kWidth], const StencilPack<T>& stencil,
                               std::size_t lane, T* sums) {
  const std::size_t at = 4 * lane;
  Row<T> plane[S::kWidth];
  HWY_UNROLL(4)
  for (int i = 0; i < S::kWidth; ++i) plane[i] = weigh<S>(rows + S::kWidth * i, stencil.weight[1] + at);
  const Row<T> sum = weigh<S>(plane, stencil.weight[0] + at);
  sum_over_nodes(sum * spread_over_values(stencil.weight[2] + at), sums + at);
}

/// The rows of nodes around particles, one after the other: those of a segment are loaded once.
template <class Stencil, class T>
class LoadedRows {
 public:
  REPOSE_INLINE explicit LoadedRows(const T* arena) : arena_(arena) {}

  REPOSE_INLINE const Row<T> (&at(std::int32_t node))[Stencil::kWidth * Stencil::kWidth] {
    if (node != node_) load_rows<Stencil>(arena_, node_ = node, rows_);
    return rows_;
  }

 private:
  const T* arena_;
  std::int32_t node_ = -1;
  Row<T> rows_[Stencil::kWidth * Stencil::kWidth];
};

template <class Stencil, Affine affine, Force force, Own own, class T>
void gather(const GatherInput<T>& in, const T* arena) {
  using S = Loops<Stencil, affine, force, own>;
  Staged<T> staged;
  LoadedRows<Stencil, T> now(arena), before(in.before);
  const Row<T> z_positions = node_positions(T(S::kCenter));
  for (const auto [first, lanes] : packs<T>(in.particles.count)) {
    const StencilPack<T>& stencil = staged.stencil;
    locate<Stencil, force>(in.particles.position, first, lanes, in.lattice.flat_axis, staged.stencil);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      sum_stencil<S>(now.at(stencil.node[lane]), z_positions, stencil, lane, staged.sums);
      if constexpr (own == Own::kMeasured) {
        interpolate<S>(before.at(stencil.node[lane]), stencil, lane, staged.before);
      }
      ask_for(in.soon, first + lane);
    }
    finish<S>(in, staged, first, lanes);
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    // A skew matrix goes to the nodes, but all of C is kept: RPIC gathers as APIC does.
    constexpr Affine kAffine = Transfer::kAffine == Affine::kNone ? Affine::kNone : Affine::kFull;
    constexpr Force kForce = force_of<Stencil, Transfer>();
    constexpr Own kHeld = Transfer::kKeepsVelocity ? Own::kHeld : Own::kNothing;
    TransferKernels<T>& to = table.transfer[s][t];
    to.gather = gather<Stencil, kAffine, kForce, kHeld, T>;
    to.gather_measuring = nullptr;
    if constexpr (Transfer::kKeepsVelocity) {
      to.gather_measuring = gather<Stencil, kAffine, kForce, Own::kMeasured, T>;
    }
    to.gradient = gather<Stencil, Affine::kNone, kForce, Own::kNothing, T>;
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
