#include "engine/study/curve.h"

#include <algorithm>
#include <cmath>

namespace repose {
namespace {

/// Mean distance of neighbouring points.
double mean_step(const Curve& curve) {
  return (curve.x.back() - curve.x.front()) / std::max(1.0, static_cast<double>(curve.x.size() - 1));
}

}  // namespace

double Curve::at(double place) const {
  if (empty() || place < x.front() || place > x.back()) return 0.0;
  const auto after = std::upper_bound(x.begin(), x.end(), place);
  if (after == x.end()) return y.back();
  const auto k = static_cast<std::size_t>(after - x.begin());
  const double share = (place - x[k - 1]) / (x[k] - x[k - 1]);
  return y[k - 1] + share * (y[k] - y[k - 1]);
}

Apart apart(const Curve& curve, const Curve& other) {
  if (curve.empty() || other.empty()) return {NAN, NAN};
  const double from = std::min(curve.x.front(), other.x.front());
  const double to = std::max(curve.x.back(), other.x.back());
  double step = std::min(mean_step(curve), mean_step(other));
  if (!(step > 0.0)) step = std::max(mean_step(curve), mean_step(other));
  const auto places = step > 0.0 ? static_cast<std::size_t>((to - from) / step + 1.5) : std::size_t{1};
  double squares = 0.0, of_other = 0.0, most = 0.0;
  Apart result;
  for (std::size_t k = 0; k < places; ++k) {
    const double at =
        places > 1 ? from + (to - from) * static_cast<double>(k) / static_cast<double>(places - 1) : from;
    const double away = curve.at(at) - other.at(at);
    squares += away * away;
    of_other += other.at(at) * other.at(at);
    result.largest = std::max(result.largest, std::abs(away));
    most = std::max(most, std::abs(other.at(at)));
  }
  result.mean = std::sqrt(squares / (of_other > 0.0 ? of_other : static_cast<double>(places)));
  if (most > 0.0) result.largest /= most;
  return result;
}

double area_between(const Curve& curve, const Curve& other) {
  if (curve.x.size() < 2 || other.empty()) return NAN;
  double area = 0.0;
  for (std::size_t k = 1; k < curve.x.size(); ++k) {
    const auto away = [&](std::size_t i) { return std::abs(curve.y[i] - other.at(curve.x[i])); };
    area += 0.5 * (curve.x[k] - curve.x[k - 1]) * (away(k) + away(k - 1));
  }
  return area;
}

}  // namespace repose
