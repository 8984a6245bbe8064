#include "engine/study/marginal.h"

#include <algorithm>
#include <cmath>

namespace repose {
namespace {

constexpr Choice kAlong[] = {
    {"x", "x"}, {"y", "y"}, {"z", "z"}, {"radius", "distance from the axis that goes up through \"origin\""}};
constexpr std::size_t kQuantiles = 200;

/// Where the shares 1/400, 3/400 ... of the volume lie: the middles of so many equal parts.
Curve quantiles(const PointCloud& points, int along, const Vec3& origin, int up) {
  std::vector<std::pair<double, double>> places;  // place, volume
  double all = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& x = points.position[p];
    Vec3 from = Vec3(x[0], x[1], x[2]) - origin;
    const double along_axis = along < 3 ? from[along] + origin[along] : 0.0;
    from[up] = 0.0;
    const double volume = particle_volume(points, p);
    places.emplace_back(along < 3 ? along_axis : from.norm(), volume);
    all += volume;
  }
  std::sort(places.begin(), places.end());
  Curve curve;
  double passed = 0.0;
  std::size_t next = 0;
  for (const auto& [place, volume] : places) {
    passed += volume;
    for (; next < kQuantiles; ++next) {
      const double share = (static_cast<double>(next) + 0.5) / static_cast<double>(kQuantiles);
      if (passed < share * all) break;
      curve.x.push_back(share);
      curve.y.push_back(place);
    }
  }
  return curve;
}

}  // namespace

void Marginal::describe(Fields& fields) {
  fields.choice("along", along, kAlong, "which coordinate");
  fields.vector("origin", origin, {.unit = "m", .meaning = "radius: a point of the axis"});
}

CurveAxes Marginal::axes() const {
  return {"share of the volume", std::string(kAlong[along].name) + " below which it lies [m]"};
}

FigureValue Marginal::measure(const RunRecord& record) const {
  const Curve before = quantiles(record.start, along, origin, record.up);
  Curve after = quantiles(record.end, along, origin, record.up);
  if (after.empty()) return FigureValue::none("there is no particle at the end");
  const double way = before.empty() ? 0.0 : area_between(after, before);
  return {way, "", std::move(after)};
}

}  // namespace repose
