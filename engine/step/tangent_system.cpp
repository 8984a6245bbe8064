#include "engine/step/tangent_system.h"

#include <Eigen/Eigenvalues>
#include <cstring>

#include "engine/base/vector.h"

namespace repose {

/// Room for the tangents of the particles as they now lie.
template <class Real>
void TangentSystem<Real>::follow_topology() {
  const State<Real>& state = sweep_.state();
  std::size_t groups = 0;
  begin_.resize(state.sets.size());
  for (std::size_t set = 0; set < state.sets.size(); ++set) {
    const auto& begin = state.sets[set].begin;
    begin_[set].clear();
    for (std::size_t owner = 0; owner + 1 < begin.size(); ++owner) {
      begin_[set].push_back(groups);
      groups += (begin[owner + 1] - begin[owner] + kTangentGroup - 1) / kTangentGroup;
    }
  }
  tangents_.reserve_uninitialized(groups * kTangentGroup * kTangentValues);
  if (preconditioner_ == Preconditioner::kBlocks) {
    diagonal_ = vector();
    side_ = vector();
  }
}

template <class Real>
Real* TangentSystem<Real>::tangent(std::size_t set, const Chunk<Real>& chunk) {
  const std::size_t within = chunk.first - chunk.set.begin[chunk.owner];
  return tangents_.data() + (begin_[set][chunk.owner] * kTangentGroup + within) * kTangentValues;
}

/// y = Q A Q x: mass, and the change of dt f with x.
template <class Real>
void TangentSystem<Real>::apply(const Vector& x, Vector& y) {
  const double square_dt = static_cast<double>(sweep_.dt()) * static_cast<double>(sweep_.dt());
  sweep_.over_particles(x, nullptr, y, [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
    sweep_.gather_gradient(chunk);
    Real* matrix[kAffineComponents];
    for (std::size_t k = 0; k < kAffineComponents; ++k) matrix[k] = own.matrix.data() + k * kChunk;
    sweep_.kernels().apply_tangent(tangent(set, chunk), chunk.moving_gradient, matrix, chunk.particles.count);
    sweep_.push(chunk, own, square_dt * chunk.set.particle_volume);
  });
  const Real weight = static_cast<Real>(1.0 + shift_);
  sweep_.for_each_block([&](std::size_t b) {
    const Real* const nodes = sweep_.state().nodes.block(b);
    const Real* const from = x.block(b);
    Real* const to = y.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      const Real mass = nodes[at];
      to[at] = Real(0);
      for (std::size_t c = 1; c < kNodeValues; ++c) {
        to[at + c] = mass > Real(0) ? weight * mass * from[at + c] - to[at + c] : Real(0);
      }
    }
    contacts_.project(b, to);
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
  sweep_.over_particles_twice(
      diagonal_, side_, [&](std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) {
        sweep_.add_stiffness(chunk, own, tangent(set, chunk), square_dt * chunk.set.particle_volume);
      });
  sweep_.for_each_block([&](std::size_t b) {
    const Real* const nodes = sweep_.state().nodes.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      if (nodes[at] > Real(0)) invert_block(nodes[at], diagonal_.block(b) + at + 1, side_.block(b) + at + 1);
    }
  });
}

template <class Real>
void TangentSystem<Real>::precondition(const Vector& r, Vector& z) {
  if (preconditioner_ == Preconditioner::kBlocks) {
    sweep_.for_each_block([&](std::size_t b) {
      const Real *const from = r.block(b), *const d = diagonal_.block(b), *const s = side_.block(b);
      Real* const to = z.block(b);
      for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
        const Real x = from[at + 1], y = from[at + 2], w = from[at + 3];
        to[at] = Real(0);
        to[at + 1] = d[at + 1] * x + s[at + 1] * y + s[at + 2] * w;
        to[at + 2] = s[at + 1] * x + d[at + 2] * y + s[at + 3] * w;
        to[at + 3] = s[at + 2] * x + s[at + 3] * y + d[at + 3] * w;
      }
      contacts_.project(b, to);
    });
    return;
  }
  const bool plain = preconditioner_ == Preconditioner::kNone;
  sweep_.for_each_block([&](std::size_t b) {
    const Real* const nodes = sweep_.state().nodes.block(b);
    const Real* const from = r.block(b);
    Real* const to = z.block(b);
    for (std::size_t at = 0; at < kBlockValues; at += kNodeValues) {
      const Real scale = !(nodes[at] > Real(0)) ? Real(0) : plain ? Real(1) : Real(1) / nodes[at];
      to[at] = Real(0);
      for (std::size_t c = 1; c < kNodeValues; ++c) to[at + c] = scale * from[at + c];
    }
    contacts_.project(b, to);
  });
}

template <class Real>
typename TangentSystem<Real>::Vector TangentSystem<Real>::vector() const {
  Vector made;
  made.values.resize(sweep_.state().grid.size() * kBlockValues);
  return made;
}

template <class Real>
double TangentSystem<Real>::dot(const Vector& x, const Vector& y) const {
  return sweep_.sum_of_blocks([&](std::size_t b) {
    const Real* const one = x.block(b);
    const Real* const other = y.block(b);
    double parts[8] = {};  // side by side, for the compiler to vectorise
    for (std::size_t k = 0; k < kBlockValues; k += 8) {
      for (std::size_t lane = 0; lane < 8; ++lane) {
        parts[lane] += static_cast<double>(one[k + lane]) * static_cast<double>(other[k + lane]);
      }
    }
    return ((parts[0] + parts[4]) + (parts[2] + parts[6])) + ((parts[1] + parts[5]) + (parts[3] + parts[7]));
  });
}

template <class Real>
void TangentSystem<Real>::add(double a, const Vector& x, Vector& y) const {
  const Real scale = static_cast<Real>(a);
  sweep_.for_each_block([&](std::size_t b) {
    const Real* const from = x.block(b);
    Real* const to = y.block(b);
    for (std::size_t k = 0; k < kBlockValues; ++k) to[k] += scale * from[k];
  });
}

template <class Real>
void TangentSystem<Real>::scale_add(const Vector& x, double b, Vector& y) const {
  const Real scale = static_cast<Real>(b);
  sweep_.for_each_block([&](std::size_t block) {
    const Real* const from = x.block(block);
    Real* const to = y.block(block);
    for (std::size_t k = 0; k < kBlockValues; ++k) to[k] = from[k] + scale * to[k];
  });
}

template <class Real>
void TangentSystem<Real>::copy(const Vector& x, Vector& y) const {
  sweep_.for_each_block(
      [&](std::size_t b) { std::memcpy(y.block(b), x.block(b), kBlockValues * sizeof(Real)); });
}

template class TangentSystem<float>;
template class TangentSystem<double>;

}  // namespace repose
