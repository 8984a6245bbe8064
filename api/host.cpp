// Repose: what a host does through the C API between calls that advance: colliders that it leads, particles
// that it begins and ends.
#include <optional>
#include <vector>

#include "api/objects.h"

using namespace repose;
using namespace repose::api;

repose_status repose_move_collider(repose_engine handle, const char* collider, const double matrix[16],
                                   double seconds) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (collider == nullptr) return null_argument("collider");
    if (matrix == nullptr) return null_argument("matrix");
    if (matrix[3] != 0.0 || matrix[7] != 0.0 || matrix[11] != 0.0 || matrix[15] != 1.0)
      return fail(
          {ErrorKind::kUsage,
           "needs a matrix of a rotation and a translation: entries 3, 7, 11 are 0 and 15 is 1, and the "
           "translation is in 12, 13, 14",
           collider});
    Pose pose;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) pose.rotation[row][column] = matrix[4 * column + row];
      pose.translation[row] = matrix[12 + row];
    }
    const auto moved = engine.simulation->move_solid(collider, pose, seconds);
    return moved ? REPOSE_OK : fail(moved.error());
  });
}

repose_status repose_deform_collider(repose_engine handle, const char* collider, const double* vertices,
                                     size_t vertex_count, const int32_t* triangles, size_t triangle_count,
                                     int32_t at_once) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (collider == nullptr) return null_argument("collider");
    if (vertices == nullptr) return null_argument("vertices");
    if (triangles == nullptr) triangle_count = 0;
    if (vertex_count > (std::size_t{1} << 31) || triangle_count > (std::size_t{1} << 31))
      return fail(REPOSE_ERROR_ARGUMENT, "is more than a mesh can have", "vertex_count");
    const auto deformed = engine.simulation->deform_solid(collider, {vertices, 3 * vertex_count},
                                                          {triangles, 3 * triangle_count}, at_once != 0);
    return deformed ? REPOSE_OK : fail(deformed.error());
  });
}

repose_status repose_contact(repose_engine handle, const char* collider, repose_contact_info* contact) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (collider == nullptr) return null_argument("collider");
    if (const repose_status known = check(contact, "contact"); known != REPOSE_OK) return known;
    const auto figures = engine.simulation->contact(collider);
    if (!figures) return fail(figures.error());
    contact->seconds = figures->seconds;
    contact->power = figures->power;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      contact->force[axis] = figures->force[axis];
      contact->moment[axis] = figures->moment[axis];
    }
    return REPOSE_OK;
  });
}

repose_status repose_drive_collider(repose_engine handle, const char* collider, const double* velocity,
                                    const double* spin, const double* center) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (collider == nullptr) return null_argument("collider");
    std::optional<SurfaceVelocity> surface;
    if (velocity != nullptr) {
      surface.emplace();
      for (std::size_t axis = 0; axis < 3; ++axis) {
        surface->velocity[axis] = velocity[axis];
        surface->spin[axis] = spin == nullptr ? 0.0 : spin[axis];
        surface->center[axis] = center == nullptr ? 0.0 : center[axis];
      }
    }
    const auto driven = engine.simulation->drive_solid(collider, surface);
    return driven ? REPOSE_OK : fail(driven.error());
  });
}

repose_status repose_add_particles(repose_engine handle, const char* emitter, const double* positions,
                                   const float* velocities, size_t count, uint32_t* first_id) {
  return repose_add_particles_with(handle, emitter, positions, velocities, count, nullptr, nullptr, 0,
                                   first_id);
}

namespace {

/// More would have no ids.
constexpr std::size_t kMostAdded = 4'000'000'000;

repose_status too_many() {
  return fail(REPOSE_ERROR_ARGUMENT, "is more than can be told apart, 4e9", "count");
}

}  // namespace

repose_status repose_add_particles_with(repose_engine handle, const char* emitter, const double* positions,
                                        const float* velocities, size_t count, const char* const* channels,
                                        const float* const* values, size_t channel_count, uint32_t* first_id) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (emitter == nullptr) return null_argument("emitter");
    if (positions == nullptr) return null_argument("positions");
    if (channel_count > 0 && channels == nullptr) return null_argument("channels");
    if (channel_count > 0 && values == nullptr) return null_argument("values");
    if (count > kMostAdded) return too_many();
    std::vector<ChannelValues> kept;
    for (std::size_t k = 0; k < channel_count; ++k) {
      if (channels[k] == nullptr) return null_argument("channels");
      if (values[k] == nullptr) return null_argument("values");
      const std::size_t components = engine.simulation->channel_components(channels[k]);
      kept.push_back({channels[k], {values[k], components * count}});
    }
    const std::size_t numbers = velocities == nullptr ? 0 : 3 * count;
    const auto first =
        engine.simulation->add_particles(emitter, {positions, 3 * count}, {velocities, numbers}, kept);
    if (!first) return fail(first.error());
    if (first_id != nullptr) *first_id = *first;
    return REPOSE_OK;
  });
}

repose_status repose_channel_components(repose_engine handle, const char* channel, int32_t* components) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (channel == nullptr) return null_argument("channel");
    if (components == nullptr) return null_argument("components");
    *components = static_cast<std::int32_t>(engine.simulation->channel_components(channel));
    if (*components > 0) return REPOSE_OK;
    return fail({ErrorKind::kUsage, "no such channel in the scene's \"channels\"", channel});
  });
}

repose_status repose_set_values(repose_engine handle, const char* channel, const uint32_t* ids,
                                const float* values, size_t count, size_t* found) {
  return with_engine(handle, false, [&](EngineObject& engine) -> repose_status {
    if (channel == nullptr) return null_argument("channel");
    if (ids == nullptr) return null_argument("ids");
    if (values == nullptr) return null_argument("values");
    if (count > kMostAdded) return too_many();
    const std::size_t components = engine.simulation->channel_components(channel);
    const auto set = engine.simulation->set_values({channel, {values, components * count}}, {ids, count});
    if (!set) return fail(set.error());
    if (found != nullptr) *found = *set;
    return REPOSE_OK;
  });
}

repose_status repose_remove_particles(repose_engine handle, const uint32_t* ids, size_t count,
                                      size_t* removed) {
  return with_engine(handle, true, [&](EngineObject& engine) -> repose_status {
    if (ids == nullptr) return null_argument("ids");
    const auto gone = engine.simulation->remove_particles({ids, count});
    if (!gone) return fail(gone.error());
    if (removed != nullptr) *removed = *gone;
    return REPOSE_OK;
  });
}
