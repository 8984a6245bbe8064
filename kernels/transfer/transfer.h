// Repose: transfers, what a particle tells the nodes and what it takes back. In all of them a particle of mass
// m tells node i the momentum
//   w m (v + A (x_i - x_p)) + dt f_i,      A = C, its skew part and some of the rest, or 0,
// and from the nodes come v = sum w v_i and C = D^-1 sum w v_i (x_i - x_p)^T (Klar et al. 2016, eqs. 7-12).
// They differ in the matrix A, in how stress pushes nodes, and in whether particles keep velocity of their own, v
// less what nodes tell of it before forces:
//   forces by moments    f_i = -V0 tau D^-1 w (x_i - x_p), gradient of velocity C    (MLS form, Hu et al. 2018)
//   forces by gradients  f_i = -V0 tau grad w, gradient of velocity sum v_i grad w^T    (Klar et al. 2016)
#pragma once

namespace repose {

/// The matrix A that a particle tells the nodes beside its velocity.
enum class Affine {
  kNone,  ///< 0: PIC and FLIP store no matrix
  kSkew,  ///< (C - C^T)/2 + s (C + C^T)/2, s the share of stretching that is kept
  kFull,  ///< C
};

/// How stress pushes nodes, and which gradient of velocity strains.
enum class Force { kMoments, kGradients };

}  // namespace repose
