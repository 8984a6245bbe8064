// Repose tests: every function of the C API that takes a handle, called as it should be.
#pragma once

#include <fstream>
#include <functional>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

#include "tests/api/api_rig.h"

namespace repose {

/// Handles of each kind, for calls that are otherwise right.
struct Handles {
  repose_scene scene;
  repose_engine engine;
  repose_points points;
  repose_volume volume;
};

struct Call {
  const char* name;
  std::function<repose_status(const Handles&)> call;
};

inline int write_nothing(void*, const void*, size_t) {
  return 0;
}

/// What calls write into.
struct Room {
  char text[64];
  double numbers[64];
  float floats[64];
  uint16_t halves[64];
  uint32_t ids[64];
  size_t size;
  uint64_t hash;
  uint32_t id;
  int32_t components;
  repose_scene scene;
  repose_engine engine;
  repose_points points;
  repose_volume volume;
  repose_report report = repose_report_init();
  repose_info info = repose_info_init();
  repose_set set = repose_set_init();
  repose_view view = repose_view_init();
  repose_measurement_info measurement = repose_measurement_info_init();
  repose_contact_info contact = repose_contact_info_init();
  repose_allocator allocator = repose_allocator_init();
  repose_scene_options scene_options = repose_scene_options_init();
  repose_engine_options engine_options = repose_engine_options_init();
  repose_points_options points_options = repose_points_options_init();
  repose_surface_options surface_options = repose_surface_options_init();
  repose_lattice lattice = repose_lattice_init();
};
inline Room room;

inline constexpr double kIdentity[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
inline constexpr double kPlaces[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
inline constexpr uint32_t kIds[1] = {0};
inline constexpr float kFloats[3] = {0, 0, 0};
inline constexpr const char* kChannels[1] = {"Cd"};
inline constexpr const float* kValues[1] = {kFloats};

/// Every function that takes a handle.
inline const std::vector<Call>& calls() {
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
      {"repose_points_read_half",
       [](const Handles& h) { return repose_points_read_half(h.points, "P", room.halves, 64); }},
      {"repose_points_write",
       [](const Handles& h) { return repose_points_write(h.points, "/nowhere/points.ply"); }},
      {"repose_surface_create",
       [](const Handles& h) { return repose_surface_create(h.engine, nullptr, &room.volume); }},
      {"repose_fog_create", [](const Handles& h) { return repose_fog_create(h.engine, 0, &room.volume); }},
      {"repose_volume_destroy", [](const Handles& h) { return repose_volume_destroy(h.volume); }},
      {"repose_volume_lattice",
       [](const Handles& h) { return repose_volume_lattice(h.volume, &room.lattice); }},
      {"repose_volume_read",
       [](const Handles& h) { return repose_volume_read(h.volume, "surface", room.floats, 64); }},
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
      {"repose_add_particles_with",
       [](const Handles& h) {
         return repose_add_particles_with(h.engine, "x", kPlaces, nullptr, 1, kChannels, kValues, 1, &room.id);
       }},
      {"repose_channel_components",
       [](const Handles& h) { return repose_channel_components(h.engine, "Cd", &room.components); }},
      {"repose_set_values",
       [](const Handles& h) { return repose_set_values(h.engine, "Cd", kIds, kFloats, 1, &room.size); }},
      {"repose_drive_collider",
       [](const Handles& h) { return repose_drive_collider(h.engine, "floor", kPlaces, nullptr, nullptr); }},
      {"repose_remove_particles",
       [](const Handles& h) { return repose_remove_particles(h.engine, kIds, 1, &room.size); }},
  };
  return list;
}

/// The headers of the C API without comments and line ends.
inline std::string header_text() {
  std::stringstream text;
  for (const auto& entry : std::filesystem::directory_iterator(REPOSE_HEADERS)) {
    if (entry.path().extension() == ".h") text << std::ifstream(entry.path()).rdbuf();
  }
  const std::string plain = std::regex_replace(text.str(), std::regex(R"(/\*[^*]*\*+([^/*][^*]*\*+)*/)"), " ");
  return std::regex_replace(plain, std::regex("\\s+"), " ");
}

/// Calls visit(name, arguments) for each function that returns a status.
template <class Visit>
void for_each_function(const std::string& header, const Visit& visit) {
  const std::regex declaration(R"(REPOSE_API repose_status (repose_\w+)\(([^;]*)\);)");
  for (std::sregex_iterator it(header.begin(), header.end(), declaration), end; it != end; ++it)
    visit((*it)[1].str(), (*it)[2].str());
}

}  // namespace repose
