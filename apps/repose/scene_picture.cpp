#include "apps/repose/scene_picture.h"

namespace repose {

std::vector<Grain> grains_of(const PointCloud& points) {
  const PointAttribute* material = nullptr;
  for (const PointAttribute& attribute : points.attributes) {
    if (attribute.name == "material") material = &attribute;
  }
  std::vector<Grain> grains(points.size());
  for (std::size_t p = 0; p < points.size(); ++p) {
    for (int axis = 0; axis < 3; ++axis) {
      grains[p].position[axis] = static_cast<float>(points.position[p][static_cast<std::size_t>(axis)]);
    }
    grains[p].radius = points.radius[p];
    grains[p].id = points.id[p];
    if (material != nullptr) grains[p].material = static_cast<std::uint8_t>(material->values[p]);
  }
  return grains;
}

std::vector<SolidMesh> draw_solids(const Scene& scene, const std::vector<Solid>& solids, double extent) {
  std::vector<SolidMesh> meshes;
  for (std::size_t k = 0; k < solids.size(); ++k) {
    const Collider& collider = scene.effect<Colliders>().list[k];
    if (collider.appearance == Appearance::kHidden) continue;
    const bool glass = collider.appearance == Appearance::kGlass ||
                       (collider.appearance == Appearance::kAuto && collider.hollow);
    const bool plane = collider.shape.type == ShapeDescription::Type::kPlane;
    SolidMesh mesh{solids[k].shape->surface(extent), glass, {}};
    if (!glass && !plane) mesh.color = {0.36f, 0.20f, 0.10f};  // warm wood, apart from sand and ground
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace repose
