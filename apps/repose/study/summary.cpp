#include "apps/repose/study/summary.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace repose {
namespace {

double share_of(const std::vector<double>& sorted, double share) {
  const double at = share * static_cast<double>(sorted.size() - 1);
  const auto below = static_cast<std::size_t>(at);
  const std::size_t above = std::min(below + 1, sorted.size() - 1);
  return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

/// Point by point, over the x of the longest; beyond its end a curve is 0.
Curve mean_curve(const std::vector<FigureValue>& values) {
  const Curve* longest = nullptr;
  for (const FigureValue& value : values) {
    if (value.curve.empty()) return {};
    if (longest == nullptr || value.curve.x.size() > longest->x.size()) longest = &value.curve;
  }
  if (longest == nullptr) return {};
  Curve mean{longest->x, std::vector<double>(longest->x.size(), 0.0)};
  for (std::size_t k = 0; k < mean.x.size(); ++k) {
    for (const FigureValue& value : values) mean.y[k] += value.curve.at(mean.x[k]);
    mean.y[k] /= static_cast<double>(values.size());
  }
  return mean;
}

/// Figures of each seed of a point, once.
std::vector<FigureValue> values_of(const std::vector<StudyRun>& runs, std::size_t point,
                                   const std::string& figure) {
  std::vector<FigureValue> values;
  for (const StudyRun& run : runs) {
    if (run.point != point || run.repeat != 0 || !run.result.complete()) continue;
    const auto found = run.result.figures.find(figure);
    if (found != run.result.figures.end() && found->second.there()) values.push_back(found->second);
  }
  return values;
}

PointSummary times_of(const StudyPlan& plan, const std::vector<StudyRun>& runs, std::size_t point) {
  PointSummary summary;
  summary.point = plan.points[point];
  summary.refused = plan.refused[point];
  std::vector<double> complete, ended;
  for (const StudyRun& run : runs) {
    if (run.point != point) continue;
    const RunResult& result = run.result;
    (result.complete() ? complete : ended).push_back(result.seconds);
    if (run.repeat != 0) continue;
    ++summary.runs;
    if (!result.complete() && summary.gave_out++ == 0) {
      summary.words = result.words;
      summary.code = result.code;
    }
    if (summary.particles > 0 && !result.complete()) continue;  // of one that came to its end, if any did
    summary.particles = result.particles;
    summary.steps = result.steps;
    summary.spacing = result.spacing;
    summary.time = result.time;
    summary.peak_bytes = std::max(summary.peak_bytes, result.peak_bytes);
  }
  summary.seconds = quartiles(complete.empty() ? ended : complete);
  return summary;
}

/// By what a figure is compared: one of which a number alone is known, by that.
Compares compares_of(const StudyPlan& plan, const Figure& figure) {
  for (const KnownFigure& known : plan.study.known) {
    if (known.figure == figure.name && known.curve.empty()) return Compares::kValue;
  }
  return figure.compares();
}

Reference known_reference(const StudyPlan& plan, const Figure& figure) {
  Reference reference;
  if (figure.compares() == Compares::kItself) {
    reference.there = true;
    reference.source = "an exact run has 0";
  }
  for (const KnownFigure& known : plan.study.known) {
    if (known.figure != figure.name) continue;
    reference.there = true;
    reference.source = known.source;
    reference.value.value = known.value;
    for (const auto& row : known.curve) {
      reference.value.curve.x.push_back(row[0]);
      reference.value.curve.y.push_back(row[1]);
    }
  }
  return reference;
}

/// The scatter of single runs, from all points that have several: the root of the mean of their squares.
double pooled_scatter(const Summary& summary, std::size_t figure) {
  double squares = 0.0, count = 0.0;
  for (const PointSummary& point : summary.points) {
    const double scatter = point.figures[figure].figure.scatter;
    if (!std::isfinite(scatter)) continue;
    squares += scatter * scatter;
    count += 1.0;
  }
  return count > 0.0 ? std::sqrt(squares / count) : NAN;
}

/// Marks what no other point beats in both time and error. Those below twice the floor are equally near.
void mark_front(Summary& summary, std::size_t figure, std::size_t not_this) {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < summary.points.size(); ++k) {
    const PointSummary& point = summary.points[k];
    if (k != not_this && point.whole() && std::isfinite(point.figures[figure].error.value)) order.push_back(k);
  }
  const double floor = summary.references[figure].floor;
  const auto error = [&](std::size_t k) {
    const double value = summary.points[k].figures[figure].error.value;
    return std::isfinite(floor) ? std::max(value, 2.0 * floor) : value;
  };
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    const double ta = summary.points[a].seconds.median, tb = summary.points[b].seconds.median;
    return ta < tb || (ta == tb && error(a) < error(b));
  });
  double best = INFINITY;
  for (const std::size_t k : order) {
    if (!(error(k) < best)) continue;
    best = error(k);
    summary.points[k].figures[figure].front = true;
  }
}

}  // namespace

Quartiles quartiles(std::vector<double> values) {
  if (values.empty()) return {NAN, NAN, NAN};
  std::sort(values.begin(), values.end());
  return {share_of(values, 0.25), share_of(values, 0.5), share_of(values, 0.75)};
}

Averaged average(Compares compares, const std::vector<FigureValue>& values) {
  Averaged averaged{{}, NAN, values.size()};
  if (values.empty()) {
    averaged.mean = FigureValue::none("no run came to it");
    return averaged;
  }
  for (const FigureValue& value : values)
    averaged.mean.value += value.value / static_cast<double>(values.size());
  averaged.mean.curve = mean_curve(values);
  if (values.size() < 2) return averaged;
  double squares = 0.0;
  for (const FigureValue& value : values) {
    const double away = compares == Compares::kItself ? value.value - averaged.mean.value
                                                      : error_of(compares, value, averaged.mean).value;
    squares += away * away;
  }
  averaged.scatter = std::sqrt(squares / static_cast<double>(values.size() - 1));
  return averaged;
}

Summary summarize(const StudyPlan& plan, const std::vector<StudyRun>& runs) {
  Summary summary;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    summary.points.push_back(times_of(plan, runs, k));
    for (const Figure& figure : plan.study.figures)
      summary.points[k].figures.push_back(
          {average(compares_of(plan, figure), values_of(runs, k, figure.name)), {NAN, NAN}});
  }
  for (std::size_t f = 0; f < plan.study.figures.size(); ++f) {
    const Figure& figure = plan.study.figures[f];
    Reference reference = known_reference(plan, figure);
    const double seeds = static_cast<double>(plan.study.seeds);
    std::size_t itself = StudyPlan::npos;
    if (!reference.there && plan.finest != StudyPlan::npos) {
      const Averaged& finest = summary.points[plan.finest].figures[f].figure;
      reference.there = finest.mean.there();
      reference.value = finest.mean;
      reference.count = finest.count;
      reference.scatter = finest.scatter;
      reference.floor = finest.scatter * std::sqrt(1.0 / seeds + 1.0 / static_cast<double>(finest.count));
      reference.source =
          plan.points[plan.finest].text() +
          (finest.count > 1 ? ", mean of " + std::to_string(finest.count) + " seeds" : ", one run");
      itself = plan.finest;
    } else {
      reference.scatter = pooled_scatter(summary, f);
      reference.floor = reference.scatter / std::sqrt(seeds);
    }
    summary.references.push_back(reference);
    if (!reference.there) continue;
    for (std::size_t k = 0; k < summary.points.size(); ++k) {
      PointFigure& point = summary.points[k].figures[f];
      if (k == itself || point.figure.count == 0) continue;
      point.error = error_of(compares_of(plan, figure), point.figure.mean, reference.value);
      point.below_floor = point.error.value < 2.0 * reference.floor;
    }
    mark_front(summary, f, itself);
  }
  return summary;
}

}  // namespace repose
