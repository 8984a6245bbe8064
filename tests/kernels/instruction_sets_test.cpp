// Repose tests: AVX2 and AVX-512 give the same bits, pass by pass, so that a scene gives the same pictures on
// every machine with either.
#include <cstring>

#include "tests/kernels/material_probe.h"
#include "tests/kernels/node_blocks.h"
#include "tests/kernels/transfer_reference.h"

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

constexpr std::size_t kCounts[] = {1, 7, 16, 17, 255, 256};
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

TYPED_TEST(InstructionSets, Transfer_ThereAndBack_SameBits) {
  for (const int flat_axis : {-1, 1}) {
    TransferCase transfer;
    transfer.flat_axis = flat_axis;
    for (const Order order : {Order::kRuns, Order::kScattered}) {
      for (const std::size_t count : kCounts) {
        std::vector<TypeParam> arena[2];
        std::vector<Particles<TypeParam>> particles(2, random_particles<TypeParam>(count, order, 1000 + count));
        for (int set = 0; set < 2; ++set) {
          const Kernels<TypeParam>& table = kernels<TypeParam>(kBoth[set]);
          arena[set].assign(kArenaValues, TypeParam(0));
          std::uint64_t rows = 0;
          const auto in = particles[set].scatter_input(transfer);
          table.transfer[0][0].scatter(in, arena[set].data(), rows);
          GatherInput<TypeParam> back{particles[set].span(), transfer.lattice<TypeParam>(), {}, {}};
          for (int k = 0; k < 3; ++k) back.velocity[k] = particles[set].velocity[k].data();
          for (int k = 0; k < 9; ++k) back.affine[k] = particles[set].affine[k].data();
          table.transfer[0][0].gather(back, arena[set].data());
        }
        EXPECT_TRUE(same_bits(arena[0], arena[1])) << count;
        expect_same(particles[0].velocity, particles[1].velocity, "velocity");
        expect_same(particles[0].affine, particles[1].affine, "affine");
      }
    }
  }
}

template <class Material, class Real>
void expect_same_material() {
  using Probe = MaterialProbe<Material, Real>;
  std::vector<Symmetric<Real>> strains = random_strains<Real>(4003, 1.0, 1100);
  for (const auto& strain : strains_of_all_sizes<Real>(4003, 1e-12, 1101)) strains.push_back(strain);
  std::vector<Gradient<Real>> gradients(strains.size());
  Samples samples(1102);
  for (auto& gradient : gradients) {
    const double size = samples.power_of_ten(-9, 0.5);
    for (Real& entry : gradient) entry = static_cast<Real>(size * samples.uniform(-1, 1));
  }
  const typename Probe::Constants constants(typename Material::Parameters{});
  const Probe avx2(constants, Target::kAvx2), avx512(constants, Target::kAvx512);
  const auto trial = avx2.trial(strains, gradients, Real(0.5));
  EXPECT_TRUE(same_bits(trial, avx512.trial(strains, gradients, Real(0.5)))) << "trial";
  EXPECT_TRUE(same_bits(avx2.project(trial), avx512.project(trial))) << "projection";
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
      const Kernels<TypeParam>& table = kernels<TypeParam>(kBoth[set]);
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

TYPED_TEST(InstructionSets, AdvanceAndInspect_SameBits) {
  for (const std::size_t count : kCounts) {
    std::vector<Particles<TypeParam>> particles(2, random_particles<TypeParam>(count, Order::kScattered, 1300));
    Motion<TypeParam> motion[2];
    std::size_t inspected[2];
    for (int set = 0; set < 2; ++set) {
      const Kernels<TypeParam>& table = kernels<TypeParam>(kBoth[set]);
      auto span = particles[set].span();
      const TypeParam* velocity[3] = {span.velocity[0], span.velocity[1], span.velocity[2]};
      const TypeParam* affine[9];
      std::copy_n(span.affine, 9, affine);
      table.advance(span, velocity, TypeParam(0.3), motion[set]);
      inspected[set] = table.inspect(velocity, affine, count, TypeParam(0.008), TypeParam(0.01));
    }
    EXPECT_EQ(std::memcmp(&motion[0], &motion[1], sizeof(motion[0])), 0) << count;
    EXPECT_EQ(inspected[0], inspected[1]) << count;
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
    active[set] = table.normalize(block[set].data(), TypeParam(0.25));
    table.accelerate(block[set].data(), change);
    table.bound(block[set].data(), bounds[set]);
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
