// Repose tests: what the tests of the transfers share: every stencil with every transfer, particles and nodes
// at random, and the results of the kernels and of the reference side by side.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "kernels/reference/transfer.h"
#include "tests/kernels/samples.h"

namespace repose {

/// The numbers of a transfer beside the particles: those of sand at dx = 1 cm, so that velocity, affine and
/// stress terms weigh about the same.
struct TransferCase {
  std::size_t stencil = 0;
  std::size_t transfer = 0;
  double mass = 2.75e-4;             // kg
  double spacing = 0.01;             // m
  double impulse_volume = 1.25e-11;  // dt V0, s m^3
  double kept_velocity = 0.75;
  double dt = 1e-3;       // s
  bool measures = false;  // what particles have for themselves, where the transfer keeps velocity
  double kept_stretching = 0.375;
  int flat_axis = -1;

  const StencilFigures& nodes() const { return kStencilFigures[stencil]; }
  const TransferFigures& figures() const { return kTransferFigures[transfer]; }
  bool keeps_affine() const { return figures().affine != Affine::kNone; }
  /// First node of an arena along every axis.
  int origin() const { return nodes().lowest_base; }
  /// "cubic flip", "cubic flip measuring".
  std::string name() const {
    return std::string(nodes().name) + ' ' + kTransferChoices[transfer].name + (measures ? " measuring" : "");
  }

  template <class Real>
  Lattice<Real> lattice() const;
  template <class Real>
  const TransferKernels<Real>& kernel(Target target) const {
    return kernels<Real>(target).transfer[stencil][transfer];
  }
  template <class Real>
  auto scatter(Target target) const {
    return measures ? kernel<Real>(target).scatter_measuring : kernel<Real>(target).scatter;
  }
  template <class Real>
  auto gather(Target target) const {
    return measures ? kernel<Real>(target).gather_measuring : kernel<Real>(target).gather;
  }
  template <class Real>
  const StencilKernels<Real>& stencil_kernel(Target target) const {
    return kernels<Real>(target).stencil[stencil];
  }
};

/// Every stencil with every transfer, measuring or not; every stencil with the first transfer.
std::vector<TransferCase> all_cases();
std::vector<TransferCase> all_stencils();

/// Nodes along an axis that a particle reaches.
int stencil_width(std::size_t stencil);

/// Whether particles with one base node follow one another.
enum class Order { kSegments, kScattered };

/// Particles of one block, with one more number behind every channel that nobody may touch.
template <class Real>
struct Particles {
  std::size_t count = 0;
  std::vector<Real> position[3], velocity[3], affine[kAffineComponents], strain[kStrainComponents],
      stress[kStrainComponents], own[3];

  explicit Particles(std::size_t size);

  ParticleSpan<Real> span();
  /// With `own` for their own velocity; `before` is where what is measured goes.
  ScatterInput<Real> scatter_input(const TransferCase& transfer, Real* before = nullptr);
  bool canaries_alive() const;
};

/// Base nodes from the lowest to the highest of the stencil, |v| and |own| to 1 m/s, |C| to 1/dx, stresses to
/// 5e4 Pa.
template <class Real>
Particles<Real> random_particles(std::size_t count, Order order, std::uint64_t seed, std::size_t stencil = 0);

/// Where the node is in an arena; the first is 0 0 0.
constexpr std::size_t arena_place(int a, int b, int c) {
  return static_cast<std::size_t>(((a * kArenaSide + b) * kArenaSide + c) * kNodeValues);
}
inline constexpr std::size_t kArenaNodes = kArenaSide * kArenaSide * kArenaSide;

template <class Real>
using Arena = std::vector<Real>;

/// Mass 1 and velocities to 1 m/s on every node.
template <class Real>
Arena<Real> random_arena(std::uint64_t seed);

/// Of momentum, and where the case measures of momentum before forces.
template <class Real>
struct ScatteredReference {
  Arena<double> arena = Arena<double>(kArenaValues, 0.0), before = arena;

  ScatteredReference(Particles<Real>& particles, const TransferCase& transfer);
};

/// Bits of the rows of nodes that the particles reach, and how many segments they form.
struct Touched {
  std::uint64_t rows = 0;
  std::size_t segments = 0;
};
template <class Real>
Touched touched_by(const Particles<Real>& particles, std::size_t stencil);

/// What a gather gave, with one more number behind every channel that nobody may touch.
template <class Real>
struct Gathered {
  std::vector<Real> velocity[3], affine[kAffineComponents], moving[3], gradient[kAffineComponents], own[3];
  Arena<Real> before;

  explicit Gathered(std::size_t count);
  /// Everything is wanted that the transfer has. Nodes before forces are at random; `own` begins as that of the
  /// particles.
  GatherInput<Real> input(Particles<Real>& particles, const TransferCase& transfer);
  bool canaries_alive() const;
};

/// Compares an arena with the reference's: masses and momenta each to their largest.
template <class Real>
void expect_near(const Arena<Real>& arena, const Arena<double>& expected, double tolerance,
                 const std::string& what);
/// Compares velocities to 1 m/s and matrices to the largest slope that such nodes can have.
template <class Real>
void expect_near(const Gathered<Real>& result, const Gathered<Real>& expected, const TransferCase& transfer,
                 const std::string& what);

template <class Real>
inline constexpr double kTransferTolerance = sizeof(Real) == 4 ? 1e-5 : 1e-12;

}  // namespace repose
