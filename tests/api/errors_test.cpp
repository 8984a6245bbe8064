// Repose tests: whatever handle a host calls the C API with, it is answered: every function of the header is
// called with no handle, a stale one and one of another kind. What errors say. Null pointers and versions of
// structs: arguments_test.cpp.
#include <cstring>
#include <set>

#include "tests/api/calls.h"

namespace repose {
namespace {

/// Those that take none.
const std::set<std::string> kWithoutHandles{"repose_scene_from_file", "repose_scene_from_text",
                                            "repose_scene_empty", "repose_error_status",
                                            "repose_set_allocator"};

TEST(ApiErrors, Table_HasEveryFunctionOfTheHeader) {
  std::set<std::string> known = kWithoutHandles, declared;
  for (const Call& call : calls()) known.insert(call.name);
  for_each_function(header_text(), [&](const std::string& name, const std::string&) { declared.insert(name); });
  EXPECT_GT(declared.size(), 50u);
  EXPECT_EQ(declared, known);
}

TEST(ApiErrors, NullStaleAndForeignHandles_AreRefusedByEveryFunction) {
  Handles stale{};
  ASSERT_EQ(
      repose_scene_from_text(box_scene().c_str(), box_scene().size(), nullptr, nullptr, nullptr, &stale.scene),
      REPOSE_OK);
  ASSERT_EQ(repose_engine_create(stale.scene, nullptr, &stale.engine), REPOSE_OK);
  ASSERT_EQ(repose_points_create(stale.engine, nullptr, &stale.points), REPOSE_OK);
  ASSERT_EQ(repose_fog_create(stale.engine, 0, &stale.volume), REPOSE_OK);
  // All calls but those that destroy go with these handles, so that it is the handle which is refused below.
  const Handles foreign{{stale.engine.value}, {stale.points.value}, {stale.volume.value}, {stale.scene.value}};
  const Handles beyond{{stale.scene.value + 100},
                       {stale.engine.value + 100},
                       {stale.points.value + 100},
                       {stale.volume.value + 100}};
  for (const Handles& wrong : {Handles{}, foreign, beyond}) {
    for (const Call& call : calls()) EXPECT_EQ(call.call(wrong), REPOSE_ERROR_HANDLE) << call.name;
  }
  EXPECT_EQ(repose_volume_destroy(stale.volume), REPOSE_OK);
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
