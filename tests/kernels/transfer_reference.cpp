// Repose tests: see transfer_reference.h.
#include "tests/kernels/transfer_reference.h"

#include <numeric>

namespace repose {
namespace {

/// The quadratic B-spline of a distance in cells (Klar et al. 2016, section 5.1).
double spline(double distance) {
  const double r = std::fabs(distance);
  if (r < 0.5) return 0.75 - r * r;
  return r < 1.5 ? 0.5 * (1.5 - r) * (1.5 - r) : 0.0;
}

/// Calls visit(node, weight, x_i - x_p in m) for the nodes of one particle.
template <class Real, class Visit>
void for_each_node(const Particles<Real>& particles, std::size_t p, const TransferCase& transfer, Visit visit) {
  int base[3];
  for (int axis = 0; axis < 3; ++axis) base[axis] = base_node(particles.position[axis][p]);
  for (int k = 0; k < 27; ++k) {
    const int node[3] = {base[0] + k / 9, base[1] + k / 3 % 3, base[2] + k % 3};
    double weight = 1, distance[3];
    for (int axis = 0; axis < 3; ++axis) {
      const double cells = node[axis] - double{particles.position[axis][p]};
      distance[axis] = cells * transfer.spacing;
      weight *= axis != transfer.flat_axis ? spline(cells) : node[axis] == base[axis] ? 1.0 : 0.0;
    }
    visit(node, weight, distance);
  }
}

constexpr int kSymmetric[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};

}  // namespace

template <class Real>
Particles<Real>::Particles(std::size_t size) : count(size) {
  for (auto* channels : {position, velocity}) {
    for (int k = 0; k < 3; ++k) channels[k].assign(size + 1, kCanary<Real>);
  }
  for (auto& channel : affine) channel.assign(size + 1, kCanary<Real>);
  for (auto* channels : {strain, stress}) {
    for (int k = 0; k < kStrainComponents; ++k) channels[k].assign(size + 1, kCanary<Real>);
  }
}

template <class Real>
ParticleSpan<Real> Particles<Real>::span() {
  ParticleSpan<Real> span{};
  for (int k = 0; k < 3; ++k) span.position[k] = position[k].data();
  for (int k = 0; k < 3; ++k) span.velocity[k] = velocity[k].data();
  for (int k = 0; k < kAffineComponents; ++k) span.affine[k] = affine[k].data();
  for (int k = 0; k < kStrainComponents; ++k) span.strain[k] = strain[k].data();
  span.count = count;
  return span;
}

template <class Real>
ScatterInput<Real> Particles<Real>::scatter_input(const TransferCase& transfer) {
  ScatterInput<Real> in{};
  in.particles = span();
  for (int k = 0; k < kStrainComponents; ++k) in.stress[k] = stress[k].data();
  in.mass = static_cast<Real>(transfer.mass);
  in.impulse_volume = static_cast<Real>(transfer.impulse_volume);
  in.lattice = transfer.lattice<Real>();
  return in;
}

template <class Real>
bool Particles<Real>::canaries_alive() const {
  bool alive = true;
  for (const auto* channels : {position, velocity}) {
    for (int k = 0; k < 3; ++k) alive = alive && channels[k][count] == kCanary<Real>;
  }
  for (const auto& channel : affine) alive = alive && channel[count] == kCanary<Real>;
  for (const auto* channels : {strain, stress}) {
    for (int k = 0; k < kStrainComponents; ++k) alive = alive && channels[k][count] == kCanary<Real>;
  }
  return alive;
}

template <class Real>
Particles<Real> random_particles(std::size_t count, Order order, std::uint64_t seed) {
  Samples samples(seed);
  Particles<Real> particles(count);
  std::vector<std::array<Real, 3>> positions(count);
  for (auto& position : positions) {
    // 5.5 itself has base node 5: stay below it after rounding.
    for (Real& x : position) x = static_cast<Real>(samples.uniform(-0.5, 5.4999));
  }
  const auto nodes = [](const std::array<Real, 3>& x) {
    return std::array{base_node(x[0]), base_node(x[1]), base_node(x[2])};
  };
  if (order == Order::kRuns) {
    // A few cells only, so that the runs are long.
    for (auto& position : positions) {
      for (Real& x : position)
        x = std::min(Real(5.4), std::max(Real(-0.5), Real(2.5) * std::round(x / Real(2.5))));
      for (Real& x : position) x = static_cast<Real>(base_node(x) + samples.uniform(0.5, 1.4999));
    }
    std::sort(positions.begin(), positions.end(),
              [&](const auto& a, const auto& b) { return nodes(a) < nodes(b); });
  }
  const auto fill = [&](std::vector<Real>& channel, double most) {
    for (std::size_t p = 0; p < count; ++p) channel[p] = static_cast<Real>(samples.uniform(-most, most));
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t p = 0; p < count; ++p) particles.position[axis][p] = positions[p][axis];
    fill(particles.velocity[axis], 1.0);
  }
  for (auto& channel : particles.affine) fill(channel, 1 / TransferCase().spacing);
  for (auto& channel : particles.strain) fill(channel, 0.1);
  for (auto& channel : particles.stress) fill(channel, 5e4);
  return particles;
}

int base_node(double position) {
  return static_cast<int>(std::floor(position - QuadraticStencil::kBaseShift));
}

double NodeValues::largest(bool momentum) const {
  double most = 0;
  const double* all = &value[0][0][0][0];
  for (int k = 0; k < kArenaSide * kArenaSide * kArenaSide * kNodeValues; ++k) {
    if ((k % kNodeValues != 0) == momentum) most = std::max(most, std::fabs(all[k]));
  }
  return most;
}

template <class Real>
NodeValues values_of(const std::vector<Real>& arena) {
  NodeValues nodes;
  std::copy_n(arena.begin(), sizeof(nodes.value) / sizeof(double), &nodes.value[0][0][0][0]);
  return nodes;
}

template <class Real>
std::vector<Real> arena_of(const NodeValues& nodes) {
  std::vector<Real> arena(kArenaValues, Real(0));
  const double* all = &nodes.value[0][0][0][0];
  for (std::size_t k = 0; k < sizeof(nodes.value) / sizeof(double); ++k) arena[k] = static_cast<Real>(all[k]);
  return arena;
}

template <class Real>
NodeValues reference_scatter(const Particles<Real>& particles, const TransferCase& transfer) {
  NodeValues nodes;
  for (std::size_t p = 0; p < particles.count; ++p) {
    for_each_node(particles, p, transfer, [&](const int* node, double weight, const double* distance) {
      double* to = nodes.at(node[0], node[1], node[2]);
      to[0] += weight * transfer.mass;
      for (int row = 0; row < 3; ++row) {
        double momentum = transfer.mass * particles.velocity[row][p];
        for (int axis = 0; axis < 3; ++axis) {
          const double affine = particles.affine[3 * row + axis][p];
          const double tau = particles.stress[kSymmetric[row][axis]][p];
          momentum += (transfer.mass * affine - transfer.impulse_volume * tau * transfer.inverse_d(axis)) *
                      distance[axis];
        }
        to[1 + row] += weight * momentum;
      }
    });
  }
  return nodes;
}

template <class Real>
Reach reach_of(const Particles<Real>& particles) {
  Reach reach;
  std::array<int, 3> last{-9, -9, -9};
  for (std::size_t p = 0; p < particles.count; ++p) {
    std::array<int, 3> base;
    for (int axis = 0; axis < 3; ++axis) base[axis] = base_node(particles.position[axis][p]);
    reach.runs += base != last;
    last = base;
    for (int k = 0; k < 9; ++k) {
      reach.rows |= std::uint64_t{1} << ((base[0] + 1 + k / 3) * kArenaSide + base[1] + 1 + k % 3);
    }
  }
  return reach;
}

template <class Real>
std::array<double, 12> reference_gather(const Particles<Real>& particles, std::size_t p,
                                        const NodeValues& nodes, const TransferCase& transfer) {
  std::array<double, 12> result{};
  for_each_node(particles, p, transfer, [&](const int* node, double weight, const double* distance) {
    const double* velocity = nodes.at(node[0], node[1], node[2]) + 1;
    for (int row = 0; row < 3; ++row) {
      result[row] += weight * velocity[row];
      for (int axis = 0; axis < 3; ++axis) {
        result[3 + 3 * row + axis] += transfer.inverse_d(axis) * weight * velocity[row] * distance[axis];
      }
    }
  });
  return result;
}

#define REPOSE_FOR(Real)                                                                                   \
  template struct Particles<Real>;                                                                         \
  template Particles<Real> random_particles<Real>(std::size_t, Order, std::uint64_t);                      \
  template NodeValues values_of(const std::vector<Real>&);                                                 \
  template std::vector<Real> arena_of(const NodeValues&);                                                  \
  template NodeValues reference_scatter(const Particles<Real>&, const TransferCase&);                      \
  template Reach reach_of(const Particles<Real>&);                                                         \
  template std::array<double, 12> reference_gather(const Particles<Real>&, std::size_t, const NodeValues&, \
                                                   const TransferCase&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose
