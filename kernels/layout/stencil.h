// Repose: stencils, the B-splines through which particles and nodes speak (Klar et al. 2016, section 5, eqs.
// 5-6, for the cubic one). The quadratic one spans three nodes an axis. With f the particle's distance from its
// base node in cells, in [1/2, 3/2): w = (3/2 - f)^2/2, 3/4 - (f - 1)^2, (f - 1/2)^2/2. D = sum w (x_i -
// x_p)(x_i - x_p)^T is dx^2/4 I, whatever f (Jiang et al. 2015; Klar et al. 2016, eq. 8).
#ifndef REPOSE_KERNELS_LAYOUT_STENCIL_H_CONSTANTS
#define REPOSE_KERNELS_LAYOUT_STENCIL_H_CONSTANTS

#include <array>
#include <tuple>

namespace repose {

struct QuadraticStencil {
  static constexpr const char* kName = "quadratic";
  static constexpr const char* kMeaning = "quadratic B-spline, 27 nodes";
  static constexpr int kWidth = 3;           ///< nodes an axis
  static constexpr int kCenter = 1;          ///< distances are counted from this node: fewer digits cancel
  static constexpr double kBaseShift = 0.5;  ///< base node = floor(x/dx - shift)
  static constexpr double kInverseD = 4.0;   ///< D^-1 in 1/dx^2
  /// Largest sum of (dw)^2/w over the stencil in 1/dx^2; bounds the feedback of a particle on itself.
  static constexpr double kFeedback = 6.0;
};

/// The list of stencils. A new one is a struct like the above, its Weights below, and its name here.
using Stencils = std::tuple<QuadraticStencil>;

/// What the engine needs of a stencil outside the kernels.
struct StencilFigures {
  const char* name;
  const char* meaning;
  double base_shift;
  double inverse_d;
};

template <class... Stencil>
constexpr auto figures_of(const std::tuple<Stencil...>&) {
  return std::array{
      StencilFigures{Stencil::kName, Stencil::kMeaning, Stencil::kBaseShift, Stencil::kInverseD}...};
}
inline constexpr auto kStencilFigures = figures_of(Stencils{});

}  // namespace repose
#endif

// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_LAYOUT_STENCIL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_LAYOUT_STENCIL_H
#undef REPOSE_KERNELS_LAYOUT_STENCIL_H
#else
#define REPOSE_KERNELS_LAYOUT_STENCIL_H
#endif

#include "kernels/base/simd.h"
#include "kernels/layout/node_block.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// Weights along one axis of the nodes base, base + 1, ...; the fourth is zero where the stencil is narrower.
template <class Stencil, class N>
struct Weights;

template <class N>
struct Weights<QuadraticStencil, N> {
  N w[4];

  REPOSE_INLINE explicit Weights(N f) {
    using T = Scalar<N>;
    const N right = N(T(1.5)) - f, middle = f - N(T(1)), left = f - N(T(0.5));
    w[0] = N(T(0.5)) * (right * right);
    w[1] = fnma(middle, middle, N(T(0.75)));
    w[2] = N(T(0.5)) * (left * left);
    w[3] = N(T(0));
  }
};

/// Where the stencils of a pack of particles lie, turned to be read one particle at a time.
template <class T>
struct StencilPack {
  static constexpr std::size_t kLanes = Pack<T>::size();
  alignas(64) T weight[3][4 * kLanes];    // per axis, four a particle
  alignas(64) std::int32_t node[kLanes];  // base node in the arena
  Pack<T> from_center[3];                 // x_p - x_c in cells, c the centre node
};

/// Locates `lanes` particles from `first` on. On the single-node axis of plane strain (`flat_axis`) the one
/// node has all the weight.
template <class Stencil, class T>
REPOSE_INLINE void locate(T* const position[3], std::size_t first, std::size_t lanes, int flat_axis,
                          StencilPack<T>& out) {
  using P = Pack<T>;
  P node(T(0));
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    const P x = P::load_first(position[axis] + first, lanes);
    const P base = floor(x - P(T(Stencil::kBaseShift)));
    const P f = x - base;
    Weights<Stencil, P> weights(f);
    if (axis == flat_axis) {
      weights.w[0] = P(T(1));
      weights.w[1] = weights.w[2] = weights.w[3] = P(T(0));
    }
    store_interleaved(weights.w[0], weights.w[1], weights.w[2], weights.w[3], out.weight[axis]);
    out.from_center[axis] = f - P(T(Stencil::kCenter));
    node = fma(node, P(T(kArenaSide)), base - P(T(kLowestBase)));
  }
  store_as_int(node, out.node);
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
