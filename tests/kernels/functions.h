// Repose tests: the functions of the kernel headers that no pass exposes by themselves, over arrays: once as
// plain scalars and once as packs of every instruction set. So a test of log1p is a test of all of its
// compilations.
#pragma once

#include <cstddef>
#include <tuple>
#include <vector>

#include "kernels/layout/stencil.h"

namespace repose {

inline constexpr std::size_t kStencilCount = std::tuple_size_v<Stencils>;

/// `count` results; a symmetric matrix is six numbers in the order of Sym3.
template <class Real>
struct Functions {
  const char* name;
  void (*log1p)(const Real* x, Real* y, std::size_t count);
  void (*expm1)(const Real* x, Real* y, std::size_t count);
  void (*eigen_sym3)(const Real* matrix, Real* result, std::size_t count);  ///< three values, then U by rows
  void (*half_log1p)(const Real* matrix, Real* result, std::size_t count);  ///< with the materials' floor
  void (*expm1_twice)(const Real* matrix, Real* result, std::size_t count);
  void (*push_forward)(const Real* gradient_and_matrix, Real* result, std::size_t count);  ///< nine, then six
  void (*determinant)(const Real* matrix, Real* result, std::size_t count);                ///< of nine
  void (*weights[kStencilCount])(const Real* f, Real* result, std::size_t count);          ///< four each
  void (*slopes[kStencilCount])(const Real* f, Real* result, std::size_t count);           ///< four each
};

/// The scalar templates first, then the packs of each instruction set that this machine has.
template <class Real>
const std::vector<Functions<Real>>& all_functions();

}  // namespace repose
