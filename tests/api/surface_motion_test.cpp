// Repose tests: what a host may decide in place of the engine: the velocity of a collider's surface, the arena
// that the engine works in, and how much memory it may take.
#include <tbb/task_arena.h>
#include <tbb/task_scheduler_observer.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

using Matrix = std::array<double, 16>;
constexpr double kFrame = 1.0 / 48.0;

/// The box of the rig on something that a host leads, with its top at 0.03125 m.
Engine engine_on(const std::string& shape) {
  std::string scene = box_scene();
  const std::string floor = R"("shape": {"type": "plane"})";
  scene.replace(scene.find(floor), floor.size(), R"("shape": )" + shape);
  Scene led = Scene::from_text(scene);
  led.lead_pose("floor");
  repose_engine_options options = repose_engine_options_init();
  options.threads = 1;
  options.log_contacts = 1;
  return Engine(led, options);
}

const std::string kBelt = R"({"type": "box", "lower": [-3, -0.5, -3], "upper": [3, 0.03125, 3]})";
const std::string kBall = R"({"type": "sphere", "center": [0.0625, -0.46875, 0.0625], "radius": 0.5})";

double apart(const Engine& a, const Engine& b) {
  const auto p = a.points().positions(), q = b.points().positions();
  double most = 0.0;
  for (std::size_t k = 0; k < p.size(); ++k)
    most = std::max(most, std::hypot(p[k][0] - q[k][0], p[k][1] - q[k][1], p[k][2] - q[k][2]));
  return most;
}

double mean_velocity(const Engine& engine, int axis) {
  const std::vector<float> v = engine.points().read("v");
  double sum = 0.0;
  for (std::size_t k = static_cast<std::size_t>(axis); k < v.size(); k += 3) sum += v[k];
  return 3.0 * sum / static_cast<double>(v.size());
}

TEST(ApiSurfaceMotion, BeltThatRunsInItsPlace_CarriesAsOneThatMoves) {
  Engine driven = engine_on(kBelt), moved = engine_on(kBelt), rests = engine_on(kBelt);
  driven.drive_collider("floor", {0.5, 0, 0.25});
  Matrix pose{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
  for (int frame = 0; frame < 8; ++frame) {
    pose[12] = 0.5 * kFrame * (frame + 1);
    pose[14] = 0.25 * kFrame * (frame + 1);
    moved.move_collider("floor", pose, kFrame);
    for (Engine* engine : {&driven, &moved, &rests}) engine->advance_frame();
  }
  EXPECT_LT(apart(driven, moved), 1e-3 * 0.03125);
  EXPECT_GT(apart(driven, rests), 0.02);
  EXPECT_GT(mean_velocity(driven, 0), 0.3);
  EXPECT_GT(driven.contact("floor").power, 0.0) << "the belt does work";
  driven.release_collider("floor");
  const double before = mean_velocity(driven, 0);
  for (int frame = 0; frame < 4; ++frame) driven.advance_frame();
  EXPECT_LT(mean_velocity(driven, 0), before - 0.1) << "a belt that stands brakes";
}

TEST(ApiSurfaceMotion, BallThatSpinsInItsPlace_CarriesAsOneThatTurns) {
  Engine driven = engine_on(kBall), turned = engine_on(kBall), rests = engine_on(kBall);
  const double spin = -1.5;
  driven.drive_collider("floor", {0, 0, 0}, {0, 0, spin}, {0.0625, -0.46875, 0});
  for (int frame = 0; frame < 6; ++frame) {
    const double angle = spin * kFrame * (frame + 1), c = std::cos(angle), s = std::sin(angle);
    const double x = 0.0625, y = -0.46875;
    const Matrix pose{c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, x - c * x + s * y, y - s * x - c * y, 0, 1};
    turned.move_collider("floor", pose, kFrame);
    for (Engine* engine : {&driven, &turned, &rests}) engine->advance_frame();
  }
  // The one follows chords of the turn, the other tangents.
  EXPECT_LT(apart(driven, turned), 0.02 * 0.03125);
  EXPECT_GT(apart(driven, rests), 0.01);
  EXPECT_GT(mean_velocity(driven, 0), 0.2);
}

TEST(ApiSurfaceMotion, OutlastsAChangeAndBoundsSteps) {
  Engine driven = engine_on(kBelt), changed = engine_on(kBelt);
  const double longest = driven.advance_step().most_dt;
  changed.advance_step();
  for (Engine* engine : {&driven, &changed}) engine->drive_collider("floor", {60, 0, 0});
  changed.change("gravity.acceleration", "[0, -9.81, 0]");
  EXPECT_LT(driven.advance_step().most_dt, 0.5 * longest);
  changed.advance_step();
  EXPECT_EQ(driven.hash(), changed.hash());
}

TEST(ApiSurfaceMotion, OfWhatIsNotLedOrNotFinite_IsRefused) {
  Engine engine = engine_on(kBelt), other = box_engine();
  EXPECT_THROW(other.drive_collider("floor", {1, 0, 0}), Error);
  EXPECT_THROW(engine.drive_collider("nothing", {1, 0, 0}), Error);
  EXPECT_THROW(engine.drive_collider("floor", {NAN, 0, 0}), Error);
  EXPECT_THROW(engine.drive_collider("floor", {0, 0, 0}, {0, INFINITY, 0}), Error);
}

/// Counts threads that come into an arena.
class Comers : public tbb::task_scheduler_observer {
 public:
  explicit Comers(tbb::task_arena& arena) : tbb::task_scheduler_observer(arena) { observe(true); }
  ~Comers() override { observe(false); }
  void on_scheduler_entry(bool) override { ++count; }
  std::atomic<int> count{0};
};

TEST(ApiArena, OfTheCaller_IsWhereTheEngineWorks) {
  const Scene scene = Scene::from_text(box_scene());
  Engine own = box_engine(2);
  own.advance_frame();
  for (const int threads : {1, 2, 3}) {
    tbb::task_arena arena(threads);
    repose_engine_options options = repose_engine_options_init();
    options.threads = REPOSE_THREADS_OF_CALLER;
    std::optional<Engine> engine;
    arena.execute([&] { engine.emplace(scene, options); });
    EXPECT_EQ(engine->info().threads, threads);
    Comers comers(arena);
    // A worker whom the making of the engine has called may come late, once.
    for (int tries = 0; tries < 5; ++tries) {
      comers.count = 0;
      box_engine(2).advance_frame();
      if (comers.count == 0) break;
    }
    EXPECT_EQ(comers.count, 0) << "an arena of its own is another one";
    engine->advance_frame();
    EXPECT_GT(comers.count, 0);
    EXPECT_EQ(engine->hash(), own.hash());
    // A change makes the passes anew; they are to work there too.
    engine->change("colliders.floor.friction", "0.4");
    EXPECT_EQ(engine->info().threads, threads);
  }
}

TEST(ApiMemory, BeyondTheBudget_IsRefusedWithItsBytesAndTheRunGoesOn) {
  const Scene scene = Scene::from_text(box_scene(
      R"(, "emitters": [{"name": "hand", "type": "host", "material": "sand", "particles_per_cell": 8}])"));
  repose_engine_options options = repose_engine_options_init();
  options.threads = 1;
  const auto expect_refused = [](const auto& call) {
    try {
      call();
      ADD_FAILURE() << "it was taken";
    } catch (const Error& error) {
      EXPECT_EQ(error.status(), REPOSE_ERROR_MEMORY);
      const std::string text = error.what();
      EXPECT_TRUE(text.find(" MB") != std::string::npos || text.find(" kB") != std::string::npos) << text;
    }
  };
  options.memory_limit = 20e3;
  expect_refused([&] { Engine engine(scene, options); });

  options.memory_limit = 0.0;
  options.memory_limit = Engine(scene, options).info().memory + 4e6;
  Engine engine(scene, options);
  std::vector<double> many;
  for (int k = 0; k < 200000; ++k)
    many.insert(many.end(), {0.01 * (k % 50), 0.5 + 0.01 * (k / 2500), 0.01 * (k / 50 % 50)});
  expect_refused([&] { engine.add_particles("hand", many); });
  EXPECT_LE(engine.info().memory, options.memory_limit);
  EXPECT_EQ(engine.info().sound, 1);
  EXPECT_EQ(engine.info().particles, 512u);
  EXPECT_EQ(engine.add_particles("hand", std::vector<double>{0.0625, 0.5, 0.0625}), 512u);
  EXPECT_EQ(engine.advance_step().steps, 1);
}

}  // namespace
}  // namespace repose
