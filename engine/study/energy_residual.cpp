#include "engine/study/energy_residual.h"

#include <algorithm>
#include <cmath>

#include "engine/study/series.h"

namespace repose {
namespace {

constexpr Choice kCounts[] = {
    {"gain", "the largest rise above the least energy before it: for matter that yields"},
    {"change", "the largest distance from the energy at the start: for elastic matter"}};

}  // namespace

void EnergyResidual::describe(Fields& fields) {
  fields.choice("counts", counts, kCounts, "what is a residual");
  fields.text("probe", probe,
              "name of a probe of energy, where solids that move do work; its work is taken off");
}

std::vector<std::string> EnergyResidual::series() const {
  return probe.empty() ? std::vector<std::string>{} : std::vector<std::string>{probe + ".work_of_solids"};
}

FigureValue EnergyResidual::measure(const RunRecord& record) const {
  if (record.moments.size() < 2) return FigureValue::none("the run has no frame");
  Curve left;
  double work = 0.0, kinetic = 0.0, low = INFINITY, high = -INFINITY;
  for (const RunMoment& m : record.moments) {
    // What a probe tells is of the frame that ends there, and the start ends none.
    if (!probe.empty() && &m != &record.moments.front())
      work += number_of(m, probe + ".work_of_solids").value_or(0.0);
    left.x.push_back(m.time);
    left.y.push_back(m.kinetic + m.affine + m.elastic + m.potential - work);
    kinetic = std::max(kinetic, m.kinetic + m.affine);
    low = std::min(low, m.potential);
    high = std::max(high, m.potential);
  }
  const double scale = kinetic + (high - low);
  if (!(scale > 0.0)) return FigureValue::none("nothing moves, so there is no energy to compare with");
  double residual = 0.0, least = left.y.front();
  for (const double energy : left.y) {
    least = std::min(least, energy);
    const double away = counts == Counts::kGain ? energy - least : std::abs(energy - left.y.front());
    residual = std::max(residual, away);
  }
  return {residual / scale, "", std::move(left)};
}

}  // namespace repose
