// Repose tests: the blocks of nodes that precondition an implicit step are those that products of its tangent
// have on the diagonal: each node moved by itself along each axis, over all stencils and transfers.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "tests/kernels/transfer_probe.h"

namespace repose {
namespace {

constexpr std::size_t kCount = 37;  // whole registers and a remainder, several groups

template <class Real>
class NodeStiffness : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(NodeStiffness, Precisions);

/// Tangents of particles at random: U and Q any matrices, A symmetric, or not.
template <class Real>
std::vector<Real> random_tangents(bool symmetric) {
  std::mt19937 engine(11);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  std::vector<Real> all((kCount + kTangentGroup) * kTangentValues);
  for (Real& number : all) number = static_cast<Real>(uniform(engine));
  for (std::size_t p = 0; p < kCount && symmetric; ++p) {
    const auto a = [&](std::size_t i, std::size_t j) -> Real& {
      return all[(p / kTangentGroup * kTangentValues + 18 + 3 * i + j) * kTangentGroup + p % kTangentGroup];
    };
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t j = 0; j < i; ++j) a(i, j) = a(j, i);
    }
  }
  return all;
}

/// What particles do to `node` when it alone moves along `axis`: the force, by components.
template <class Real>
std::array<Real, 3> force_on(const TransferCase& transfer, Target target, Particles<Real>& particles,
                             const std::vector<Real>& tangent, std::size_t node, std::size_t axis) {
  const auto& kernel = transfer.kernel<Real>(target);
  Arena<Real> unit(kArenaValues, Real(0)), answer(kArenaValues, Real(0));
  unit[node + 1 + axis] = Real(1);
  std::array<std::vector<Real>, 9> gradient, matrix;
  GatherInput<Real> gather{};
  PushInput<Real> push{};
  push.particles = gather.particles = particles.span();
  push.lattice = gather.lattice = transfer.lattice<Real>();
  push.scale = Real(-1);
  const Real* change[9];
  Real* moved[9];
  for (std::size_t k = 0; k < 9; ++k) {
    gradient[k].resize(kCount);
    matrix[k].resize(kCount);
    gather.gradient[k] = gradient[k].data();
    change[k] = gradient[k].data();
    moved[k] = matrix[k].data();
    push.matrix[k] = matrix[k].data();
  }
  kernel.gradient(gather, unit.data());
  kernels<Real>(target).apply_tangent(tangent.data(), change, moved, kCount);
  std::uint64_t rows = 0;
  kernel.push(push, answer.data(), rows);
  return {answer[node + 1], answer[node + 2], answer[node + 3]};
}

TYPED_TEST(NodeStiffness, Block_IsTheAnswerOfANodeToItself) {
  using Real = TypeParam;
  constexpr std::size_t kDiagonal[3] = {0, 1, 2}, kSide[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  for (TransferCase transfer : all_cases()) {
    for (const int flat : {-1, 2}) {
      transfer.flat_axis = flat;
      auto particles = random_particles<Real>(kCount, Order::kScattered, 401, transfer.stencil);
      for (const bool symmetric : {true, false}) {
        const auto tangent = random_tangents<Real>(symmetric);
        const Target target = best_target();
        Arena<Real> diagonal(kArenaValues, Real(0)), side(kArenaValues, Real(0));
        transfer.kernel<Real>(target).add_stiffness(
            {particles.span(), tangent.data(), Real(1), transfer.lattice<Real>()}, diagonal.data(),
            side.data());
        const double scale = 1.0 / (transfer.spacing * transfer.spacing);
        for (std::size_t place = 0; place < kArenaNodes; place += 7) {
          const std::size_t node = place * kNodeValues;
          std::array<std::array<Real, 3>, 3> column;
          for (std::size_t axis = 0; axis < 3; ++axis)
            column[axis] = force_on<Real>(transfer, target, particles, tangent, node, axis);
          const double tolerance = (sizeof(Real) == 4 ? 1e-4 : 1e-12) * scale;
          for (std::size_t c = 0; c < 3; ++c) {
            const auto [i, j] = kSide[c];
            const double mean = 0.5 * (double(column[j][i]) + double(column[i][j]));
            ASSERT_NEAR(double(diagonal[node + 1 + c]), double(column[kDiagonal[c]][kDiagonal[c]]), tolerance)
                << transfer.name();
            ASSERT_NEAR(double(side[node + 1 + c]), mean, tolerance) << transfer.name();
          }
          ASSERT_EQ(diagonal[node], Real(0));
          ASSERT_EQ(side[node], Real(0));
        }
      }
    }
  }
}

TYPED_TEST(NodeStiffness, InstructionSets_SameBits) {
  using Real = TypeParam;
  if (!target_supported(Target::kAvx512)) GTEST_SKIP() << "AVX-512 is not there to compare with";
  const auto tangent = random_tangents<Real>(false);
  for (const TransferCase& transfer : all_cases()) {
    auto particles = random_particles<Real>(kCount, Order::kScattered, 402, transfer.stencil);
    Arena<Real> first, second;
    for (const Target target : {Target::kAvx2, Target::kAvx512}) {
      Arena<Real> diagonal(kArenaValues, Real(0)), side(kArenaValues, Real(0));
      transfer.kernel<Real>(target).add_stiffness(
          {particles.span(), tangent.data(), Real(1), transfer.lattice<Real>()}, diagonal.data(), side.data());
      diagonal.insert(diagonal.end(), side.begin(), side.end());
      (target == Target::kAvx2 ? first : second) = diagonal;
    }
    ASSERT_EQ(first, second) << transfer.name();
  }
}

}  // namespace
}  // namespace repose
