// Repose: what the C API reads of particles, blocks and probes: copies, and views of where numbers lie.
#include <algorithm>
#include <cstring>
#include <string_view>

#include "api/objects.h"
#include "engine/scene/scene.h"

namespace repose::api {

Registry<PointsObject>& points() {
  static Registry<PointsObject>* const kept = new Registry<PointsObject>(3);
  return *kept;
}

const std::vector<SetView>& EngineObject::views() {
  const std::uint64_t now = generation.load();
  if (sets_of != now) {
    sets = simulation->sets();
    sets_of = now;
  }
  return sets;
}

namespace {

struct KnownAttribute {
  std::string_view name;
  OutputAttribute attribute;
};
constexpr KnownAttribute kKnownAttributes[] = {
    {"stress", OutputAttribute::kStress},
    {"pressure", OutputAttribute::kPressure},
    {"density", OutputAttribute::kDensity},
    {"elastic_strain", OutputAttribute::kElasticStrain},
    {"speed", OutputAttribute::kSpeed},
    {"age", OutputAttribute::kAge},
    {"channels", OutputAttribute::kChannels},
    {"shear_rate", OutputAttribute::kShearRate},
    {"inertial_number", OutputAttribute::kInertialNumber},
    {"plastic_strain", OutputAttribute::kPlasticStrain},
    {"velocity_gradient", OutputAttribute::kVelocityGradient},
};

/// "a,b, c" into what points are to carry. Returns the name that is unknown, or nothing.
std::string_view parse_attributes(std::string_view list, PointsWanted& wanted) {
  while (!list.empty()) {
    const std::size_t comma = std::min(list.find(','), list.size());
    std::string_view name = list.substr(0, comma);
    while (!name.empty() && name.front() == ' ') name.remove_prefix(1);
    while (!name.empty() && name.back() == ' ') name.remove_suffix(1);
    list.remove_prefix(std::min(comma + 1, list.size()));
    const auto* const end = std::end(kKnownAttributes);
    const auto* const known = std::find_if(std::begin(kKnownAttributes), end,
                                           [&](const KnownAttribute& k) { return k.name == name; });
    if (known == end) return name.empty() ? "(nothing)" : name;
    if (std::find(wanted.attributes.begin(), wanted.attributes.end(), known->attribute) ==
        wanted.attributes.end())
      wanted.attributes.push_back(known->attribute);
  }
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

/// x y z as the frame of the copy has them.
template <class Number>
void put_turned(const Number* from, int turn, Number* to) {
  to[0] = from[0];
  to[1] = turn == 0 ? from[1] : turn > 0 ? -from[2] : from[2];
  to[2] = turn == 0 ? from[2] : turn > 0 ? from[1] : -from[1];
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
}

repose_status too_small(std::size_t needed) {
  return fail({static_cast<ErrorKind>(REPOSE_ERROR_ARGUMENT),
               "too little room: " + std::to_string(needed) + " numbers are to be copied", "capacity"});
}

void fill(const ChannelView& channel, const SetView& set, std::uint64_t generation, repose_view& view) {
  view.name = channel.name.c_str();
  view.data = channel.data;
  view.count = set.count;
  view.generation = generation;
  view.type = channel.type == ChannelView::Type::kFloat    ? REPOSE_FLOAT
              : channel.type == ChannelView::Type::kDouble ? REPOSE_DOUBLE
                                                           : REPOSE_UINT32;
  view.reserved = 0;
}

/// Runs body(set) on a set of an engine.
template <class Body>
repose_status with_set(repose_engine handle, size_t index, const Body& body) noexcept {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    const auto& sets = engine.views();
    if (index >= sets.size()) return fail(REPOSE_ERROR_ARGUMENT, "there is no such set", "set");
    return body(sets[index], engine.sets_of);
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
        const std::string_view unknown = parse_attributes(options->attributes, wanted);
        if (!unknown.empty())
          return fail({ErrorKind::kUsage,
                       "no such attribute; choose among stress, pressure, elastic_strain, density, speed, age, "
                       "shear_rate, inertial_number, plastic_strain, velocity_gradient, channels",
                       std::string(unknown)});
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
  return with_points(handle, [&](const PointsObject& object) -> repose_status {
    if (attribute == nullptr) return null_argument("attribute");
    if (values == nullptr) return null_argument("values");
    const int per_particle = components(object, attribute);
    if (per_particle == 0) return unknown_attribute(object, attribute);
    const std::size_t needed = static_cast<std::size_t>(per_particle) * object.cloud.size();
    if (capacity < needed) return too_small(needed);
    copy(object, attribute, values);
    return REPOSE_OK;
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

repose_status repose_set_count(repose_engine handle, size_t* count) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (count == nullptr) return null_argument("count");
    *count = engine.views().size();
    return REPOSE_OK;
  });
}

repose_status repose_set_info(repose_engine handle, size_t index, repose_set* info) {
  return with_set(handle, index, [&](const SetView& set, std::uint64_t generation) -> repose_status {
    if (const repose_status known = check(info, "set"); known != REPOSE_OK) return known;
    info->name = set.name.c_str();
    info->material = set.material.c_str();
    info->particle_mass = set.particle_mass;
    info->particle_volume = set.particle_volume;
    info->count = set.count;
    info->channels = set.channels.size();
    info->begin = set.begin;
    info->blocks = set.blocks;
    info->generation = generation;
    return REPOSE_OK;
  });
}

repose_status repose_channel(repose_engine handle, size_t set, size_t index, repose_view* view) {
  return with_set(handle, set, [&](const SetView& of, std::uint64_t generation) -> repose_status {
    if (const repose_status known = check(view, "view"); known != REPOSE_OK) return known;
    if (index >= of.channels.size()) return fail(REPOSE_ERROR_ARGUMENT, "there is no such channel", "index");
    fill(of.channels[index], of, generation, *view);
    return REPOSE_OK;
  });
}

repose_status repose_channel_named(repose_engine handle, size_t set, const char* name, repose_view* view) {
  return with_set(handle, set, [&](const SetView& of, std::uint64_t generation) -> repose_status {
    if (name == nullptr) return null_argument("name");
    if (const repose_status known = check(view, "view"); known != REPOSE_OK) return known;
    std::string names;
    for (const ChannelView& channel : of.channels) {
      if (channel.name == name) {
        fill(channel, of, generation, *view);
        return REPOSE_OK;
      }
      names += (names.empty() ? "" : ", ") + channel.name;
    }
    return fail({ErrorKind::kUsage, "no such channel; this set has " + names, name});
  });
}

repose_status repose_view_check(repose_engine handle, uint64_t generation) {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<EngineObject> engine = engines().find(handle.value);
    if (engine == nullptr) return no_handle("engine");
    if (engine->generation.load() == generation) return REPOSE_OK;
    return fail(REPOSE_ERROR_STALE, "the engine has gone on since the view was made; make it anew",
                "generation");
  });
}

repose_status repose_block_corners(repose_engine handle, double* corners, size_t capacity, size_t* count) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (count == nullptr && corners == nullptr) return null_argument("count");
    const std::vector<Triple> all = engine.simulation->block_corners();
    if (count != nullptr) *count = all.size();
    if (corners == nullptr) return REPOSE_OK;
    if (capacity < 3 * all.size()) return too_small(3 * all.size());
    for (std::size_t b = 0; b < all.size(); ++b) std::copy(all[b].begin(), all[b].end(), corners + 3 * b);
    return REPOSE_OK;
  });
}

repose_status repose_measurement_count(repose_engine handle, size_t* count) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (count == nullptr) return null_argument("count");
    engine.measurements = engine.simulation->measurements();
    *count = engine.measurements.size();
    return REPOSE_OK;
  });
}

repose_status repose_measurement(repose_engine handle, size_t index, repose_measurement_info* measurement) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (const repose_status known = check(measurement, "measurement"); known != REPOSE_OK) return known;
    engine.measurements = engine.simulation->measurements();
    if (index >= engine.measurements.size())
      return fail(REPOSE_ERROR_ARGUMENT, "there is no such measurement", "index");
    const Measurement& of = engine.measurements[index];
    measurement->probe = of.probe.c_str();
    measurement->quantity = of.quantity.c_str();
    measurement->unit = of.unit.c_str();
    measurement->value = of.value;
    return REPOSE_OK;
  });
}
