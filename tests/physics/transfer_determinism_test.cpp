// Repose tests: every stencil with every transfer gives the same bits with any number of threads, on any vector
// width and in any place of the lattice. A small column is enough: it slumps over several blocks of all
// colours.
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <ostream>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

constexpr int kSteps = 200;

/// About three thousand particles on a floor with friction.
constexpr const char* kColumn = R"json({"repose": 1, "name": "small_column", "grid": {"spacing": 0.02},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "column", "material": "sand", "velocity": [0.3, 0, 0.1],
              "shape": {"type": "box", "lower": [-0.06, 0, -0.06], "upper": [0.06, 0.2, 0.06]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

struct Choices {
  std::string stencil, transfer;
};

void PrintTo(const Choices& given, std::ostream* out) {
  *out << given.stencil << ' ' << given.transfer;
}

std::vector<Choices> every_choice() {
  std::vector<Choices> all;
  for (const StencilFigures& stencil : kStencilFigures) {
    for (const Choice& transfer : kTransferChoices) all.push_back({stencil.name, transfer.name});
  }
  return all;
}

class TransferDeterminism : public testing::TestWithParam<Choices> {
 protected:
  static Scene scene(std::vector<std::string> more = {}) {
    more.push_back("grid.stencil=" + GetParam().stencil);
    more.push_back("grid.transfer=" + GetParam().transfer);
    return scene_of(kColumn, more);
  }

  /// The hash after all steps; every figure must then be finite and nothing may lie below the floor.
  static std::uint64_t hash_after(const Scene& scene, int threads, Target target = best_target()) {
    const auto simulation = simulate(scene, threads, target);
    EXPECT_TRUE(run_steps(*simulation, kSteps));
    const Diagnostics figures = simulation->diagnose();
    EXPECT_TRUE(std::isfinite(figures.kinetic_energy + figures.affine_energy + figures.elastic_energy));
    EXPECT_LT(figures.deepest, scene.grid.spacing);
    // With the linear stencil single grains are shot off the surface: all of a force, hardly any mass.
    EXPECT_TRUE(figures.max_speed < 5.0 || GetParam().stencil == "linear") << figures.max_speed;
    return simulation->hash();
  }

  // Without this the library would never start more threads than the machine has cores.
  tbb::global_control control_{tbb::global_control::max_allowed_parallelism, 16};
};

TEST_P(TransferDeterminism, OneToSixteenThreads_SameBits) {
  const std::uint64_t one = hash_after(scene(), 1);
  for (const int threads : {2, 7, 16}) EXPECT_EQ(hash_after(scene(), threads), one) << threads << " threads";
}

TEST_P(TransferDeterminism, Avx2AndAvx512_SameBits) {
  if (!target_supported(Target::kAvx512)) GTEST_SKIP() << "needs AVX-512";
  EXPECT_EQ(hash_after(scene(), 2, Target::kAvx2), hash_after(scene(), 2, Target::kAvx512));
}

TEST_P(TransferDeterminism, MillionCellsAway_SameBits) {
  const std::uint64_t here = hash_after(scene(), 2);
  EXPECT_EQ(hash_after(scene({"grid.origin_cells=[1000000,1000000,1000000]"}), 2), here);
  EXPECT_EQ(hash_after(scene({"grid.origin_cells=[-1000000,-1000000,-1000000]"}), 2), here);
}

INSTANTIATE_TEST_SUITE_P(Choices, TransferDeterminism, testing::ValuesIn(every_choice()),
                         [](const auto& parameter) {
                           return parameter.param.stencil + "_" + parameter.param.transfer;
                         });

/// Else the hashes above would tell nothing. By gradients or by moments, a linear stencil has one way of
/// forces: its mls_apic is its apic.
TEST(TransferDeterminismControl, OtherStencilOrTransfer_OtherHash) {
  std::vector<std::uint64_t> hashes;
  for (const Choices& choices : every_choice()) {
    if (choices.stencil == "linear" && choices.transfer == "mls_apic") continue;
    const auto simulation = simulate(
        scene_of(kColumn, {"grid.stencil=" + choices.stencil, "grid.transfer=" + choices.transfer}), 2);
    ASSERT_TRUE(run_steps(*simulation, 50));
    for (const std::uint64_t other : hashes)
      EXPECT_NE(simulation->hash(), other) << testing::PrintToString(choices);
    hashes.push_back(simulation->hash());
  }
}

}  // namespace
}  // namespace repose
