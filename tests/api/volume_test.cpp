// Repose tests: copies that a host takes out of an engine as it wants them: half precision, turned frames, and
// the material as boxes of numbers.
#include <algorithm>
#include <bit>
#include <cmath>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

float value_of(std::uint16_t half) {
  const int exponent = half >> 10 & 31, mantissa = half & 1023;
  const float size = exponent == 0    ? std::ldexp(static_cast<float>(mantissa), -24)
                     : exponent == 31 ? (mantissa == 0 ? INFINITY : NAN)
                                      : std::ldexp(static_cast<float>(1024 + mantissa), exponent - 25);
  return half & 0x8000 ? -size : size;
}

/// A channel of one number with given values, in half precision.
std::vector<std::uint16_t> halves_of(const std::vector<float>& values) {
  Engine engine = box_engine(1, R"(, "channels": [{"name": "number"}])");
  std::vector<std::uint32_t> ids;
  for (std::uint32_t id = 0; id < values.size(); ++id) ids.push_back(id);
  EXPECT_EQ(engine.set_values("number", ids, values), values.size());
  repose_points_options options = repose_points_options_init();
  options.attributes = "number";
  std::vector<std::uint16_t> halves = engine.points(options).read_half("number");
  halves.resize(values.size());
  return halves;
}

TEST(ApiVolume, HalfPrecision_IsTheNearestNumberTiesToEven) {
  const std::vector<std::pair<float, std::uint16_t>> known{
      {0.0f, 0x0000},       {-0.0f, 0x8000},        {1.0f, 0x3c00},           {-2.0f, 0xc000},
      {65504.0f, 0x7bff},   {65519.9f, 0x7bff},     {65520.0f, 0x7c00},       {-1e30f, 0xfc00},
      {INFINITY, 0x7c00},   {0.1f, 0x2e66},         {1.00048828125f, 0x3c00}, {1.00146484375f, 0x3c02},
      {0x1p-14f, 0x0400},   {0x1p-24f, 0x0001},     {0x1p-25f, 0x0000},       {0x1.8p-25f, 0x0001},
      {0x1.8p-24f, 0x0002}, {0x1.ffcp-15f, 0x0400}, {1e-20f, 0x0000}};
  std::vector<float> values;
  for (const auto& each : known) values.push_back(each.first);
  const std::vector<std::uint16_t> halves = halves_of(values);
  for (std::size_t k = 0; k < known.size(); ++k) EXPECT_EQ(halves[k], known[k].second) << known[k].first;
  EXPECT_TRUE(std::isnan(value_of(halves_of({NAN})[0])));

  values.clear();
  for (int k = 0; k < 500; ++k)
    values.push_back(std::sin(static_cast<float>(k)) * std::ldexp(1.0f, k % 40 - 26));
  const std::vector<std::uint16_t> many = halves_of(values);
  for (std::size_t k = 0; k < values.size(); ++k) {
    const float got = value_of(many[k]), next = value_of(static_cast<std::uint16_t>(many[k] + 1)),
                before = (many[k] & 0x7fff) == 0 ? got : value_of(static_cast<std::uint16_t>(many[k] - 1));
    EXPECT_LE(std::abs(got - values[k]), std::abs(next - values[k])) << values[k];
    EXPECT_LE(std::abs(got - values[k]), std::abs(before - values[k])) << values[k];
  }
}

TEST(ApiVolume, TensorsInAnotherFrame_AreTurnedLikeVectors) {
  Engine engine = box_engine(1, R"(, "gravity": {"acceleration": [3, -9.81, -5]})");
  for (int frame = 0; frame < 6; ++frame) engine.advance_frame();
  repose_points_options options = repose_points_options_init();
  options.attributes = "stress,elastic_strain,pressure,velocity_gradient";
  const Points y_up = engine.points(options);
  options.up = REPOSE_UP_Z;
  const Points z_up = engine.points(options);
  const std::vector<float> v = y_up.read("v"), turned_v = z_up.read("v");
  for (const char* name : {"stress", "elastic_strain"}) {
    const std::vector<float> plain = y_up.read(name), turned = z_up.read(name);
    double most = 0.0;
    for (std::size_t p = 0; p < y_up.size(); ++p) {
      // v . T v is the same in any frame.
      const auto form = [p](const std::vector<float>& t, const std::vector<float>& u) {
        const float *const s = &t[6 * p], *const w = &u[3 * p];
        return double(s[0]) * w[0] * w[0] + double(s[1]) * w[1] * w[1] + double(s[2]) * w[2] * w[2] +
               2.0 * (double(s[3]) * w[0] * w[1] + double(s[4]) * w[1] * w[2] + double(s[5]) * w[0] * w[2]);
      };
      const double expected = form(plain, v);
      EXPECT_NEAR(form(turned, turned_v), expected, 1e-12 * (1.0 + std::abs(expected)));
      EXPECT_EQ(turned[6 * p + 2], plain[6 * p + 1]);
      most = std::max(most, std::abs(double(plain[6 * p + 3])));
    }
    EXPECT_GT(most, 0.0) << "no shear, so nothing is tested";
  }
  EXPECT_EQ(y_up.read("pressure"), z_up.read("pressure"));
  const std::vector<float> plain = y_up.read("velocity_gradient"), turned = z_up.read("velocity_gradient");
  ASSERT_EQ(plain.size(), 9 * y_up.size());
  // x y z is x z -y there: where each number of L comes from, and its sign.
  constexpr int kFrom[9] = {0, 2, 1, 6, 8, 7, 3, 5, 4}, kSign[9] = {1, -1, 1, -1, 1, -1, 1, -1, 1};
  for (std::size_t p = 0; p < y_up.size(); ++p) {
    for (std::size_t k = 0; k < 9; ++k)
      ASSERT_EQ(turned[9 * p + k], static_cast<float>(kSign[k]) * plain[9 * p + std::size_t(kFrom[k])]) << k;
  }
}

std::size_t place(const repose_lattice& lattice, std::size_t i, std::size_t j, std::size_t k) {
  return (i * lattice.count[1] + j) * lattice.count[2] + k;
}

/// The box of the rig: [0, 0.125] x [0.03125, 0.15625] x [0, 0.125].
TEST(ApiVolume, SurfaceAsABox_LiesWhereTheMaterialDoes) {
  const Engine engine = box_engine();
  const Volume surface = engine.surface();
  const repose_lattice& lattice = surface.lattice();
  const std::vector<float> distance = surface.read("surface");
  ASSERT_EQ(distance.size(), lattice.count[0] * lattice.count[1] * lattice.count[2]);
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(lattice.voxel[axis], 0.03125 / 2, 1e-12);
  double volume = 0.0;
  for (std::size_t i = 0; i < lattice.count[0]; ++i) {
    for (std::size_t j = 0; j < lattice.count[1]; ++j) {
      for (std::size_t k = 0; k < lattice.count[2]; ++k) {
        const double h = lattice.voxel[0];
        const std::size_t index[3] = {i, j, k};
        double outside = -1e9;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const double x = lattice.lower[axis] + h * static_cast<double>(index[axis]);
          const double lower = axis == 1 ? 0.03125 : 0.0;
          outside = std::max(outside, std::abs(x - lower - 0.0625) - 0.0625);
        }
        const float d = distance[place(lattice, i, j, k)];
        EXPECT_LE(std::abs(d), 3.0 * h * 1.0001);
        EXPECT_TRUE(outside <= h || d > 0.0f);
        EXPECT_TRUE(outside >= -h || d < 0.0f);
        if (d < 0.0f) volume += h * h * h;
      }
    }
  }
  EXPECT_NEAR(volume, std::pow(0.125, 3), 0.3 * std::pow(0.125, 3));

  repose_surface_options fine = repose_surface_options_init();
  fine.voxel = 0.03125 / 4;
  EXPECT_GT(engine.surface(fine).size(), 3 * surface.size());  // the band is narrower, too
  fine.voxel = 0.1;
  EXPECT_THROW(engine.surface(fine), Error);
}

TEST(ApiVolume, FogAsABox_HasTheMassAndTheMomentum) {
  Engine engine = box_engine();
  for (int frame = 0; frame < 2; ++frame) engine.advance_frame();
  const Volume fog = engine.fog(0.02);
  const repose_lattice& lattice = fog.lattice();
  const std::vector<float> density = fog.read("density"), v = fog.read("v");
  double mass = 0.0, momentum = 0.0, moment = 0.0;
  const double cell = lattice.voxel[0] * lattice.voxel[1] * lattice.voxel[2];
  for (std::size_t i = 0; i < lattice.count[0]; ++i) {
    for (std::size_t j = 0; j < lattice.count[1]; ++j) {
      for (std::size_t k = 0; k < lattice.count[2]; ++k) {
        const std::size_t at = place(lattice, i, j, k);
        mass += cell * density[at];
        momentum += cell * density[at] * v[3 * at + 1];
        moment += cell * density[at] * (lattice.lower[1] + lattice.voxel[1] * static_cast<double>(j));
      }
    }
  }
  const repose_set set = engine.set(0);
  const Points points = engine.points();
  double expected = 0.0, expected_moment = 0.0;
  const std::vector<float> velocities = points.read("v");
  const auto positions = points.positions();
  for (std::size_t p = 0; p < points.size(); ++p) {
    expected += set.particle_mass * velocities[3 * p + 1];
    expected_moment += set.particle_mass * positions[p][1];
  }
  EXPECT_NEAR(mass, 512 * set.particle_mass, 1e-4 * mass);
  EXPECT_NEAR(momentum, expected, 1e-3 * std::abs(expected));
  EXPECT_NEAR(moment, expected_moment, 1e-3 * moment);
  EXPECT_EQ(repose_volume_read(fog.get(), "surface", nullptr, 0), REPOSE_ERROR_ARGUMENT);
  float one = 0;
  EXPECT_EQ(repose_volume_read(fog.get(), "surface", &one, 1), REPOSE_ERROR_USAGE);
}

TEST(ApiVolume, OfNoMaterial_IsEmpty) {
  Engine engine = box_engine(
      1, R"(, "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}])");
  std::vector<std::uint32_t> all = engine.points().ids();
  engine.remove_particles(all);
  EXPECT_EQ(engine.surface().size(), 0u);
  EXPECT_EQ(engine.fog().size(), 0u);
  EXPECT_TRUE(engine.fog().read("v").empty());
}

TEST(ApiVolume, BoxBeyondTheBudget_IsRefusedWithItsBytes) {
  repose_engine_options options = repose_engine_options_init();
  options.threads = 1;
  options.memory_limit = 64e6;
  Engine engine(
      Scene::from_text(box_scene(
          R"(, "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}])")),
      options);
  engine.fog();
  engine.add_particles("hand", std::vector<double>{30, 30, 30});  // far away: the box is all between
  try {
    engine.fog();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), REPOSE_ERROR_MEMORY);
    EXPECT_NE(std::string(error.what()).find("GB"), std::string::npos) << error.what();
  }
  EXPECT_EQ(engine.advance_step().steps, 1);
}

}  // namespace
}  // namespace repose
