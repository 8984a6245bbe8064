// Repose tests: the elastic energy of a state is the sum of what each particle's own material says.
#include "engine/simulation/diagnostics.h"

#include <gtest/gtest.h>

#include "engine/reading/reader.h"
#include "engine/state/block_sort.h"

namespace repose {
namespace {

constexpr double kVolume = 0.125;
constexpr double kStrain[6] = {-0.03, 0.01, 0.002, 0.02, -0.005, -0.001};

Scene three_materials() {
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "three", "grid": {"spacing": 0.25},
    "materials": {"a": {"type": "drucker_prager", "youngs_modulus": 1e5, "poisson_ratio": 0.2},
                  "b": {"type": "elastic", "youngs_modulus": 2e5, "poisson_ratio": 0.3},
                  "c": {"type": "neo_hookean", "youngs_modulus": 3e5, "poisson_ratio": 0.4}},
    "bodies": [{"name": "x", "material": "a", "shape": {"type": "sphere", "radius": 1}}]})json",
                                     "s.json", ".");
  EXPECT_TRUE(scene);
  return *scene;
}

/// One particle of each of the materials, at rest and strained alike.
double elastic_energy(const Scene& scene, const std::vector<int>& materials) {
  State<double> state;
  state.spacing = scene.grid.spacing;
  for (const int material : materials) {
    ParticleSet<double>& set = state.sets.emplace_back();
    set.material = material;
    set.particle_mass = 1.0;
    set.particle_volume = kVolume;
    set.allocate(1);
    set.for_each_real([](AlignedArray<double>& channel) { channel[0] = 0.5; });
    for (int k = 0; k < kStrainComponents; ++k) set.strain[k][0] = kStrain[k];
    set.id[0] = static_cast<std::uint32_t>(material);
  }
  place_in_blocks(state, std::vector<std::vector<Index3>>(materials.size(), {Index3{1, 1, 1}}), {});
  Threads threads(1);
  return diagnose(scene, {}, state, threads).elastic_energy;
}

double hencky(const Elasticity& e) {
  const double trace = kStrain[0] + kStrain[3] + kStrain[5];
  const double square = kStrain[0] * kStrain[0] + kStrain[3] * kStrain[3] + kStrain[5] * kStrain[5] +
                        2.0 * (kStrain[1] * kStrain[1] + kStrain[2] * kStrain[2] + kStrain[4] * kStrain[4]);
  return kVolume * (e.mu() * square + 0.5 * e.lambda() * trace * trace);
}

TEST(ElasticEnergy, SandAndHenckySolid_IsHenckysToTheLastBit) {
  const Scene scene = three_materials();
  for (const int material : {0, 1}) {
    EXPECT_EQ(elastic_energy(scene, {material}), hencky(scene.materials[material].elasticity()));
  }
}

TEST(ElasticEnergy, NeoHookeanSolid_IsItsOwn) {
  const Scene scene = three_materials();
  const double got = elastic_energy(scene, {2}), other = hencky(scene.materials[2].elasticity());
  EXPECT_EQ(got,
            kVolume * std::get<NeoHookeanParameters>(scene.materials[2].parameters).energy_density(kStrain));
  EXPECT_NEAR(got, other, 0.05 * other);
  EXPECT_GT(std::abs(got - other), 1e-3 * other) << "the second order in strain";
}

TEST(ElasticEnergy, SeveralMaterials_IsTheSum) {
  const Scene scene = three_materials();
  EXPECT_DOUBLE_EQ(elastic_energy(scene, {0, 1, 2}),
                   elastic_energy(scene, {0}) + elastic_energy(scene, {1}) + elastic_energy(scene, {2}));
}

}  // namespace
}  // namespace repose
