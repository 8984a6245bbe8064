#include "engine/study/heap.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace repose {
namespace {

constexpr Choice kForms[] = {{"round", "rings about an axis that goes up through \"origin\""},
                             {"plane", "strips from \"origin\" along \"direction\""}};
constexpr std::size_t kMostBins = 100000;  // what lies beyond is on its way to infinity

Vec3 level(Vec3 v, int up) {
  v[up] = 0.0;
  return v;
}

/// How far the matter of a plane heap goes across it, m; 0: not known.
double depth_of(const Heap& heap, const RunRecord& record) {
  if (heap.depth > 0.0) return heap.depth;
  if (record.flat >= 0) return record.spacing;
  for (int axis = 0; axis < 3; ++axis) {
    const bool across = axis != record.up && std::abs(heap.direction[axis]) < 1e-9 * heap.direction.norm();
    if (across) return record.period[static_cast<std::size_t>(axis)];
  }
  return 0.0;
}

}  // namespace

double particle_volume(const PointCloud& points, std::size_t p) {
  const auto radius = static_cast<double>(points.radius[p]);
  return 8.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

void describe(Fields& fields, Heap& heap) {
  fields.choice("form", heap.form, kForms, "how the heap lies");
  fields.vector("origin", heap.origin, {.unit = "m", .meaning = "its middle, or where a plane heap begins"});
  fields.vector("direction", heap.direction, {.meaning = "plane: which way it runs, of any length"});
  fields.check(heap.direction.norm() > 1e-12, "direction", "must not be zero, for example [1, 0, 0]");
  fields.number("width", heap.width,
                {.unit = "m", .meaning = "of a ring or strip; 0: the grid's spacing", .low = 0.0});
  fields.number(
      "depth", heap.depth,
      {.unit = "m",
       .meaning = "plane: how far it goes across; 0: a spacing in plane strain, else the period across",
       .low = 0.0});
}

double ring_area(std::size_t k, double width) {
  return std::numbers::pi * width * width * static_cast<double>(2 * k + 1);
}

Curve heights(const Heap& heap, const PointCloud& points, const RunRecord& record) {
  const double width = heap.width_in(record);
  const bool round = heap.form == Heap::Form::kRound;
  const double depth = round ? 0.0 : depth_of(heap, record);
  if (!round && !(depth > 0.0)) return {};
  const Vec3 along = level(heap.direction, record.up).normalized();
  std::vector<double> volume;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& x = points.position[p];
    const Vec3 from = level(Vec3(x[0], x[1], x[2]) - heap.origin, record.up);
    const double at = (round ? from.norm() : from.dot(along)) / width;
    if (!(at >= 0.0) || at >= static_cast<double>(kMostBins)) continue;
    const auto bin = static_cast<std::size_t>(at);
    if (bin >= volume.size()) volume.resize(bin + 1, 0.0);
    volume[bin] += particle_volume(points, p);
  }
  Curve curve;
  for (std::size_t k = 0; k < volume.size(); ++k) {
    curve.x.push_back((static_cast<double>(k) + 0.5) * width);
    curve.y.push_back(volume[k] / (round ? ring_area(k, width) : width * depth));
  }
  return curve;
}

double front(const Curve& heights, bool round, double cover) {
  const std::size_t bins = heights.x.size();
  if (bins == 0) return 0.0;
  const double width = 2.0 * heights.x.front();
  const auto share = [&](std::size_t k) { return round ? ring_area(k, 1.0) : 1.0; };
  const auto volume = [&](std::size_t k) { return k < bins ? heights.y[k] * share(k) : 0.0; };
  /// Of ring k with its neighbours; before the first there is none.
  const auto mean = [&](std::size_t k) {
    const double before = k > 0 ? volume(k - 1) : 0.0, area_before = k > 0 ? share(k - 1) : 0.0;
    return (before + volume(k) + volume(k + 1)) / (area_before + share(k) + share(k + 1));
  };
  for (std::size_t k = bins + 1; k-- > 0;) {
    const double here = mean(k), beyond = mean(k + 1);
    if (here < cover) continue;
    return (static_cast<double>(k) + 0.5 + (here - cover) / (here - beyond)) * width;
  }
  return 0.0;
}

}  // namespace repose
