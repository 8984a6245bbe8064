// Repose tests: AVX2 and AVX-512 give the same bits, pass by pass, so that a scene gives the same pictures on
// every machine with either.
#include <cstring>

#include "kernels/effect/volume_correction.h"
#include "tests/kernels/material_rig.h"
#include "tests/kernels/node_blocks.h"
#include "tests/kernels/tangent_samples.h"
#include "tests/kernels/yield_rig.h"

namespace repose {
namespace {

template <class Real>
class InstructionSets : public testing::Test {
 protected:
  void SetUp() override {
    if (!target_supported(Target::kAvx2) || !target_supported(Target::kAvx512)) {
      GTEST_SKIP() << "this machine has not both AVX2 and AVX-512";
    }
  }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(InstructionSets, Precisions);

constexpr std::size_t kCounts[] = {1, 7, 16, 17, 127, 128};
constexpr Target kBoth[] = {Target::kAvx2, Target::kAvx512};

/// Equal bit by bit: 0 and -0 differ, a NaN equals itself.
template <class Real>
bool same_bits(const std::vector<Real>& a, const std::vector<Real>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Real)) == 0;
}

template <class Real>
bool same_bits(const std::vector<Symmetric<Real>>& a, const std::vector<Symmetric<Real>>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(a[0])) == 0;
}

template <class Real, std::size_t n>
void expect_same(const std::vector<Real> (&a)[n], const std::vector<Real> (&b)[n], const std::string& what) {
  for (std::size_t k = 0; k < n; ++k) EXPECT_TRUE(same_bits(a[k], b[k])) << what << ' ' << k;
}

/// There and back with one instruction set; what a step would write.
template <class Real>
struct ThereAndBack {
  Arena<Real> arena = Arena<Real>(kArenaValues, Real(0)), before = arena;
  Gathered<Real> gathered;

  ThereAndBack(Target target, const TransferCase& transfer, Particles<Real> particles)
      : gathered(particles.count) {
    std::uint64_t rows = 0;
    transfer.scatter<Real>(target)(particles.scatter_input(transfer, before.data()), arena.data(), rows);
    transfer.gather<Real>(target)(gathered.input(particles, transfer), arena.data());
  }
};

TYPED_TEST(InstructionSets, EveryStencilAndTransfer_ThereAndBack_SameBits) {
  for (TransferCase transfer : all_cases()) {
    for (const int flat_axis : {-1, 1}) {
      transfer.flat_axis = flat_axis;
      for (const Order order : {Order::kSegments, Order::kScattered}) {
        for (const std::size_t count : kCounts) {
          const auto particles = random_particles<TypeParam>(count, order, 1000 + count, transfer.stencil);
          const ThereAndBack<TypeParam> avx2(Target::kAvx2, transfer, particles);
          const ThereAndBack<TypeParam> avx512(Target::kAvx512, transfer, particles);
          const std::string what = transfer.name() + ' ' + std::to_string(count);
          EXPECT_TRUE(same_bits(avx2.arena, avx512.arena)) << what;
          expect_same(avx2.gathered.velocity, avx512.gathered.velocity, what + " velocity");
          expect_same(avx2.gathered.affine, avx512.gathered.affine, what + " affine");
          expect_same(avx2.gathered.moving, avx512.gathered.moving, what + " moving");
          expect_same(avx2.gathered.gradient, avx512.gathered.gradient, what + " gradient");
          expect_same(avx2.gathered.own, avx512.gathered.own, what + " own");
          EXPECT_TRUE(same_bits(avx2.before, avx512.before)) << what << " before forces";
        }
      }
    }
  }
}

TYPED_TEST(InstructionSets, EveryStencil_Arenas_SameBits) {
  const auto arena = random_arena<TypeParam>(1050);
  for (const TransferCase& transfer : all_stencils()) {
    NodeBlocks<TypeParam> blocks[2];
    Arena<TypeParam> loaded[2];
    for (int set = 0; set < 2; ++set) {
      const auto& kernel = transfer.stencil_kernel<TypeParam>(kBoth[set]);
      blocks[set].fill(TypeParam(0.3));
      loaded[set].assign(kArenaValues, TypeParam(0));
      kernel.add_arena(arena.data(), ~std::uint64_t{0}, blocks[set].pointers);
      kernel.load_arena(loaded[set].data(), ~std::uint64_t{0}, blocks[set].pointers);
    }
    loaded[0].resize(kArenaNodes * kNodeValues);  // what lies behind is never used
    loaded[1].resize(kArenaNodes * kNodeValues);
    EXPECT_TRUE(same_bits(loaded[0], loaded[1])) << transfer.nodes().name;
  }
}

TYPED_TEST(InstructionSets, EveryStencilAndTransfer_BlocksOfNodes_SameBits) {
  using Real = TypeParam;
  for (const TransferCase& transfer : all_cases()) {
    for (const std::size_t count : kCounts) {
      auto particles = random_particles<Real>(count, Order::kScattered, 1060 + count, transfer.stencil);
      const auto tangent = random_tangents<Real>(count, false);
      Arena<Real> arenas[2][2];
      for (int set = 0; set < 2; ++set) {
        for (Arena<Real>& arena : arenas[set]) arena.assign(kArenaValues, Real(0));
        const StiffnessInput<Real> in{particles.span(), tangent.data(), Real(1), transfer.lattice<Real>()};
        transfer.kernel<Real>(kBoth[set]).add_stiffness(in, arenas[set][0].data(), arenas[set][1].data());
      }
      const std::string what = transfer.name() + ' ' + std::to_string(count);
      EXPECT_TRUE(same_bits(arenas[0][0], arenas[1][0])) << what << " diagonal";
      EXPECT_TRUE(same_bits(arenas[0][1], arenas[1][1])) << what << " side";
    }
  }
}

template <class Material, class Real>
void expect_same_material() {
  using Rig = MaterialRig<Material, Real>;
  std::vector<Symmetric<Real>> strains = random_strains<Real>(4003, 1.0, 1100);
  for (const auto& strain : strains_of_all_sizes<Real>(4003, 1e-12, 1101)) strains.push_back(strain);
  std::vector<Gradient<Real>> gradients(strains.size());
  Samples samples(1102);
  for (auto& gradient : gradients) {
    const double size = samples.power_of_ten(-9, 0.5);
    for (Real& entry : gradient) entry = static_cast<Real>(size * samples.uniform(-1, 1));
  }
  const typename Rig::Constants constants(typename Material::Parameters{});
  const Rig avx2(constants, Target::kAvx2), avx512(constants, Target::kAvx512);
  const auto trial = avx2.trial(strains, gradients, Real(0.5));
  EXPECT_TRUE(same_bits(trial, avx512.trial(strains, gradients, Real(0.5)))) << "trial";
  EXPECT_TRUE(same_bits(avx2.return_map(trial), avx512.return_map(trial))) << "projection";
  EXPECT_TRUE(same_bits(avx2.stress(trial), avx512.stress(trial))) << "stress";
}

TYPED_TEST(InstructionSets, Materials_TrialProjectionStress_SameBits) {
  [&]<std::size_t... k>(std::index_sequence<k...>) {
    (expect_same_material<std::tuple_element_t<k, Materials>, TypeParam>(), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Materials>>());
}

TYPED_TEST(InstructionSets, VolumeCorrection_SameBits) {
  for (const std::size_t count : kCounts) {
    std::vector<Particles<TypeParam>> particles(2, random_particles<TypeParam>(count, Order::kScattered, 1200));
    std::vector<TypeParam> gained[2], trace[2];
    for (int set = 0; set < 2; ++set) {
      const auto& table = volume_correction_kernels<TypeParam>(kBoth[set]);
      gained[set].assign(particles[set].position[0].begin(), particles[set].position[0].end());
      trace[set].assign(count, TypeParam(0));
      auto span = particles[set].span();
      table.open_volume(span.strain, gained[set].data(), trace[set].data(), count);
      table.close_volume(span.strain, gained[set].data(), trace[set].data(), count);
    }
    EXPECT_TRUE(same_bits(gained[0], gained[1]) && same_bits(trace[0], trace[1])) << count;
    expect_same(particles[0].strain, particles[1].strain, "strain");
  }
}

TYPED_TEST(InstructionSets, ShapesOfYielding_SameBits) {
  using Real = TypeParam;
  const auto strains = strains_for_yielding<Real>(4003, 1250);
  const std::size_t count = strains.size();
  Samples samples(1251);
  std::vector<Real> q(count), cohesion(count), dilatancy(count);
  for (std::size_t p = 0; p < count; ++p) {
    q[p] = static_cast<Real>(samples.power_of_ten(-6, 2));
    cohesion[p] = static_cast<Real>(samples.power_of_ten(-8, -1));
    dilatancy[p] = static_cast<Real>(samples.uniform(0, 0.3));
  }
  const HenckyConstants<Real> elastic(golden_sand().elasticity);
  std::vector<Real> yield_slope[2], trace[2];
  std::vector<Symmetric<Real>> cut[2], projected[2];
  typename YieldRig<Real>::Surface surface[2];
  for (int set = 0; set < 2; ++set) {
    const YieldRig<Real> rig(kBoth[set]);
    yield_slope[set] = rig.harden(q, {Real(0.6), Real(0.16), Real(0.2), Real(0.17), {}, Real(3.25)});
    yield_slope[set] =
        rig.strengthen(strains, cohesion, {Real(0.7), Real(0.3), Real(1e-4)}, Real(1e-4), yield_slope[set]);
    surface[set] = {yield_slope[set], cohesion, dilatancy};
    projected[set] = rig.return_map(strains, surface[set]);
    trace[set] = q;
    cut[set] = rig.cut_tension(strains, elastic, Real(30), trace[set]);
  }
  EXPECT_TRUE(same_bits(yield_slope[0], yield_slope[1]) && same_bits(projected[0], projected[1]));
  EXPECT_TRUE(same_bits(surface[0].plastic, surface[1].plastic));
  EXPECT_TRUE(same_bits(surface[0].sheared, surface[1].sheared));
  EXPECT_TRUE(same_bits(surface[0].dilated, surface[1].dilated));
  EXPECT_TRUE(same_bits(cut[0], cut[1]) && same_bits(trace[0], trace[1]));
}

TYPED_TEST(InstructionSets, AdvanceAndInspect_SameBits) {
  for (const std::size_t count : kCounts) {
    std::vector<Particles<TypeParam>> particles(2, random_particles<TypeParam>(count, Order::kScattered, 1300));
    Motion<TypeParam> motion[2];
    std::size_t failed[2];
    for (int set = 0; set < 2; ++set) {
      const Kernels<TypeParam>& table = kernels<TypeParam>(kBoth[set]);
      auto span = particles[set].span();
      const TypeParam* velocity[3] = {span.velocity[0], span.velocity[1], span.velocity[2]};
      const TypeParam* gradient[9];
      std::copy_n(span.affine, 9, gradient);
      table.particle.advance(span, velocity, gradient, TypeParam(0.3), motion[set]);
      failed[set] = table.particle.first_failed(velocity, gradient, count, TypeParam(0.008), TypeParam(0.01));
    }
    EXPECT_EQ(std::memcmp(&motion[0], &motion[1], sizeof(motion[0])), 0) << count;
    EXPECT_EQ(failed[0], failed[1]) << count;
    expect_same(particles[0].position, particles[1].position, "position");
  }
}

TYPED_TEST(InstructionSets, NormalizeAccelerateBound_SameBits) {
  Samples samples(1400);
  std::vector<TypeParam> start(kBlockValues);
  for (std::size_t k = 0; k < start.size(); ++k) {
    start[k] = static_cast<TypeParam>(samples.uniform(k % kNodeValues == 0 ? 0 : -1, 1));
  }
  const TypeParam change[3] = {TypeParam(0.1), TypeParam(-0.2), TypeParam(0.3)};
  std::vector<TypeParam> block[2] = {start, start};
  std::uint64_t active[2];
  VelocityBounds<TypeParam> bounds[2];
  for (int set = 0; set < 2; ++set) {
    const Kernels<TypeParam>& table = kernels<TypeParam>(kBoth[set]);
    active[set] = table.node.normalize(block[set].data(), TypeParam(0.25));
    table.node.accelerate(block[set].data(), change);
    table.node.bound(block[set].data(), bounds[set]);
  }
  EXPECT_EQ(active[0], active[1]);
  EXPECT_TRUE(same_bits(block[0], block[1]));
  for (int k = 0; k < 3; ++k) {
    EXPECT_EQ(bounds[0].low[k], bounds[1].low[k]);
    EXPECT_EQ(bounds[0].high[k], bounds[1].high[k]);
  }
}

}  // namespace
}  // namespace repose
