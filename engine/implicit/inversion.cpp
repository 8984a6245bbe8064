#include "engine/implicit/inversion.h"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace repose {
namespace {

using Cubic = std::array<double, 4>;  // of s^0, s, ...

double value(const Cubic& c, double s) {
  return c[0] + s * (c[1] + s * (c[2] + s * c[3]));
}

/// The transposed cofactors: their inner product with b^T is how det(a) changes with b.
Mat3 adjugate(const Mat3& a) {
  Mat3 out;
  out.row(0) = a.col(1).cross(a.col(2));
  out.row(1) = a.col(2).cross(a.col(0));
  out.row(2) = a.col(0).cross(a.col(1));
  return out;
}

/// Where in (0, 1) c has its extremes, ascending; 1 where there are fewer than two.
std::array<double, 2> extremes(const Cubic& c) {
  std::array<double, 2> at{1.0, 1.0};
  const double half = c[2], square = half * half - 3.0 * c[3] * c[1];
  if (square < 0.0) return at;
  // The root that does not cancel, and the other by the product of both.
  const double sum = -(half + std::copysign(std::sqrt(square), half));
  const double one = sum / (3.0 * c[3]), other = c[1] / sum;
  std::size_t count = 0;
  for (const double s : {std::min(one, other), std::max(one, other)}) {
    if (s > 0.0 && s < 1.0) at[count++] = s;
  }
  return at;
}

}  // namespace

double length_to_determinant(const Mat3& a, const Mat3& b, double least) {
  const Cubic c{a.determinant() - least, (adjugate(a) * b).trace(), (adjugate(b) * a).trace(), b.determinant()};
  const auto bends = extremes(c);
  double low = 0.0;
  for (const double high : {bends[0], bends[1], 1.0}) {
    if (!(value(c, high) <= 0.0)) {
      low = high;
      continue;
    }
    double left = low, right = high;
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (left + right);
      (value(c, middle) > 0.0 ? left : right) = middle;
    }
    return left;
  }
  return 1.0;
}

}  // namespace repose
