// Repose tests: null pointers, and structs of another version, are refused by every function of the C API that
// takes some. Which those are the headers say: an argument that is missing here fails the test.
#include <set>

#include "tests/api/calls.h"

namespace repose {
namespace {

/// "repose_hash/hash" and so on.
using Argument = std::string;

/// Null is as good as a default, or nobody.
const std::set<Argument> kMayBeNull{"repose_set_allocator/allocator",
                                    "repose_scene_from_file/options",
                                    "repose_scene_from_text/name",
                                    "repose_scene_from_text/folder",
                                    "repose_scene_from_text/options",
                                    "repose_scene_empty/folder",
                                    "repose_scene_empty/options",
                                    "repose_scene_vdb_reader/program",
                                    "repose_scene_json/length",
                                    "repose_engine_create/options",
                                    "repose_advance_frame/report",
                                    "repose_advance_seconds/report",
                                    "repose_advance_step/report",
                                    "repose_set_progress/user",
                                    "repose_set_log/user",
                                    "repose_warning/length",
                                    "repose_state_write/user",
                                    "repose_points_create/options",
                                    "repose_surface_create/options",
                                    "repose_deform_collider/triangles",
                                    "repose_drive_collider/velocity",
                                    "repose_drive_collider/spin",
                                    "repose_drive_collider/center",
                                    "repose_add_particles/velocities",
                                    "repose_add_particles/first_id",
                                    "repose_add_particles_with/velocities",
                                    "repose_add_particles_with/first_id",
                                    "repose_set_values/found",
                                    "repose_remove_particles/removed"};

/// Each pointer, null, all else being right.
std::vector<std::pair<Argument, repose_status>> null_answers(repose_scene s, repose_engine e, repose_points p,
                                                             repose_volume v) {
  return {
      {"repose_scene_from_file/path", repose_scene_from_file(nullptr, nullptr, &room.scene)},
      {"repose_scene_from_file/scene", repose_scene_from_file("x", nullptr, nullptr)},
      {"repose_scene_from_text/text",
       repose_scene_from_text(nullptr, 1, nullptr, nullptr, nullptr, &room.scene)},
      {"repose_scene_from_text/scene", repose_scene_from_text("{}", 2, nullptr, nullptr, nullptr, nullptr)},
      {"repose_scene_empty/scene", repose_scene_empty(nullptr, nullptr, nullptr)},
      {"repose_scene_set/key", repose_scene_set(s, nullptr, "1")},
      {"repose_scene_set/value", repose_scene_set(s, "name", nullptr)},
      {"repose_scene_lead_pose/collider", repose_scene_lead_pose(s, nullptr)},
      {"repose_scene_lead_mesh/collider", repose_scene_lead_mesh(s, nullptr, 24)},
      {"repose_scene_json/buffer", repose_scene_json(s, nullptr, 5, nullptr)},
      {"repose_engine_create/engine", repose_engine_create(s, nullptr, nullptr)},
      {"repose_warning_count/count", repose_warning_count(e, nullptr)},
      {"repose_warning/buffer", repose_warning(e, 0, nullptr, 5, nullptr)},
      {"repose_engine_info/info", repose_engine_info(e, nullptr)},
      {"repose_hash/hash", repose_hash(e, nullptr)},
      {"repose_change/key", repose_change(e, nullptr, "1")},
      {"repose_change/value", repose_change(e, "time.cfl", nullptr)},
      {"repose_state_save/path", repose_state_save(e, nullptr)},
      {"repose_state_load/path", repose_state_load(e, nullptr)},
      {"repose_state_write/write", repose_state_write(e, nullptr, nullptr)},
      {"repose_state_read/data", repose_state_read(e, nullptr, 5)},
      {"repose_points_create/points", repose_points_create(e, nullptr, nullptr)},
      {"repose_points_count/count", repose_points_count(p, nullptr)},
      {"repose_points_components/attribute", repose_points_components(p, nullptr, &room.components)},
      {"repose_points_components/components", repose_points_components(p, "P", nullptr)},
      {"repose_points_read/attribute", repose_points_read(p, nullptr, room.floats, 64)},
      {"repose_points_read/values", repose_points_read(p, "P", nullptr, 64)},
      {"repose_points_read_half/attribute", repose_points_read_half(p, nullptr, room.halves, 64)},
      {"repose_points_read_half/values", repose_points_read_half(p, "P", nullptr, 64)},
      {"repose_points_positions/values", repose_points_positions(p, nullptr, 64)},
      {"repose_points_ids/ids", repose_points_ids(p, nullptr, 64)},
      {"repose_points_write/path", repose_points_write(p, nullptr)},
      {"repose_set_count/count", repose_set_count(e, nullptr)},
      {"repose_set_info/set", repose_set_info(e, 0, nullptr)},
      {"repose_channel/view", repose_channel(e, 0, 0, nullptr)},
      {"repose_channel_named/name", repose_channel_named(e, 0, nullptr, &room.view)},
      {"repose_channel_named/view", repose_channel_named(e, 0, "id", nullptr)},
      {"repose_block_corners/corners", repose_block_corners(e, nullptr, 0, nullptr)},
      {"repose_block_corners/count", repose_block_corners(e, nullptr, 0, nullptr)},
      {"repose_measurement_count/count", repose_measurement_count(e, nullptr)},
      {"repose_measurement/measurement", repose_measurement(e, 0, nullptr)},
      {"repose_surface_create/volume", repose_surface_create(e, nullptr, nullptr)},
      {"repose_fog_create/volume", repose_fog_create(e, 0, nullptr)},
      {"repose_volume_lattice/lattice", repose_volume_lattice(v, nullptr)},
      {"repose_volume_read/grid", repose_volume_read(v, nullptr, room.floats, 64)},
      {"repose_volume_read/values", repose_volume_read(v, "density", nullptr, 64)},
      {"repose_move_collider/collider", repose_move_collider(e, nullptr, kIdentity, 0)},
      {"repose_move_collider/matrix", repose_move_collider(e, "floor", nullptr, 0)},
      {"repose_drive_collider/collider", repose_drive_collider(e, nullptr, nullptr, nullptr, nullptr)},
      {"repose_deform_collider/collider", repose_deform_collider(e, nullptr, kPlaces, 3, nullptr, 0, 0)},
      {"repose_deform_collider/vertices", repose_deform_collider(e, "floor", nullptr, 3, nullptr, 0, 0)},
      {"repose_contact/collider", repose_contact(e, nullptr, &room.contact)},
      {"repose_contact/contact", repose_contact(e, "floor", nullptr)},
      {"repose_add_particles/emitter", repose_add_particles(e, nullptr, kPlaces, nullptr, 1, nullptr)},
      {"repose_add_particles/positions", repose_add_particles(e, "x", nullptr, nullptr, 1, nullptr)},
      {"repose_add_particles_with/emitter",
       repose_add_particles_with(e, nullptr, kPlaces, nullptr, 1, kChannels, kValues, 1, nullptr)},
      {"repose_add_particles_with/positions",
       repose_add_particles_with(e, "x", nullptr, nullptr, 1, kChannels, kValues, 1, nullptr)},
      {"repose_add_particles_with/channels",
       repose_add_particles_with(e, "x", kPlaces, nullptr, 1, nullptr, kValues, 1, nullptr)},
      {"repose_add_particles_with/values",
       repose_add_particles_with(e, "x", kPlaces, nullptr, 1, kChannels, nullptr, 1, nullptr)},
      {"repose_channel_components/channel", repose_channel_components(e, nullptr, &room.components)},
      {"repose_channel_components/components", repose_channel_components(e, "Cd", nullptr)},
      {"repose_set_values/channel", repose_set_values(e, nullptr, kIds, kFloats, 1, nullptr)},
      {"repose_set_values/ids", repose_set_values(e, "Cd", nullptr, kFloats, 1, nullptr)},
      {"repose_set_values/values", repose_set_values(e, "Cd", kIds, nullptr, 1, nullptr)},
      {"repose_remove_particles/ids", repose_remove_particles(e, nullptr, 1, nullptr)},
  };
}

TEST(ApiArguments, NullPointers_AreRefusedWhereverTheHeadersHaveOne) {
  Engine engine = box_engine();
  const Scene scene = Scene::from_text(box_scene());
  const Points points = engine.points();
  const Volume fog = engine.fog();
  std::set<Argument> known = kMayBeNull, declared;
  for (const auto& [name, answer] : null_answers(scene.get(), engine.get(), points.get(), fog.get())) {
    EXPECT_EQ(answer, REPOSE_ERROR_ARGUMENT) << name;
    EXPECT_TRUE(known.insert(name).second) << name << " may be null, and is refused";
  }
  const std::regex pointer(R"((?:\*(?: const\*)?|double) ?(\w+)(?:\[16\])?(?:,|$))");
  for_each_function(header_text(), [&](const std::string& name, const std::string& arguments) {
    for (std::sregex_iterator it(arguments.begin(), arguments.end(), pointer), end; it != end; ++it) {
      const std::string text = it->str();
      if (text.find('*') != std::string::npos || text.find('[') != std::string::npos)
        declared.insert(name + "/" + (*it)[1].str());
    }
  });
  // Functions are pointers without a star.
  known.erase("repose_state_write/write");
  EXPECT_GT(declared.size(), 80u);
  EXPECT_EQ(declared, known);
  engine.advance_step();  // and all goes on
}

TEST(ApiArguments, IndicesSizesAndNumbersThatCannotBe_AreRefused) {
  Engine engine = box_engine();
  const Scene scene = Scene::from_text(box_scene());
  const Points points = engine.points();
  const Volume fog = engine.fog();
  const repose_engine e = engine.get();
  const repose_points p = points.get();
  repose_surface_options surface = repose_surface_options_init();
  surface.smoothing = 101;
  const float* const no_values[1] = {nullptr};
  const char* const no_names[1] = {nullptr};
  const std::vector<std::pair<const char*, repose_status>> answers{
      {"set, no path", repose_scene_set(scene.get(), "", "1")},
      {"lead_mesh, rate", repose_scene_lead_mesh(scene.get(), "floor", 0)},
      {"vdb_reader, memory", repose_scene_vdb_reader(scene.get(), nullptr, -1, 0)},
      {"vdb_reader, seconds", repose_scene_vdb_reader(scene.get(), nullptr, 0, -1)},
      {"seconds", repose_advance_seconds(e, -1, nullptr)},
      {"warning", repose_warning(e, 9999, room.text, 64, nullptr)},
      {"points_read, room", repose_points_read(p, "P", room.floats, 64)},
      {"points_read_half, room", repose_points_read_half(p, "P", room.halves, 64)},
      {"positions, room", repose_points_positions(p, room.numbers, 64)},
      {"ids, room", repose_points_ids(p, room.ids, 64)},
      {"set_info, index", repose_set_info(e, 1, &room.set)},
      {"channel, index", repose_channel(e, 0, 999, &room.view)},
      {"block_corners, room", repose_block_corners(e, room.numbers, 1, nullptr)},
      {"measurement, index", repose_measurement(e, 0, &room.measurement)},
      {"surface, smoothing", repose_surface_create(e, &surface, &room.volume)},
      {"fog, voxel", repose_fog_create(e, -1, &room.volume)},
      {"volume_read, room", repose_volume_read(fog.get(), "density", room.floats, 1)},
      {"add, name", repose_add_particles_with(e, "x", kPlaces, nullptr, 1, no_names, kValues, 1, nullptr)},
      {"add, values", repose_add_particles_with(e, "x", kPlaces, nullptr, 1, kChannels, no_values, 1, nullptr)},
      {"add, count", repose_add_particles(e, "x", kPlaces, nullptr, std::size_t{1} << 40, nullptr)},
  };
  for (const auto& [name, answer] : answers) EXPECT_EQ(answer, REPOSE_ERROR_ARGUMENT) << name;
}

/// Calls of functions with a struct as another version of the header would make it.
class OtherVersions {
 public:
  template <class Struct, class Ask>
  void expect_refused(const Argument& name, const Struct& right, const Ask& call) {
    asked_.insert(name);
    std::vector<Struct> wrong(3, right);
    wrong[0].version = REPOSE_STRUCT_VERSION + 1;
    wrong[1].version = 0;
    wrong[2].size -= 4;
    for (Struct& given : wrong) EXPECT_EQ(call(&given), REPOSE_ERROR_VERSION) << name;
  }
  const std::set<Argument>& asked() const { return asked_; }

 private:
  std::set<Argument> asked_;
};

TEST(ApiArguments, StructsOfAnotherVersion_AreRefusedWhereverTheHeadersHaveOne) {
  Engine engine = box_engine();
  const Scene scene = Scene::from_text(box_scene());
  const Volume fog = engine.fog();
  const repose_engine e = engine.get();
  const std::string text = box_scene();
  const std::uint64_t hash = engine.hash();
  OtherVersions others;
  others.expect_refused("repose_set_allocator/allocator", room.allocator,
                        [](const auto* given) { return repose_set_allocator(given); });
  others.expect_refused("repose_scene_from_text/options", room.scene_options, [&](const auto* given) {
    return repose_scene_from_text(text.c_str(), text.size(), nullptr, nullptr, given, &room.scene);
  });
  others.expect_refused("repose_scene_from_file/options", room.scene_options,
                        [&](const auto* given) { return repose_scene_from_file("x", given, &room.scene); });
  others.expect_refused("repose_scene_empty/options", room.scene_options,
                        [&](const auto* given) { return repose_scene_empty(nullptr, given, &room.scene); });
  others.expect_refused("repose_engine_create/options", room.engine_options, [&](const auto* given) {
    return repose_engine_create(scene.get(), given, &room.engine);
  });
  others.expect_refused("repose_points_create/options", room.points_options,
                        [&](const auto* given) { return repose_points_create(e, given, &room.points); });
  others.expect_refused("repose_surface_create/options", room.surface_options,
                        [&](const auto* given) { return repose_surface_create(e, given, &room.volume); });
  others.expect_refused("repose_advance_frame/report", room.report,
                        [&](auto* given) { return repose_advance_frame(e, given); });
  others.expect_refused("repose_advance_step/report", room.report,
                        [&](auto* given) { return repose_advance_step(e, given); });
  others.expect_refused("repose_advance_seconds/report", room.report,
                        [&](auto* given) { return repose_advance_seconds(e, 1, given); });
  others.expect_refused("repose_engine_info/info", room.info,
                        [&](auto* given) { return repose_engine_info(e, given); });
  others.expect_refused("repose_set_info/set", room.set,
                        [&](auto* given) { return repose_set_info(e, 0, given); });
  others.expect_refused("repose_channel/view", room.view,
                        [&](auto* given) { return repose_channel(e, 0, 0, given); });
  others.expect_refused("repose_channel_named/view", room.view,
                        [&](auto* given) { return repose_channel_named(e, 0, "id", given); });
  others.expect_refused("repose_measurement/measurement", room.measurement,
                        [&](auto* given) { return repose_measurement(e, 0, given); });
  others.expect_refused("repose_contact/contact", room.contact,
                        [&](auto* given) { return repose_contact(e, "floor", given); });
  others.expect_refused("repose_volume_lattice/lattice", room.lattice,
                        [&](auto* given) { return repose_volume_lattice(fog.get(), given); });
  EXPECT_EQ(engine.hash(), hash) << "refused before anything is done";

  const std::string header = header_text();
  std::string structs;
  const std::regex sized(R"(typedef struct (\w+) \{ uint32_t size;)");
  for (std::sregex_iterator it(header.begin(), header.end(), sized), end; it != end; ++it)
    structs += (structs.empty() ? "" : "|") + (*it)[1].str();
  const std::regex takes("(?:" + structs + R"()\* (\w+))");
  std::set<Argument> declared;
  for_each_function(header, [&](const std::string& name, const std::string& arguments) {
    for (std::sregex_iterator it(arguments.begin(), arguments.end(), takes), end; it != end; ++it)
      declared.insert(name + "/" + (*it)[1].str());
  });
  EXPECT_EQ(declared, others.asked());
}

}  // namespace
}  // namespace repose
