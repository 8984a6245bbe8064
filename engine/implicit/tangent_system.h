// Repose: the linear system of an implicit step, A = dr/dv = M + dt^2 K at the velocities where it was
// linearised:
//   (A z)_i = m_i z_i + dt^2 sum_p V0 dS_p(grad z) g_ip
// (Klar et al. 2016, supplement, algorithm 2), with what contacts hold projected out. No matrix is assembled: a
// product is one pass over the particles. Vectors are node fields, [0, x, y, z] a node, zero where a node is
// empty.
#pragma once

#include "engine/implicit/contact_set.h"
#include "engine/implicit/particle_sweep.h"

namespace repose {

template <class Real_>
class TangentSystem {
 public:
  using Real = Real_;
  using Vector = NodeField<Real>;

  TangentSystem(ParticleSweep<Real>& sweep, const ContactSet<Real>& contacts, Preconditioner preconditioner)
      : sweep_(sweep), contacts_(contacts), preconditioner_(preconditioner) {}

  /// After each sort event.
  void follow_topology();
  /// Where the tangents of a chunk begin (kTangentValues numbers a particle, in groups).
  Real* tangent(std::size_t set, const Chunk<Real>& chunk) {
    return tangents_.data() + sweep_.place(set, chunk) * kTangentValues;
  }

  /// After each linearisation: what the preconditioner is made of.
  void prepare();

  // What Krylov solvers ask for (engine/solve/krylov.h).
  Vector vector() const;
  void apply(const Vector& x, Vector& y);
  void shift(double delta) { shift_ = delta; }
  /// A block of all vectors.
  class Part {
   public:
    Part(const TangentSystem& system, std::size_t block) : system_(system), block_(block) {}
    void precondition(const Vector& r, Vector& z) const;
    double dot(const Vector& x, const Vector& y) const;
    void add(double a, const Vector& x, Vector& y) const;
    void scale_add(const Vector& x, double b, Vector& y) const;
    void copy(const Vector& x, Vector& y) const;

   private:
    const VectorKernels<Real>& kernels() const { return system_.sweep_.kernels().vector; }

    const TangentSystem& system_;
    std::size_t block_;
  };
  template <class Body>
  void parts(Body body) {
    sweep_.for_each_block([&](std::size_t block) { body(Part(*this, block)); });
  }
  template <class Body>
  auto sums(Body body) {
    return sweep_.sums_of_blocks([&](std::size_t block) { return body(Part(*this, block)); });
  }

  std::size_t particle_bytes() const { return tangents_.bytes(); }
  std::size_t block_bytes() const { return diagonal_.bytes() + side_.bytes(); }

 private:
  void times_inverse_blocks(std::size_t block, Real* z) const;

  ParticleSweep<Real>& sweep_;
  const ContactSet<Real>& contacts_;
  Preconditioner preconditioner_;
  AlignedArray<Real> tangents_;
  double shift_ = 0.0;
  Vector diagonal_, side_;  // of the inverses of the blocks: [0, xx, yy, zz] and [0, xy, xz, yz] a node
};

}  // namespace repose
