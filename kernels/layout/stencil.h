// Repose: stencils, the B-splines through which particles and nodes speak (Klar et al. 2016, section 5, eqs.
// 5-6, for the cubic one; Steffen et al. 2008 for all). With f the particle's distance from its base node in
// cells, their weights are
//   linear     1 - f, f                                                     f in [0, 1)
//   quadratic  (3/2 - f)^2/2, 3/4 - (f - 1)^2, (f - 1/2)^2/2                 f in [1/2, 3/2)
//   cubic      (2 - f)^3/6, g^3/2 - g^2 + 2/3 (g = f - 1),                   f in [1, 2)
//              h^3/2 - h^2 + 2/3 (h = 2 - f), (f - 1)^3/6
// D = sum w (x_i - x_p)(x_i - x_p)^T is dx^2/4 I for the quadratic one and dx^2/3 I for the cubic, whatever f
// (Jiang et al. 2015; Klar et al. 2016, eq. 8). For the linear one it varies with f and vanishes on nodes, so
// D^-1 sum w v (x_i - x_p)^T is taken as sum v grad w^T, which it equals where both exist. The linear one is
// there to compare with: its forces jump where a particle changes cells.
#ifndef REPOSE_KERNELS_LAYOUT_STENCIL_H_CONSTANTS
#define REPOSE_KERNELS_LAYOUT_STENCIL_H_CONSTANTS

#include <array>
#include <limits>
#include <tuple>

namespace repose {

struct QuadraticStencil {
  static constexpr const char* kName = "quadratic";
  static constexpr const char* kMeaning = "quadratic B-spline, 27 nodes";
  static constexpr int kWidth = 3;           ///< nodes an axis
  static constexpr int kCenter = 1;          ///< distances are counted from this node: fewer digits cancel
  static constexpr double kBaseShift = 0.5;  ///< base node = floor(x/dx - shift)
  static constexpr bool kConstantD = true;   ///< whether D is the same for every f
  static constexpr double kInverseD = 4.0;   ///< D^-1 in 1/dx^2
  /// Largest sum of (dw)^2/w over an axis in 1/dx^2; bounds the feedback of a particle on itself.
  static constexpr double kFeedback = 6.0;
  /// |grad v| dx <= this times d where node velocities lie within d of one another's middle: the larger of
  /// sqrt(3 D^-1) for moments and sqrt(3) max sum |dw| for gradients.
  static constexpr double kGradientBound = 3.4641016151377544;
  /// A block owns the particles with floor((x - base shift - block shift) / 4) its coordinate; they may drift a
  /// cell out of it (half a cell where the shift is a half). Base nodes are then in [lowest, highest], and no
  /// two blocks of a colour touch one node: see node_block.h.
  static constexpr double kBlockShift = 0.0;
  static constexpr int kLowestBase = -1;
  static constexpr int kHighestBase = 4;
};

struct CubicStencil {
  static constexpr const char* kName = "cubic";
  static constexpr const char* kMeaning = "cubic B-spline, 64 nodes: smoother forces, about 1.2 times the time";
  static constexpr int kWidth = 4;
  static constexpr int kCenter = 1;
  static constexpr double kBaseShift = 1.0;
  static constexpr bool kConstantD = true;
  static constexpr double kInverseD = 3.0;
  static constexpr double kFeedback = 3.13682;
  static constexpr double kGradientBound = 3.0;
  static constexpr double kBlockShift = 0.5;
  static constexpr int kLowestBase = 0;
  static constexpr int kHighestBase = 4;
};

struct LinearStencil {
  static constexpr const char* kName = "linear";
  static constexpr const char* kMeaning = "linear, 8 nodes: for comparison; forces jump between cells";
  static constexpr int kWidth = 2;
  static constexpr int kCenter = 0;
  static constexpr double kBaseShift = 0.0;
  static constexpr bool kConstantD = false;
  static constexpr double kInverseD = 6.0;  ///< of the mean of D over a cell; only energies and momenta use it
  static constexpr double kFeedback = std::numeric_limits<double>::infinity();
  static constexpr double kGradientBound = 3.4641016151377544;
  static constexpr double kBlockShift = 0.0;
  static constexpr int kLowestBase = -1;
  static constexpr int kHighestBase = 4;
};

/// The list of stencils. A new one is a struct like the above, its Weights below, and its name here. The first
/// is what scenes get that name none.
using Stencils = std::tuple<QuadraticStencil, CubicStencil, LinearStencil>;

/// What the engine needs of a stencil outside the kernels.
struct StencilFigures {
  const char* name;
  const char* meaning;
  double base_shift;
  bool constant_d;
  double inverse_d;
  double feedback;
  double gradient_bound;
  double block_shift;
  int lowest_base, highest_base;
};

template <class... Stencil>
constexpr auto figures_of(const std::tuple<Stencil...>&) {
  return std::array{StencilFigures{Stencil::kName, Stencil::kMeaning, Stencil::kBaseShift, Stencil::kConstantD,
                                   Stencil::kInverseD, Stencil::kFeedback, Stencil::kGradientBound,
                                   Stencil::kBlockShift, Stencil::kLowestBase, Stencil::kHighestBase}...};
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

#include "kernels/base/simd-inl.h"
#include "kernels/layout/node_block.h"
#include "kernels/transfer/transfer.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

/// Weights along one axis of the nodes base, base + 1, ...; zero beyond the stencil's width. slope() has their
/// derivatives by x in 1/dx.
template <class Stencil, class N>
struct Weights;

template <class N>
struct Weights<LinearStencil, N> {
  using T = Scalar<N>;
  N f;

  REPOSE_INLINE void value(N (&w)[4]) const {
    w[0] = N(T(1)) - f;
    w[1] = f;
    w[2] = w[3] = N(T(0));
  }
  REPOSE_INLINE void slope(N (&d)[4]) const {
    d[0] = N(T(-1));
    d[1] = N(T(1));
    d[2] = d[3] = N(T(0));
  }
};

template <class N>
struct Weights<QuadraticStencil, N> {
  using T = Scalar<N>;
  N f;

  REPOSE_INLINE void value(N (&w)[4]) const {
    const N right = N(T(1.5)) - f, middle = f - N(T(1)), left = f - N(T(0.5));
    w[0] = N(T(0.5)) * (right * right);
    w[1] = fnma(middle, middle, N(T(0.75)));
    w[2] = N(T(0.5)) * (left * left);
    w[3] = N(T(0));
  }
  REPOSE_INLINE void slope(N (&d)[4]) const {
    d[0] = f - N(T(1.5));
    d[1] = N(T(2)) - (f + f);
    d[2] = f - N(T(0.5));
    d[3] = N(T(0));
  }
};

template <class N>
struct Weights<CubicStencil, N> {
  using T = Scalar<N>;
  N f;

  REPOSE_INLINE void value(N (&w)[4]) const {
    const N near = f - N(T(1)), far = N(T(2)) - f;
    w[0] = N(T(1.0 / 6)) * (far * far * far);
    w[1] = inner(near);
    w[2] = inner(far);
    w[3] = N(T(1.0 / 6)) * (near * near * near);
  }
  REPOSE_INLINE void slope(N (&d)[4]) const {
    const N near = f - N(T(1)), far = N(T(2)) - f;
    d[0] = N(T(-0.5)) * (far * far);
    d[1] = inner_slope(near);
    d[2] = -inner_slope(far);
    d[3] = N(T(0.5)) * (near * near);
  }

 private:
  REPOSE_INLINE static N inner(N r) { return fma(r * r, fma(N(T(0.5)), r, N(T(-1))), N(T(2.0 / 3))); }
  REPOSE_INLINE static N inner_slope(N r) { return r * fma(N(T(1.5)), r, N(T(-2))); }
};

/// Where the stencils of a pack of particles lie, turned to be read one particle at a time.
template <class T>
struct StencilPack {
  static constexpr std::size_t kLanes = Pack<T>::size();
  alignas(64) T weight[3][4 * kLanes];    // per axis, four a particle
  alignas(64) T slope[3][4 * kLanes];     // their derivatives in 1/dx, where asked for
  alignas(64) std::int32_t node[kLanes];  // base node in the arena
  Pack<T> from_center[3];                 // x_p - x_c in cells, c the centre node
};

/// Locates `lanes` particles from `first` on. On the single-node axis of plane strain (`flat_axis`) the one
/// node has all the weight and no slope.
template <class Stencil, Force force, class T>
REPOSE_INLINE void locate(T* const position[3], std::size_t first, std::size_t lanes, int flat_axis,
                          StencilPack<T>& out) {
  using P = Pack<T>;
  P node(T(0));
  HWY_UNROLL(3)
  for (int axis = 0; axis < 3; ++axis) {
    const P x = P::load_first(position[axis] + first, lanes);
    const P base = floor(x - P(T(Stencil::kBaseShift)));
    const P f = x - base;
    const Weights<Stencil, P> weights{f};
    const bool flat = axis == flat_axis;
    P w[4];
    weights.value(w);
    if (flat) {
      w[0] = P(T(1));
      w[1] = w[2] = w[3] = P(T(0));
    }
    store_interleaved(w[0], w[1], w[2], w[3], out.weight[axis]);
    if constexpr (force == Force::kGradients) {
      weights.slope(w);
      if (flat) w[0] = w[1] = w[2] = w[3] = P(T(0));
      store_interleaved(w[0], w[1], w[2], w[3], out.slope[axis]);
    }
    out.from_center[axis] = f - P(T(Stencil::kCenter));
    node = fma(node, P(T(kArenaSide)), base - P(T(Stencil::kLowestBase)));
  }
  store_as_int(node, out.node);
}

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
