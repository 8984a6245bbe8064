// Repose tests: the blocks of nodes that precondition an implicit step are those that products of its tangent
// have on the diagonal: each node moved by itself along each axis, over all stencils and transfers.
#include <gtest/gtest.h>

#include "tests/kernels/samples.h"
#include "tests/kernels/tangent_samples.h"
#include "tests/kernels/transfer_rig.h"

namespace repose {
namespace {

constexpr std::size_t kCount = 37;  // whole registers and a remainder, several groups

template <class Real>
class NodeStiffness : public testing::Test {};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(NodeStiffness, Precisions);

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
  kernels<Real>(target).tangent.apply(tangent.data(), change, moved, kCount);
  std::uint64_t rows = 0;
  kernel.push(push, answer.data(), rows);
  return {answer[node + 1], answer[node + 2], answer[node + 3]};
}

TYPED_TEST(NodeStiffness, Block_IsTheAnswerOfANodeToItself) {
  using Real = TypeParam;
  constexpr std::size_t kDiagonal[3] = {0, 1, 2}, kSide[3][2] = {{0, 1}, {0, 2}, {1, 2}};
  std::vector<std::pair<Target, bool>> all_ways;
  for (const Target target : supported_targets()) {
    all_ways.insert(all_ways.end(), {{target, true}, {target, false}});
  }
  for (TransferCase transfer : all_cases()) {
    for (const int flat : {-1, 2}) {
      transfer.flat_axis = flat;
      auto particles = random_particles<Real>(kCount, Order::kScattered, 401, transfer.stencil);
      for (const auto& [target, symmetric] : all_ways) {
        const auto tangent = random_tangents<Real>(kCount, symmetric);
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

}  // namespace
}  // namespace repose
