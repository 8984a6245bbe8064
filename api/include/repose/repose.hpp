/**
 * @file repose.hpp
 * Repose for C++17: handles that destroy themselves, exceptions for errors, vectors and spans for arrays. It
 * stands on repose.h alone, which says what each function does, its units and its errors; nothing of it is in
 * the library. Objects can be moved and not copied. What a callback throws comes out of the call that it
 * belongs to.
 */
#ifndef REPOSE_REPOSE_HPP
#define REPOSE_REPOSE_HPP

#include <array>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "repose_base.hpp"
#include "repose_reading.hpp"

namespace repose {
// Names apart from those of the engine, which the static library holds.
inline namespace host_1 {

/** A scene being put together. */
class Scene {
 public:
  static Scene from_file(const std::string& path,
                         const repose_scene_options& options = repose_scene_options_init()) {
    repose_scene handle{0};
    detail::check(repose_scene_from_file(path.c_str(), &options, &handle));
    return Scene(handle);
  }
  static Scene from_text(std::string_view text, const std::string& folder = ".",
                         const std::string& name = "scene",
                         const repose_scene_options& options = repose_scene_options_init()) {
    repose_scene handle{0};
    detail::check(
        repose_scene_from_text(text.data(), text.size(), name.c_str(), folder.c_str(), &options, &handle));
    return Scene(handle);
  }
  static Scene empty(const std::string& folder = ".",
                     const repose_scene_options& options = repose_scene_options_init()) {
    repose_scene handle{0};
    detail::check(repose_scene_empty(folder.c_str(), &options, &handle));
    return Scene(handle);
  }

  Scene& set(const std::string& key, const std::string& json) {
    detail::check(repose_scene_set(get(), key.c_str(), json.c_str()));
    return *this;
  }
  void check() const { detail::check(repose_scene_check(get())); }
  Scene& lead_pose(const std::string& collider) {
    detail::check(repose_scene_lead_pose(get(), collider.c_str()));
    return *this;
  }
  Scene& lead_mesh(const std::string& collider, double rate) {
    detail::check(repose_scene_lead_mesh(get(), collider.c_str(), rate));
    return *this;
  }
  /// An empty path and 0 are defaults.
  Scene& vdb_reader(const std::string& program, double memory = 0.0, double seconds = 0.0) {
    detail::check(repose_scene_vdb_reader(get(), program.empty() ? nullptr : program.c_str(), memory, seconds));
    return *this;
  }
  std::string json() const {
    std::size_t length = 0;
    detail::check(repose_scene_json(get(), nullptr, 0, &length));
    std::string text(length, '\0');
    detail::check(repose_scene_json(get(), text.data(), length + 1, nullptr));
    return text;
  }
  repose_scene get() const { return handle_.get(); }

 private:
  explicit Scene(repose_scene handle) : handle_(handle) {}
  detail::Owned<repose_scene, repose_scene_destroy> handle_;
};

/** A probe's figure. */
struct Measurement {
  std::string probe, quantity, unit;
  double value = 0.0;
};

/** A simulation. */
class Engine {
 public:
  using Log = std::function<void(int level, const char* message)>;
  /** Returns whether to go on. */
  using Progress = std::function<bool(const repose_progress&)>;

  explicit Engine(const Scene& scene, repose_engine_options options = repose_engine_options_init(),
                  Log log = {})
      : callbacks_(std::make_unique<Callbacks>()) {
    if (log) {
      callbacks_->log = std::move(log);
      options.log = &Callbacks::told;
      options.log_user = callbacks_.get();
    }
    repose_engine handle{0};
    const repose_status status = repose_engine_create(scene.get(), &options, &handle);
    handle_ = detail::Owned<repose_engine, repose_engine_destroy>(handle);
    finish(status);
  }

  repose_report advance_frame() { return advance(repose_advance_frame); }
  repose_report advance_step() { return advance(repose_advance_step); }
  repose_report advance_seconds(double seconds) {
    return advance([seconds](repose_engine engine, repose_report* report) {
      return repose_advance_seconds(engine, seconds, report);
    });
  }
  /** From any thread. */
  void interrupt() { detail::check(repose_interrupt(get())); }
  void on_progress(Progress progress) {
    callbacks_->progress = std::move(progress);
    const bool any = static_cast<bool>(callbacks_->progress);
    detail::check(repose_set_progress(get(), any ? &Callbacks::stepped : nullptr, callbacks_.get()));
  }

  repose_info info() const {
    repose_info info = repose_info_init();
    detail::check(repose_engine_info(get(), &info));
    return info;
  }
  std::uint64_t hash() const {
    std::uint64_t hash = 0;
    detail::check(repose_hash(get(), &hash));
    return hash;
  }
  std::vector<std::string> warnings() const {
    std::size_t count = 0;
    detail::check(repose_warning_count(get(), &count));
    std::vector<std::string> warnings;
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t length = 0;
      detail::check(repose_warning(get(), k, nullptr, 0, &length));
      warnings.emplace_back(length, '\0');
      detail::check(repose_warning(get(), k, warnings.back().data(), length + 1, nullptr));
    }
    return warnings;
  }
  void change(const std::string& key, const std::string& json) {
    detail::check(repose_change(get(), key.c_str(), json.c_str()));
  }

  void save(const std::string& path) const { detail::check(repose_state_save(get(), path.c_str())); }
  void load(const std::string& path) { detail::check(repose_state_load(get(), path.c_str())); }
  std::vector<std::byte> save() const {
    std::vector<std::byte> bytes;
    detail::check(repose_state_write(get(), &append, &bytes));
    return bytes;
  }
  void load(Span<const std::byte> bytes) {
    detail::check(repose_state_read(get(), bytes.data(), bytes.size()));
  }

  Points points(const repose_points_options& options = repose_points_options_init()) const {
    repose_points handle{0};
    detail::check(repose_points_create(get(), &options, &handle));
    return Points(handle);
  }
  Volume surface(const repose_surface_options& options = repose_surface_options_init()) const {
    repose_volume handle{0};
    detail::check(repose_surface_create(get(), &options, &handle));
    return Volume(handle);
  }
  Volume fog(double voxel = 0.0) const {
    repose_volume handle{0};
    detail::check(repose_fog_create(get(), voxel, &handle));
    return Volume(handle);
  }
  std::size_t set_count() const {
    std::size_t count = 0;
    detail::check(repose_set_count(get(), &count));
    return count;
  }
  repose_set set(std::size_t index) const {
    repose_set set = repose_set_init();
    detail::check(repose_set_info(get(), index, &set));
    return set;
  }
  /** Where the numbers of a channel lie, until the next call that advances, loads, changes, adds or removes. */
  template <class T>
  Span<const T> view(std::size_t set, const std::string& channel) const {
    repose_view view = repose_view_init();
    detail::check(repose_channel_named(get(), set, channel.c_str(), &view));
    if (view.type != detail::ElementType<T>::value)
      throw Error(REPOSE_ERROR_USAGE, channel + ": has numbers of another type", channel, "");
    return {static_cast<const T*>(view.data), static_cast<std::size_t>(view.count)};
  }
  bool is_current(std::uint64_t generation) const { return repose_view_check(get(), generation) == REPOSE_OK; }
  std::vector<std::array<double, 3>> block_corners() const {
    std::size_t count = 0;
    detail::check(repose_block_corners(get(), nullptr, 0, &count));
    std::vector<std::array<double, 3>> corners(count + 1);
    detail::check(repose_block_corners(get(), corners[0].data(), 3 * count, &count));
    corners.pop_back();
    return corners;
  }
  std::vector<Measurement> measurements() const {
    std::size_t count = 0;
    detail::check(repose_measurement_count(get(), &count));
    std::vector<Measurement> list;
    for (std::size_t k = 0; k < count; ++k) {
      repose_measurement_info info = repose_measurement_info_init();
      detail::check(repose_measurement(get(), k, &info));
      list.push_back({info.probe, info.quantity, info.unit, info.value});
    }
    return list;
  }

  void move_collider(const std::string& collider, const std::array<double, 16>& matrix, double seconds) {
    detail::check(repose_move_collider(get(), collider.c_str(), matrix.data(), seconds));
  }
  /** How its surface moves; about an axis through `center`. */
  void drive_collider(const std::string& collider, const std::array<double, 3>& velocity,
                      const std::array<double, 3>& spin = {}, const std::array<double, 3>& center = {}) {
    detail::check(repose_drive_collider(get(), collider.c_str(), velocity.data(), spin.data(), center.data()));
  }
  /** By its poses again. */
  void release_collider(const std::string& collider) {
    detail::check(repose_drive_collider(get(), collider.c_str(), nullptr, nullptr, nullptr));
  }
  void deform_collider(const std::string& collider, Span<const double> vertices,
                       Span<const std::int32_t> triangles = {}, bool at_once = false) {
    detail::check(repose_deform_collider(get(), collider.c_str(), vertices.data(), vertices.size() / 3,
                                         triangles.data(), triangles.size() / 3, at_once ? 1 : 0));
  }
  repose_contact_info contact(const std::string& collider) const {
    repose_contact_info contact = repose_contact_info_init();
    detail::check(repose_contact(get(), collider.c_str(), &contact));
    return contact;
  }
  /** Numbers of the scene's "channels", by name, particle by particle. */
  using Values = std::vector<std::pair<std::string, Span<const float>>>;
  /** Returns the id of the first; `velocities` may be empty. */
  std::uint32_t add_particles(const std::string& emitter, Span<const double> positions,
                              Span<const float> velocities = {}, const Values& values = {}) {
    const std::size_t count = positions.size() / 3;
    if (!velocities.empty() && velocities.size() != positions.size())
      throw Error(REPOSE_ERROR_ARGUMENT, "velocities: as many numbers as positions are needed", "velocities",
                  "");
    std::vector<const char*> channels;
    std::vector<const float*> numbers;
    for (const auto& [channel, of] : values) {
      check_size(channel, of, count);
      channels.push_back(channel.c_str());
      numbers.push_back(of.data());
    }
    std::uint32_t first = 0;
    detail::check(repose_add_particles_with(get(), emitter.c_str(), positions.data(), velocities.data(), count,
                                            channels.data(), numbers.data(), channels.size(), &first));
    return first;
  }
  /** Returns how many of the ids there were. */
  std::size_t set_values(const std::string& channel, Span<const std::uint32_t> ids, Span<const float> values) {
    std::size_t found = 0;
    check_size(channel, values, ids.size());
    detail::check(repose_set_values(get(), channel.c_str(), ids.data(), values.data(), ids.size(), &found));
    return found;
  }
  std::size_t remove_particles(Span<const std::uint32_t> ids) {
    std::size_t removed = 0;
    detail::check(repose_remove_particles(get(), ids.data(), ids.size(), &removed));
    return removed;
  }
  repose_engine get() const { return handle_.get(); }

 private:
  struct Callbacks {
    Log log;
    Progress progress;
    std::exception_ptr thrown;

    static void told(void* user, std::int32_t level, const char* message) {
      auto& self = *static_cast<Callbacks*>(user);
      try {
        self.log(level, message);
      } catch (...) {
        self.thrown = std::current_exception();
      }
    }
    static int stepped(void* user, const repose_progress* progress) {
      auto& self = *static_cast<Callbacks*>(user);
      try {
        return self.progress(*progress) ? 0 : 1;
      } catch (...) {
        self.thrown = std::current_exception();
        return 1;
      }
    }
  };

  static int append(void* user, const void* data, std::size_t bytes) {
    auto& all = *static_cast<std::vector<std::byte>*>(user);
    try {
      const auto* const begin = static_cast<const std::byte*>(data);
      all.insert(all.end(), begin, begin + bytes);
      return 0;
    } catch (...) {
      return 1;
    }
  }

  /** As the library cannot see how many numbers there are. */
  void check_size(const std::string& channel, Span<const float> values, std::size_t particles) const {
    std::int32_t components = 0;
    detail::check(repose_channel_components(get(), channel.c_str(), &components));
    if (values.size() == particles * static_cast<std::size_t>(components)) return;
    throw Error(REPOSE_ERROR_ARGUMENT,
                channel + ": has " + std::to_string(components) + " numbers per particle", channel, "");
  }
  void finish(repose_status status) {
    if (callbacks_->thrown) std::rethrow_exception(std::exchange(callbacks_->thrown, nullptr));
    detail::check(status);
  }
  template <class Call>
  repose_report advance(const Call& call) {
    repose_report report = repose_report_init();
    finish(call(get(), &report));
    return report;
  }

  std::unique_ptr<Callbacks> callbacks_;  // outlives the engine, which may call them
  detail::Owned<repose_engine, repose_engine_destroy> handle_;
};

}  // namespace host_1
}  // namespace repose

#endif
