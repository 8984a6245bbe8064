#include "engine/effect/surface_probe.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace repose {
namespace {

using Column = std::map<std::int64_t, double>;  // volume by height, in cells

Vec3 level(const Vec3& x, const Vec3& up) {
  return x - x.dot(up) * up;
}

double height_of(const Column& column, double cell_volume, double spacing) {
  const auto fill = [&](std::int64_t cell) {
    const auto found = column.find(cell);
    return found == column.end() ? 0.0 : std::min(1.0, found->second / cell_volume);
  };
  for (auto cell = column.rbegin(); cell != column.rend(); ++cell) {
    if (fill(cell->first) < 0.5) continue;
    return (static_cast<double>(cell->first) + fill(cell->first) + fill(cell->first + 1)) * spacing;
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

std::size_t columns(const SurfaceLine& line, const Vec3& up, double spacing) {
  if (line.samples > 0) return static_cast<std::size_t>(line.samples);
  return static_cast<std::size_t>(
      std::max(1.0, std::ceil(level(line.to - line.from, up).norm() / spacing - 1e-9)));
}

template <class Real>
std::vector<double> surface_heights(const State<Real>& state, const SurfaceLine& line, const Vec3& up) {
  const double dx = state.spacing;
  const int flat = state.topology.flat_axis;
  const std::size_t count = columns(line, up, dx);
  const double length = level(line.to - line.from, up).norm(), step = length / static_cast<double>(count);
  const Vec3 along = level(line.to - line.from, up) / length, across = up.cross(along);
  // Material of plane strain is a slice of one cell.
  const double width = flat >= 0 || line.width <= 0.0 ? dx : line.width;
  std::vector<Column> filled(count);
  for_each_particle(state, [&](const ParticleSet<Real>& set, std::size_t, const Vec3& x) {
    const double s = (x - line.from).dot(along);
    if (flat < 0 && std::abs((x - line.from).dot(across)) > 0.5 * width) return;
    // Column k reaches half a cell to either side of its middle, (k + 1/2) step.
    const double first = std::ceil((s - 0.5 * dx) / step - 0.5), last = (s + 0.5 * dx) / step - 0.5;
    for (double k = std::max(0.0, first); k < last && k < static_cast<double>(count); ++k) {
      filled[static_cast<std::size_t>(k)][static_cast<std::int64_t>(std::floor(x.dot(up) / dx))] +=
          set.particle_volume;
    }
  });
  std::vector<double> heights;
  for (const Column& column : filled) heights.push_back(height_of(column, dx * dx * width, dx));
  return heights;
}

template std::vector<double> surface_heights(const State<float>&, const SurfaceLine&, const Vec3&);
template std::vector<double> surface_heights(const State<double>&, const SurfaceLine&, const Vec3&);

}  // namespace repose
