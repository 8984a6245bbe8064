// Repose: triangles of an outline turned about an axis. Each corner is a ring of vertices, or one vertex on the
// axis, so the surface is closed by construction and passes the same check as a mesh from a file.
#include "engine/geometry/revolved_surface.h"

#include <cmath>
#include <numbers>

namespace repose {

TriangleMesh revolve(const std::vector<Corner>& outline, const AxisFrame& frame, int sides) {
  TriangleMesh mesh;
  const Vec3 other = frame.axis.cross(frame.side);
  std::vector<std::int32_t> first;  // of each corner's ring
  for (const auto& [radius, height] : outline) {
    first.push_back(static_cast<std::int32_t>(mesh.vertices.size()));
    const int count = radius == 0 ? 1 : sides;
    for (int k = 0; k < count; ++k) {
      const double angle = 2 * std::numbers::pi * k / sides;
      const Vec3 outward = std::cos(angle) * frame.side + std::sin(angle) * other;
      mesh.vertices.push_back(frame.center + height * frame.axis + radius * outward);
    }
  }
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const std::size_t j = (i + 1) % outline.size();
    const bool low_on_axis = outline[i][0] == 0, high_on_axis = outline[j][0] == 0;
    for (int k = 0; k < sides; ++k) {
      const int next = (k + 1) % sides;
      const std::int32_t high = first[j] + (high_on_axis ? 0 : k);
      if (!low_on_axis) mesh.triangles.push_back({first[i] + k, first[i] + next, high});
      if (!high_on_axis) mesh.triangles.push_back({first[i] + (low_on_axis ? 0 : next), first[j] + next, high});
    }
  }
  return mesh;
}

}  // namespace repose
