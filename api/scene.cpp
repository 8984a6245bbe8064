// Repose: scenes of the C API.
#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "api/objects.h"

namespace repose::api {

Registry<SceneObject>& scenes() {
  static Registry<SceneObject>* const kept =
      new Registry<SceneObject>(1);  // outlasts what ends with the process
  return *kept;
}

Result<Scene> SceneText::read() const {
  auto scene = read_scene_text(text, name, folder, options);
  if (!scene) return scene;
  auto& colliders = scene->effect<Colliders>().list;
  for (const auto& [collider, rate] : led) {
    const auto found = std::find_if(colliders.begin(), colliders.end(),
                                    [&, &wanted = collider](const Collider& c) { return c.name == wanted; });
    if (found == colliders.end()) {
      std::string names;
      for (const Collider& c : colliders) names += (names.empty() ? "\"" : ", \"") + c.name + "\"";
      return Error{ErrorKind::kUsage,
                   "no collider \"" + collider + "\" that a host could lead" +
                       (names.empty() ? "" : "; choose among " + names),
                   name};
    }
    found->lead = rate > 0.0 ? Lead::kMesh : Lead::kPose;
    found->lead_rate = rate;
  }
  return scene;
}

namespace {

repose_status read_options(const repose_scene_options* given, ReadOptions& options) {
  if (const repose_status known = check_optional(given, "options"); known != REPOSE_OK) return known;
  if (given == nullptr) return REPOSE_OK;
  switch (given->quality) {
    case REPOSE_QUALITY_STANDARD:
      options.quality = Quality::kStandard;
      break;
    case REPOSE_QUALITY_DRAFT:
      options.quality = Quality::kDraft;
      break;
    case REPOSE_QUALITY_REFERENCE:
      options.quality = Quality::kReference;
      break;
    default:
      return fail(REPOSE_ERROR_ARGUMENT, "is no REPOSE_QUALITY", "options.quality");
  }
  options.allow_outside_paths = given->allow_outside_paths != 0;
  return REPOSE_OK;
}

repose_status give(SceneText scene, bool whole, repose_scene* handle) {
  if (whole) {
    if (const auto read = scene.read(); !read) return fail(read.error());
  }
  auto object = std::make_shared<SceneObject>();
  object->scene = std::move(scene);
  handle->value = scenes().add(std::move(object));
  return REPOSE_OK;
}

/// Runs body(scene) on what the host has said of a scene.
template <class Body>
repose_status with_scene(repose_scene handle, const Body& body) noexcept {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<SceneObject> object = scenes().find(handle.value);
    if (object == nullptr) return no_handle("scene");
    const std::lock_guard<std::mutex> lock(object->mutex);
    return body(object->scene);
  });
}

}  // namespace
}  // namespace repose::api

using namespace repose;
using namespace repose::api;

repose_status repose_scene_from_file(const char* path, const repose_scene_options* options,
                                     repose_scene* scene) {
  return guarded([&]() -> repose_status {
    if (path == nullptr) return null_argument("path");
    if (scene == nullptr) return null_argument("scene");
    SceneText made;
    if (const repose_status known = read_options(options, made.options); known != REPOSE_OK) return known;
    if (const auto read = read_scene(path, made.options); !read) return fail(read.error());
    std::ostringstream text;
    text << std::ifstream(path, std::ios::binary).rdbuf();
    const std::string file = path;
    const std::size_t slash = file.rfind('/');
    made.text = text.str();
    made.name = file;
    made.folder = slash == std::string::npos ? "." : slash == 0 ? "/" : file.substr(0, slash);
    return give(std::move(made), true, scene);
  });
}

repose_status repose_scene_from_text(const char* text, size_t length, const char* name, const char* folder,
                                     const repose_scene_options* options, repose_scene* scene) {
  return guarded([&]() -> repose_status {
    if (text == nullptr) return null_argument("text");
    if (scene == nullptr) return null_argument("scene");
    SceneText made{{text, length}, name == nullptr ? "scene" : name, folder == nullptr ? "." : folder};
    if (const repose_status known = read_options(options, made.options); known != REPOSE_OK) return known;
    return give(std::move(made), true, scene);
  });
}

repose_status repose_scene_empty(const char* folder, const repose_scene_options* options, repose_scene* scene) {
  return guarded([&]() -> repose_status {
    if (scene == nullptr) return null_argument("scene");
    SceneText made{"{}", "scene", folder == nullptr ? "." : folder};
    if (const repose_status known = read_options(options, made.options); known != REPOSE_OK) return known;
    return give(std::move(made), false, scene);
  });
}

repose_status repose_scene_set(repose_scene handle, const char* key, const char* value) {
  return with_scene(handle, [&](SceneText& scene) -> repose_status {
    if (key == nullptr) return null_argument("key");
    if (value == nullptr) return null_argument("value");
    if (*key == '\0' || std::strchr(key, '=') != nullptr)
      return fail(REPOSE_ERROR_ARGUMENT, "is no path of a key, such as grid.spacing", "key");
    scene.options.overrides.push_back(std::string(key) + "=" + value);
    return REPOSE_OK;
  });
}

repose_status repose_scene_check(repose_scene handle) {
  return with_scene(handle, [](const SceneText& scene) -> repose_status {
    const auto read = scene.read();
    return read ? REPOSE_OK : fail(read.error());
  });
}

namespace {

repose_status lead(repose_scene handle, const char* collider, double rate) {
  return with_scene(handle, [&](SceneText& scene) -> repose_status {
    if (collider == nullptr) return null_argument("collider");
    for (auto& [name, before] : scene.led) {
      if (name != collider) continue;
      before = rate;
      return REPOSE_OK;
    }
    scene.led.emplace_back(collider, rate);
    return REPOSE_OK;
  });
}

}  // namespace

repose_status repose_scene_lead_pose(repose_scene scene, const char* collider) {
  return lead(scene, collider, 0.0);
}

repose_status repose_scene_lead_mesh(repose_scene scene, const char* collider, double rate) {
  return with_scene(scene,
                    [&](SceneText&) -> repose_status {
                      if (!(std::isfinite(rate) && rate > 0.0))
                        return fail(REPOSE_ERROR_ARGUMENT, "must be above 0, in 1/s", "rate");
                      return REPOSE_OK;
                    }) == REPOSE_OK
             ? lead(scene, collider, rate)
             : repose_error_status();
}

repose_status repose_scene_vdb_reader(repose_scene handle, const char* program, double memory, double seconds) {
  return with_scene(handle, [&](SceneText& scene) -> repose_status {
    if (!(std::isfinite(memory) && memory >= 0.0))
      return fail(REPOSE_ERROR_ARGUMENT, "must be a number of bytes, or 0", "memory");
    if (!(std::isfinite(seconds) && seconds >= 0.0))
      return fail(REPOSE_ERROR_ARGUMENT, "must be a number of seconds, or 0", "seconds");
    scene.vdb_reader = {program == nullptr ? "" : program, memory, seconds};
    return REPOSE_OK;
  });
}

repose_status repose_scene_json(repose_scene handle, char* buffer, size_t capacity, size_t* length) {
  return with_scene(handle, [&](const SceneText& scene) -> repose_status {
    if (buffer == nullptr && capacity > 0) return null_argument("buffer");
    const auto read = scene.read();
    if (!read) return fail(read.error());
    const std::size_t whole = copy_text(read->canonical, buffer, capacity);
    if (length != nullptr) *length = whole;
    return REPOSE_OK;
  });
}

repose_status repose_scene_destroy(repose_scene handle) {
  return guarded([&]() -> repose_status {
    return scenes().remove(handle.value) == nullptr ? no_handle("scene") : REPOSE_OK;
  });
}
