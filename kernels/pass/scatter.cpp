// Repose: particles to nodes. Node i of the stencil receives mass w m and momentum (Klar et al. 2016, eqs. 7-9)
//   w (m v + m A (x_i - x_p)) + dt f_i,
//   f_i = -V0 tau D^-1 w (x_i - x_p)  by moments (Hu et al. 2018),   or  -V0 tau grad w  by gradients
// as rows of four nodes. Particles with one base node (a segment) add up in registers and touch memory once.
// Where particles keep their velocity, a second arena receives the momentum without dt f_i in the same sweep.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/scatter.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

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
template <class Stencil, Affine affine, Force force, bool before = false>
struct Loops {
  static constexpr int kWidth = Stencil::kWidth;
  static constexpr int kCenter = Stencil::kCenter;
  static constexpr bool kAffine = affine != Affine::kNone;
  static constexpr bool kPush = force == Force::kGradients;  ///< forces by gradients
  static constexpr bool kSlope = kAffine || !kPush;          ///< momentum varies along the stencil
  static constexpr bool kBefore = before;                    ///< momentum before forces is wanted too
};

/// Of a pack of particles, turned to be read one particle at a time, four numbers each.
template <class T>
struct Momentum {
  static constexpr std::size_t kLanes = Pack<T>::size();
  alignas(64) T center[4 * kLanes];    // m, and the momentum that the centre node would get
  alignas(64) T slope[3][4 * kLanes];  // 0, and its change per cell along x, y, z
};
template <class T>
struct Staged {
  Momentum<T> momentum, before;
  alignas(64) T push[3][4 * Pack<T>::size()];  // 0, and -dt V0 tau_axis / dx, for the weights' slopes
  StencilPack<T> stencil;
};

/// A, entry (row, axis).
template <Affine affine, class T>
REPOSE_INLINE Pack<T> p2g_affine(const Pack<T> (&c)[3][3], int row, int axis, T kept_stretching) {
  if constexpr (affine == Affine::kFull) return c[row][axis];
  const Pack<T> half(T(0.5));
  const Pack<T> spin = half * (c[row][axis] - c[axis][row]), stretch = half * (c[row][axis] + c[axis][row]);
  return fma(Pack<T>(kept_stretching), stretch, spin);
}

/// Momentum at the centre node, and its slopes unless they are zero.
template <bool slopes, class T>
REPOSE_INLINE void store(Pack<T> mass, const Pack<T> (&momentum)[3], const Pack<T> (&slope)[3][3],
                         Momentum<T>& out) {
  store_interleaved(mass, momentum[0], momentum[1], momentum[2], out.center);
  if constexpr (!slopes) return;
  const Pack<T> zero(T(0));
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    store_interleaved(zero, slope[axis][0], slope[axis][1], slope[axis][2], out.slope[axis]);
  }
}

/// From a particle to the centre node.
template <class T>
REPOSE_INLINE Pack<T> at_center(Pack<T> momentum, const Pack<T> (&slope)[3][3], int row,
                                const StencilPack<T>& stencil) {
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    momentum = fnma(slope[axis][row], stencil.from_center[axis], momentum);
  }
  return momentum;
}

template <class Stencil, Affine affine, Force force, bool before, class T>
REPOSE_INLINE void stage(const ScatterInput<T>& in, std::size_t first, std::size_t lanes, Staged<T>& out) {
  using P = Pack<T>;
  using S = Loops<Stencil, affine, force, before>;
  locate<Stencil, force>(in.particles.position, first, lanes, in.lattice.flat_axis, out.stencil);
  const P mass(in.mass), mass_per_cell(in.mass * in.lattice.spacing), zero(T(0));
  const P push_scale(-in.impulse_volume / in.lattice.spacing);
  static constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const auto next = static_cast<std::ptrdiff_t>(first) + in.particles.ahead;
  P momentum[3], slope[3][3], push[3][3], c[3][3], own_momentum[3], own_slope[3][3];
  if constexpr (S::kAffine) {
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) {
      P::prefetch(in.particles.affine[k] + next);
      c[k / 3][k % 3] = P::load_first(in.particles.affine[k] + first, lanes);
    }
  }
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    P::prefetch(in.particles.velocity[row] + next);
    P::prefetch(in.particles.position[row] + next);
    momentum[row] = mass * P::load_first(in.particles.velocity[row] + first, lanes);
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      const P tau = P::load_first(in.stress[kSymmetric[row][axis]] + first, lanes);
      if constexpr (S::kAffine) {
        // The single node of a flat axis has no lever: RPIC's mirror must not give it one.
        const bool flat = affine == Affine::kSkew && axis == in.lattice.flat_axis;
        slope[axis][row] = flat ? zero : mass_per_cell * p2g_affine<affine>(c, row, axis, in.kept_stretching);
      } else {
        slope[axis][row] = zero;
      }
      own_slope[axis][row] = slope[axis][row];
      if constexpr (S::kPush) {
        push[axis][row] = push_scale * tau;
      } else {
        const P impulse_per_cell(in.impulse_volume * in.lattice.axis_scale[axis]);
        slope[axis][row] = fnma(impulse_per_cell, tau, slope[axis][row]);
      }
    }
    if constexpr (S::kBefore) {
      own_momentum[row] = mass * P::load_first(in.own_velocity[row] + first, lanes);
      if constexpr (S::kAffine) {
        own_momentum[row] = at_center(own_momentum[row], own_slope, row, out.stencil);
      }
    }
    if constexpr (S::kSlope) momentum[row] = at_center(momentum[row], slope, row, out.stencil);
  }
  store<S::kSlope>(mass, momentum, slope, out.momentum);
  if constexpr (S::kBefore) store<S::kAffine>(mass, own_momentum, own_slope, out.before);
  if constexpr (S::kPush) {
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      store_interleaved(zero, push[axis][0], push[axis][1], push[axis][2], out.push[axis]);
    }
  }
}

/// The same of pushes alone: no mass and no momentum but that of -scale S g_i.
template <class Stencil, Force force, class T>
REPOSE_INLINE void stage(const PushInput<T>& in, std::size_t first, std::size_t lanes, Staged<T>& out) {
  using P = Pack<T>;
  constexpr bool kPush = force == Force::kGradients;
  locate<Stencil, force>(in.particles.position, first, lanes, in.lattice.flat_axis, out.stencil);
  const P zero(T(0));
  P momentum[3] = {zero, zero, zero}, change[3][3];
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    const P scale(kPush ? -in.scale / in.lattice.spacing : -in.scale * in.lattice.axis_scale[axis]);
    HWY_UNROLL(3)
    for (int row = 0; row < 3; ++row) {
      change[axis][row] = scale * P::load_first(in.matrix[3 * row + axis] + first, lanes);
      if constexpr (!kPush)
        momentum[row] = fnma(change[axis][row], out.stencil.from_center[axis], momentum[row]);
    }
    store_interleaved(zero, change[axis][0], change[axis][1], change[axis][2],
                      kPush ? out.push[axis] : out.momentum.slope[axis]);
  }
  store_interleaved(zero, momentum[0], momentum[1], momentum[2], out.momentum.center);
}

/// base + k slope for a small k known at compile time.
template <int k, class T>
REPOSE_INLINE Row<T> step_row(const Row<T>& base, const Row<T>& slope) {
  if constexpr (k == 0) return base;
  if constexpr (k == 1) return base + slope;
  if constexpr (k == -1) return base - slope;
  return fma(slope, Pack<T>(T(k)), base);
}

/// Calls body(std::integral_constant<int, 0>()), ... below count.
template <int count, class Body>
REPOSE_INLINE void unroll(Body body) {
  [&]<int... k>(std::integer_sequence<int, k...>) {
    (body(std::integral_constant<int, k>()), ...);
  }
  (std::make_integer_sequence<int, count>());
}

template <class S, class T>
using Rows = Row<T>[S::kWidth * S::kWidth];

/// Adds one particle to the rows of its segment. Along z a row does all nodes at once; then
///   row (i, j) += wx_i wy_j (center + (i - c) slope_x + (j - c) slope_y) + (wx'_i wy_j push_x + wx_i wy'_j
///   push_y)
template <class S, bool slopes, bool pushes, class T>
REPOSE_INLINE void add_particle(const Momentum<T>& momentum, const Staged<T>& from, std::size_t lane,
                                const Row<T>& z_positions, Rows<S, T>& rows) {
  const std::size_t at = 4 * lane;
  const StencilPack<T>& stencil = from.stencil;
  const Row<T> weight_z = spread_over_values(stencil.weight[2] + at);
  Row<T> center = repeat_for_nodes(momentum.center + at), slope_x, slope_y, push_x, push_y;
  if constexpr (slopes) {
    center = weight_z * fma(z_positions, repeat_for_nodes(momentum.slope[2] + at), center);
    slope_x = weight_z * repeat_for_nodes(momentum.slope[0] + at);
    slope_y = weight_z * repeat_for_nodes(momentum.slope[1] + at);
  } else {
    center = weight_z * center;
  }
  if constexpr (pushes) {
    center = fma(spread_over_values(stencil.slope[2] + at), repeat_for_nodes(from.push[2] + at), center);
    push_x = weight_z * repeat_for_nodes(from.push[0] + at);
    push_y = weight_z * repeat_for_nodes(from.push[1] + at);
  }
  unroll<S::kWidth>([&]<int i>(std::integral_constant<int, i>) {
    const Pack<T> w(stencil.weight[0][at + i]);
    Row<T> middle = center, slope, side;
    if constexpr (slopes) {
      middle = step_row<i - S::kCenter>(center, slope_x);
      slope = slope_y * w;
    }
    middle = middle * w;
    if constexpr (pushes) {
      middle = fma(push_x, Pack<T>(stencil.slope[0][at + i]), middle);
      side = push_y * w;
    }
    unroll<S::kWidth>([&]<int j>(std::integral_constant<int, j>) {
      Row<T>& row = rows[i * S::kWidth + j];
      Row<T> value = middle;
      if constexpr (slopes) value = step_row<j - S::kCenter>(middle, slope);
      row = fma(value, Pack<T>(stencil.weight[1][at + j]), row);
      if constexpr (pushes) row = fma(side, Pack<T>(stencil.slope[1][at + j]), row);
    });
  });
}

/// Particles with one base node, one after the other: their rows stay in registers.
template <class S, bool slopes, bool pushes, class T>
class Segments {
 public:
  REPOSE_INLINE explicit Segments(T* arena) : arena_(arena), z_positions_(node_positions(T(S::kCenter))) {
    HWY_UNROLL(16)
    for (int r = 0; r < S::kWidth * S::kWidth; ++r) rows_[r] = zero_row<T>();
  }

  REPOSE_INLINE void add(const Momentum<T>& momentum, const Staged<T>& staged, std::size_t lane) {
    if (staged.stencil.node[lane] != node_) {
      end();
      node_ = staged.stencil.node[lane];
      ++count_;
    }
    add_particle<S, slopes, pushes>(momentum, staged, lane, z_positions_, rows_);
  }
  /// Adds the rows to the arena and clears them.
  REPOSE_INLINE void end() {
    if (node_ < 0) return;
    constexpr int kWidth = S::kWidth;
    T* corner = arena_ + node_ * kNodeValues;
    HWY_UNROLL(4)
    for (int i = 0; i < kWidth; ++i) {
      HWY_UNROLL(4)
      for (int j = 0; j < kWidth; ++j) {
        T* at = corner + (i * kArenaSide + j) * kArenaRow;
        store_row(load_row(at) + rows_[i * kWidth + j], at);
        rows_[i * kWidth + j] = zero_row<T>();
      }
    }
    constexpr std::uint64_t kColumn = (1u << kWidth) - 1;
    std::uint64_t square = 0;
    for (int i = 0; i < kWidth; ++i) square |= kColumn << (i * kArenaSide);
    touched_ |= square << (node_ / kArenaSide);
  }
  std::uint64_t touched() const { return touched_; }
  std::size_t count() const { return count_; }

 private:
  T* arena_;
  Row<T> z_positions_;
  Rows<S, T> rows_;
  std::int32_t node_ = -1;
  std::uint64_t touched_ = 0;
  std::size_t count_ = 0;
};

template <class Stencil, Affine affine, Force force, bool before, class T>
std::size_t scatter(const ScatterInput<T>& in, T* arena, std::uint64_t& touched) {
  using S = Loops<Stencil, affine, force, before>;
  Staged<T> staged;
  Segments<S, S::kSlope, S::kPush, T> segments(arena);
  Segments<S, S::kAffine, false, T> segments_before(in.before);
  for (const auto [first, lanes] : packs<T>(in.particles.count)) {
    stage<Stencil, affine, force, before>(in, first, lanes, staged);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      segments.add(staged.momentum, staged, lane);
      if constexpr (before) segments_before.add(staged.before, staged, lane);
    }
  }
  segments.end();
  if constexpr (before) segments_before.end();
  touched |= segments.touched();
  return segments.count();
}

template <class Stencil, Force force, class T>
void push(const PushInput<T>& in, T* arena, std::uint64_t& touched) {
  using S = Loops<Stencil, Affine::kNone, force>;
  Staged<T> staged;
  Segments<S, S::kSlope, S::kPush, T> segments(arena);
  for (const auto [first, lanes] : packs<T>(in.particles.count)) {
    stage<Stencil, force>(in, first, lanes, staged);
    for (std::size_t lane = 0; lane < lanes; ++lane) segments.add(staged.momentum, staged, lane);
  }
  segments.end();
  touched |= segments.touched();
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    constexpr Force kForce = force_of<Stencil, Transfer>();
    table.transfer[s][t].scatter = scatter<Stencil, Transfer::kAffine, kForce, false, T>;
    table.transfer[s][t].scatter_measuring = nullptr;
    if constexpr (Transfer::kKeepsVelocity) {
      table.transfer[s][t].scatter_measuring = scatter<Stencil, Transfer::kAffine, kForce, true, T>;
    }
    table.transfer[s][t].push = push<Stencil, force_of<Stencil, Transfer>(), T>;
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
REPOSE_DEFINE_FILL(scatter, Kernels)
}  // namespace repose
#endif
