// Repose tests: clouds made of states: who is in which row, and attributes against the formulas of their laws.
#include "engine/simulation/points.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

#include "engine/state/block_sort.h"

namespace repose {
namespace {

using enum OutputAttribute;

/// Sand and rubber, by hand.
Scene two_materials() {
  Scene scene;
  scene.grid.spacing = 0.5;
  scene.materials.push_back({"sand", DruckerPragerParameters{}});
  HenckyParameters rubber;
  rubber.elasticity = {.density = 900.0, .youngs_modulus = 2.0e6, .poisson_ratio = 0.25};
  scene.materials.push_back({"rubber", rubber});
  return scene;
}

/// A state whose particles lie and move as their ids say: x = id spacings, v = (id, 0, 1). Sets in the order of
/// `ids`, with the material of the same place.
template <class Real>
State<Real> state_of(const std::vector<std::vector<std::uint32_t>>& ids) {
  State<Real> state;
  state.spacing = 0.5;
  std::vector<std::vector<Index3>> cells;
  for (std::size_t k = 0; k < ids.size(); ++k) {
    ParticleSet<Real>& set = state.sets.emplace_back();
    set.material = static_cast<int>(k);
    set.particle_mass = 1.0 + static_cast<double>(k);
    set.particle_volume = 0.01;
    if (k == 1) set.extra.push_back({kVolumeGained.kName, {}});
    set.allocate(ids[k].size());
    auto& set_cells = cells.emplace_back();
    for (std::size_t p = 0; p < ids[k].size(); ++p) {
      const auto id = static_cast<std::int32_t>(ids[k][p]);
      set.for_each_real([&](AlignedArray<Real>& channel) { channel[p] = Real(0); });
      set.id[p] = ids[k][p];
      set.velocity[0][p] = static_cast<Real>(id);
      set.velocity[2][p] = Real(1);
      set_cells.push_back({id, 0, 0});
      for (auto& x : set.position) x[p] = Real(0.5);
      if (k == 1) set.extra[0].values[p] = static_cast<Real>(0.001 * id);
    }
  }
  place_in_blocks(state, std::move(cells), Ownership{});
  return state;
}

template <class Real>
PointCloud points_of(const State<Real>& state, const PointsWanted& wanted = {}) {
  return make_points(two_materials(), state, kernels<Real>(Target::kBaseline), wanted);
}

const PointAttribute& attribute(const PointCloud& points, const std::string& name) {
  for (const PointAttribute& each : points.attributes) {
    if (each.name == name) return each;
  }
  ADD_FAILURE() << "no attribute " << name;
  static const PointAttribute none;
  return none;
}

/// Every row has what belongs to its id.
void expect_rows(const PointCloud& points, const std::vector<std::uint32_t>& ids) {
  EXPECT_EQ(points.id, ids);
  for (std::size_t row = 0; row < points.size(); ++row) {
    EXPECT_DOUBLE_EQ(points.position[row][0], 0.5 * (points.id[row] + 0.5));
    EXPECT_FLOAT_EQ(points.velocity[row][0], static_cast<float>(points.id[row]));
    EXPECT_GT(points.radius[row], 0.0f);
  }
}

TEST(Points, IdsWithoutGaps_AreTheRows) {
  expect_rows(points_of(state_of<float>({{3, 0, 4}, {2, 1}})), {0, 1, 2, 3, 4});
}

TEST(Points, IdsWithGaps_AreSorted) {
  const PointCloud points = points_of(state_of<float>({{7, 4000, 21}, {8, 2}}), {{kChannels}, true});
  expect_rows(points, {2, 7, 8, 21, 4000});
  EXPECT_EQ(attribute(points, "material").values, (std::vector<float>{1, 0, 1, 0, 0}));
  EXPECT_EQ(points.mass, (std::vector<float>{2, 1, 2, 1, 1}));
  const std::vector<float>& gained = attribute(points, "volume_gained").values;
  EXPECT_FLOAT_EQ(gained[0], 0.002f);
  EXPECT_FLOAT_EQ(gained[1], 0.0f) << "the other set keeps none";
  EXPECT_FLOAT_EQ(gained[2], 0.008f);
}

TEST(Points, SetsWithoutParticles_ChangeNothing) {
  const PointsWanted all{{kStress, kPressure, kElasticStrain, kDensity, kSpeed, kChannels}, true};
  expect_rows(points_of(state_of<float>({{}, {1, 5}}), all), {1, 5});
  expect_rows(points_of(state_of<float>({{1, 0}, {}}), all), {0, 1});
  const PointCloud none = points_of(state_of<double>({{}, {}}), all);
  EXPECT_EQ(none.size(), 0u);
  ASSERT_EQ(none.attributes.size(), 7u);
  for (const PointAttribute& each : none.attributes) EXPECT_TRUE(each.values.empty()) << each.name;
}

TEST(Points, NothingWanted_NothingMore) {
  const PointCloud points = points_of(state_of<float>({{0}, {1}}));
  ASSERT_EQ(points.attributes.size(), 1u);
  EXPECT_EQ(points.attributes[0].name, "material");
  EXPECT_TRUE(points.mass.empty());
}

TEST(Points, Attributes_AreInTheOrderAsked) {
  const PointCloud points =
      points_of(state_of<float>({{0}, {1}}), {{kSpeed, kStress, kChannels, kPressure}, false});
  std::vector<std::string> names;
  for (const PointAttribute& each : points.attributes) names.push_back(each.name);
  EXPECT_EQ(names, (std::vector<std::string>{"material", "speed", "stress", "volume_gained", "pressure"}));
}

/// Strains of which no two entries are alike, so that none can stand in for another.
template <class Real>
void expect_attributes_follow_the_formulas(double tolerance) {
  State<Real> state = state_of<Real>({std::vector<std::uint32_t>(1, 0), {2, 1}});
  const std::array<double, 6> eps{-0.02, 0.003, -0.005, 0.01, 0.007, -0.03};  // xx xy xz yy yz zz
  for (auto& set : state.sets) {
    for (std::size_t p = 0; p < set.count; ++p) {
      for (std::size_t k = 0; k < 6; ++k) set.strain[k][p] = static_cast<Real>(eps[k] * (1.0 + set.id[p]));
    }
  }
  const PointCloud points = points_of(state, {{kStress, kPressure, kElasticStrain, kDensity, kSpeed}, false});
  for (std::size_t row = 0; row < 3; ++row) {
    const Scene scene = two_materials();
    const Elasticity& e = scene.materials[row == 0 ? 0 : 1].elasticity();
    const double scale = 1.0 + static_cast<double>(row), trace = (eps[0] + eps[3] + eps[5]) * scale;
    const double j = std::exp(trace);
    const std::array<double, 6> file{eps[0], eps[3], eps[5], eps[1], eps[4], eps[2]};
    double mean = 0.0;
    for (std::size_t k = 0; k < 6; ++k) {
      const double sigma = (2.0 * e.mu() * file[k] * scale + (k < 3 ? e.lambda() * trace : 0.0)) / j;
      EXPECT_NEAR(attribute(points, "stress").values[6 * row + k], sigma, tolerance * e.youngs_modulus);
      EXPECT_NEAR(attribute(points, "elastic_strain").values[6 * row + k], file[k] * scale, tolerance);
      if (k < 3) mean += sigma / 3.0;
    }
    EXPECT_NEAR(attribute(points, "pressure").values[row], -mean, tolerance * e.youngs_modulus);
    EXPECT_GT(-mean, 0.0) << "compression is positive pressure";
    const double gained = row == 0 ? 0.0 : 0.001 * static_cast<double>(row);
    EXPECT_NEAR(attribute(points, "density").values[row] / (e.density * std::exp(-trace - gained)), 1.0,
                tolerance);
    EXPECT_NEAR(attribute(points, "speed").values[row], std::hypot(double(row), 1.0), 1e-6);
  }
}

TEST(Points, Attributes_FollowTheFormulas) {
  expect_attributes_follow_the_formulas<double>(1e-7);
  expect_attributes_follow_the_formulas<float>(1e-6);
}

TEST(Points, Age_IsTheTimeSinceBirth) {
  State<double> state = state_of<double>({{0, 2}, {1}});
  state.counters.time = 2.5;
  EXPECT_TRUE(std::isnan(attribute(points_of(state, {{kAge}, false}), "age").values[0])) << "nobody remembers";
  for (auto& set : state.sets) {
    set.extra.push_back({kBirth.kName, {}});
    set.extra.back().values.resize(set.count);
    for (std::size_t p = 0; p < set.count; ++p) set.extra.back().values[p] = 0.5 * set.id[p];
  }
  EXPECT_EQ(attribute(points_of(state, {{kAge}, false}), "age").values, (std::vector<float>{2.5f, 2.0f, 1.5f}));
}

/// Gives every particle of every set a velocity gradient, by rows.
template <class Real>
void set_gradient(State<Real>& state, const std::array<double, 9>& gradient) {
  for (auto& set : state.sets) {
    for (std::size_t p = 0; p < set.count; ++p) {
      for (std::size_t k = 0; k < 9; ++k) set.affine[k][p] = static_cast<Real>(gradient[k]);
    }
  }
}

double shear_rate_of(const std::array<double, 9>& gradient) {
  State<double> state = state_of<double>({{0}, {1}});
  set_gradient(state, gradient);
  return attribute(points_of(state, {{kShearRate}, false}), "shear_rate").values[0];
}

TEST(Points, VelocityGradient_IsTheMatrixByRows) {
  State<float> state = state_of<float>({{2, 0}, {1}});
  const std::array<double, 9> gradient{1, 2, 3, 4, 5, 6, 7, 8, 9};
  set_gradient(state, gradient);
  state.sets[0].affine[1][0] = 20.0f;
  const PointCloud points = points_of(state, {{kVelocityGradient}, false});
  const PointAttribute& found = attribute(points, "velocity_gradient");
  ASSERT_EQ(found.components, 9);
  ASSERT_EQ(found.values.size(), 27u);
  for (std::size_t k = 0; k < 9; ++k) EXPECT_EQ(found.values[k], static_cast<float>(gradient[k]));
  EXPECT_EQ(found.values[2 * 9 + 1], 20.0f) << "xy of id 2";
}

TEST(Points, ShearRate_IsThatOfTheDeviatorAlone) {
  EXPECT_NEAR(shear_rate_of({0, 7, 0, 0, 0, 0, 0, 0, 0}), 7.0, 1e-6) << "simple shear: the slope of velocity";
  EXPECT_NEAR(shear_rate_of({0, 0, 0, 0, 0, 0, 0, -7, 0}), 7.0, 1e-6) << "whatever the plane and the sense";
  EXPECT_EQ(shear_rate_of({0, -3, 2, 3, 0, -1, -2, 1, 0}), 0.0) << "a rigid spin";
  EXPECT_NEAR(shear_rate_of({4, 0, 0, 0, 4, 0, 0, 0, 4}), 0.0, 1e-6) << "a change of size";
  EXPECT_NEAR(shear_rate_of({2, 0, 0, 0, -2, 0, 0, 0, 0}), 4.0, 1e-6)
      << "pure shear: the difference of stretchings";
  EXPECT_NEAR(shear_rate_of({-1, 0, 0, 0, 0.5, 0, 0, 0, 0.5}), std::sqrt(3.0), 1e-6)
      << "triaxial, axial rate 1";
}

TEST(Points, GradientThatTransfersDoNotKeep_IsNotANumber) {
  State<double> state = state_of<double>({{0}, {1}});
  for (auto& set : state.sets) set.keeps_affine = false;
  for (const PointAttribute& each :
       points_of(state, {{kVelocityGradient, kShearRate, kInertialNumber}, false}).attributes) {
    if (each.name == "material") continue;
    for (const float value : each.values) EXPECT_TRUE(std::isnan(value)) << each.name;
  }
}

TEST(Points, InertialNumber_IsOfRatePressureAndGrains) {
  Scene scene = two_materials();
  scene.materials[0].grain_diameter = 2e-3;
  scene.materials[0].grain_density = 2600.0;
  State<double> state = state_of<double>({{0, 1, 2}, {3}});
  set_gradient(state, {0, 5, 0, 0, 0, 0, 0, 0, 0});
  const double trace = -3e-3;  // of id 0; id 1 bears nothing, and id 2 shears not either
  for (const std::size_t k : {0, 3, 5}) state.sets[0].strain[k][0] = trace / 3.0;
  state.sets[0].affine[1][2] = 0.0;
  const PointsWanted wanted{{kInertialNumber}, false};
  const auto values_of = [&](const Scene& of) {
    return attribute(make_points(of, state, kernels<double>(Target::kBaseline), wanted), "inertial_number")
        .values;
  };
  const Elasticity& e = scene.materials[0].elasticity();
  const double pressure = -(e.lambda() + 2.0 / 3.0 * e.mu()) * trace / std::exp(trace);
  const std::vector<float> values = values_of(scene);
  EXPECT_NEAR(values[0], 5.0 * 2e-3 / std::sqrt(pressure / 2600.0), 1e-8);
  EXPECT_EQ(values[1], std::numeric_limits<float>::infinity()) << "it flies";
  EXPECT_EQ(values[2], 0.0f);
  EXPECT_TRUE(std::isnan(values[3])) << "rubber has no grains";
  scene.effect<RateFriction>().entries.push_back({"sand", {.grain_diameter = 4e-3, .grain_density = 2600.0}});
  EXPECT_NEAR(values_of(scene)[0], 2.0 * values[0], 1e-7) << "the grains of the law that asks for them";
}

TEST(Points, PlasticStrain_IsTheChannelOfItsEffect) {
  State<float> state = state_of<float>({{1, 0}, {2}});
  const auto values = [&] {
    return attribute(points_of(state, {{kPlasticStrain}, false}), "plastic_strain").values;
  };
  EXPECT_TRUE(std::isnan(values()[0])) << "nobody has added it up";
  EXPECT_EQ(values()[2], 0.0f) << "rubber does not yield";
  state.sets[0].extra.push_back({kEquivalentPlasticStrain.kName, {}});
  state.sets[0].extra.back().values.resize(2);
  state.sets[0].extra.back().values[0] = 0.25f;
  state.sets[0].extra.back().values[1] = 0.5f;
  EXPECT_EQ(values(), (std::vector<float>{0.5f, 0.25f, 0.0f}));
}

TEST(Points, StressOfManyParticles_IsThatOfEach) {
  // More than one chunk, and no multiple of one.
  std::vector<std::uint32_t> ids(2 * kChunk + 37);
  for (std::size_t p = 0; p < ids.size(); ++p) ids[p] = static_cast<std::uint32_t>(p);
  State<float> state = state_of<float>({{}, ids});
  ParticleSet<float>& set = state.sets[1];
  for (std::size_t p = 0; p < set.count; ++p) set.strain[1][p] = 1e-5f * static_cast<float>(set.id[p]);
  const PointCloud points = points_of(state, {{kStress}, false});
  const double mu = two_materials().materials[1].elasticity().mu();
  for (std::size_t row = 0; row < ids.size(); ++row) {
    EXPECT_NEAR(points.attributes[1].values[6 * row + 3], 2.0 * mu * 1e-5 * static_cast<double>(row),
                1e-5 * mu * 1e-2);
  }
}

}  // namespace
}  // namespace repose
