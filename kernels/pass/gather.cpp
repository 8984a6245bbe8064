// Repose: nodes to particles.
//   v = sum w v_i,     C = D^-1 sum w v_i (x_i - x_p)^T           (Klar et al. 2016, eqs. 11-12)
// C is also the velocity gradient of the MLS form. Runs keep their rows of nodes in registers; the sums over
// the four nodes of a row are taken in the order that simd.h writes down.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/gather.cpp"
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

template <class T>
struct Staged {
  StencilPack<T> stencil;
  alignas(64) T sums[4][4 * Pack<T>::size()];  // sum w (m, v), then its first moments along x, y, z in cells
};

/// Weighted sums over the stencil of the node values and of their first moments about the centre node.
template <class Stencil, class T>
REPOSE_INLINE void sum_stencil(const Row<T> (&rows)[Stencil::kWidth * Stencil::kWidth],
                               const Row<T>& z_positions, std::size_t lane, Staged<T>& staged) {
  static_assert(Stencil::kWidth == 3 && Stencil::kCenter == 1);
  const T* wx = staged.stencil.weight[0] + 4 * lane;
  const T* wy = staged.stencil.weight[1] + 4 * lane;
  const Pack<T> x0(wx[0]), x1(wx[1]), x2(wx[2]), y0(wy[0]), y1(wy[1]), y2(wy[2]);
  Row<T> plane[3], moment_y[3];
  HWY_UNROLL(3)
  for (int i = 0; i < 3; ++i) {
    const Row<T> low = rows[3 * i] * y0, high = rows[3 * i + 2] * y2;
    plane[i] = fma(rows[3 * i + 1], y1, low + high);
    moment_y[i] = high - low;
  }
  const Row<T> weight_z = spread_over_values(staged.stencil.weight[2] + 4 * lane);
  const Row<T> low = plane[0] * x0, high = plane[2] * x2;
  const Row<T> sum = fma(plane[1], x1, low + high) * weight_z;
  const Row<T> along_x = (high - low) * weight_z;
  const Row<T> along_y = fma(moment_y[0], x0, fma(moment_y[1], x1, moment_y[2] * x2)) * weight_z;
  const Row<T> along_z = sum * z_positions;
  sum_over_nodes(sum, along_x, along_y, along_z, staged.sums[0] + 4 * lane, staged.sums[1] + 4 * lane,
                 staged.sums[2] + 4 * lane, staged.sums[3] + 4 * lane);
}

template <class Stencil, class T>
REPOSE_INLINE void finish(const GatherInput<T>& in, const Staged<T>& staged, std::size_t first,
                          std::size_t lanes) {
  using P = Pack<T>;
  const auto next = static_cast<std::ptrdiff_t>(first) + in.particles.ahead;
  P mass, v[3];
  load_interleaved(staged.sums[0], mass, v[0], v[1], v[2]);
  HWY_UNROLL(3)
  for (int row = 0; row < 3; ++row) {
    P::prefetch(in.particles.position[row] + next);
    P::prefetch(in.particles.velocity[row] + next);
    v[row].store_first(in.velocity[row] + first, lanes);
  }
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    P moment[3];
    load_interleaved(staged.sums[1 + axis], mass, moment[0], moment[1], moment[2]);
    const P scale(in.lattice.axis_scale[axis]);
    HWY_UNROLL(3)
    for (int row = 0; row < 3; ++row) {
      const P c = scale * fnma(staged.stencil.from_center[axis], v[row], moment[row]);
      P::prefetch(in.particles.affine[3 * row + axis] + next);
      c.store_first(in.affine[3 * row + axis] + first, lanes);
    }
  }
}

template <class Stencil, class Transfer, class T>
void gather(const GatherInput<T>& in, const T* arena) {
  constexpr int kWidth = Stencil::kWidth;
  Staged<T> staged;
  Row<T> rows[kWidth * kWidth];
  const Row<T> z_positions = node_positions(T(Stencil::kCenter));
  std::int32_t node = -1;
  for (std::size_t first = 0; first < in.particles.count; first += Pack<T>::size()) {
    const std::size_t left = in.particles.count - first;
    const std::size_t lanes = left < Pack<T>::size() ? left : Pack<T>::size();
    locate<Stencil>(in.particles.position, first, lanes, in.lattice.flat_axis, staged.stencil);
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      if (staged.stencil.node[lane] != node) {
        node = staged.stencil.node[lane];
        const T* corner = arena + node * kNodeValues;
        HWY_UNROLL(16)
        for (int r = 0; r < kWidth * kWidth; ++r) {
          rows[r] = load_row(corner + ((r / kWidth) * kArenaSide + r % kWidth) * kArenaRow);
        }
      }
      sum_stencil<Stencil>(rows, z_positions, lane, staged);
    }
    finish<Stencil>(in, staged, first, lanes);
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    table.transfer[s][t].gather = gather<Stencil, Transfer, T>;
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
REPOSE_DEFINE_FILL(gather)
}  // namespace repose
#endif
