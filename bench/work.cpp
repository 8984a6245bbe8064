// Repose: the table of work. A fused multiply-add counts two; a sum, a product, a quotient and a root count
// one; what only compares, selects, rounds, moves or changes a sign counts nothing. Counted is the arithmetic
// of the formulas in the form in which the kernels compute them (sums factored axis by axis), without what
// falls on padding: the fourth node of a row where a stencil has fewer. Numbers of an arena are counted once a
// segment.
#include "bench/work.h"

#include <array>
#include <iterator>

#include "kernels/base/matrix_function-inl.h"
#include "kernels/layout/node_block.h"
#include "kernels/pass/pass.h"

namespace repose {
namespace {

/// What the loops of a transfer depend on.
struct Loops {
  int width, center;
  bool affine, skew, moments, slopes;  ///< moments, slopes: what the gather sums
  bool push, tilt;  ///< of the scatter: forces by gradients; momentum that varies along the stencil
  bool keeps_velocity, separate_gradient;

  double row() const { return width * kNodeValues; }
  /// Rows times values of a row, padding included: what a segment reads or writes of the arena.
  double reach() const { return width * width * kBlockSide * kNodeValues; }
};

constexpr auto kWidths = []<class... Stencil>(const std::tuple<Stencil...>&) {
  return std::array{Stencil::kWidth...};
}(Stencils{});
constexpr auto kCenters = []<class... Stencil>(const std::tuple<Stencil...>&) {
  return std::array{Stencil::kCenter...};
}(Stencils{});

Loops loops_of(std::size_t stencil, std::size_t transfer) {
  const TransferFigures& figures = kTransferFigures[transfer];
  const bool affine = figures.affine != Affine::kNone, constant_d = kStencilFigures[stencil].constant_d;
  // Where D varies, forces by moments are forces by gradients.
  const bool slopes = figures.force == Force::kGradients || !constant_d;
  return {kWidths[stencil],
          kCenters[stencil],
          affine,
          figures.affine == Affine::kSkew,
          !slopes || (affine && constant_d),
          slopes,
          slopes,
          affine || !slopes,
          figures.keeps_velocity,
          !affine || figures.keeps_velocity || (figures.force == Force::kGradients && constant_d)};
}

/// Weights, slopes and base node of a particle, all axes: per axis x - shift, x - base, f - centre, the node's
/// index (3), and the polynomials as stencil.h writes them.
double locate_flops(int width, bool slopes) {
  const double weights = width == 2 ? 1 : width == 3 ? 9 : 18;
  const double derivatives = width == 2 ? 0 : width == 3 ? 4 : 10;
  return 3 * (6 + weights + (slopes ? derivatives : 0));
}

/// sum of w_i r_i over rows r_i.
double weigh_flops(const Loops& s) {
  return (2 * s.width - 1) * s.row();
}

/// Sum, first moment and sum by slopes along one axis.
double axis_flops(const Loops& s) {
  const double sum = s.width == 2 ? 3 : s.width == 3 ? 5 : 7;
  const double moment = s.width == 2 ? 0 : s.width == 3 ? 1 : 3;
  return (sum + (s.moments ? moment : 0)) * s.row() + (s.slopes ? weigh_flops(s) : 0);
}

/// The matrix told, stresses and momentum of a particle, then its rows; per segment the rows are added to the
/// arena.
double scatter_flops(const Loops& s, double segment) {
  const double matrix = s.affine ? 9 + (s.skew ? 9 * 6 : 0) : 0;
  const double stress = s.push ? 9 : 9 * 2;
  const double momentum = 3 + (s.tilt ? 9 * 2 : 0);
  double steps = 0;  // to k nodes from the centre: nothing, a sum, or a fused product
  for (int k = 0; k < s.width; ++k) steps += k == s.center ? 0 : k <= s.center + 1 ? 1 : 2;
  const double w = s.width;
  double rows = s.tilt ? 5 + (w + steps) + w * steps : 1;  // centre and slopes; columns; nodes
  rows += w + 2 * w * w;                                   // middle w_i; value w_j added
  if (s.push) rows += 4 + 3 * w + 2 * w * w;
  return locate_flops(s.width, s.push) + matrix + stress + momentum + rows * s.row() +
         w * w * s.row() / segment;
}

double gather_flops(const Loops& s) {
  const double w = s.width, along = 3 * s.row();  // three products with weights along z
  double sums = (w + 1) * axis_flops(s) + s.row() + kNodeValues * (w - 1);
  for (const bool matrix : {s.moments, s.slopes}) {
    if (matrix) sums += weigh_flops(s) + along + 3 * kNodeValues * (w - 1);
  }
  const double matrices = (s.moments ? 9 * 3 : 0) + (s.slopes ? 9 : 0);
  return locate_flops(s.width, s.slopes) + sums + matrices +
         (s.keeps_velocity ? 3 * 3 + (s.affine ? 28 : 0) : 0);
}

/// a (c0 + c1 a + ...): invariants 24, three fused products for each of terms - 2 powers, a^2 30, its sum 21.
double polynomial_flops(std::size_t terms) {
  return 24 + 6 * static_cast<double>(terms - 2) + 30 + 21;
}

}  // namespace

Work scatter_work(std::size_t stencil, std::size_t transfer, double segment, bool measures) {
  const Loops s = loops_of(stencil, transfer);
  Work work;
  work.read = 3 + 3 + (s.affine ? 9 : 0);    // position, velocity, C
  work.near_read = 6 + s.reach() / segment;  // stress, arena
  work.near_written = s.reach() / segment;   // arena
  work.flops = scatter_flops(s, segment);
  if (!measures) return work;
  Loops before = s;
  before.push = false;
  before.tilt = s.affine;
  work.near_read += s.reach() / segment;
  work.near_written += s.reach() / segment;
  work.flops += scatter_flops(before, segment) - locate_flops(s.width, false);
  return work;
}

Work gather_work(std::size_t stencil, std::size_t transfer, double segment, bool measures) {
  const Loops s = loops_of(stencil, transfer);
  const double own = s.keeps_velocity ? 3 : 0;
  Work work;
  work.read = 3 + own;                                      // position; own velocity, or velocity
  work.written = 3 + (s.affine ? 9 : 0) + own;              // velocity, C, own velocity
  work.fetched = 3 + (s.affine ? 9 : 0);                    // velocity, C
  work.near_read = s.reach() / segment;                     // arena
  work.near_written = own + (s.separate_gradient ? 9 : 0);  // moving velocity, gradient
  work.flops = gather_flops(s);
  if (!measures) return work;
  work.near_read += s.reach() / segment;
  work.flops += (s.width + 1) * weigh_flops(s) + s.row() + kNodeValues * (s.width - 1);
  return work;
}

/// dt G 9; exp(2 eps) - I: doubling 6, norm 12; push forward 63 + 42; log: norm 12; and the two polynomials.
template <class Real>
Work trial_work() {
  using Polynomials = MatrixPolynomials<Real>;
  const double polynomials =
      polynomial_flops(std::size(Polynomials::kExpm1)) + polynomial_flops(std::size(Polynomials::kHalfLog1p));
  return {.read = 6, .written = 6, .near_read = 9, .flops = 9 + 6 + 12 + 105 + 12 + polynomials};
}
template Work trial_work<float>();
template Work trial_work<double>();

/// 2 mu eps 6, trace 2, lambda tr 1, its sum 3.
Work stress_hencky_work() {
  return {.read = 6, .near_written = 6, .flops = 12};
}
/// exp(2 eps) - I: doubling 6, norm 12, polynomial; its product with mu 6; the rest as above.
template <class Real>
Work stress_neo_hookean_work() {
  const double exponential = 6 + 12 + polynomial_flops(std::size(MatrixPolynomials<Real>::kExpm1));
  return {.read = 6, .near_written = 6, .flops = exponential + 12};
}
template Work stress_neo_hookean_work<float>();
template Work stress_neo_hookean_work<double>();

/// Trace and mean 3, deviator 3, its norm 13, dg 2, share kept 2, product and mean 9.
Work return_map_drucker_prager_work() {
  return {.read = 6, .written = 6, .flops = 32};
}

/// Trace and mean 3, deviator 3, its norm 13; dg 7; trace and apex left 3; norm kept 2; what was lost 9;
/// product and mean 10.
Work return_map_per_particle_drucker_prager_work() {
  return {.read = 6, .written = 6, .near_read = 3, .near_written = 3, .flops = 50};
}
/// Reduction of exp 6 and its series; the angle 5; sine: square, series, its end 3; slope over sine 2 and their
/// products 2.
template <class Real>
Work harden_work() {
  const double exponential = sizeof(Real) == 4 ? 12 : 24, sine = sizeof(Real) == 4 ? 10 : 18;
  return {.read = 1, .near_written = 1, .flops = 6 + exponential + 6 + 5 + 1 + sine + 3 + 4};
}
template Work harden_work<float>();
template Work harden_work<double>();
/// Trace and mean 3, deviator 3, its norm 13; what exceeds the cone 3; g 2, b 4, root 6; both forms of dg 7;
/// the new cone 3.
Work strengthen_work() {
  return {.read = 6, .near_read = 2, .near_written = 1, .flops = 44};
}
/// The test 18; scaling 7 and back 3; 41 a rotation, three a sweep; the bound 7; composed again 48; traces 4.
template <class Real>
Work cut_tension_work() {
  const double sweeps = sizeof(Real) == 4 ? 5 : 6;
  return {.read = 6, .written = 6, .near_read = 1, .near_written = 1, .flops = 87 + 3 * 41 * sweeps};
}
template Work cut_tension_work<float>();
template Work cut_tension_work<double>();

/// x 6, v^2 6, |grad v|^2 18. Moving velocity and gradient are in scratch.
Work advance_work() {
  return {.read = 6, .written = 3, .near_read = 12, .flops = 30};
}
/// I + dt grad v 18, determinant 14.
Work first_failed_work() {
  return {.near_read = 12, .flops = 32};
}
Work open_volume_work() {
  return {.read = 4, .written = 3, .near_written = 1, .flops = 6};
}
Work close_volume_work() {
  return {.read = 4, .written = 1, .near_read = 1, .flops = 4};
}

Work add_arena_work() {
  return {.near_read = 8, .near_written = 4, .flops = 4};
}
Work load_arena_work() {
  return {.near_read = 4, .near_written = 4};
}
/// A quotient and three products.
Work normalize_work() {
  return {.near_read = 4, .near_written = 4, .flops = 4};
}
Work accelerate_work() {
  return {.near_read = 4, .near_written = 4, .flops = 3};
}
Work bound_work() {
  return {.near_read = 4};
}

}  // namespace repose
