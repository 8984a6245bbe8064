// Repose: copies of particles that the C API makes.
#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

#include "api/half.h"
#include "api/objects.h"
#include "engine/scene/attributes.h"

namespace repose::api {

Registry<PointsObject>& points() {
  static Registry<PointsObject>* const kept = new Registry<PointsObject>(3);
  return *kept;
}

namespace {

/// Names of the numbers that effects and hosts keep: "Cd" of "Cd.x", "Cd.y" and "Cd.z".
std::vector<std::string> kept_names(const Simulation& simulation) {
  static constexpr const char* kOwn[] = {"id", "position", "velocity", "affine", "strain"};
  std::vector<std::string> names;
  for (const SetView& set : simulation.sets()) {
    for (const ChannelView& channel : set.channels) {
      std::string name = channel.name.substr(0, channel.name.find('.'));
      const bool own = std::find(std::begin(kOwn), std::end(kOwn), name) != std::end(kOwn);
      if (!own && std::find(names.begin(), names.end(), name) == names.end()) names.push_back(std::move(name));
    }
  }
  return names;
}

/// "a,b, c" into what points are to carry. Returns the name that is unknown, or nothing.
std::string_view parse_attributes(std::string_view list, const std::vector<std::string>& kept,
                                  PointsWanted& wanted) {
  const auto add = [](auto& to, const auto& what) {
    if (std::find(to.begin(), to.end(), what) == to.end()) to.push_back(what);
  };
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view name = list.substr(0, comma);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    list.remove_prefix(std::min(comma + 1, list.size()));
    const auto* const known = std::find_if(std::begin(kOutputAttributes), std::end(kOutputAttributes),
                                           [&](const Choice& choice) { return choice.name == name; });
    if (known != std::end(kOutputAttributes)) {
      add(wanted.attributes, static_cast<OutputAttribute>(known - std::begin(kOutputAttributes)));
    } else if (std::find(kept.begin(), kept.end(), name) != kept.end()) {
      add(wanted.channels, std::string(name));
    } else {
      return name.empty() ? "(nothing)" : name;
    }
  }
  const auto& all = wanted.attributes;
  if (std::find(all.begin(), all.end(), OutputAttribute::kChannels) != all.end()) wanted.channels.clear();
  return {};
}

/// Runs body(points) on a copy of particles.
template <class Body>
repose_status with_points(repose_points handle, const Body& body) noexcept {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<PointsObject> object = points().find(handle.value);
    return object == nullptr ? no_handle("points") : body(*object);
  });
}

/// xx yy zz xy yz xz as the frame of the copy has them.
void turn_tensor(int turn, float* t) {
  if (turn == 0) return;
  std::swap(t[1], t[2]);
  std::swap(t[3], t[5]);
  t[turn > 0 ? 3 : 5] *= -1.0f;
  t[4] *= -1.0f;
}

/// x y z as the frame of the copy has them.
template <class Number>
void put_turned(const Number* from, int turn, Number* to) {
  to[0] = from[0];
  to[1] = turn == 0 ? from[1] : turn > 0 ? -from[2] : from[2];
  to[2] = turn == 0 ? from[2] : turn > 0 ? from[1] : -from[1];
}

/// L of the frame's x y z, by rows: its columns are turned, then its rows.
void turn_gradient(int turn, float* l) {
  float columns[9];
  for (int column = 0; column < 3; ++column) {
    const float from[3] = {l[column], l[3 + column], l[6 + column]};
    float to[3];
    put_turned(from, turn, to);
    for (int row = 0; row < 3; ++row) columns[3 * row + column] = to[row];
  }
  for (int row = 0; row < 3; ++row) put_turned(columns + 3 * row, turn, l + 3 * row);
}

repose_status unknown_attribute(const std::vector<std::string>& kept, std::string_view name) {
  std::string names;
  for (const Choice& known : kOutputAttributes) names += (names.empty() ? "" : ", ") + std::string(known.name);
  for (const std::string& each : kept) names += ", " + each;
  return fail({ErrorKind::kUsage, "no such attribute; choose among " + names, std::string(name)});
}

repose_status unknown_attribute(const PointsObject& object, std::string_view name) {
  std::string names = "P, v, pscale";
  if (!object.cloud.mass.empty()) names += ", mass";
  for (const PointAttribute& attribute : object.cloud.attributes) names += ", " + attribute.name;
  return fail({ErrorKind::kUsage, "no such attribute; this copy has " + names, std::string(name)});
}

/// Numbers per particle of an attribute; 0 where there is none of this name.
int components(const PointsObject& object, std::string_view name) {
  if (name == "P" || name == "v") return 3;
  if (name == "pscale" || (name == "mass" && !object.cloud.mass.empty())) return 1;
  for (const PointAttribute& attribute : object.cloud.attributes) {
    if (attribute.name == name) return attribute.components;
  }
  return 0;
}

void copy(const PointsObject& object, std::string_view name, float* values) {
  const PointCloud& cloud = object.cloud;
  if (name == "P" || name == "v") {
    for (std::size_t p = 0; p < cloud.size(); ++p) {
      float x[3];
      for (std::size_t axis = 0; axis < 3; ++axis)
        x[axis] = name == "P" ? static_cast<float>(cloud.position[p][axis]) : cloud.velocity[p][axis];
      put_turned(x, object.turn, values + 3 * p);
    }
    return;
  }
  const std::vector<float>* from = name == "pscale" ? &cloud.radius : &cloud.mass;
  for (const PointAttribute& attribute : cloud.attributes) {
    if (attribute.name == name) from = &attribute.values;
  }
  std::copy(from->begin(), from->end(), values);
  const bool tensor = name == "stress" || name == "elastic_strain";
  for (std::size_t p = 0; tensor && p < cloud.size(); ++p) turn_tensor(object.turn, values + 6 * p);
  for (std::size_t p = 0; name == "velocity_gradient" && p < cloud.size(); ++p)
    turn_gradient(object.turn, values + 9 * p);
}

/// Runs read(copy, count) where an attribute's `count` numbers have room.
template <class Read>
repose_status read_points(repose_points handle, const char* attribute, const void* values, std::size_t capacity,
                          const Read& read) noexcept {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (attribute == nullptr) return null_argument("attribute");
    if (values == nullptr) return null_argument("values");
    const std::size_t count = static_cast<std::size_t>(components(object, attribute)) * object.cloud.size();
    if (components(object, attribute) == 0) return unknown_attribute(object, attribute);
    if (capacity < count) return too_small(count);
    read(object, count);
    return REPOSE_OK;
  });
}

}  // namespace
}  // namespace repose::api

using namespace repose;
using namespace repose::api;

repose_status repose_points_create(repose_engine handle, const repose_points_options* options,
                                   repose_points* made) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (made == nullptr) return null_argument("points");
    if (const repose_status known = check_optional(options, "options"); known != REPOSE_OK) return known;
    PointsWanted wanted;
    auto object = std::make_shared<PointsObject>();
    if (options != nullptr) {
      if (options->attributes != nullptr) {
        const std::vector<std::string> kept = kept_names(*engine.simulation);
        const std::string_view unknown = parse_attributes(options->attributes, kept, wanted);
        if (!unknown.empty()) return unknown_attribute(kept, unknown);
        for (const OutputAttribute attribute : wanted.attributes) {
          const std::string lacks = engine.simulation->lacking(attribute);
          if (!lacks.empty()) return fail({ErrorKind::kUsage, lacks, "options.attributes"});
        }
      }
      if (options->up < REPOSE_UP_OF_SCENE || options->up > REPOSE_UP_Z)
        return fail(REPOSE_ERROR_ARGUMENT, "is no REPOSE_UP", "options.up");
      wanted.mass = options->mass != 0;
      const bool z_up = engine.simulation->z_up();
      if (options->up == REPOSE_UP_Z && !z_up) object->turn = 1;
      if (options->up == REPOSE_UP_Y && z_up) object->turn = -1;
    }
    object->cloud = engine.simulation->points(wanted);
    made->value = points().add(std::move(object));
    return REPOSE_OK;
  });
}

repose_status repose_points_destroy(repose_points handle) {
  return guarded([&]() -> repose_status {
    return points().remove(handle.value) == nullptr ? no_handle("points") : REPOSE_OK;
  });
}

repose_status repose_points_count(repose_points handle, size_t* count) {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (count == nullptr) return null_argument("count");
    *count = object.cloud.size();
    return REPOSE_OK;
  });
}

repose_status repose_points_components(repose_points handle, const char* attribute, int32_t* count) {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (attribute == nullptr) return null_argument("attribute");
    if (count == nullptr) return null_argument("components");
    *count = components(object, attribute);
    return *count > 0 ? REPOSE_OK : unknown_attribute(object, attribute);
  });
}

repose_status repose_points_read(repose_points handle, const char* attribute, float* values, size_t capacity) {
  return read_points(handle, attribute, values, capacity,
                     [&](const PointsObject& object, std::size_t) { copy(object, attribute, values); });
}

repose_status repose_points_read_half(repose_points handle, const char* attribute, uint16_t* values,
                                      size_t capacity) {
  return read_points(handle, attribute, values, capacity, [&](const PointsObject& object, std::size_t count) {
    std::vector<float> whole(count);
    copy(object, attribute, whole.data());
    std::transform(whole.begin(), whole.end(), values, half_of);
  });
}

repose_status repose_points_positions(repose_points handle, double* values, size_t capacity) {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (values == nullptr) return null_argument("values");
    if (capacity < 3 * object.cloud.size()) return too_small(3 * object.cloud.size());
    for (std::size_t p = 0; p < object.cloud.size(); ++p)
      put_turned(object.cloud.position[p].data(), object.turn, values + 3 * p);
    return REPOSE_OK;
  });
}

repose_status repose_points_ids(repose_points handle, uint32_t* ids, size_t capacity) {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (ids == nullptr) return null_argument("ids");
    if (capacity < object.cloud.size()) return too_small(object.cloud.size());
    std::copy(object.cloud.id.begin(), object.cloud.id.end(), ids);
    return REPOSE_OK;
  });
}

repose_status repose_points_write(repose_points handle, const char* path) {
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (path == nullptr) return null_argument("path");
    const std::string_view name = path;
    const auto write = name.ends_with(".vdb")   ? write_vdb_points
                       : name.ends_with(".ply") ? write_ply
                       : name.ends_with(".vtp") ? write_vtp
                                                : nullptr;
    if (write == nullptr) return fail({ErrorKind::kUsage, "must end in .vdb, .ply or .vtp", path});
    const auto written = write(object.cloud, path);
    return written ? REPOSE_OK : fail(written.error());
  });
}
