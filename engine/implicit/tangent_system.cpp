#include "engine/implicit/tangent_system.h"

#include <Eigen/Eigenvalues>
#include <cstring>

#include "engine/base/vector.h"

namespace repose {

/// Room for the tangents of the particles as they now lie.
template <class Real>
void TangentSystem<Real>::follow_topology() {
  tangents_.reserve_uninitialized(sweep_.room() * kTangentValues);
  if (preconditioner_ == Preconditioner::kBlocks) {
    diagonal_ = vector();
    side_ = vector();
  }
}

/// y = A x: mass, friction, and what particles push with the change of their stress. What contacts hold and
/// what is empty is left to the preconditioner, which lets none of it through.
template <class Real>
void TangentSystem<Real>::apply(const Vector& x, Vector& y) {
  const Real weight = static_cast<Real>(1.0 + shift_);
  sweep_.for_each_block([&](std::size_t b) {
    sweep_.kernels().vector.times_mass(sweep_.state().nodes.block(b), weight, x.block(b), y.block(b));
    contacts_.add_friction(b, x.block(b), y.block(b));
  });
  const double square_dt = static_cast<double>(sweep_.dt()) * static_cast<double>(sweep_.dt());
  sweep_.over_particles({.from = &x, .to = &y, .adds = true},
                        [&](std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) {
                          Real *gradient[kAffineComponents], *matrix[kAffineComponents];
                          for (std::size_t k = 0; k < kAffineComponents; ++k) {
                            gradient[k] = own.gradient + k * kChunk;
                            matrix[k] = own.matrix + k * kChunk;
                          }
                          const Real* const tangents = tangent(set, chunk);
                          sweep_.gather_gradient(chunk, own.arena, gradient, {tangents, kTangentValues});
                          sweep_.kernels().tangent.apply(tangents, gradient, matrix, chunk.particles.count);
                          sweep_.push(chunk, own, -square_dt * chunk.set.particle_volume);
                        });
}

namespace {

/// The inverse of m + K, with eigenvalues of no less than m: what is left of K where sand has given way may not
/// be definite.
template <class Real>
void invert_block(Real mass, Real* diagonal, Real* side) {
  Mat3 block = Mat3::Zero();
  block.diagonal() << static_cast<double>(diagonal[0]), static_cast<double>(diagonal[1]),
      static_cast<double>(diagonal[2]);
  block(1, 0) = static_cast<double>(side[0]);
  block(2, 0) = static_cast<double>(side[1]);
  block(2, 1) = static_cast<double>(side[2]);
  const Eigen::SelfAdjointEigenSolver<Mat3> eigen(block);  // reads the lower triangle
  const auto m = static_cast<double>(mass);
  const Vec3 weight = (eigen.eigenvalues().cwiseMax(0.0).array() + m).inverse();
  const Mat3 inverse = eigen.eigenvectors() * weight.asDiagonal() * eigen.eigenvectors().transpose();
  for (int c = 0; c < 3; ++c) diagonal[c] = static_cast<Real>(inverse(c, c));
  side[0] = static_cast<Real>(inverse(1, 0));
  side[1] = static_cast<Real>(inverse(2, 0));
  side[2] = static_cast<Real>(inverse(2, 1));
}

}  // namespace

template <class Real>
void TangentSystem<Real>::prepare() {
  if (preconditioner_ != Preconditioner::kBlocks) return;
  const double square_dt = static_cast<double>(sweep_.dt()) * static_cast<double>(sweep_.dt());
  sweep_.over_particles({.to = &diagonal_, .second = &side_}, [&](std::size_t set, Chunk<Real>& chunk,
                                                                  const ImplicitScratch<Real>& own) {
    sweep_.add_stiffness(chunk, own, tangent(set, chunk), square_dt * chunk.set.particle_volume);
  });
  sweep_.for_each_block([&](std::size_t b) {
    contacts_.for_each_friction(b, [&](int node, const auto& friction) {
      const std::size_t at = static_cast<std::size_t>(node) * kNodeValues + 1;
      Real *const d = diagonal_.block(b) + at, *const s = side_.block(b) + at;
      for (int c = 0; c < 3; ++c) d[c] += friction(c, c);
      s[0] += friction(1, 0);
      s[1] += friction(2, 0);
      s[2] += friction(2, 1);
    });
    const Real* const nodes = sweep_.state().nodes.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      Real *const d = diagonal_.block(b) + at, *const s = side_.block(b) + at;
      if (nodes[at] > Real(0)) {
        invert_block(nodes[at], d + 1, s + 1);
      } else {  // what rounds to no mass may have some stiffness
        std::fill_n(d, kNodeValues, Real(0));
        std::fill_n(s, kNodeValues, Real(0));
      }
    }
  });
}

template <class Real>
void TangentSystem<Real>::Part::precondition(const Vector& r, Vector& z) const {
  const Real *const from = r.block(block_), *const nodes = system_.sweep_.state().nodes.block(block_);
  Real* const to = z.block(block_);
  const ContactSet<Real>& contacts = system_.contacts_;
  switch (system_.preconditioner_) {
    case Preconditioner::kMass:
      kernels().over_mass(nodes, from, to);
      contacts.precondition(block_, to);
      break;
    case Preconditioner::kBlocks:
      std::copy_n(from, kBlockValues, to);
      contacts.project(block_, to);  // or the blocks would make what is held part of what is not
      system_.times_inverse_blocks(block_, to);
      contacts.project(block_, to);
      break;
    case Preconditioner::kNone:
      for (std::size_t at = 0; at < kBlockValues; ++at) {
        const std::size_t value = at % kNodeValues;
        to[at] = value != 0 && nodes[at - value] > Real(0) ? from[at] : Real(0);
      }
      contacts.project(block_, to);
      break;
  }
}

template <class Real>
void TangentSystem<Real>::times_inverse_blocks(std::size_t block, Real* z) const {
  const Real *const d = diagonal_.block(block), *const s = side_.block(block);
  for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
    const Real x = z[at + 1], y = z[at + 2], w = z[at + 3];
    z[at] = Real(0);
    z[at + 1] = d[at + 1] * x + s[at + 1] * y + s[at + 2] * w;
    z[at + 2] = s[at + 1] * x + d[at + 2] * y + s[at + 3] * w;
    z[at + 3] = s[at + 2] * x + s[at + 3] * y + d[at + 3] * w;
  }
}

template <class Real>
typename TangentSystem<Real>::Vector TangentSystem<Real>::vector() const {
  Vector made;
  made.values.resize(sweep_.state().grid.size() * kBlockValues);
  return made;
}

template <class Real>
double TangentSystem<Real>::Part::dot(const Vector& x, const Vector& y) const {
  return kernels().dot(x.block(block_), y.block(block_));
}

template <class Real>
void TangentSystem<Real>::Part::add(double a, const Vector& x, Vector& y) const {
  kernels().add(static_cast<Real>(a), x.block(block_), y.block(block_));
}

template <class Real>
void TangentSystem<Real>::Part::scale_add(const Vector& x, double b, Vector& y) const {
  kernels().scale_add(x.block(block_), static_cast<Real>(b), y.block(block_));
}

template <class Real>
void TangentSystem<Real>::Part::copy(const Vector& x, Vector& y) const {
  std::memcpy(y.block(block_), x.block(block_), kBlockValues * sizeof(Real));
}

template class TangentSystem<float>;
template class TangentSystem<double>;

}  // namespace repose
