// Repose: volumes of the C API: the surface of the material and its fog, as boxes of numbers.
#include <algorithm>
#include <cmath>
#include <string_view>

#include "api/objects.h"

namespace repose::api {

Registry<DenseVolume>& volumes() {
  static Registry<DenseVolume>* const kept = new Registry<DenseVolume>(4);
  return *kept;
}

namespace {

repose_status give(Result<DenseVolume> made, repose_volume* volume) {
  if (!made) return fail(made.error());
  volume->value = volumes().add(std::make_shared<DenseVolume>(std::move(*made)));
  return REPOSE_OK;
}

/// Runs body(volume) on a volume.
template <class Body>
repose_status with_volume(repose_volume handle, const Body& body) noexcept {
  return guarded([&]() -> repose_status {
    const std::shared_ptr<DenseVolume> object = volumes().find(handle.value);
    return object == nullptr ? no_handle("volume") : body(*object);
  });
}

bool is_length(double length) {
  return std::isfinite(length) && length >= 0.0;
}

}  // namespace
}  // namespace repose::api

using namespace repose;
using namespace repose::api;

repose_status repose_surface_create(repose_engine handle, const repose_surface_options* options,
                                    repose_volume* volume) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (volume == nullptr) return null_argument("volume");
    if (const repose_status known = check_optional(options, "options"); known != REPOSE_OK) return known;
    const repose_surface_options chosen = options == nullptr ? repose_surface_options_init() : *options;
    if (!is_length(chosen.voxel)) return fail(REPOSE_ERROR_ARGUMENT, "must be a length, or 0", "options.voxel");
    if (!is_length(chosen.radius))
      return fail(REPOSE_ERROR_ARGUMENT, "must be a length, or 0", "options.radius");
    if (chosen.smoothing > 100) return fail(REPOSE_ERROR_ARGUMENT, "must be at most 100", "options.smoothing");
    return give(engine.simulation->surface(chosen.voxel, chosen.radius, chosen.smoothing), volume);
  });
}

repose_status repose_fog_create(repose_engine handle, double voxel, repose_volume* volume) {
  return with_engine(handle, false, [&](const EngineObject& engine) -> repose_status {
    if (volume == nullptr) return null_argument("volume");
    if (!is_length(voxel)) return fail(REPOSE_ERROR_ARGUMENT, "must be a length, or 0", "voxel");
    return give(engine.simulation->fog(voxel), volume);
  });
}

repose_status repose_volume_destroy(repose_volume handle) {
  return guarded([&]() -> repose_status {
    return volumes().remove(handle.value) == nullptr ? no_handle("volume") : REPOSE_OK;
  });
}

repose_status repose_volume_lattice(repose_volume handle, repose_lattice* lattice) {
  return with_volume(handle, [&](const DenseVolume& volume) -> repose_status {
    if (const repose_status known = check(lattice, "lattice"); known != REPOSE_OK) return known;
    std::copy(volume.lower.begin(), volume.lower.end(), lattice->lower);
    std::copy(volume.voxel.begin(), volume.voxel.end(), lattice->voxel);
    std::copy(volume.count.begin(), volume.count.end(), lattice->count);
    return REPOSE_OK;
  });
}

repose_status repose_volume_read(repose_volume handle, const char* grid, float* values, size_t capacity) {
  return with_volume(handle, [&](const DenseVolume& volume) -> repose_status {
    if (grid == nullptr) return null_argument("grid");
    if (values == nullptr) return null_argument("values");
    std::string names;
    for (const DenseVolume::Grid& each : volume.grids) {
      names += (names.empty() ? "" : ", ") + each.name;
      if (each.name != std::string_view(grid)) continue;
      if (capacity < each.values.size()) return too_small(each.values.size());
      std::copy(each.values.begin(), each.values.end(), values);
      return REPOSE_OK;
    }
    return fail({ErrorKind::kUsage, "no such grid; this volume has " + names, grid});
  });
}
