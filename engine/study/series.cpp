#include "engine/study/series.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace repose {
namespace {

/// What every run tells.
std::vector<std::pair<std::string, double>> own_numbers(const RunMoment& m) {
  std::vector<std::pair<std::string, double>> all;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::string name(1, "xyz"[axis]);
    all.emplace_back("center_of_mass." + name, m.center_of_mass[axis]);
    all.emplace_back("momentum." + name, m.momentum[axis]);
    all.emplace_back("velocity." + name, m.mass > 0.0 ? m.momentum[axis] / m.mass : 0.0);
  }
  all.emplace_back("energy.kinetic", m.kinetic);
  all.emplace_back("energy.affine", m.affine);
  all.emplace_back("energy.elastic", m.elastic);
  all.emplace_back("energy.potential", m.potential);
  all.emplace_back("energy.total", m.kinetic + m.affine + m.elastic + m.potential);
  return all;
}

/// Of the parabola through three points about a largest one.
Swing top(const Curve& series, std::size_t k, double level) {
  const auto height = [&](std::size_t i) { return std::abs(series.y[i] - level); };
  Swing swing{series.x[k], height(k)};
  if (k == 0 || k + 1 == series.x.size()) return swing;
  const double h0 = series.x[k - 1] - series.x[k], h1 = series.x[k + 1] - series.x[k];
  const double d0 = (height(k - 1) - height(k)) / h0, d1 = (height(k + 1) - height(k)) / h1;
  const double bend = (d1 - d0) / (h1 - h0);
  if (!(bend < 0.0)) return swing;
  const double slope = d0 - bend * h0, at = -0.5 * slope / bend;
  if (at < h0 || at > h1) return swing;
  return {series.x[k] + at, height(k) + 0.5 * slope * at};
}

}  // namespace

std::vector<std::string> series_names(const RunMoment& moment) {
  std::vector<std::string> names;
  for (const auto& [name, value] : own_numbers(moment)) names.push_back(name);
  for (const Measurement& m : moment.measured) names.push_back(m.probe + "." + m.quantity);
  return names;
}

std::optional<double> number_of(const RunMoment& moment, const std::string& name) {
  for (const Measurement& m : moment.measured) {
    if (m.probe + "." + m.quantity == name)
      return std::isfinite(m.value) ? std::optional(m.value) : std::nullopt;
  }
  for (const auto& [own, value] : own_numbers(moment)) {
    if (own == name) return value;
  }
  return std::nullopt;
}

Curve series_of(const RunRecord& record, const std::string& name) {
  Curve series;
  for (const RunMoment& moment : record.moments) {
    const auto value = number_of(moment, name);
    if (!value) continue;
    series.x.push_back(moment.time);
    series.y.push_back(*value);
  }
  return series;
}

std::vector<double> crossings(const Curve& series, double level) {
  std::vector<double> times;
  for (std::size_t k = 1; k < series.x.size(); ++k) {
    const double before = series.y[k - 1] - level, now = series.y[k] - level;
    if (!((before < 0.0 && now >= 0.0) || (before > 0.0 && now <= 0.0))) continue;
    times.push_back(series.x[k - 1] + (series.x[k] - series.x[k - 1]) * before / (before - now));
  }
  return times;
}

std::vector<Swing> swings(const Curve& series, double level) {
  const std::vector<double> ends = crossings(series, level);
  std::vector<Swing> all;
  for (std::size_t half = 1; half < ends.size(); ++half) {
    std::size_t highest = series.x.size();
    for (std::size_t k = 0; k < series.x.size(); ++k) {
      if (series.x[k] < ends[half - 1] || series.x[k] > ends[half]) continue;
      if (highest == series.x.size() || std::abs(series.y[k] - level) > std::abs(series.y[highest] - level))
        highest = k;
    }
    if (highest < series.x.size()) all.push_back(top(series, highest, level));
  }
  return all;
}

Curve within(const Curve& series, double from, double to) {
  Curve part;
  for (std::size_t k = 0; k < series.x.size(); ++k) {
    if (series.x[k] < from || (to > from && series.x[k] > to)) continue;
    part.x.push_back(series.x[k]);
    part.y.push_back(series.y[k]);
  }
  return part;
}

}  // namespace repose
