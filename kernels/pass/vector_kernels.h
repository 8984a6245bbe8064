// Repose: what Krylov solvers do with a block of node vectors, four values a node.
#pragma once

namespace repose {

template <class Real>
struct VectorKernels {
  /// x^T y, summed in double.
  double (*dot)(const Real* x, const Real* y);
  void (*add)(Real a, const Real* x, Real* y);        ///< y += a x
  void (*scale_add)(const Real* x, Real b, Real* y);  ///< y = x + b y
  /// y = weight m x and y = x / m, m the first value of `nodes`; of y it is zero, and all where m is.
  void (*times_mass)(const Real* nodes, Real weight, const Real* x, Real* y);
  void (*over_mass)(const Real* nodes, const Real* x, Real* y);
};

}  // namespace repose
