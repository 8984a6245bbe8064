// Repose: the linear system of an implicit step, A = dr/dv = M + dt^2 K at the velocities where it was
// linearised:
//   (A z)_i = m_i z_i + dt^2 sum_p V0 dS_p(grad z) g_ip
// (Klar et al. 2016, supplement, algorithm 2), with what contacts hold projected out. No matrix is assembled: a
// product is one pass over the particles. Vectors are node fields, [0, x, y, z] a node, zero where a node is
// empty.
#pragma once

#include "engine/step/block_sweep.h"
#include "engine/step/contact_set.h"

namespace repose {

template <class Real_>
class TangentSystem {
 public:
  using Real = Real_;
  using Vector = NodeField<Real>;

  TangentSystem(BlockSweep<Real>& sweep, const ContactSet<Real>& contacts, Preconditioner preconditioner)
      : sweep_(sweep), contacts_(contacts), preconditioner_(preconditioner) {}

  /// After each order event.
  void follow_topology();
  /// Where the tangents of a chunk begin (kTangentValues numbers a particle, in groups).
  Real* tangent(std::size_t set, const Chunk<Real>& chunk);

  /// After each linearisation: what the preconditioner is made of.
  void prepare();

  // What Krylov solvers ask for (engine/step/krylov.h).
  Vector vector() const;
  void apply(const Vector& x, Vector& y);
  void precondition(const Vector& r, Vector& z);
  double dot(const Vector& x, const Vector& y) const;
  void add(double a, const Vector& x, Vector& y) const;
  void scale_add(const Vector& x, double b, Vector& y) const;
  void copy(const Vector& x, Vector& y) const;
  void shift(double delta) { shift_ = delta; }

  std::size_t bytes() const { return tangents_.bytes() + diagonal_.bytes() + side_.bytes(); }

 private:
  BlockSweep<Real>& sweep_;
  const ContactSet<Real>& contacts_;
  Preconditioner preconditioner_;
  AlignedArray<Real> tangents_;
  std::vector<std::vector<std::size_t>> begin_;  // per set and owner, in groups
  double shift_ = 0.0;
  Vector diagonal_, side_;  // of the inverses of the blocks: [0, xx, yy, zz] and [0, xy, xz, yz] a node
};

}  // namespace repose
