// Repose tests: what hosts do between calls that advance. What a host leads or adds frame by frame is, to the
// bit, what a scene says with files and emitters; views are the memory of the engine.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

using Matrix = std::array<double, 16>;
constexpr Matrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};

Matrix moved(double x, double y) {
  Matrix matrix = kIdentity;
  matrix[12] = x;
  matrix[13] = y;
  return matrix;
}

/// Turned about z by an angle, then moved.
Matrix turned(double angle, double x) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x, 0, 0, 1};
}

/// A box that comes towards the sand.
struct Piston {
  std::vector<double> vertices;
  std::vector<std::int32_t> triangles{0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4,
                                      2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5};

  /// `k`: how far it has come, ever faster; it leans the more.
  explicit Piston(int k) {
    for (int corner = 0; corner < 8; ++corner) {
      const double x = corner & 1 ? 0.0 : -0.12, y = corner & 2 ? 0.3 : -0.1, z = corner & 4 ? 0.25 : -0.15;
      vertices.insert(vertices.end(), {x + 0.008 * k + 0.002 * k * k + 0.02 * k * y, y, z});
    }
  }
  std::string obj() const {
    std::string text;
    char line[128];
    for (std::size_t v = 0; v < vertices.size(); v += 3) {
      std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", vertices[v], vertices[v + 1], vertices[v + 2]);
      text += line;
    }
    for (std::size_t t = 0; t < triangles.size(); t += 3) {
      std::snprintf(line, sizeof line, "f %d %d %d\n", triangles[t] + 1, triangles[t + 1] + 1,
                    triangles[t + 2] + 1);
      text += line;
    }
    return text;
  }
};

std::string piston_scene(const std::string& piston) {
  std::string scene = box_scene();
  scene.insert(scene.rfind("]}"),
               R"(, {"name": "piston", "friction": 0.3, "shape": {"type": "mesh", )" + piston + "}");
  return scene;
}

Engine piston_engine(const TemporaryFolder& folder, bool led, double rate = 48.0) {
  const std::string sequence = R"("file": "p.####.obj"}, "frames": {"count": 6, "rate": 48})";
  Scene scene = Scene::from_text(piston_scene(led ? R"("file": "p.0001.obj"})" : sequence), folder.path());
  if (led) scene.lead_mesh("piston", rate);
  return Engine(scene);
}

TEST(ApiHost, VerticesFrameByFrame_AreTheSequenceOfFilesToTheBit) {
  const TemporaryFolder folder;
  for (int k = 0; k < 6; ++k) folder.write("p.000" + std::to_string(k + 1) + ".obj", Piston(k).obj());
  Engine files = piston_engine(folder, false), host = piston_engine(folder, true),
         rests = piston_engine(folder, true);
  for (int frame = 0; frame < 5; ++frame) {
    host.deform_collider("piston", Piston(frame + 1).vertices);
    files.advance_frame();
    host.advance_frame();
    rests.advance_frame();
    ASSERT_EQ(host.hash(), files.hash()) << frame;
    EXPECT_EQ(host.info().step, files.info().step);
  }
  EXPECT_NE(host.hash(), rests.hash()) << "the piston does nothing";
}

TEST(ApiHost, VerticesOfOtherTriangles_AndAfterALoadedState_AreTaken) {
  const TemporaryFolder folder;
  folder.write("p.0001.obj", Piston(0).obj());
  Engine host = piston_engine(folder, true);
  Piston other(1);
  other.vertices.insert(other.vertices.end(), {0.01 + 0.02 * 0.1, 0.1, 0.05});  // one more, on the front
  other.triangles.erase(other.triangles.end() - 6, other.triangles.end());
  for (const std::array<int, 2>& edge : {std::array{1, 3}, {3, 7}, {7, 5}, {5, 1}})
    other.triangles.insert(other.triangles.end(), {edge[0], edge[1], 8});
  EXPECT_THROW(host.deform_collider("piston", other.vertices), Error)
      << "it does not go with the triangles so far";
  host.deform_collider("piston", other.vertices, other.triangles);
  host.advance_frame();
  const std::vector<std::byte> state = host.save();
  host.deform_collider("piston", Piston(2).vertices, Piston(2).triangles);
  host.advance_frame();

  Engine again = piston_engine(folder, true);
  again.load(Span<const std::byte>(state.data(), state.size()));
  again.deform_collider("piston", other.vertices, other.triangles, true);
  again.deform_collider("piston", Piston(2).vertices, Piston(2).triangles);
  again.advance_frame();
  EXPECT_EQ(again.hash(), host.hash());
}

TEST(ApiHost, VerticesBetweenTwoStretches_AreRefusedAndSubstepsAreStretches) {
  const TemporaryFolder folder;
  folder.write("p.0001.obj", Piston(0).obj());
  Engine host = piston_engine(folder, true, 4 * 48.0);
  for (int part = 0; part < 8; ++part) {
    std::vector<double> vertices = Piston(0).vertices;
    for (std::size_t v = 0; v < vertices.size(); v += 3) vertices[v] += 0.002 * (part + 1);
    host.deform_collider("piston", vertices);
    host.advance_seconds(0.25 / 48.0);
  }
  EXPECT_EQ(host.info().frame, 2);
  host.advance_seconds(0.1 / 48.0);
  EXPECT_EQ(repose_deform_collider(host.get(), "piston", Piston(1).vertices.data(), 8, nullptr, 0, 0),
            REPOSE_ERROR_USAGE);
}

/// How far the particles of two engines are apart at most, m.
double apart(const Engine& a, const Engine& b) {
  const auto p = a.points().positions(), q = b.points().positions();
  double most = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k)
    most = std::max(most, std::hypot(p[k][0] - q[k][0], p[k][1] - q[k][1], p[k][2] - q[k][2]));
  return most;
}

std::string wall_scene(const std::string& motion) {
  std::string scene = box_scene();
  scene.insert(scene.rfind("]}"), R"(, {"name": "wall", "friction": 0.3,
    "shape": {"type": "box", "lower": [-0.15, -0.1, -0.3], "upper": [-0.03, 0.4, 0.3]})" +
                                      motion + "}");
  return scene;
}

TEST(ApiHost, PosesFrameByFrame_PushAsKeyframesDo) {
  Engine keys(Scene::from_text(
      wall_scene(R"(, "motion": {"keys": [{"time": 0}, {"time": 0.125, "translation": [0.1, 0, 0]}]})")));
  Scene led = Scene::from_text(wall_scene(""));
  led.lead_pose("wall");
  Engine host(led), rests(led);
  for (int frame = 0; frame < 6; ++frame) {
    host.move_collider("wall", moved(0.1 * (frame + 1) / 6.0, 0), 1.0 / 48.0);
    keys.advance_frame();
    host.advance_frame();
    rests.advance_frame();
  }
  EXPECT_LT(apart(host, keys), 1e-3 * 0.03125);
  EXPECT_GT(apart(host, rests), 0.03);
}

TEST(ApiHost, PosesOfEachSubstep_TurnAndRest) {
  Scene led = Scene::from_text(wall_scene(""));
  led.lead_pose("wall");
  Engine host(led);
  for (int part = 0; part < 12; ++part) {
    host.move_collider("wall", turned(-0.02 * (part + 1), 0.0), 0.25 / 48.0);
    host.advance_seconds(0.25 / 48.0);
  }
  EXPECT_EQ(host.info().frame, 3);
  EXPECT_THROW(host.move_collider("floor", kIdentity, 0.0), Error);
  EXPECT_THROW(host.move_collider("nothing", kIdentity, 0.0), Error);
  Matrix stretched = kIdentity;
  stretched[0] = 1.1;
  EXPECT_THROW(host.move_collider("wall", stretched, 0.0), Error);
  Matrix mirrored = kIdentity;
  mirrored[0] = -1.0;
  EXPECT_THROW(host.move_collider("wall", mirrored, 0.0), Error);
  EXPECT_THROW(host.move_collider("wall", kIdentity, -1.0), Error);
}

TEST(ApiHost, ColliderMovedAfterAChangeOfGravity_IsStillLed) {
  Scene led = Scene::from_text(wall_scene(""));
  led.lead_pose("wall");
  Engine host(led), plain(led);
  for (Engine* engine : {&host, &plain}) {
    engine->move_collider("wall", moved(0.02, 0), 1.0 / 48.0);
    engine->advance_frame();
  }
  host.change("gravity.acceleration", "[0, -9.8100000001, 0]");
  for (Engine* engine : {&host, &plain}) {
    engine->move_collider("wall", moved(0.05, 0), 1.0 / 48.0);
    engine->advance_frame();
  }
  EXPECT_LT(apart(host, plain), 1e-3 * 0.03125);
}

TEST(ApiHost, Contact_IsTheForceOfTheProbe) {
  const std::string probe = R"(, "probes": [{"name": "weight", "type": "force", "collider": "floor"}])";
  repose_engine_options options = repose_engine_options_init();
  options.log_contacts = 1;
  Engine probed = box_engine(1, probe), engine(Scene::from_text(box_scene()), options);
  for (int frame = 0; frame < 10; ++frame) {
    probed.advance_frame();
    engine.advance_frame();
  }
  const repose_contact_info contact = engine.contact("floor");
  const std::vector<Measurement> force = probed.measurements();
  for (std::size_t axis = 0; axis < 3; ++axis) EXPECT_DOUBLE_EQ(contact.force[axis], force[axis].value);
  EXPECT_NEAR(contact.seconds, 1.0 / 48.0, 1e-12);
  EXPECT_LT(contact.force[1], -1.0);
  EXPECT_EQ(engine.hash(), probed.hash()) << "measuring changes no bit";
  repose_contact_info none = repose_contact_info_init();
  EXPECT_EQ(repose_contact(probed.get(), "floor", &none), REPOSE_ERROR_USAGE);
}

std::string inlet_scene(const std::string& emitter) {
  return box_scene(R"(, "emitters": [{"name": "spout", "material": "sand", "particles_per_cell": 8, )" +
                   emitter + "}]");
}

TEST(ApiHost, ParticlesAddedAtTheEndsOfFrames_AreThoseOfTheEmitterToTheBit) {
  // So slow that all it makes comes at the ends of frames.
  Engine emitter(Scene::from_text(inlet_scene(
      R"("type": "disc", "center": [0.06, 0.4, 0.06], "normal": [0, -1, 0], "speed": 0.2, "radius": 0.05)")));
  Engine host(Scene::from_text(inlet_scene(R"("type": "host")")));
  std::uint32_t next = 512;
  for (int frame = 0; frame < 6; ++frame) {
    emitter.advance_frame();
    host.advance_frame();
    const Points points = emitter.points();
    const auto positions = points.positions();
    const std::vector<float> velocities = points.read("v");
    std::vector<double> places;
    std::vector<float> speeds;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (points.ids()[p] < next) continue;
      places.insert(places.end(), positions[p].begin(), positions[p].end());
      speeds.insert(speeds.end(), velocities.begin() + 3 * p, velocities.begin() + 3 * p + 3);
    }
    ASSERT_FALSE(places.empty());
    EXPECT_EQ(host.add_particles("spout", places, speeds), next);
    next += static_cast<std::uint32_t>(places.size() / 3);
    ASSERT_EQ(host.hash(), emitter.hash()) << frame;
  }
  EXPECT_EQ(host.info().step, emitter.info().step);
}

TEST(ApiHost, ParticlesRemoved_AreGoneAndAStateRemembers) {
  const Scene scene = Scene::from_text(inlet_scene(R"("type": "host")"));
  Engine host(scene);
  const std::uint32_t first =
      host.add_particles("spout", std::vector<double>{0.06, 0.3, 0.06, 0.08, 0.31, 0.06});
  EXPECT_EQ(first, 512u);
  EXPECT_EQ(host.remove_particles(std::vector<std::uint32_t>{3, first, 99999, 7}), 3u);
  EXPECT_EQ(host.info().particles, 511u);
  host.advance_frame();
  const std::vector<std::uint32_t> ids = host.points().ids();
  EXPECT_EQ(ids.back(), first + 1);
  EXPECT_EQ(std::count(ids.begin(), ids.end(), 3u), 0);
  Engine again(scene);
  const std::vector<std::byte> state = host.save();
  again.load(Span<const std::byte>(state.data(), state.size()));
  EXPECT_EQ(again.info().particles, 511u);
  host.advance_frame();
  again.advance_frame();
  EXPECT_EQ(again.hash(), host.hash());
  EXPECT_THROW(host.add_particles("box", std::vector<double>{0, 1, 0}), Error);
  EXPECT_THROW(host.add_particles("spout", std::vector<double>{0, NAN, 0}), Error);
  EXPECT_THROW(box_engine().remove_particles(std::vector<std::uint32_t>{1}), Error);
}

TEST(ApiHost, Views_AreTheMemoryOfTheEngineUntilItGoesOn) {
  Engine engine = box_engine();
  engine.advance_frame();
  const repose_set set = engine.set(0);
  EXPECT_EQ(set.count, 512u);
  EXPECT_EQ(std::string(set.name), "box");
  EXPECT_EQ(set.begin[set.blocks], 512u);
  const auto ids = engine.view<std::uint32_t>(0, "id");
  const auto corners = engine.block_corners();
  const Points points = engine.points();
  const auto positions = points.positions();
  const std::vector<float> velocities = points.read("v");
  std::array<Span<const float>, 3> position, velocity;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    position[axis] = engine.view<float>(0, std::string("position.") + "xyz"[axis]);
    velocity[axis] = engine.view<float>(0, std::string("velocity.") + "xyz"[axis]);
  }
  EXPECT_EQ(position[0].data(), engine.view<float>(0, "position.x").data()) << "no copy";
  for (std::size_t block = 0; block < set.blocks; ++block) {
    for (std::size_t p = set.begin[block]; p < set.begin[block + 1]; ++p) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        EXPECT_DOUBLE_EQ(corners[block][axis] + 0.03125 * position[axis][p], positions[ids[p]][axis]);
        EXPECT_EQ(velocity[axis][p], velocities[3 * ids[p] + axis]);
      }
    }
  }
  EXPECT_TRUE(engine.is_current(set.generation));
  EXPECT_EQ(engine.info().generation, set.generation);
  engine.advance_step();
  EXPECT_FALSE(engine.is_current(set.generation));
  EXPECT_THROW(engine.view<double>(0, "position.x"), Error);
  EXPECT_THROW(engine.view<float>(0, "position"), Error);
}

TEST(ApiHost, PointsWithZUp_AreTurned) {
  Engine engine = box_engine();
  repose_points_options options = repose_points_options_init();
  options.up = REPOSE_UP_Z;
  options.attributes = "pressure, stress";
  options.mass = 1;
  const Points y_up = engine.points(), z_up = engine.points(options);
  const auto a = y_up.positions(), b = z_up.positions();
  for (std::size_t p = 0; p < a.size(); p += 37) {
    EXPECT_EQ(b[p][0], a[p][0]);
    EXPECT_EQ(b[p][1], -a[p][2]);
    EXPECT_EQ(b[p][2], a[p][1]);
  }
  EXPECT_EQ(z_up.components("stress"), 6);
  EXPECT_EQ(z_up.read("pressure").size(), z_up.size());
  EXPECT_GT(z_up.read("mass")[0], 0.0f);
  EXPECT_THROW(z_up.read("speed"), Error);
}

TEST(ApiHost, AttributesOfShear_AreCopiedWhereTheSceneHasTheirKeys) {
  const auto copy = [](const Engine& engine, const char* attributes) {
    repose_points_options options = repose_points_options_init();
    options.attributes = attributes;
    return engine.points(options);
  };
  Engine engine = box_engine();
  engine.advance_frame();
  for (const auto& [attribute, key] :
       {std::pair("inertial_number", "grain_diameter"), std::pair("plastic_strain", "plastic_strain"),
        std::pair("age", "age")}) {
    try {
      copy(engine, attribute);
      ADD_FAILURE() << attribute;
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), REPOSE_ERROR_USAGE);
      EXPECT_NE(std::string(error.what()).find(key), std::string::npos) << error.what();
    }
  }
  const Points gradients = copy(engine, "velocity_gradient,shear_rate");
  EXPECT_EQ(gradients.components("velocity_gradient"), 9);
  std::vector<float> rows(9 * gradients.size()), rates(gradients.size());
  gradients.read("velocity_gradient", rows);
  gradients.read("shear_rate", rates);
  for (std::size_t p = 0; p < rates.size(); ++p) {
    double square = 0.0, trace = 0.0;
    for (int k = 0; k < 9; ++k) {
      const double rate = 0.5 * (rows[9 * p + k] + rows[9 * p + 3 * (k % 3) + k / 3]);
      square += 2.0 * rate * rate;
      trace += k % 4 == 0 ? rate : 0.0;
    }
    ASSERT_NEAR(rates[p], std::sqrt(std::max(0.0, square - 2.0 / 3.0 * trace * trace)),
                1e-4 * (1.0 + rates[p]));
  }
  EXPECT_EQ(copy(box_engine(1, ", \"plastic_strain\": {}"), "plastic_strain").components("plastic_strain"), 1);
}

}  // namespace
}  // namespace repose
