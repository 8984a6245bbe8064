// Repose tests: numbers that a host keeps with particles: they go with them through ordering, removal, states
// and files, change no bit of what moves, and are copied out by name.
#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

constexpr const char* kEmitter =
    R"(, "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}])";
constexpr const char* kChannels = R"(, "channels": [{"name": "Cd", "components": 3, "initial": 0.25},
    {"name": "uv", "components": 2}, {"name": "grain"}])";

Engine kept_engine(int threads = 1) {
  return box_engine(threads, std::string(kEmitter) + kChannels);
}

/// What a particle of an id has, so that it is known again anywhere.
std::vector<float> colours_of(const std::vector<std::uint32_t>& ids) {
  std::vector<float> colours;
  for (const std::uint32_t id : ids) {
    for (int k = 0; k < 3; ++k) colours.push_back(static_cast<float>(id) + 0.25f * static_cast<float>(k));
  }
  return colours;
}

/// 64 particles that fall beside the box and stir, with all channels but one.
void pour(Engine& engine) {
  std::vector<double> positions;
  std::vector<float> velocities, grains, uv;
  std::vector<std::uint32_t> ids;
  for (std::uint32_t k = 0; k < 64; ++k) {
    positions.insert(positions.end(), {0.01 + 0.012 * (k % 8), 0.17 + 0.012 * (k / 8), 0.0625});
    velocities.insert(velocities.end(), {0.5f - 0.125f * static_cast<float>(k % 8), -1.0f, 0.25f});
    ids.push_back(512 + k);
    grains.push_back(1000.0f + static_cast<float>(k));
  }
  EXPECT_EQ(engine.add_particles("hand", positions, velocities, {{"grain", grains}, {"Cd", colours_of(ids)}}),
            512u);
}

void expect_known(const Engine& engine) {
  repose_points_options options = repose_points_options_init();
  options.attributes = "Cd,grain, uv";
  const Points points = engine.points(options);
  const std::vector<std::uint32_t> ids = points.ids();
  const std::vector<float> colours = points.read("Cd"), grains = points.read("grain"), all = colours_of(ids);
  EXPECT_EQ(points.components("Cd"), 3);
  EXPECT_EQ(points.components("uv"), 2);
  EXPECT_EQ(points.read("uv"), std::vector<float>(2 * ids.size(), 0.0f));
  for (std::size_t p = 0; p < ids.size(); ++p) {
    const bool poured = ids[p] >= 512;
    EXPECT_EQ(grains[p], poured ? 1000.0f + static_cast<float>(ids[p] - 512) : 0.0f);
    for (std::size_t k = 0; k < 3; ++k) EXPECT_EQ(colours[3 * p + k], poured ? all[3 * p + k] : 0.25f);
  }
}

TEST(ApiChannels, NumbersOfParticles_FollowThemThroughOrderingAndRemoval) {
  Engine engine = kept_engine(2);
  pour(engine);
  expect_known(engine);
  for (int frame = 0; frame < 8; ++frame) engine.advance_frame();
  EXPECT_EQ(engine.remove_particles(std::vector<std::uint32_t>{0, 17, 513, 520, 511}), 5u);
  engine.advance_frame();
  expect_known(engine);
  // Ordered they are not as they came.
  const auto ids = engine.view<std::uint32_t>(1, "id");
  EXPECT_FALSE(std::is_sorted(ids.begin(), ids.end()));
  const auto red = engine.view<float>(1, "Cd.x");
  for (std::size_t p = 0; p < ids.size(); ++p) EXPECT_EQ(red[p], static_cast<float>(ids[p]));
}

TEST(ApiChannels, SavedAndLoaded_GoOnWithTheSameBits) {
  Engine engine = kept_engine(), again = kept_engine(2);
  pour(engine);
  engine.advance_frame();
  const std::vector<std::byte> state = engine.save();
  again.load(Span<const std::byte>(state.data(), state.size()));
  EXPECT_EQ(again.hash(), engine.hash());
  engine.advance_frame();
  again.advance_frame();
  EXPECT_EQ(again.hash(), engine.hash());
  expect_known(again);
  Engine without = box_engine(1, kEmitter);
  EXPECT_EQ(repose_state_read(without.get(), state.data(), state.size()), REPOSE_ERROR_SCENE);
}

TEST(ApiChannels, ChangeNothingThatMoves_AndCostNothingWhereThereAreNone) {
  Engine with = kept_engine(), without = box_engine(1, kEmitter), plain = box_engine();
  EXPECT_EQ(without.set(0).channels, plain.set(0).channels);
  EXPECT_EQ(with.set(0).channels, plain.set(0).channels + 6);
  for (int frame = 0; frame < 3; ++frame) {
    with.advance_frame();
    without.advance_frame();
    plain.advance_frame();
  }
  EXPECT_EQ(with.points().positions(), without.points().positions());
  EXPECT_EQ(with.points().positions(), plain.points().positions());
  EXPECT_EQ(with.points().read("v"), without.points().read("v"));
}

TEST(ApiChannels, SetById_AreThoseOfTheParticlesAndAnotherHash) {
  Engine engine = kept_engine();
  engine.advance_frame();
  const std::uint64_t before = engine.hash();
  const std::vector<std::uint32_t> ids{300, 2, 9999, 411};
  EXPECT_EQ(engine.set_values("Cd", ids, colours_of(ids)), 3u);
  EXPECT_NE(engine.hash(), before);
  repose_points_options options = repose_points_options_init();
  options.attributes = "channels";
  const std::vector<float> colours = engine.points(options).read("Cd");
  for (const std::uint32_t id : {300u, 2u, 411u})
    EXPECT_EQ(colours[3 * id + 1], static_cast<float>(id) + 0.25f);
  EXPECT_EQ(colours[3 * 3], 0.25f);
  const std::uint64_t after = engine.hash();
  EXPECT_THROW(engine.set_values("Cd", std::vector<std::uint32_t>{1, 1}, std::vector<float>(6)), Error);
  EXPECT_THROW(engine.set_values("Cd", ids, std::vector<float>(4)), Error);
  EXPECT_THROW(engine.set_values("Ce", ids, std::vector<float>(4)), Error);
  EXPECT_EQ(repose_set_values(engine.get(), "velocity", ids.data(), colours.data(), 4, nullptr),
            REPOSE_ERROR_USAGE);
  EXPECT_EQ(engine.hash(), after);
}

TEST(ApiChannels, UnknownOrTooFewAtAnEmitter_AreRefusedAndNothingBegins) {
  Engine engine = kept_engine();
  const std::vector<double> place{0.0625, 0.3, 0.0625};
  EXPECT_THROW(engine.add_particles("hand", place, {}, {{"Ce", std::vector<float>(3)}}), Error);
  EXPECT_THROW(engine.add_particles("hand", place, {}, {{"Cd", std::vector<float>(2)}}), Error);
  const char* const name = "nothing";
  const float numbers[3] = {};
  const float* const values = numbers;
  EXPECT_EQ(
      repose_add_particles_with(engine.get(), "hand", place.data(), nullptr, 1, &name, &values, 1, nullptr),
      REPOSE_ERROR_USAGE);
  EXPECT_EQ(engine.info().particles, 512u);
}

TEST(ApiChannels, NamesThatAreTakenOrNone_AreRefusedWithTheirKey) {
  for (const char* channel :
       {R"({"name": "v"})", R"({"name": "stress"})", R"({"name": "velocity"})", R"({"name": "a.b"})",
        R"({"name": ""})", R"({"name": "own", "components": 5})", R"({"name": "Cd", "components": 0})",
        R"({"name": "Cd"}, {"name": "Cd", "components": 2})",
        R"({"name": "Cd", "components": 3}, {"name": "Cd_y"})"}) {
    const std::string scene = box_scene(std::string(R"(, "channels": [)") + channel + "]");
    try {
      Scene::from_text(scene);
      ADD_FAILURE() << channel;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), REPOSE_ERROR_SCENE);
      EXPECT_NE(error.key().find("channels"), std::string::npos) << error.what();
    }
  }
  EXPECT_THROW(Scene::from_text(box_scene(R"(, "age": {}, "channels": [{"name": "birth"}])")), Error);
}

TEST(ApiChannels, Files_HaveThemAsAttributes) {
  const TemporaryFolder folder;
  Engine engine = kept_engine();
  pour(engine);
  engine.advance_frame();
  repose_points_options options = repose_points_options_init();
  options.attributes = "Cd,uv,grain";
  const Points points = engine.points(options);
  for (const char* name : {"p.vdb", "p.ply", "p.vtp"}) points.write(folder.path(name));
  std::ostringstream ply, vtp;
  ply << std::ifstream(folder.path("p.ply")).rdbuf();
  vtp << std::ifstream(folder.path("p.vtp")).rdbuf();
  const std::string header = ply.str().substr(0, ply.str().find("end_header"));
  for (const char* name : {" Cd_x\n", " Cd_z\n", " uv_x\n", " uv_y\n", " grain\n"})
    EXPECT_NE(header.find(name), std::string::npos) << name << header;
  EXPECT_NE(vtp.str().find(R"(Name="uv" NumberOfComponents="2")"), std::string::npos);
  EXPECT_GT(std::filesystem::file_size(folder.path("p.vdb")), 1000u);
  EXPECT_EQ(repose_points_write(points.get(), folder.path("p.obj").c_str()), REPOSE_ERROR_USAGE);
  EXPECT_EQ(repose_points_write(points.get(), "/no/such/folder/p.ply"), REPOSE_ERROR_CANNOT_WRITE);
}

}  // namespace
}  // namespace repose
