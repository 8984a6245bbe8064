// Repose: the check that a mesh is closed. Each triangle lends its three edges; sorted by their ends, the two
// uses of an edge lie side by side and must run in opposite directions. That is all that inside and outside
// need.
#include "engine/geometry/mesh_solid.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace repose {
namespace {

struct Use {
  std::int32_t low;
  std::int32_t high;
  bool forward;  ///< runs from low to high

  bool same_edge(const Use& other) const { return low == other.low && high == other.high; }
};

struct Fault {
  std::size_t count = 0;
  std::int32_t vertex = 0;

  void note(const Use& use) {
    if (count++ == 0) vertex = use.low;
  }
};

std::string place(const TriangleMesh& mesh, std::int32_t index) {
  const Vec3& v = mesh.vertices[index];
  return "vertex " + std::to_string(index) + " (" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
         std::to_string(v[2]) + ")";
}

/// Joins vertices that lie in the same place, as files that split them at seams have. The first of each stays.
TriangleMesh weld(const TriangleMesh& mesh) {
  std::vector<std::int32_t> order(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  const auto key = [&](std::int32_t i) {
    const Vec3& v = mesh.vertices[i];
    return std::array<double, 3>{v[0], v[1], v[2]};
  };
  std::sort(order.begin(), order.end(), [&](std::int32_t a, std::int32_t b) {
    const auto ka = key(a), kb = key(b);
    return ka != kb ? ka < kb : a < b;
  });
  std::vector<std::int32_t> stays(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) {
    const bool repeats = k > 0 && key(order[k]) == key(order[k - 1]);
    stays[order[k]] = repeats ? stays[order[k - 1]] : order[k];
  }
  TriangleMesh welded{mesh.vertices, {}};
  for (const Index3& t : mesh.triangles) {
    const Index3 joined{stays[t[0]], stays[t[1]], stays[t[2]]};
    if (joined[0] == joined[1] || joined[1] == joined[2] || joined[2] == joined[0]) continue;
    welded.triangles.push_back(joined);
  }
  return welded;
}

Result<void> check_edges(const TriangleMesh& mesh, const std::string& name) {
  std::vector<Use> uses;
  uses.reserve(3 * mesh.triangles.size());
  for (const Index3& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) {
      const std::int32_t a = t[k], b = t[(k + 1) % 3];
      uses.push_back({std::min(a, b), std::max(a, b), a < b});
    }
  }
  std::sort(uses.begin(), uses.end(),
            [](const Use& a, const Use& b) { return a.low != b.low ? a.low < b.low : a.high < b.high; });
  Fault boundary, crowded, turned;
  for (std::size_t begin = 0, end = 0; begin < uses.size(); begin = end) {
    while (end < uses.size() && uses[end].same_edge(uses[begin])) ++end;
    if (end - begin == 1) boundary.note(uses[begin]);
    if (end - begin > 2) crowded.note(uses[begin]);
    if (end - begin == 2 && uses[begin].forward == uses[begin + 1].forward) turned.note(uses[begin]);
  }
  const auto refuse = [&](const std::string& what, const Fault& fault) {
    return Error{ErrorKind::kBadScene, what + "; first at " + place(mesh, fault.vertex), name};
  };
  if (boundary.count > 0) {
    return refuse("open mesh: " + std::to_string(boundary.count) + " boundary edges", boundary);
  }
  if (crowded.count > 0) {
    return refuse("mesh with " + std::to_string(crowded.count) + " edges of more than two triangles", crowded);
  }
  if (turned.count > 0) {
    return refuse("mesh with " + std::to_string(turned.count) + " edges whose triangles face opposite ways",
                  turned);
  }
  return {};
}

double wedge(const TriangleMesh& mesh, const Index3& t, const Vec3& apex) {
  const Vec3 a = mesh.vertices[t[0]] - apex, b = mesh.vertices[t[1]] - apex, c = mesh.vertices[t[2]] - apex;
  return a.dot(b.cross(c)) / 6;
}

/// The representative of each vertex's connected piece.
std::vector<std::int32_t> pieces(const TriangleMesh& mesh) {
  std::vector<std::int32_t> parent(mesh.vertices.size());
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](std::int32_t i) {
    while (parent[i] != i) i = parent[i] = parent[parent[i]];
    return i;
  };
  for (const Index3& t : mesh.triangles) {
    for (int k = 1; k < 3; ++k) {
      const std::int32_t a = root(t[0]), b = root(t[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  for (std::int32_t i = 0; i < static_cast<std::int32_t>(parent.size()); ++i) parent[i] = root(i);
  return parent;
}

/// Every piece of a solid turns its outside outwards; one that does not bounds a cavity (or is inside out).
Result<void> check_pieces(const TriangleMesh& mesh, const std::string& name) {
  const std::vector<std::int32_t> piece = pieces(mesh);
  const Vec3 apex = (bounds_of(mesh).lower + bounds_of(mesh).upper) / 2;
  std::vector<double> volume(mesh.vertices.size(), 0.0);
  for (const Index3& t : mesh.triangles) volume[piece[t[0]]] += wedge(mesh, t, apex);
  for (std::size_t i = 0; i < volume.size(); ++i) {
    if (volume[i] >= 0) continue;
    return Error{ErrorKind::kBadScene,
                 "mesh with a cavity, or with a piece that is inside out, at " +
                     place(mesh, static_cast<std::int32_t>(i)) + "; make it one skin, or turn that piece",
                 name};
  }
  return {};
}

}  // namespace

Bounds bounds_of(const TriangleMesh& mesh) {
  Bounds bounds;
  for (const Index3& t : mesh.triangles) {
    for (const std::int32_t i : t) {
      bounds.lower = bounds.lower.cwiseMin(mesh.vertices[i]);
      bounds.upper = bounds.upper.cwiseMax(mesh.vertices[i]);
    }
  }
  return bounds;
}

/// In the order of their lower ends along x, so that most pairs are never looked at.
bool may_overlap_itself(const TriangleMesh& mesh) {
  const std::vector<std::int32_t> piece = pieces(mesh);
  std::map<std::int32_t, Bounds> found;
  for (const Index3& t : mesh.triangles) {
    Bounds& bounds = found[piece[t[0]]];
    for (const std::int32_t i : t) {
      bounds.lower = bounds.lower.cwiseMin(mesh.vertices[i]);
      bounds.upper = bounds.upper.cwiseMax(mesh.vertices[i]);
    }
  }
  std::vector<Bounds> all;
  for (const auto& [name, bounds] : found) all.push_back(bounds);
  std::sort(all.begin(), all.end(), [](const Bounds& a, const Bounds& b) { return a.lower[0] < b.lower[0]; });
  for (std::size_t a = 0; a < all.size(); ++a) {
    for (std::size_t b = a + 1; b < all.size() && all[b].lower[0] < all[a].upper[0]; ++b) {
      const auto meet =
          (all[a].lower.array() < all[b].upper.array()) && (all[b].lower.array() < all[a].upper.array());
      if (meet.all()) return true;
    }
  }
  return false;
}

double enclosed_volume(const TriangleMesh& mesh) {
  // Seen from the middle of the bounds, so that a mesh far from the origin loses no digits.
  const Bounds bounds = bounds_of(mesh);
  const Vec3 middle = (bounds.lower + bounds.upper) / 2;
  double sum = 0;
  for (const Index3& t : mesh.triangles) sum += wedge(mesh, t, middle);
  return sum;
}

Result<TriangleMesh> make_solid(TriangleMesh mesh, const std::string& name) {
  mesh = weld(mesh);
  if (mesh.triangles.empty()) return Error{ErrorKind::kBadScene, "mesh without triangles", name};
  if (auto edges = check_edges(mesh, name); !edges) return edges.error();
  const double volume = enclosed_volume(mesh);
  const Bounds bounds = bounds_of(mesh);
  const double size = (bounds.upper - bounds.lower).norm();
  if (!(std::abs(volume) > 1e-12 * size * size * size)) {
    return Error{ErrorKind::kBadScene, "mesh that encloses no volume", name};
  }
  if (volume < 0) {
    for (Index3& t : mesh.triangles) std::swap(t[1], t[2]);
  }
  if (auto whole = check_pieces(mesh, name); !whole) return whole.error();
  return mesh;
}

}  // namespace repose
