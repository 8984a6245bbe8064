// Repose tests: whatever a host calls the C API with, it is answered. Every function of the header stands in a
// table here: with no handle, a stale one and one of another kind, with null pointers, and with structs of
// another version.
#include <cstring>
#include <fstream>
#include <functional>
#include <regex>
#include <set>
#include <sstream>

#include "tests/api/api_rig.h"

namespace repose {
namespace {

/// Handles of each kind, for calls that are otherwise right.
struct Handles {
  repose_scene scene;
  repose_engine engine;
  repose_points points;
};

struct Call {
  const char* name;
  std::function<repose_status(const Handles&)> call;
};

int write_nothing(void*, const void*, size_t) {
  return 0;
}

/// What calls write into.
struct Room {
  char text[64];
  double numbers[64];
  float floats[64];
  uint32_t ids[64];
  size_t size;
  uint64_t hash;
  uint32_t id;
  int32_t components;
  repose_scene scene;
  repose_engine engine;
  repose_points points;
  repose_report report = repose_report_init();
  repose_info info = repose_info_init();
  repose_set set = repose_set_init();
  repose_view view = repose_view_init();
  repose_measurement_info measurement = repose_measurement_info_init();
  repose_contact_info contact = repose_contact_info_init();
  repose_scene_options scene_options = repose_scene_options_init();
  repose_engine_options engine_options = repose_engine_options_init();
  repose_points_options points_options = repose_points_options_init();
} room;

constexpr double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
constexpr double kPlaces[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
constexpr uint32_t kIds[1] = {0};

/// Every function that takes a handle.
const std::vector<Call>& calls() {
  static const std::vector<Call> list{
      {"repose_scene_set", [](const Handles& h) { return repose_scene_set(h.scene, "name", "x"); }},
      {"repose_scene_check", [](const Handles& h) { return repose_scene_check(h.scene); }},
      {"repose_scene_lead_pose", [](const Handles& h) { return repose_scene_lead_pose(h.scene, "floor"); }},
      {"repose_scene_lead_mesh", [](const Handles& h) { return repose_scene_lead_mesh(h.scene, "floor", 24); }},
      {"repose_scene_vdb_reader",
       [](const Handles& h) { return repose_scene_vdb_reader(h.scene, nullptr, 0, 0); }},
      {"repose_scene_json",
       [](const Handles& h) { return repose_scene_json(h.scene, room.text, 64, &room.size); }},
      {"repose_scene_destroy", [](const Handles& h) { return repose_scene_destroy(h.scene); }},
      {"repose_engine_create",
       [](const Handles& h) { return repose_engine_create(h.scene, nullptr, &room.engine); }},
      {"repose_engine_destroy", [](const Handles& h) { return repose_engine_destroy(h.engine); }},
      {"repose_advance_frame", [](const Handles& h) { return repose_advance_frame(h.engine, &room.report); }},
      {"repose_advance_seconds",
       [](const Handles& h) { return repose_advance_seconds(h.engine, 1, &room.report); }},
      {"repose_advance_step", [](const Handles& h) { return repose_advance_step(h.engine, &room.report); }},
      {"repose_interrupt", [](const Handles& h) { return repose_interrupt(h.engine); }},
      {"repose_set_progress", [](const Handles& h) { return repose_set_progress(h.engine, nullptr, nullptr); }},
      {"repose_set_log", [](const Handles& h) { return repose_set_log(h.engine, nullptr, nullptr); }},
      {"repose_warning_count", [](const Handles& h) { return repose_warning_count(h.engine, &room.size); }},
      {"repose_warning",
       [](const Handles& h) { return repose_warning(h.engine, 0, room.text, 64, &room.size); }},
      {"repose_engine_info", [](const Handles& h) { return repose_engine_info(h.engine, &room.info); }},
      {"repose_hash", [](const Handles& h) { return repose_hash(h.engine, &room.hash); }},
      {"repose_change", [](const Handles& h) { return repose_change(h.engine, "time.cfl", "0.5"); }},
      {"repose_state_save", [](const Handles& h) { return repose_state_save(h.engine, "/nowhere/state"); }},
      {"repose_state_load", [](const Handles& h) { return repose_state_load(h.engine, "/nowhere/state"); }},
      {"repose_state_write",
       [](const Handles& h) { return repose_state_write(h.engine, write_nothing, nullptr); }},
      {"repose_state_read", [](const Handles& h) { return repose_state_read(h.engine, room.text, 64); }},
      {"repose_points_create",
       [](const Handles& h) { return repose_points_create(h.engine, nullptr, &room.points); }},
      {"repose_points_destroy", [](const Handles& h) { return repose_points_destroy(h.points); }},
      {"repose_points_count", [](const Handles& h) { return repose_points_count(h.points, &room.size); }},
      {"repose_points_components",
       [](const Handles& h) { return repose_points_components(h.points, "P", &room.components); }},
      {"repose_points_read",
       [](const Handles& h) { return repose_points_read(h.points, "P", room.floats, 64); }},
      {"repose_points_positions",
       [](const Handles& h) { return repose_points_positions(h.points, room.numbers, 64); }},
      {"repose_points_ids", [](const Handles& h) { return repose_points_ids(h.points, room.ids, 64); }},
      {"repose_set_count", [](const Handles& h) { return repose_set_count(h.engine, &room.size); }},
      {"repose_set_info", [](const Handles& h) { return repose_set_info(h.engine, 0, &room.set); }},
      {"repose_channel", [](const Handles& h) { return repose_channel(h.engine, 0, 0, &room.view); }},
      {"repose_channel_named",
       [](const Handles& h) { return repose_channel_named(h.engine, 0, "id", &room.view); }},
      {"repose_view_check", [](const Handles& h) { return repose_view_check(h.engine, 1); }},
      {"repose_block_corners",
       [](const Handles& h) { return repose_block_corners(h.engine, room.numbers, 64, &room.size); }},
      {"repose_measurement_count",
       [](const Handles& h) { return repose_measurement_count(h.engine, &room.size); }},
      {"repose_measurement",
       [](const Handles& h) { return repose_measurement(h.engine, 0, &room.measurement); }},
      {"repose_move_collider",
       [](const Handles& h) { return repose_move_collider(h.engine, "floor", kIdentity, 1); }},
      {"repose_deform_collider",
       [](const Handles& h) { return repose_deform_collider(h.engine, "floor", kPlaces, 3, nullptr, 0, 0); }},
      {"repose_contact", [](const Handles& h) { return repose_contact(h.engine, "floor", &room.contact); }},
      {"repose_add_particles",
       [](const Handles& h) { return repose_add_particles(h.engine, "x", kPlaces, nullptr, 1, &room.id); }},
      {"repose_remove_particles",
       [](const Handles& h) { return repose_remove_particles(h.engine, kIds, 1, &room.size); }},
  };
  return list;
}

/// Those that take none.
const std::set<std::string> kWithoutHandles{"repose_scene_from_file", "repose_scene_from_text",
                                            "repose_scene_empty", "repose_error_status"};

TEST(ApiErrors, Table_HasEveryFunctionOfTheHeader) {
  std::stringstream text;
  for (const char* name : {"/repose_base.h", "/repose.h"})
    text << std::ifstream(std::string(REPOSE_HEADERS) + name).rdbuf();
  const std::string header = text.str();
  std::set<std::string> known = kWithoutHandles, declared;
  for (const Call& call : calls()) known.insert(call.name);
  const std::regex declaration("REPOSE_API repose_status\\s+(repose_\\w+)\\(");
  for (std::sregex_iterator it(header.begin(), header.end(), declaration), end; it != end; ++it)
    declared.insert((*it)[1]);
  EXPECT_GT(declared.size(), 40u);
  EXPECT_EQ(declared, known);
}

TEST(ApiErrors, NullStaleAndForeignHandles_AreRefusedByEveryFunction) {
  Handles stale{};
  ASSERT_EQ(
      repose_scene_from_text(box_scene().c_str(), box_scene().size(), nullptr, nullptr, nullptr, &stale.scene),
      REPOSE_OK);
  ASSERT_EQ(repose_engine_create(stale.scene, nullptr, &stale.engine), REPOSE_OK);
  ASSERT_EQ(repose_points_create(stale.engine, nullptr, &stale.points), REPOSE_OK);
  // All calls but those that destroy go with these handles, so that it is the handle which is refused below.
  const Handles foreign{{stale.engine.value}, {stale.points.value}, {stale.scene.value}};
  const Handles beyond{{stale.scene.value + 100}, {stale.engine.value + 100}, {stale.points.value + 100}};
  for (const Handles& wrong : {Handles{}, foreign, beyond}) {
    for (const Call& call : calls()) EXPECT_EQ(call.call(wrong), REPOSE_ERROR_HANDLE) << call.name;
  }
  EXPECT_EQ(repose_points_destroy(stale.points), REPOSE_OK);
  EXPECT_EQ(repose_engine_destroy(stale.engine), REPOSE_OK);
  EXPECT_EQ(repose_scene_destroy(stale.scene), REPOSE_OK);
  const Scene takes_the_place = Scene::from_text(box_scene());
  for (const Call& call : calls()) {
    EXPECT_EQ(call.call(stale), REPOSE_ERROR_HANDLE) << call.name;
    EXPECT_EQ(repose_error_status(), REPOSE_ERROR_HANDLE);
    EXPECT_GT(repose_error_message(nullptr, 0), 10u);
  }
}

TEST(ApiErrors, NullPointers_AreRefused) {
  Engine engine = box_engine();
  const Scene scene = Scene::from_text(box_scene());
  const Points points = engine.points();
  const repose_engine e = engine.get();
  const repose_scene s = scene.get();
  const repose_points p = points.get();
  const std::vector<std::pair<const char*, repose_status>> answers{
      {"from_file", repose_scene_from_file(nullptr, nullptr, &room.scene)},
      {"from_file, scene", repose_scene_from_file("x", nullptr, nullptr)},
      {"from_text", repose_scene_from_text(nullptr, 1, nullptr, nullptr, nullptr, &room.scene)},
      {"from_text, scene", repose_scene_from_text("{}", 2, nullptr, nullptr, nullptr, nullptr)},
      {"empty", repose_scene_empty(nullptr, nullptr, nullptr)},
      {"set, key", repose_scene_set(s, nullptr, "1")},
      {"set, value", repose_scene_set(s, "name", nullptr)},
      {"set, no path", repose_scene_set(s, "", "1")},
      {"lead_pose", repose_scene_lead_pose(s, nullptr)},
      {"lead_mesh", repose_scene_lead_mesh(s, nullptr, 24)},
      {"lead_mesh, rate", repose_scene_lead_mesh(s, "floor", 0)},
      {"vdb_reader, memory", repose_scene_vdb_reader(s, nullptr, -1, 0)},
      {"vdb_reader, seconds", repose_scene_vdb_reader(s, nullptr, 0, -1)},
      {"json", repose_scene_json(s, nullptr, 5, nullptr)},
      {"create", repose_engine_create(s, nullptr, nullptr)},
      {"seconds", repose_advance_seconds(e, -1, nullptr)},
      {"warning_count", repose_warning_count(e, nullptr)},
      {"warning", repose_warning(e, 9999, room.text, 64, nullptr)},
      {"info", repose_engine_info(e, nullptr)},
      {"hash", repose_hash(e, nullptr)},
      {"change, key", repose_change(e, nullptr, "1")},
      {"change, value", repose_change(e, "time.cfl", nullptr)},
      {"save", repose_state_save(e, nullptr)},
      {"load", repose_state_load(e, nullptr)},
      {"write", repose_state_write(e, nullptr, nullptr)},
      {"read", repose_state_read(e, nullptr, 5)},
      {"points", repose_points_create(e, nullptr, nullptr)},
      {"count", repose_points_count(p, nullptr)},
      {"components", repose_points_components(p, nullptr, &room.components)},
      {"components, out", repose_points_components(p, "P", nullptr)},
      {"points_read", repose_points_read(p, nullptr, room.floats, 64)},
      {"points_read, out", repose_points_read(p, "P", nullptr, 64)},
      {"points_read, room", repose_points_read(p, "P", room.floats, 64)},
      {"positions", repose_points_positions(p, nullptr, 64)},
      {"positions, room", repose_points_positions(p, room.numbers, 64)},
      {"ids", repose_points_ids(p, nullptr, 64)},
      {"ids, room", repose_points_ids(p, room.ids, 64)},
      {"set_count", repose_set_count(e, nullptr)},
      {"set_info", repose_set_info(e, 0, nullptr)},
      {"set_info, index", repose_set_info(e, 1, &room.set)},
      {"channel", repose_channel(e, 0, 0, nullptr)},
      {"channel, index", repose_channel(e, 0, 999, &room.view)},
      {"channel_named", repose_channel_named(e, 0, nullptr, &room.view)},
      {"channel_named, view", repose_channel_named(e, 0, "id", nullptr)},
      {"block_corners", repose_block_corners(e, nullptr, 0, nullptr)},
      {"block_corners, room", repose_block_corners(e, room.numbers, 1, nullptr)},
      {"measurement_count", repose_measurement_count(e, nullptr)},
      {"measurement", repose_measurement(e, 0, nullptr)},
      {"measurement, index", repose_measurement(e, 0, &room.measurement)},
      {"move", repose_move_collider(e, nullptr, kIdentity, 0)},
      {"move, matrix", repose_move_collider(e, "floor", nullptr, 0)},
      {"deform", repose_deform_collider(e, nullptr, kPlaces, 3, nullptr, 0, 0)},
      {"deform, vertices", repose_deform_collider(e, "floor", nullptr, 3, nullptr, 0, 0)},
      {"contact", repose_contact(e, nullptr, &room.contact)},
      {"contact, out", repose_contact(e, "floor", nullptr)},
      {"add", repose_add_particles(e, nullptr, kPlaces, nullptr, 1, nullptr)},
      {"add, positions", repose_add_particles(e, "x", nullptr, nullptr, 1, nullptr)},
      {"remove", repose_remove_particles(e, nullptr, 1, nullptr)},
  };
  for (const auto& [name, answer] : answers) EXPECT_EQ(answer, REPOSE_ERROR_ARGUMENT) << name;
  engine.advance_step();  // and all goes on
}

/// A struct as another version of the header would make it.
template <class Struct>
std::vector<Struct> of_other_versions(Struct right) {
  std::vector<Struct> wrong(3, right);
  wrong[0].version = REPOSE_STRUCT_VERSION + 1;
  wrong[1].version = 0;
  wrong[2].size -= 4;
  return wrong;
}

TEST(ApiErrors, StructsOfAnotherVersion_AreRefused) {
  Engine engine = box_engine();
  const Scene scene = Scene::from_text(box_scene());
  const repose_engine e = engine.get();
  const std::string text = box_scene();
  for (const auto& options : of_other_versions(room.scene_options)) {
    EXPECT_EQ(repose_scene_from_text(text.c_str(), text.size(), nullptr, nullptr, &options, &room.scene),
              REPOSE_ERROR_VERSION);
    EXPECT_EQ(repose_scene_from_file("x", &options, &room.scene), REPOSE_ERROR_VERSION);
    EXPECT_EQ(repose_scene_empty(nullptr, &options, &room.scene), REPOSE_ERROR_VERSION);
  }
  for (const auto& options : of_other_versions(room.engine_options))
    EXPECT_EQ(repose_engine_create(scene.get(), &options, &room.engine), REPOSE_ERROR_VERSION);
  for (const auto& options : of_other_versions(room.points_options))
    EXPECT_EQ(repose_points_create(e, &options, &room.points), REPOSE_ERROR_VERSION);
  const std::uint64_t hash = engine.hash();
  for (auto& report : of_other_versions(room.report)) {
    repose_report given = report;
    EXPECT_EQ(repose_advance_frame(e, &given), REPOSE_ERROR_VERSION);
    EXPECT_EQ(repose_advance_step(e, &given), REPOSE_ERROR_VERSION);
    EXPECT_EQ(repose_advance_seconds(e, 1, &given), REPOSE_ERROR_VERSION);
  }
  EXPECT_EQ(engine.hash(), hash) << "refused before anything is done";
  for (auto given : of_other_versions(room.info))
    EXPECT_EQ(repose_engine_info(e, &given), REPOSE_ERROR_VERSION);
  for (auto given : of_other_versions(room.set)) EXPECT_EQ(repose_set_info(e, 0, &given), REPOSE_ERROR_VERSION);
  for (auto given : of_other_versions(room.view)) {
    EXPECT_EQ(repose_channel(e, 0, 0, &given), REPOSE_ERROR_VERSION);
    EXPECT_EQ(repose_channel_named(e, 0, "id", &given), REPOSE_ERROR_VERSION);
  }
  for (auto given : of_other_versions(room.measurement))
    EXPECT_EQ(repose_measurement(e, 0, &given), REPOSE_ERROR_VERSION);
  for (auto given : of_other_versions(room.contact))
    EXPECT_EQ(repose_contact(e, "floor", &given), REPOSE_ERROR_VERSION);
}

TEST(ApiErrors, WrongScene_NamesKeyAndPlace) {
  Scene scene = Scene::from_text(box_scene());
  scene.set("grid.spacing", "-1");
  try {
    scene.check();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.status(), REPOSE_ERROR_SCENE);
    EXPECT_EQ(error.key(), "grid.spacing");
    EXPECT_NE(std::string(error.what()).find("grid.spacing"), std::string::npos);
  }
  try {
    Scene::from_text("{\n \"repose\": 1, \"nonsense\": 2}", ".", "text");
    FAIL();
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("text:2:"), std::string::npos) << error.what();
  }
  EXPECT_EQ(repose_scene_from_file("/no/such/scene.json", nullptr, &room.scene), REPOSE_ERROR_NO_INPUT);
  char cut[8];
  const std::size_t whole = repose_error_message(cut, sizeof cut);
  EXPECT_GT(whole, sizeof cut);
  EXPECT_EQ(std::strlen(cut), sizeof cut - 1);
}

TEST(ApiErrors, VersionsAndTexts) {
  EXPECT_EQ(repose_version(), std::uint32_t{REPOSE_VERSION});
  for (const repose_status status : {0, 64, 65, 66, 70, 71, 73, 74, 78, 100, 101, 102, 103, 104})
    EXPECT_STRNE(repose_status_text(status), "unknown") << status;
  EXPECT_STREQ(repose_status_text(5), "unknown");
}

}  // namespace
}  // namespace repose
