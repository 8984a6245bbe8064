// Repose tests: engines of the C API, through its C++ wrapper: equal bits whoever asks and however often,
// states to and from memory, interruption, progress, changes of a scene that runs.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <thread>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

TEST(ApiEngine, TwoEnginesAndThreads_EqualHashes) {
  Engine one = box_engine(1), two = box_engine(2);
  EXPECT_EQ(one.hash(), two.hash());
  const std::uint64_t start = one.hash();
  for (int frame = 0; frame < 3; ++frame) {
    one.advance_frame();
    two.advance_frame();
    EXPECT_EQ(one.hash(), two.hash());
  }
  EXPECT_NE(one.hash(), start);
  EXPECT_EQ(two.info().threads, 2);
}

TEST(ApiEngine, EightEnginesSideBySide_EqualHashes) {
  std::array<std::uint64_t, 8> hashes{};
  std::vector<std::thread> hosts;
  for (std::uint64_t& hash : hashes) {
    hosts.emplace_back([&hash] {
      Engine engine = box_engine(1);
      engine.advance_frame();
      hash = engine.hash();
    });
  }
  for (std::thread& host : hosts) host.join();
  Engine alone = box_engine(2);
  alone.advance_frame();
  for (const std::uint64_t hash : hashes) EXPECT_EQ(hash, alone.hash());
}

TEST(ApiEngine, MadeAndDestroyedOften_HandlesAreNeverTheSame) {
  const Scene scene = Scene::from_text(box_scene());
  std::vector<std::uint64_t> handles;
  for (int k = 0; k < 200; ++k) {
    Engine engine(scene);
    handles.push_back(engine.get().value);
  }
  std::sort(handles.begin(), handles.end());
  EXPECT_EQ(std::adjacent_find(handles.begin(), handles.end()), handles.end());
  std::uint64_t hash = 0;
  for (const std::uint64_t handle : handles) EXPECT_EQ(repose_hash({handle}, &hash), REPOSE_ERROR_HANDLE);
}

TEST(ApiEngine, StepsSecondsAndFrames_GoAlongOneLine) {
  Engine frames = box_engine(), steps = box_engine(), mixed = box_engine();
  const repose_report first = frames.advance_frame();
  EXPECT_EQ(first.frame, 1);
  EXPECT_EQ(first.complete, 1);
  EXPECT_DOUBLE_EQ(first.time, 1.0 / 48.0);
  while (steps.info().frame < 1) EXPECT_EQ(steps.advance_step().steps, 1);
  EXPECT_EQ(steps.hash(), frames.hash());
  EXPECT_EQ(steps.info().step, first.step);

  const repose_report half = mixed.advance_seconds(0.4 / 48.0);
  EXPECT_EQ(half.frame, 0);
  EXPECT_EQ(half.complete, 1);
  EXPECT_NEAR(half.time, 0.4 / 48.0, 1e-12);
  mixed.advance_frame();
  EXPECT_EQ(mixed.info().frame, 1);
  EXPECT_DOUBLE_EQ(mixed.info().time, 1.0 / 48.0);
  const repose_report on = mixed.advance_seconds(1.5 / 48.0);
  EXPECT_EQ(on.frame, 2);
  EXPECT_NEAR(on.time, 2.5 / 48.0, 1e-12);
}

TEST(ApiEngine, StateInMemoryAndInAFile_GoesOnWithTheSameBits) {
  const TemporaryFolder folder;
  Engine engine = box_engine();
  engine.advance_step();
  const std::vector<std::byte> bytes = engine.save();
  engine.save(folder.path("state"));
  engine.advance_frame();
  Engine from_memory = box_engine(2), from_file = box_engine();
  from_memory.load(Span<const std::byte>(bytes.data(), bytes.size()));
  from_file.load(folder.path("state"));
  from_memory.advance_frame();
  from_file.advance_frame();
  EXPECT_EQ(from_memory.hash(), engine.hash());
  EXPECT_EQ(from_file.hash(), engine.hash());
  EXPECT_EQ(std::filesystem::file_size(folder.path("state")), bytes.size());
}

TEST(ApiEngine, DamagedState_IsRefusedAndChangesNothing) {
  Engine engine = box_engine();
  engine.advance_step();
  std::vector<std::byte> bytes = engine.save();
  engine.advance_step();
  const std::uint64_t before = engine.hash();
  for (std::size_t at = 100; at < bytes.size(); at += bytes.size() / 23) {
    std::vector<std::byte> damaged = bytes;
    damaged[at] ^= std::byte{1};
    EXPECT_NE(repose_state_read(engine.get(), damaged.data(), damaged.size()), REPOSE_OK) << at;
    EXPECT_NE(repose_state_read(engine.get(), bytes.data(), at), REPOSE_OK) << "cut to " << at;
    ASSERT_EQ(engine.hash(), before) << at;
  }
  Scene seeded = Scene::from_text(box_scene());
  Engine other(seeded.set("bodies.box.seed", "7"));
  EXPECT_EQ(repose_state_read(other.get(), bytes.data(), bytes.size()), REPOSE_ERROR_SCENE);
}

TEST(ApiEngine, InterruptedByAnotherThread_LeavesTheFrameAndGoesOn) {
  Engine whole = box_engine(), engine = box_engine();
  whole.advance_frame();
  std::atomic<bool> began{false};
  std::thread canceller([&] {
    while (!began) std::this_thread::yield();
    engine.interrupt();
  });
  engine.on_progress([&](const repose_progress&) {
    if (!began.exchange(true)) canceller.join();  // the step after this one is never made
    return true;
  });
  const repose_report report = engine.advance_frame();
  EXPECT_EQ(report.complete, 0);
  EXPECT_EQ(report.steps, 1);
  EXPECT_EQ(report.frame, 0);
  EXPECT_EQ(engine.advance_frame().complete, 1);
  EXPECT_EQ(engine.hash(), whole.hash());
}

TEST(ApiEngine, Progress_IsToldOfEachStepAndMayEnd) {
  Engine engine = box_engine();
  int steps = 0;
  engine.on_progress([&](const repose_progress& progress) {
    EXPECT_EQ(progress.step, ++steps);
    EXPECT_GT(progress.dt, 0.0);
    return steps < 3;
  });
  EXPECT_EQ(engine.advance_frame().complete, 0);
  EXPECT_EQ(steps, 3);
  engine.on_progress([](const repose_progress&) -> bool { throw std::runtime_error("of the host"); });
  EXPECT_THROW(engine.advance_frame(), std::runtime_error);
  engine.on_progress({});
  EXPECT_EQ(engine.advance_frame().complete, 1);
}

TEST(ApiEngine, CallFromACallback_IsBusy) {
  Engine engine = box_engine();
  repose_status hash_status = REPOSE_OK, interrupt_status = REPOSE_ERROR_BUSY;
  engine.on_progress([&](const repose_progress&) {
    std::uint64_t hash = 0;
    hash_status = repose_hash(engine.get(), &hash);
    interrupt_status = repose_interrupt(engine.get());
    return true;
  });
  EXPECT_EQ(engine.advance_frame().steps, 1);
  EXPECT_EQ(hash_status, REPOSE_ERROR_BUSY);
  EXPECT_EQ(interrupt_status, REPOSE_OK);
}

TEST(ApiEngine, DestroyedInACallback_EndsTheCallAndTheHandle) {
  const Scene scene = Scene::from_text(box_scene());
  repose_engine engine{0};
  ASSERT_EQ(repose_engine_create(scene.get(), nullptr, &engine), REPOSE_OK);
  repose_set_progress(
      engine,
      [](void* user, const repose_progress*) {
        repose_engine_destroy(*static_cast<repose_engine*>(user));
        return 0;
      },
      &engine);
  repose_report report = repose_report_init();
  EXPECT_EQ(repose_advance_frame(engine, &report), REPOSE_OK);
  EXPECT_EQ(report.complete, 0);
  EXPECT_EQ(repose_advance_frame(engine, &report), REPOSE_ERROR_HANDLE);
}

TEST(ApiEngine, ChangedKey_GoesOnAsASavedStateInTheOtherScene) {
  Engine engine = box_engine();
  engine.advance_frame();
  const std::vector<std::byte> bytes = engine.save();
  engine.change("gravity.acceleration", "[2, -4, 0]");
  engine.change("colliders.floor.friction", "0.1");
  engine.advance_frame();

  Engine same = box_engine();
  same.load(Span<const std::byte>(bytes.data(), bytes.size()));
  same.advance_frame();
  EXPECT_NE(engine.hash(), same.hash());
  // Changed and changed back before a step, it is the same again.
  Engine back = box_engine();
  back.load(Span<const std::byte>(bytes.data(), bytes.size()));
  back.change("gravity.acceleration", "[2, -4, 0]");
  back.change("gravity.acceleration", "[0, -9.81, 0]");
  back.advance_frame();
  EXPECT_EQ(back.hash(), same.hash());
  const Points points = engine.points();
  const std::vector<float> v = points.read("v");
  double mean = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) mean += v[3 * p] / static_cast<double>(points.size());
  EXPECT_NEAR(mean, 2.0 / 48.0, 0.003);  // still falling

  const std::uint64_t hash = engine.hash();
  EXPECT_THROW(engine.change("bodies.box.seed", "2"), Error);
  EXPECT_THROW(engine.change("materials.sand.density", "1000"), Error);
  EXPECT_THROW(engine.change("gravity.nonsense", "1"), Error);
  EXPECT_THROW(engine.change("probes", R"([{"name": "push", "type": "force", "collider": "floor"}])"), Error);
  EXPECT_EQ(engine.hash(), hash);
}

TEST(ApiEngine, BudgetOfMemory_Refuses) {
  const Scene scene = Scene::from_text(box_scene());
  repose_engine_options options = repose_engine_options_init();
  options.memory_limit = 1e4;
  repose_engine engine{0};
  EXPECT_EQ(repose_engine_create(scene.get(), &options, &engine), REPOSE_ERROR_MEMORY);
  EXPECT_EQ(engine.value, 0u);
}

TEST(ApiEngine, Warnings_AreLoggedWhileItIsMade) {
  Scene inside = Scene::from_text(box_scene());
  inside.set("colliders.floor.shape.point", "[0, 0.1, 0]");
  std::vector<std::string> told;
  Engine engine(inside, repose_engine_options_init(), [&](int level, const char* message) {
    EXPECT_EQ(level, REPOSE_LOG_WARNING);
    told.push_back(message);
  });
  EXPECT_FALSE(told.empty());
  EXPECT_EQ(engine.warnings(), told);
}

TEST(ApiEngine, SceneMadeKeyByKey_IsTheSceneOfTheText) {
  Scene scene = Scene::empty();
  EXPECT_THROW(scene.check(), Error);
  scene.set("repose", "1")
      .set("name", "box")
      .set("grid.spacing", "0.03125")
      .set("time.frames_per_second", "48")
      .set("materials", R"({"sand": {"type": "drucker_prager", "density": 2200, "youngs_modulus": 3.5e5,
                                     "poisson_ratio": 0.3, "friction_angle": 35}})")
      .set("bodies", R"([{"name": "box", "material": "sand",
                          "shape": {"type": "box", "lower": [0, 0.03125, 0], "upper": [0.125, 0.15625, 0.125]}}])")
      .set("colliders", R"([{"name": "floor", "shape": {"type": "plane"}, "friction": 0.4}])");
  scene.check();
  Engine engine(scene), other = box_engine();
  engine.advance_frame();
  other.advance_frame();
  EXPECT_EQ(engine.hash(), other.hash());
}

TEST(ApiEngine, Probes_AreMeasured) {
  Engine engine = box_engine(1, R"(, "probes": [{"name": "push", "type": "force", "collider": "floor"}])");
  for (int frame = 0; frame < 6; ++frame) engine.advance_frame();
  const std::vector<Measurement> list = engine.measurements();
  ASSERT_FALSE(list.empty());
  EXPECT_EQ(list[1].probe, "push");
  EXPECT_EQ(list[1].quantity, "force.y");
  EXPECT_EQ(list[1].unit, "N");
  EXPECT_LT(list[1].value, 0.0);
}

/// What an engine of a scene with a wind from g.vdb, which is no VDB file, is refused with.
std::pair<int, std::string> refusal_of_grid(const TemporaryFolder& folder, const std::string& reader,
                                            double seconds) {
  folder.write("g.vdb", "this is no grid");
  Scene scene = Scene::from_text(
      box_scene(R"(, "force_fields": [{"name": "f", "type": "wind_grid", "file": "g.vdb", "grid": "v"}])"),
      folder.path().string());
  scene.vdb_reader(reader, 0.0, seconds);
  try {
    Engine engine(scene);
  } catch (const Error& error) {
    return {error.status(), error.what()};
  }
  return {REPOSE_OK, ""};
}

TEST(ApiEngine, VdbFiles_AreReadByTheProgramThatTheHostNames) {
  const TemporaryFolder folder;
  const auto nonsense = refusal_of_grid(folder, "", 0.0);
  EXPECT_EQ(nonsense.first, REPOSE_ERROR_NO_INPUT);
  EXPECT_NE(nonsense.second.find("g.vdb: cannot be read as a VDB file: "), std::string::npos)
      << nonsense.second;
  const auto missing = refusal_of_grid(folder, folder.path("none"), 0.0);
  EXPECT_EQ(missing.first, REPOSE_ERROR_NO_INPUT);
  EXPECT_NE(missing.second.find(folder.path("none")), std::string::npos) << missing.second;
  folder.write("hangs", "#!/bin/sh\nexec sleep 1000\n");
  std::filesystem::permissions(folder.path("hangs"), std::filesystem::perms::owner_all);
  const auto hangs = refusal_of_grid(folder, folder.path("hangs"), 0.5);
  EXPECT_EQ(hangs.first, REPOSE_ERROR_NO_INPUT);
  EXPECT_NE(hangs.second.find("the reader ran past 0.5 s"), std::string::npos) << hangs.second;
}

}  // namespace
}  // namespace repose
