// Repose: the scene around an effect, while it makes itself ready.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/places.h"
#include "engine/effect/description.h"
#include "engine/effect/solid.h"
#include "engine/geometry/periodic_shape.h"
#include "engine/geometry/vdb_grid.h"

namespace repose {

struct Surroundings {
  double spacing = 0.0;  ///< dx, m
  int flat_axis = -1;    ///< of plane strain, or -1
  Vec3 up{0, 1, 0};
  Periods periods{};             ///< of the axes that repeat
  Index3 origin_cells{0, 0, 0};  ///< where the scene's origin lies in the lattice
  std::string folder;            ///< where relative paths start
  bool allow_outside_paths = false;
  VdbReader vdb_reader = {};
  std::vector<SetDescription> bodies;  ///< in the scene's order
  Places places;
  std::shared_ptr<KnownMeshes> meshes = std::make_shared<KnownMeshes>();

  // What effects furnish.
  Vec3 gravity{0, 0, 0};      ///< m/s^2, at its full value
  double gravity_ramp = 0.0;  ///< s, over which it grows linearly to that
  std::vector<Solid> solids;

  std::string where(const std::string& key) const { return places.where(key); }
  GridFiles grid_files() const { return {folder, allow_outside_paths, vdb_reader}; }

  /// Builds the shape that stands at a key, with its images where space repeats. Errors: 65, 66, with the key.
  Result<std::shared_ptr<const Shape>> shape(const ShapeDescription& description,
                                             const std::string& key) const {
    auto made = shape_alone(description, key);
    if (!made) return made;
    return in_periods(*made, periods);
  }
  /// The same without images.
  Result<std::shared_ptr<const Shape>> shape_alone(const ShapeDescription& description,
                                                   const std::string& key) const {
    auto made = make_shape(description, folder, spacing, allow_outside_paths, meshes.get());
    if (!made) return Error{made.error().kind, made.error().text(), where(key)};
    return *made;
  }

  const SetDescription* body(const std::string& name) const {
    for (const SetDescription& each : bodies) {
      if (each.name == name) return &each;
    }
    return nullptr;
  }
  /// What is said of a key that names no body.
  Error no_body(const std::string& name, const std::string& key) const {
    std::string names;
    for (const SetDescription& each : bodies) names += (names.empty() ? "\"" : ", \"") + each.name + "\"";
    return {ErrorKind::kBadScene, "no body \"" + name + "\"; choose among " + names, where(key)};
  }
};

}  // namespace repose
