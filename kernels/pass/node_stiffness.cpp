// Repose: the 3x3 blocks on the diagonal of an implicit step's stiffness, one per node, for a preconditioner. A
// displacement of node i by e_c changes a particle's G by e_c g^T, and so in the axes U of its trial state
// L = (U^T e_c) h^T with h = Q^T g; what that does to f_i, with the numbers of kernels/pass/stiffness.cpp, is
//   K = U K' U^T,  K'_ab = (A_ab + beta_ab) h_a h_b,  K'_aa = A_aa h_a^2 + sum_b theta_ab h_b^2.
// A preconditioner must be symmetric: A is replaced by its symmetric part.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "kernels/pass/node_stiffness.cpp"
#include "kernels/base/targets.h"

#include "hwy/foreach_target.h"
#include "hwy/highway.h"

#include "kernels/layout/stencil.h"
#include "kernels/material/response-inl.h"
#include "kernels/pass/fill.h"
#include "kernels/pass/for_each_transfer.h"
#include "kernels/transfer/transfers.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {
namespace {

/// A particle's numbers, as far as blocks need them.
template <class T>
struct Stiffness {
  using P = Pack<T>;
  P u[3][3], q[3][3];
  P slope[3];           // A_aa
  P mixed[3], turn[3];  // of the pairs of axes: A_ab + beta_ab, theta_ab

  REPOSE_INLINE explicit Stiffness(const T* from) {
    const auto number = [from](int k)
                            HWY_ATTR { return P::load(from + static_cast<std::size_t>(k) * kTangentGroup); };
    HWY_UNROLL(9)
    for (int k = 0; k < 9; ++k) {
      u[k / 3][k % 3] = number(k);
      q[k / 3][k % 3] = number(9 + k);
    }
    HWY_UNROLL(3)
    for (int k = 0; k < 3; ++k) {
      const int a = kPairs[k][0], b = kPairs[k][1];
      slope[k] = number(18 + 4 * k);
      mixed[k] = fma(P(T(0.5)), number(18 + 3 * a + b) + number(18 + 3 * b + a), number(30 + k));
      turn[k] = number(27 + k);
    }
  }

  /// K of a gradient g: xx, yy, zz, xy, xz, yz.
  REPOSE_INLINE void block(const P (&g)[3], P (&out)[6]) const {
    P h[3], k[3][3], half[3][3];
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a) h[a] = fma(q[0][a], g[0], fma(q[1][a], g[1], q[2][a] * g[2]));
    HWY_UNROLL(3)
    for (int a = 0; a < 3; ++a) k[a][a] = slope[a] * h[a] * h[a];
    HWY_UNROLL(3)
    for (int p = 0; p < 3; ++p) {
      const int a = kPairs[p][0], b = kPairs[p][1];
      k[a][b] = k[b][a] = mixed[p] * h[a] * h[b];
      k[a][a] = fma(turn[p] * h[b], h[b], k[a][a]);
      k[b][b] = fma(turn[p] * h[a], h[a], k[b][b]);
    }
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      HWY_UNROLL(3)
      for (int c = 0; c < 3; ++c) half[r][c] = fma(u[r][0], k[0][c], fma(u[r][1], k[1][c], u[r][2] * k[2][c]));
    }
    const auto entry = [&](int r, int c) HWY_ATTR {
      return fma(half[r][0], u[c][0], fma(half[r][1], u[c][1], half[r][2] * u[c][2]));
    };
    HWY_UNROLL(3)
    for (int r = 0; r < 3; ++r) {
      out[r] = entry(r, r);
      out[3 + r] = entry(kPairs[r][0], kPairs[r][1]);
    }
  }
};

/// Gradients of the weights of a pack of particles.
template <class Stencil, Force force, class T>
struct Gradients {
  using P = Pack<T>;
  P weight[3][4], other[3][4];  // other: along its own axis
  P base;

  REPOSE_INLINE Gradients(const StiffnessInput<T>& in, std::size_t first, std::size_t lanes) : base(T(0)) {
    HWY_UNROLL(3)
    for (int axis = 0; axis < 3; ++axis) {
      const P x = P::load_first(in.particles.position[axis] + first, lanes);
      const P corner = floor(x - P(T(Stencil::kBaseShift))), f = x - corner;
      const Weights<Stencil, P> weights{f};
      const bool flat = axis == in.lattice.flat_axis;
      weights.value(weight[axis]);
      if constexpr (force == Force::kGradients) weights.slope(other[axis]);
      const P per_spacing(T(1) / in.lattice.spacing), scale(in.lattice.axis_scale[axis]);
      HWY_UNROLL(4)
      for (int k = 0; k < 4; ++k) {
        if (flat) weight[axis][k] = P(T(k == 0 ? 1 : 0));
        if constexpr (force == Force::kGradients) {
          other[axis][k] = flat ? P(T(0)) : other[axis][k] * per_spacing;
        } else {
          other[axis][k] = weight[axis][k] * scale * (P(T(k)) - f);
        }
      }
      base = fma(base, P(T(kArenaSide)), corner - P(T(Stencil::kLowestBase)));
    }
  }

  REPOSE_INLINE void at(int i, int j, int k, P (&g)[3]) const {
    g[0] = other[0][i] * weight[1][j] * weight[2][k];
    g[1] = weight[0][i] * other[1][j] * weight[2][k];
    g[2] = weight[0][i] * weight[1][j] * other[2][k];
  }
};

template <class Stencil, Force force, class T>
void add_stiffness(const StiffnessInput<T>& in, T* diagonal, T* side) {
  using P = Pack<T>;
  constexpr int kWidth = Stencil::kWidth;
  for (const auto [first, lanes] : packs<T>(in.particles.count)) {
    const T* const from =
        in.tangent + (first / kTangentGroup) * kTangentValues * kTangentGroup + first % kTangentGroup;
    const Stiffness<T> stiffness(from);
    const Gradients<Stencil, force, T> gradients(in, first, lanes);
    alignas(64) std::int32_t base[P::size()];
    alignas(64) T values[kWidth * kWidth * kWidth][6][P::size()];
    store_as_int(gradients.base, base);
    for (int node = 0; node < kWidth * kWidth * kWidth; ++node) {
      P g[3], block[6];
      gradients.at(node / (kWidth * kWidth), node / kWidth % kWidth, node % kWidth, g);
      stiffness.block(g, block);
      HWY_UNROLL(6)
      for (int c = 0; c < 6; ++c) (P(in.scale) * block[c]).store(values[node][c]);
    }
    // One particle after the other: with another width of packs the sums are the same.
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      for (int node = 0; node < kWidth * kWidth * kWidth; ++node) {
        const int offset =
            (node / (kWidth * kWidth) * kArenaSide + node / kWidth % kWidth) * kArenaSide + node % kWidth;
        const std::ptrdiff_t at = (base[lane] + offset) * kNodeValues + 1;
        for (int c = 0; c < 3; ++c) {
          diagonal[at + c] += values[node][c][lane];
          side[at + c] += values[node][3 + c][lane];
        }
      }
    }
  }
}

template <class T>
void fill_precision(Kernels<T>& table) {
  for_each_transfer([&]<class Stencil, class Transfer>(std::size_t s, std::size_t t) {
    table.transfer[s][t].add_stiffness = add_stiffness<Stencil, force_of<Stencil, Transfer>(), T>;
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
REPOSE_DEFINE_FILL(node_stiffness, Kernels)
}  // namespace repose
#endif
