// Repose: transfers, what a particle tells the nodes and what it takes back. In all of them a particle of mass
// m tells node i   w m (v + A (x_i - x_p))   and from the nodes come v = sum w v_i and C = D^-1 sum w v_i (x_i
// - x_p)^T; they differ in the matrix A and in what they keep. The stress goes along in the affine matrix (MLS
// form, Hu et al. 2018): f_i = -V0 tau D^-1 w (x_i - x_p).
//
// APIC (Jiang et al. 2015) tells all of C and keeps all of it: linear and angular momentum are exact.
#pragma once

namespace repose {

struct ApicTransfer {
  static constexpr const char* kName = "apic";
  static constexpr const char* kMeaning = "affine particle-in-cell, Jiang et al. 2015";

  /// A = C: the matrix that a particle tells the nodes, entry (row, axis).
  template <class N>
  static constexpr N told(const N (&c)[3][3], int row, int axis) {
    return c[row][axis];
  }
};

}  // namespace repose
