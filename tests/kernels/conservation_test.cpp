// Repose tests: particles to nodes and back the whole way that a step goes, through arena and blocks: mass,
// momentum and the angular momentum of APIC are kept.
#include <gtest/gtest.h>

#include "tests/kernels/node_blocks.h"
#include "tests/kernels/transfer_reference.h"

namespace repose {
namespace {

template <class Real>
class Conservation : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Conservation, Precisions);

struct Momenta {
  double mass = 0;
  double linear[3] = {};
  double angular[3] = {};
};

/// Of particles: L = sum x_p x m v_p + m axial(B), axial(B)_k = eps_kab B_ba, B = C D (Jiang et al. 2015).
template <class Real>
Momenta momenta(const Particles<Real>& particles, const TransferCase& transfer) {
  Momenta sum;
  const double m = transfer.mass, d = transfer.spacing * transfer.spacing / QuadraticStencil::kInverseD;
  for (std::size_t p = 0; p < particles.count; ++p) {
    sum.mass += m;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const double xa = particles.position[a][p] * transfer.spacing,
                   xb = particles.position[b][p] * transfer.spacing;
      sum.linear[k] += m * particles.velocity[k][p];
      sum.angular[k] += m * (xa * particles.velocity[b][p] - xb * particles.velocity[a][p]);
      sum.angular[k] += m * d * (double{particles.affine[3 * b + a][p]} - particles.affine[3 * a + b][p]);
    }
  }
  return sum;
}

/// Of nodes that hold momentum, or velocity once they are normalized.
template <class Real>
Momenta momenta(NodeBlocks<Real>& blocks, const TransferCase& transfer, bool velocities) {
  Momenta sum;
  for (int node = 0; node < 512; ++node) {
    const int x[3] = {node / 64 - 1, node / 8 % 8 - 1, node % 8 - 1};
    const Real* values = blocks.at(x[0], x[1], x[2]);
    const double factor = velocities ? values[0] : 1.0;
    sum.mass += values[0];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      sum.linear[k] += factor * values[1 + k];
      sum.angular[k] +=
          factor * transfer.spacing * (x[a] * double{values[1 + b]} - x[b] * double{values[1 + a]});
    }
  }
  return sum;
}

void expect_equal(const Momenta& value, const Momenta& expected, double tolerance, const char* what) {
  const double speed = 2.0, reach = 0.05;  // m/s and m: more than any particle has
  EXPECT_NEAR(value.mass, expected.mass, tolerance * expected.mass) << what;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(value.linear[k], expected.linear[k], tolerance * speed * expected.mass) << what;
    EXPECT_NEAR(value.angular[k], expected.angular[k], tolerance * speed * reach * expected.mass) << what;
  }
}

/// Particles to blocks; returns the rows touched.
template <class Real>
std::uint64_t to_blocks(const Kernels<Real>& table, Particles<Real>& particles, const TransferCase& transfer,
                        NodeBlocks<Real>& blocks) {
  std::vector<Real> arena(kArenaValues, Real(0));
  std::uint64_t rows = 0;
  const auto in = particles.scatter_input(transfer);
  table.transfer[0][0].scatter(in, arena.data(), rows);
  table.add_arena(arena.data(), rows, blocks.pointers);
  return rows;
}

TYPED_TEST(Conservation, ScatterNormalizeGather_KeepsMassMomentumAndSpin) {
  const double tolerance = sizeof(TypeParam) == 4 ? 1e-6 : 1e-12;
  TransferCase transfer;
  transfer.impulse_volume = 0;
  for (const Target target : supported_targets()) {
    const Kernels<TypeParam>& table = kernels<TypeParam>(target);
    auto particles = random_particles<TypeParam>(256, Order::kRuns, 300);
    const Momenta before = momenta(particles, transfer);
    NodeBlocks<TypeParam> blocks;
    const std::uint64_t rows = to_blocks(table, particles, transfer, blocks);
    expect_equal(momenta(blocks, transfer, false), before, tolerance, target_name(target));
    for (TypeParam* block : blocks.pointers) table.normalize(block, TypeParam(0));
    expect_equal(momenta(blocks, transfer, true), before, tolerance, target_name(target));
    std::vector<TypeParam> arena(kArenaValues);
    table.load_arena(arena.data(), rows, blocks.pointers);
    GatherInput<TypeParam> in{particles.span(), transfer.lattice<TypeParam>(), {}, {}};
    for (int k = 0; k < 3; ++k) in.velocity[k] = particles.velocity[k].data();
    for (int k = 0; k < 9; ++k) in.affine[k] = particles.affine[k].data();
    table.transfer[0][0].gather(in, arena.data());
    expect_equal(momenta(particles, transfer), before, tolerance, target_name(target));
  }
}

/// Stresses push nodes apart and change neither sum.
TYPED_TEST(Conservation, ScatterWithStress_KeepsMomentumAndSpin) {
  const double tolerance = sizeof(TypeParam) == 4 ? 1e-6 : 1e-12;
  const TransferCase transfer;
  for (const Target target : supported_targets()) {
    auto particles = random_particles<TypeParam>(255, Order::kScattered, 310);
    NodeBlocks<TypeParam> blocks;
    to_blocks(kernels<TypeParam>(target), particles, transfer, blocks);
    expect_equal(momenta(blocks, transfer, false), momenta(particles, transfer), tolerance,
                 target_name(target));
  }
}

}  // namespace
}  // namespace repose
