// Repose tests: the transfers between particles and nodes written once more, in double, node by node, straight
// from the equations in the kernels' headers: no rows, no runs, no stored form of the weights.
#pragma once

#include <cstdint>
#include <vector>

#include "kernels/layout/stencil.h"
#include "tests/kernels/samples.h"

namespace repose {

/// The numbers of a transfer beside the particles: those of sand at dx = 1 cm, so that velocity, affine and
/// stress terms weigh about the same.
struct TransferCase {
  double mass = 2.75e-4;             // kg
  double spacing = 0.01;             // m
  double impulse_volume = 1.25e-11;  // dt V0, s m^3
  int flat_axis = -1;

  /// D^-1 of an axis, 1/m^2.
  double inverse_d(int axis) const {
    return axis == flat_axis ? 0.0 : QuadraticStencil::kInverseD / (spacing * spacing);
  }
  template <class Real>
  Lattice<Real> lattice() const {
    Lattice<Real> lattice{static_cast<Real>(spacing), {}, flat_axis};
    for (int axis = 0; axis < 3; ++axis)
      lattice.axis_scale[axis] = static_cast<Real>(inverse_d(axis) * spacing);
    return lattice;
  }
};

/// Whether particles with one base node follow one another.
enum class Order { kRuns, kScattered };

/// Particles of one block, with one more number behind every channel that nobody may touch.
template <class Real>
struct Particles {
  std::size_t count = 0;
  std::vector<Real> position[3], velocity[3], affine[kAffineComponents], strain[kStrainComponents],
      stress[kStrainComponents];

  explicit Particles(std::size_t size);

  ParticleSpan<Real> span();
  ScatterInput<Real> scatter_input(const TransferCase& transfer);
  bool canaries_alive() const;
};

/// Base nodes from -1 to 4 an axis, |v| to 1 m/s, |C| to 1/dx, stresses to 1e4 Pa.
template <class Real>
Particles<Real> random_particles(std::size_t count, Order order, std::uint64_t seed);

/// Base node of a position in cells.
int base_node(double position);

/// The four values of nodes [-1, 6] an axis.
struct NodeValues {
  double value[kArenaSide][kArenaSide][kArenaSide][kNodeValues] = {};

  double* at(int x, int y, int z) { return value[x + 1][y + 1][z + 1]; }
  const double* at(int x, int y, int z) const { return value[x + 1][y + 1][z + 1]; }
  /// Largest absolute mass (false) or momentum (true) of all nodes.
  double largest(bool momentum) const;
};

/// Where the node is in an arena.
constexpr std::size_t arena_place(int x, int y, int z) {
  return static_cast<std::size_t>((((x + 1) * kArenaSide + y + 1) * kArenaSide + z + 1) * kNodeValues);
}

template <class Real>
NodeValues values_of(const std::vector<Real>& arena);
template <class Real>
std::vector<Real> arena_of(const NodeValues& nodes);

/// Sum over particles of w (m, m v + (m C - dt V0 tau D^-1)(x_i - x_p)).
template <class Real>
NodeValues reference_scatter(const Particles<Real>& particles, const TransferCase& transfer);

/// Bits of the rows of nodes that the particles reach, and how many runs they form.
struct Reach {
  std::uint64_t rows = 0;
  std::size_t runs = 0;
};
template <class Real>
Reach reach_of(const Particles<Real>& particles);

/// v = sum w v_i in the first three, C = D^-1 sum w v_i (x_i - x_p)^T by rows in the other nine.
template <class Real>
std::array<double, 12> reference_gather(const Particles<Real>& particles, std::size_t p,
                                        const NodeValues& nodes, const TransferCase& transfer);

}  // namespace repose
