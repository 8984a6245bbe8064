// Repose: particles to nodes. Node i of the stencil receives mass w m and momentum
//   w (m v + (m C - dt V0 D^-1 tau)(x_i - x_p))          (Klar et al. 2016, eqs. 7-9; the stress term of Hu et
//   al. 2018)
// as rows of four nodes. Particles with one base node (a run) add up in registers and touch memory once.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/scatter.cpp"
#include "hwy/foreach_target.h"
#include "hwy/highway.h"
#include "kernels/base/targets.h"

#include "kernels/base/simd.h"
#include "kernels/layout/stencil.h"
#include "kernels/pass/tables.h"
#include "kernels/transfer/transfers.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// A pack of particles, turned to be read one particle at a time: four numbers each.
template <class T>
struct Staged {
  static constexpr std::size_t kLanes = Pack<T>::size();
  alignas(64) T center[4 * kLanes];    // m, and the momentum that the centre node would get
  alignas(64) T slope[3][4 * kLanes];  // 0, and its change per cell along x, y, z
  StencilPack<T> stencil;
};

template <class Stencil, class Transfer, class T>
REPOSE_INLINE void stage(const ScatterInput<T>& in, std::size_t first, std::size_t lanes, Staged<T>& out) {
  using P = Pack<T>;
  locate<Stencil>(in.particles.position, first, lanes, in.lattice.flat_axis, out.stencil);
  const P mass(in.mass), mass_per_cell(in.mass * in.lattice.spacing), zero(T(0));
  static constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const auto next = static_cast<std::ptrdiff_t>(first) + in.particles.ahead;
  P momentum[3], slope[3][3], c[3][3];
  HWY_UNROLL(9)
  for (int k = 0; k < 9; ++k) {
    P::prefetch(in.particles.affine[k] + next);
    c[k / 3][k % 3] = P::load_first(in.particles.affine[k] + first, lanes);
  }
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    P::prefetch(in.particles.velocity[row] + next);
    P::prefetch(in.particles.position[row] + next);
    momentum[row] = mass * P::load_first(in.particles.velocity[row] + first, lanes);
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      const P affine = Transfer::told(c, row, axis);
      const P tau = P::load_first(in.stress[kSymmetric[row][axis]] + first, lanes);
      const P impulse_per_cell(in.impulse_volume * in.lattice.axis_scale[axis]);
      slope[axis][row] = fnma(impulse_per_cell, tau, mass_per_cell * affine);
      momentum[row] = fnma(slope[axis][row], out.stencil.from_center[axis], momentum[row]);
    }
  }
  store_interleaved(mass, momentum[0], momentum[1], momentum[2], out.center);
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    store_interleaved(zero, slope[axis][0], slope[axis][1], slope[axis][2], out.slope[axis]);
  }
}

/// base + k slope for a small k known at compile time.
template <int k, class T>
REPOSE_INLINE Row<T> step_row(const Row<T>& base, const Row<T>& slope) {
  if constexpr (k == 0) return base;
  if constexpr (k == 1) return base + slope;
  if constexpr (k == -1) return base - slope;
  return fma(slope, Pack<T>(T(k)), base);
}

/// Adds one particle to the rows of its run.
template <class Stencil, class T>
REPOSE_INLINE void add_particle(const Staged<T>& from, std::size_t lane, const Row<T>& z_positions,
                                Row<T> (&rows)[Stencil::kWidth * Stencil::kWidth]) {
  constexpr int kWidth = Stencil::kWidth, kCenter = Stencil::kCenter;
  const Row<T> weight_z = spread_over_values(from.stencil.weight[2] + 4 * lane);
  const Row<T> center = weight_z * fma(z_positions, repeat_for_nodes(from.slope[2] + 4 * lane),
                                       repeat_for_nodes(from.center + 4 * lane));
  const Row<T> slope_x = weight_z * repeat_for_nodes(from.slope[0] + 4 * lane);
  const Row<T> slope_y = weight_z * repeat_for_nodes(from.slope[1] + 4 * lane);
  const T* wx = from.stencil.weight[0] + 4 * lane;
  const T* wy = from.stencil.weight[1] + 4 * lane;
  const auto add_plane = [&]<int i>(std::integral_constant<int, i>) {
    const Pack<T> w(wx[i]);
    const Row<T> middle = step_row<i - kCenter>(center, slope_x) * w;
    const Row<T> slope = slope_y * w;
    const auto add_row = [&]<int j>(std::integral_constant<int, j>) {
      Row<T>& row = rows[i * kWidth + j];
      row = fma(step_row<j - kCenter>(middle, slope), Pack<T>(wy[j]), row);
    };
    [&]<int... j>(std::integer_sequence<int, j...>) {
      (add_row(std::integral_constant<int, j>()), ...);
    }
    (std::make_integer_sequence<int, kWidth>());
  };
  [&]<int... i>(std::integer_sequence<int, i...>) {
    (add_plane(std::integral_constant<int, i>()), ...);
  }
  (std::make_integer_sequence<int, kWidth>());
}

/// Adds the rows of a run to the arena and clears them.
template <int kWidth, class T>
REPOSE_INLINE void flush(std::int32_t node, Row<T> (&rows)[kWidth * kWidth], T* arena, std::uint64_t& touched) {
  T* corner = arena + node * kNodeValues;
  HWY_UNROLL(4)
  for (int i = 0; i < kWidth; ++i) {
    HWY_UNROLL(4)
    for (int j = 0; j < kWidth; ++j) {
      T* at = corner + (i * kArenaSide + j) * kArenaRow;
      store_row(load_row(at) + rows[i * kWidth + j], at);
      rows[i * kWidth + j] = zero_row<T>();
    }
  }
  constexpr std::uint64_t kColumn = (1u << kWidth) - 1;
  std::uint64_t square = 0;
  for (int i = 0; i < kWidth; ++i) square |= kColumn << (i * kArenaSide);
  touched |= square << (node / kArenaSide);
}

template <class Stencil, class Transfer, class T>
std::size_t scatter(const ScatterInput<T>& in, T* arena, std::uint64_t& touched) {
  constexpr int kWidth = Stencil::kWidth;
  Staged<T> staged;
  Row<T> rows[kWidth * kWidth];
  HWY_UNROLL(16)
  for (int r = 0; r < kWidth * kWidth; ++r) rows[r] = zero_row<T>();
  const Row<T> z_positions = node_positions(T(Stencil::kCenter));
  std::int32_t node = -1;
  std::size_t runs = 0;
  for (std::size_t first = 0; first < in.particles.count; first += Pack<T>::size()) {
    const std::size_t left = in.particles.count - first;
    const std::size_t lanes = left < Pack<T>::size() ? left : Pack<T>::size();
    stage<Stencil, Transfer>(in, first, lanes, staged);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (staged.stencil.node[lane] != node) {
        if (node >= 0) flush<kWidth>(node, rows, arena, touched);
        node = staged.stencil.node[lane];
        ++runs;
      }
      add_particle<Stencil>(staged, lane, z_positions, rows);
    }
  }
  if (node >= 0) flush<kWidth>(node, rows, arena, touched);
  return runs;
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    table.transfer[s][t].scatter = scatter<Stencil, Transfer, T>;
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
REPOSE_DEFINE_FILL(scatter)
}  // namespace repose
#endif
