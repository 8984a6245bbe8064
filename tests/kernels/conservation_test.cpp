// Repose tests: particles to nodes and back the whole way that a step goes, through arena and blocks. Mass and
// momentum are kept by every transfer, angular momentum by those that carry a matrix; PIC is seen to lose it.
#include <gtest/gtest.h>

#include "tests/kernels/node_blocks.h"

namespace repose {
namespace {

template <class Real>
class Conservation : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(Conservation, Precisions);

template <class Real>
constexpr double kTolerance = sizeof(Real) == 4 ? 2e-6 : 1e-12;

struct Momenta {
  double mass = 0;
  double linear[3] = {};
  double angular[3] = {};
};

/// D of one axis of a particle, m^2.
double second_moment(const TransferCase& transfer, double x) {
  const int base = reference::base_node(transfer.stencil, x);
  double d = 0;
  for (int i = base; i < base + 4; ++i) d += reference::weight(transfer.stencil, i - x) * (i - x) * (i - x);
  return d * transfer.spacing * transfer.spacing;
}

/// What a particle tells the nodes of its matrix C, or all of it (`kept`).
enum class Part { kTold, kKept };

/// Of particles: L = sum x_p x m v_p + m axial(A D), axial(B)_k = eps_kab B_ba (Jiang et al. 2015).
template <class Real>
Momenta momenta(const Particles<Real>& particles, const TransferCase& transfer, Part part) {
  Momenta sum;
  const double m = transfer.mass;
  const Affine affine =
      part == Part::kKept && transfer.keeps_affine() ? Affine::kFull : transfer.figures().affine;
  const double stretching = affine == Affine::kSkew ? transfer.kept_stretching : 1.0;
  for (std::size_t p = 0; p < particles.count; ++p) {
    sum.mass += m;
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      const double xa = particles.position[a][p], xb = particles.position[b][p];
      sum.linear[k] += m * particles.velocity[k][p];
      sum.angular[k] += m * transfer.spacing * (xa * particles.velocity[b][p] - xb * particles.velocity[a][p]);
      if (affine == Affine::kNone) continue;
      const double ba = particles.affine[3 * b + a][p], ab = particles.affine[3 * a + b][p];
      const double spin = (ba - ab) / 2, stretch = stretching * (ba + ab) / 2;
      sum.angular[k] +=
          m * ((stretch + spin) * second_moment(transfer, xa) - (stretch - spin) * second_moment(transfer, xb));
    }
  }
  return sum;
}

/// Of nodes that hold momentum, or velocity once they are normalized.
template <class Real>
Momenta momenta(NodeBlocks<Real>& blocks, const TransferCase& transfer, bool velocities) {
  Momenta sum;
  for_each_node([&](int x, int y, int z) {
    const double place[3] = {x * transfer.spacing, y * transfer.spacing, z * transfer.spacing};
    const Real* values = blocks.at(x, y, z);
    const double factor = velocities ? values[0] : 1.0;
    sum.mass += values[0];
    for (int k = 0; k < 3; ++k) {
      const int a = (k + 1) % 3, b = (k + 2) % 3;
      sum.linear[k] += factor * values[1 + k];
      sum.angular[k] += factor * (place[a] * values[1 + b] - place[b] * values[1 + a]);
    }
  });
  return sum;
}

void expect_linear(const Momenta& value, const Momenta& expected, double tolerance, const std::string& what) {
  const double speed = 2.0;  // m/s: more than any particle has
  EXPECT_NEAR(value.mass, expected.mass, tolerance * expected.mass) << what;
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(value.linear[k], expected.linear[k], tolerance * speed * expected.mass) << what;
  }
}

void expect_angular(const Momenta& value, const Momenta& expected, double tolerance, const std::string& what) {
  const double speed = 2.0, reach = 0.05;  // m/s and m: more than any particle has
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(value.angular[k], expected.angular[k], tolerance * speed * reach * expected.mass) << what;
  }
}

/// Particles to blocks; returns the rows touched.
template <class Real>
std::uint64_t to_blocks(Target target, Particles<Real>& particles, const TransferCase& transfer,
                        NodeBlocks<Real>& blocks) {
  Arena<Real> arena(kArenaValues, Real(0));
  std::uint64_t rows = 0;
  Arena<Real> before(kArenaValues, Real(0));
  transfer.scatter<Real>(target)(particles.scatter_input(transfer, before.data()), arena.data(), rows);
  transfer.stencil_kernel<Real>(target).add_arena(arena.data(), rows, blocks.pointers);
  return rows;
}

/// Blocks to particles, as in a step without forces.
template <class Real>
void to_particles(Target target, NodeBlocks<Real>& blocks, std::uint64_t rows, const TransferCase& transfer,
                  Particles<Real>& particles) {
  Arena<Real> arena(kArenaValues);
  transfer.stencil_kernel<Real>(target).load_arena(arena.data(), rows, blocks.pointers);
  GatherInput<Real> in{};
  in.particles = particles.span();
  in.lattice = transfer.lattice<Real>();
  in.kept_velocity = static_cast<Real>(transfer.kept_velocity);
  std::copy_n(in.particles.velocity, 3, in.velocity);
  if (transfer.keeps_affine()) std::copy_n(in.particles.affine, kAffineComponents, in.affine);
  in.dt = static_cast<Real>(transfer.dt);
  std::vector<Real> own[3];
  for (int k = 0; k < 3; ++k) {
    own[k].assign(particles.count, Real(0));
    in.own[k] = own[k].data();
  }
  if (transfer.measures) in.before = arena.data();
  transfer.gather<Real>(target)(in, arena.data());
}

TYPED_TEST(Conservation, ScatterNormalizeGather_KeepsMassMomentumAndSpin) {
  constexpr double kBound = kTolerance<TypeParam>;
  for (TransferCase transfer : all_cases()) {
    transfer.impulse_volume = 0;
    for (const Target target : supported_targets()) {
      const std::string what = transfer.name() + ", " + target_name(target);
      auto particles = random_particles<TypeParam>(128, Order::kSegments, 300, transfer.stencil);
      const Momenta before = momenta(particles, transfer, Part::kTold);
      NodeBlocks<TypeParam> blocks;
      const std::uint64_t rows = to_blocks(target, particles, transfer, blocks);
      const Momenta momentum = momenta(blocks, transfer, false);
      expect_linear(momentum, before, kBound, what + ", on nodes");
      expect_angular(momentum, before, kBound, what + ", on nodes");
      for (TypeParam* block : blocks.pointers) kernels<TypeParam>(target).node.normalize(block, TypeParam(0));
      expect_angular(momenta(blocks, transfer, true), before, kBound, what + ", normalized");
      to_particles(target, blocks, rows, transfer, particles);
      const Momenta after = momenta(particles, transfer, Part::kKept);
      expect_linear(after, before, kBound, what);
      // A particle that keeps velocity of its own and a matrix as well has more than the nodes gave it.
      // Where D varies, turning the stretching of C changes its moments.
      const bool turns = transfer.figures().keeps_velocity && !transfer.nodes().constant_d;
      if (transfer.keeps_affine() && !transfer.measures && !turns) expect_angular(after, before, kBound, what);
    }
  }
}

/// Stresses push nodes apart and change neither sum.
TYPED_TEST(Conservation, ScatterWithStress_KeepsMomentumAndSpin) {
  for (const TransferCase& transfer : all_cases()) {
    for (const Target target : supported_targets()) {
      const std::string what = transfer.name() + ", " + target_name(target);
      auto particles = random_particles<TypeParam>(127, Order::kScattered, 310, transfer.stencil);
      NodeBlocks<TypeParam> blocks;
      to_blocks(target, particles, transfer, blocks);
      const Momenta before = momenta(particles, transfer, Part::kTold),
                    after = momenta(blocks, transfer, false);
      expect_linear(after, before, kTolerance<TypeParam>, what);
      expect_angular(after, before, kTolerance<TypeParam>, what);
    }
  }
}

/// Turns about the z axis through the middle of the block with 1 rad/s.
template <class Real>
Particles<Real> rigid_particles(const TransferCase& transfer) {
  auto particles = random_particles<Real>(128, Order::kScattered, 320, transfer.stencil);
  for (std::size_t p = 0; p < particles.count; ++p) {
    const double x = (particles.position[0][p] - 3.0) * transfer.spacing;
    const double y = (particles.position[1][p] - 3.0) * transfer.spacing;
    particles.velocity[0][p] = static_cast<Real>(-y);
    particles.velocity[1][p] = static_cast<Real>(x);
    particles.velocity[2][p] = 0;
    for (int k = 0; k < 9; ++k) particles.affine[k][p] = static_cast<Real>(k == 1 ? -1 : k == 3 ? 1 : 0);
  }
  return particles;
}

/// One step of a rigid turn: matrices bring it back exactly, also RPIC that tells the spin alone.
TYPED_TEST(Conservation, RigidTurn_IsReproducedByMatricesAndLostByPic) {
  for (TransferCase transfer : all_cases()) {
    transfer.impulse_volume = 0;
    transfer.kept_stretching = 0;
    transfer.dt = 0;  // what turns is another slope at the end of the step
    for (const Target target : supported_targets()) {
      const std::string what = transfer.name() + ", " + target_name(target);
      auto particles = rigid_particles<TypeParam>(transfer);
      const auto start = particles;
      NodeBlocks<TypeParam> blocks;
      const std::uint64_t rows = to_blocks(target, particles, transfer, blocks);
      for (TypeParam* block : blocks.pointers) kernels<TypeParam>(target).node.normalize(block, TypeParam(0));
      to_particles(target, blocks, rows, transfer, particles);
      double turned = 0, most = 0;
      for (std::size_t p = 0; p < particles.count; ++p) {
        for (int k = 0; k < 3; ++k) {
          turned = std::max(turned, std::fabs(double{particles.velocity[k][p]} - start.velocity[k][p]));
          most = std::max(most, std::fabs(double{start.velocity[k][p]}));
        }
        for (int k = 0; k < 9 && transfer.keeps_affine(); ++k) {
          ASSERT_NEAR(particles.affine[k][p], start.affine[k][p], 10 * kTolerance<TypeParam>) << what;
        }
      }
      if (transfer.keeps_affine()) {
        EXPECT_LT(turned, 2 * kTolerance<TypeParam> * most) << what;
      } else {
        EXPECT_GT(turned, 0.01 * most) << what << ": smoothing is not seen";
      }
    }
  }
}

}  // namespace
}  // namespace repose
