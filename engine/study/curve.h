// Repose: a figure that is no single number: y over x, and how far two of them are apart.
#pragma once

#include <vector>

namespace repose {

struct Curve {
  std::vector<double> x, y;  ///< x ascending

  bool empty() const { return x.empty(); }
  /// Between two points a straight line; 0 beyond the ends, where there is no matter.
  double at(double place) const;
};

/// How far a curve is from another, in shares of the root mean square, and of the largest |y|, of that other.
/// Both are looked at in the places of the finer one, from end to end of both; where the other is 0 all along,
/// absolutely.
struct Apart {
  double mean = 0.0;  ///< root of the mean square
  double largest = 0.0;
};
Apart apart(const Curve& curve, const Curve& other);

/// The integral of |y - other's y| over the x of the first, which both share; of quantiles over shares it is
/// the Wasserstein-1 distance.
double area_between(const Curve& curve, const Curve& other);

}  // namespace repose
