// Repose tests: see transfer_rig.h.
#include "tests/kernels/transfer_rig.h"

#include <gtest/gtest.h>

namespace repose {
namespace {

template <class Real>
void append_canary(std::vector<Real>& channel, std::size_t count) {
  channel.assign(count + 1, kCanary<Real>);
}

template <class Real, std::size_t n>
bool alive(const std::vector<Real> (&channels)[n]) {
  return std::all_of(channels, channels + n, [](const auto& c) { return c.back() == kCanary<Real>; });
}

template <class Real, std::size_t n>
void expect_channels(const std::vector<Real> (&value)[n], const std::vector<Real> (&expected)[n], double bound,
                     const std::string& what) {
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t p = 0; p < value[k].size(); ++p) {
      ASSERT_NEAR(value[k][p], expected[k][p], bound) << what << ' ' << k << ", particle " << p;
    }
  }
}

/// Positions of one particle each; with long segments, in a few cells only.
template <class Real>
std::vector<std::array<Real, 3>> random_positions(std::size_t count, Order order, Samples& samples,
                                                  std::size_t stencil) {
  const StencilFigures& nodes = kStencilFigures[stencil];
  const int places = nodes.highest_base - nodes.lowest_base + 1;
  std::vector<std::array<Real, 3>> positions(count);
  for (auto& position : positions) {
    for (Real& x : position) {
      const int cell = order == Order::kSegments ? static_cast<int>(samples.index(2)) * (places - 1)
                                                 : static_cast<int>(samples.index(places));
      // A cell's end has the next base node already: stay below it after rounding.
      x = static_cast<Real>(nodes.lowest_base + cell + nodes.base_shift + samples.uniform(0, 0.9999));
    }
  }
  if (order == Order::kSegments) {
    std::sort(positions.begin(), positions.end(), [&](const auto& a, const auto& b) {
      const auto base = [&](const auto& x) {
        return std::array{reference::base_node(stencil, x[0]), reference::base_node(stencil, x[1]),
                          reference::base_node(stencil, x[2])};
      };
      return base(a) < base(b);
    });
  }
  return positions;
}

}  // namespace

template <class Real>
Lattice<Real> TransferCase::lattice() const {
  Lattice<Real> lattice{static_cast<Real>(spacing), {}, flat_axis};
  for (int axis = 0; axis < 3; ++axis) {
    lattice.axis_scale[axis] = axis == flat_axis ? Real(0) : static_cast<Real>(nodes().inverse_d / spacing);
  }
  return lattice;
}

std::vector<TransferCase> all_cases() {
  std::vector<TransferCase> cases;
  for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil) {
    for (std::size_t transfer = 0; transfer < kTransferFigures.size(); ++transfer) {
      cases.push_back({stencil, transfer});
      if (!kTransferFigures[transfer].keeps_velocity) continue;
      cases.push_back({stencil, transfer});
      cases.back().measures = true;
    }
  }
  return cases;
}

std::vector<TransferCase> all_stencils() {
  std::vector<TransferCase> cases;
  for (std::size_t stencil = 0; stencil < kStencilFigures.size(); ++stencil) cases.push_back({stencil});
  return cases;
}

int stencil_width(std::size_t stencil) {
  int width = 0;
  while (reference::weight(stencil, width - kStencilFigures[stencil].base_shift - 0.5) > 0) ++width;
  return width;
}

template <class Real>
Particles<Real>::Particles(std::size_t size) : count(size) {
  for (auto* channels : {position, velocity, own}) {
    for (int k = 0; k < 3; ++k) append_canary(channels[k], size);
  }
  for (auto& channel : affine) append_canary(channel, size);
  for (auto* channels : {strain, stress}) {
    for (int k = 0; k < kStrainComponents; ++k) append_canary(channels[k], size);
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
ScatterInput<Real> Particles<Real>::scatter_input(const TransferCase& transfer, Real* before) {
  ScatterInput<Real> in{};
  in.particles = span();
  for (int k = 0; k < kStrainComponents; ++k) in.stress[k] = stress[k].data();
  in.mass = static_cast<Real>(transfer.mass);
  in.impulse_volume = static_cast<Real>(transfer.impulse_volume);
  in.kept_stretching = static_cast<Real>(transfer.kept_stretching);
  in.lattice = transfer.lattice<Real>();
  for (int k = 0; k < 3; ++k) in.own_velocity[k] = own[k].data();
  in.before = before;
  return in;
}

template <class Real>
bool Particles<Real>::canaries_alive() const {
  return alive(position) && alive(velocity) && alive(affine) && alive(strain) && alive(stress) && alive(own);
}

template <class Real>
Particles<Real> random_particles(std::size_t count, Order order, std::uint64_t seed, std::size_t stencil) {
  Samples samples(seed);
  Particles<Real> particles(count);
  const auto positions = random_positions<Real>(count, order, samples, stencil);
  const auto fill = [&](std::vector<Real>& channel, double most) {
    for (std::size_t p = 0; p < count; ++p) channel[p] = static_cast<Real>(samples.uniform(-most, most));
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (std::size_t p = 0; p < count; ++p) particles.position[axis][p] = positions[p][axis];
    fill(particles.velocity[axis], 1.0);
    fill(particles.own[axis], 1.0);
  }
  for (auto& channel : particles.affine) fill(channel, 1 / TransferCase().spacing);
  for (auto& channel : particles.strain) fill(channel, 0.1);
  for (auto& channel : particles.stress) fill(channel, 5e4);
  return particles;
}

template <class Real>
Arena<Real> random_arena(std::uint64_t seed) {
  Samples samples(seed);
  Arena<Real> arena(kArenaValues, Real(0));
  for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) {
    arena[k] = k % kNodeValues == 0 ? Real(1) : static_cast<Real>(samples.uniform(-1, 1));
  }
  return arena;
}

template <class Real>
ScatteredReference<Real>::ScatteredReference(Particles<Real>& particles, const TransferCase& transfer) {
  reference::scatter(transfer.stencil, transfer.transfer, particles.scatter_input(transfer), arena.data(),
                     transfer.measures ? before.data() : nullptr);
}

template <class Real>
Touched touched_by(const Particles<Real>& particles, std::size_t stencil) {
  const int width = stencil_width(stencil), origin = kStencilFigures[stencil].lowest_base;
  Touched touched;
  std::array<int, 3> last{-9, -9, -9};
  for (std::size_t p = 0; p < particles.count; ++p) {
    std::array<int, 3> base;
    for (int axis = 0; axis < 3; ++axis) {
      base[axis] = reference::base_node(stencil, particles.position[axis][p]) - origin;
    }
    touched.segments += base != last;
    last = base;
    for (int k = 0; k < width * width; ++k) {
      touched.rows |= std::uint64_t{1} << ((base[0] + k / width) * kArenaSide + base[1] + k % width);
    }
  }
  return touched;
}

template <class Real>
Gathered<Real>::Gathered(std::size_t count) {
  for (auto* channels : {velocity, moving, own}) {
    for (int k = 0; k < 3; ++k) append_canary(channels[k], count);
  }
  for (auto* channels : {affine, gradient}) {
    for (int k = 0; k < kAffineComponents; ++k) append_canary(channels[k], count);
  }
}

template <class Real>
GatherInput<Real> Gathered<Real>::input(Particles<Real>& particles, const TransferCase& transfer) {
  GatherInput<Real> in{};
  in.particles = particles.span();
  in.lattice = transfer.lattice<Real>();
  in.kept_velocity = static_cast<Real>(transfer.kept_velocity);
  in.dt = static_cast<Real>(transfer.dt);
  if (transfer.measures) {
    before = random_arena<Real>(77);
    in.before = before.data();
  }
  for (int k = 0; k < 3; ++k) {
    in.velocity[k] = velocity[k].data();
    in.moving[k] = moving[k].data();
    if (!transfer.figures().keeps_velocity) continue;
    own[k] = particles.own[k];
    in.own[k] = own[k].data();
  }
  for (int k = 0; k < kAffineComponents; ++k) {
    if (transfer.keeps_affine()) in.affine[k] = affine[k].data();
    in.gradient[k] = gradient[k].data();
  }
  return in;
}

template <class Real>
bool Gathered<Real>::canaries_alive() const {
  return alive(velocity) && alive(affine) && alive(moving) && alive(gradient) && alive(own);
}

template <class Real>
void expect_near(const Arena<Real>& arena, const Arena<double>& expected, double tolerance,
                 const std::string& what) {
  double largest[2] = {};
  for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) {
    double& most = largest[k % kNodeValues != 0];
    most = std::max(most, std::fabs(expected[k]));
  }
  for (std::size_t k = 0; k < kArenaNodes * kNodeValues; ++k) {
    const std::size_t node = k / kNodeValues;
    ASSERT_NEAR(arena[k], expected[k], tolerance * largest[k % kNodeValues != 0])
        << what << ", node " << node / 64 << ' ' << node / 8 % 8 << ' ' << node % 8 << ", value "
        << k % kNodeValues;
  }
}

template <class Real>
void expect_near(const Gathered<Real>& result, const Gathered<Real>& expected, const TransferCase& transfer,
                 const std::string& what) {
  const double tolerance = kTransferTolerance<Real>;
  const double steepest = tolerance * transfer.nodes().inverse_d / transfer.spacing;
  expect_channels(result.velocity, expected.velocity, tolerance, what + ", velocity");
  expect_channels(result.moving, expected.moving, tolerance, what + ", moving");
  expect_channels(result.own, expected.own, tolerance, what + ", own");
  expect_channels(result.affine, expected.affine, steepest, what + ", affine");
  expect_channels(result.gradient, expected.gradient, steepest, what + ", gradient");
}

#define REPOSE_FOR(Real)                                                                           \
  template Lattice<Real> TransferCase::lattice<Real>() const;                                      \
  template struct Particles<Real>;                                                                 \
  template struct Gathered<Real>;                                                                  \
  template Particles<Real> random_particles<Real>(std::size_t, Order, std::uint64_t, std::size_t); \
  template Arena<Real> random_arena<Real>(std::uint64_t);                                          \
  template struct ScatteredReference<Real>;                                                        \
  template Touched touched_by(const Particles<Real>&, std::size_t);                                \
  template void expect_near(const Arena<Real>&, const Arena<double>&, double, const std::string&); \
  template void expect_near(const Gathered<Real>&, const Gathered<Real>&, const TransferCase&,     \
                            const std::string&);
REPOSE_FOR(float)
REPOSE_FOR(double)
#undef REPOSE_FOR

}  // namespace repose
