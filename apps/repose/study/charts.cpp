#include "apps/repose/study/charts.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>

namespace repose {
namespace {

constexpr int kGrey = 6;

struct Look {
  int colour = 0, shape = 0;
};

std::optional<double> number(const std::string& text) {
  double value = 0.0;
  const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
  if (read.ec != std::errc() || read.ptr != text.data() + text.size()) return std::nullopt;
  return value;
}

bool all_numbers(const Vary& vary) {
  return std::all_of(vary.values.begin(), vary.values.end(),
                     [](const std::string& v) { return number(v).has_value(); });
}

std::string value_of(const Point& point, const std::string& key) {
  for (const Setting& setting : point.settings) {
    if (setting.key == key) return setting.value;
  }
  return "";
}

int place_of(const std::string& value, const Vary& vary) {
  return static_cast<int>(std::find(vary.values.begin(), vary.values.end(), value) - vary.values.begin());
}

/// The last part of a key, where no other key ends in the same.
std::string short_key(const std::string& key, const std::vector<Vary>& all) {
  const auto last = [](const std::string& of) { return of.substr(of.rfind('.') + 1); };
  const auto alike =
      std::count_if(all.begin(), all.end(), [&](const Vary& other) { return last(other.key) == last(key); });
  return alike > 1 ? key : last(key);
}

/// How the points of a sweep look, and which of them lines join.
struct Looks {
  std::vector<Look> of_point;
  std::vector<std::vector<std::size_t>> joined;
  std::vector<LegendEntry> legend;
  std::vector<double> depth;  // of a point along its line, from 0 to 1; empty: there are no lines
  std::string depth_text;
};

/// Lines follow the first key whose values are numbers; the next key is told by colour, the one after it by
/// shape.
Looks looks_of_product(const StudyHead& head, const StudyPlan& plan) {
  const Vary *path = nullptr, *colour = nullptr, *shape = nullptr;
  for (const Vary& vary : head.vary) {
    if (path == nullptr && vary.values.size() > 1 && all_numbers(vary)) path = &vary;
  }
  for (const Vary& vary : head.vary) {
    if (&vary == path || vary.values.size() < 2) continue;
    (colour == nullptr ? colour : shape) = &vary;
    if (shape != nullptr) break;
  }
  Looks looks;
  std::map<std::string, std::vector<std::size_t>> lines;
  for (std::size_t k = 0; k < plan.points.size(); ++k) {
    const Point& point = plan.points[k];
    looks.of_point.push_back({colour != nullptr ? place_of(value_of(point, colour->key), *colour) : 0,
                              shape != nullptr ? place_of(value_of(point, shape->key), *shape) : 0});
    if (k == plan.finest && point.settings.size() != head.vary.size()) looks.of_point.back() = {kGrey, 0};
    if (path == nullptr || value_of(point, path->key).empty()) continue;
    std::string rest;
    for (const Setting& setting : point.settings)
      rest += setting.key == path->key ? "" : setting.key + "=" + setting.value + ";";
    lines[rest].push_back(k);
  }
  if (path != nullptr) {
    const auto last = static_cast<double>(path->values.size() - 1);
    std::vector<std::string> ordered = path->values;
    std::sort(ordered.begin(), ordered.end(),
              [](const auto& a, const auto& b) { return *number(a) < *number(b); });
    for (const Point& point : plan.points) {
      const auto place =
          std::find(ordered.begin(), ordered.end(), value_of(point, path->key)) - ordered.begin();
      looks.depth.push_back(std::min(1.0, static_cast<double>(place) / last));
    }
    looks.depth_text =
        short_key(path->key, head.vary) + " from " + ordered.front() + ", pale, to " + ordered.back();
  }
  for (auto& [rest, points] : lines) {
    std::stable_sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
      return *number(value_of(plan.points[a], path->key)) < *number(value_of(plan.points[b], path->key));
    });
    looks.joined.push_back(points);
  }
  const bool shape_free = shape == nullptr;
  const auto explain = [&looks, &head, shape_free](const Vary& vary, bool by_colour, bool by_shape) {
    looks.legend.push_back({short_key(vary.key, head.vary), 0, LegendEntry::kHeading});
    for (int k = 0; k < static_cast<int>(vary.values.size()); ++k)
      looks.legend.push_back({vary.values[static_cast<std::size_t>(k)], by_colour ? k : -1,
                              by_shape                  ? k
                              : by_colour && shape_free ? 0
                                                        : LegendEntry::kAnyShape});
  };
  if (colour != nullptr) explain(*colour, true, false);
  if (shape != nullptr) explain(*shape, false, true);
  return looks;
}

/// A colour for each key; lines lead from the scene as it is written, along the values where these are numbers.
Looks looks_one_by_one(const StudyHead& head, const StudyPlan& plan) {
  Looks looks;
  looks.of_point.assign(plan.points.size(), {kGrey, 0});
  looks.legend.push_back({"as written", kGrey, 0});
  for (std::size_t v = 0; v < head.vary.size(); ++v) {
    const Vary& vary = head.vary[v];
    std::vector<std::size_t> points;
    for (std::size_t k = 0; k < plan.points.size(); ++k) {
      const auto& settings = plan.points[k].settings;
      if (k != plan.finest && settings.size() == 1 && settings[0].key == vary.key) points.push_back(k);
    }
    const Look look{
        static_cast<int>(v % (kColours - 1)) + (static_cast<int>(v % (kColours - 1)) >= kGrey ? 1 : 0),
        static_cast<int>(v / (kColours - 1))};
    for (const std::size_t k : points) looks.of_point[k] = look;
    looks.legend.push_back({vary.key, look.colour, look.shape});
    const auto written = number(head.written[v]);
    if (!all_numbers(vary) || !written) {
      for (const std::size_t k : points) looks.joined.push_back({k, 0});
      continue;
    }
    points.push_back(0);
    std::sort(points.begin(), points.end(), [&](std::size_t a, std::size_t b) {
      const auto at = [&](std::size_t k) {
        return k == 0 ? *written : *number(value_of(plan.points[k], vary.key));
      };
      return at(a) < at(b);
    });
    looks.joined.push_back(points);
  }
  return looks;
}

std::string with_unit(const std::string& name, const std::string& unit) {
  return unit.empty() ? name : name + " [" + unit + "]";
}

/// What the plots of a figure share.
class Charts {
 public:
  Charts(const StudyHead& head, const StudyPlan& plan, const Summary& summary, std::size_t figure)
      : plan_(plan),
        summary_(summary),
        index_(figure),
        figure_(plan.study.figures[figure]),
        looks_(plan.study.design == Design::kProduct ? looks_of_product(head, plan)
                                                     : looks_one_by_one(head, plan)) {}

  std::vector<Plot> all() const {
    std::vector<Plot> plots;
    const bool errors =
        std::any_of(summary_.points.begin(), summary_.points.end(),
                    [&](const PointSummary& point) { return point.figures[index_].error.value > 0.0; });
    if (errors) plots.push_back(error());
    // Of what is compared by its curve the number says little; where it is an error already, nothing more.
    const bool by_value = figure_.compares() == Compares::kValue || !summary_.references[index_].there;
    if (by_value && figure_.compares() != Compares::kItself) plots.push_back(value());
    if (Plot plot = curves(); !plot.lines.empty()) plots.push_back(std::move(plot));
    return plots;
  }

 private:
  double factor() const { return is_share(figure_.compares()) ? 100.0 : 1.0; }

  Plot against_time(const std::string& kind) const {
    Plot plot;
    plot.name = kind + "-" + figure_.name;
    plot.x = {"time of the steps [s]", true};
    plot.legend = looks_.legend;
    for (std::size_t k = 0; k < summary_.points.size(); ++k) {
      const PointSummary& point = summary_.points[k];
      if (!point.made() || (point.whole() && point.figures[index_].figure.count > 0)) continue;
      Mark mark = mark_of(k);
      if (!point.refused.empty() || !(point.seconds.median > 0.0)) mark.x = NAN;
      plot.margin.push_back(mark);
    }
    return plot;
  }

  Mark mark_of(std::size_t k) const {
    const PointSummary& point = summary_.points[k];
    Mark mark;
    mark.point = k;
    mark.x = point.seconds.median;
    mark.x_low = point.seconds.low;
    mark.x_high = point.seconds.high;
    mark.colour = looks_.of_point[k].colour;
    mark.shape = looks_.of_point[k].shape;
    mark.front = point.figures[index_].front;
    mark.reference = k == plan_.finest;
    mark.title = point_text(plan_, summary_, k, index_);
    return mark;
  }

  /// Marks and the lines that join them, at what `y` says of a point's figure; not a number: not shown.
  template <class Y>
  void put(Plot& plot, Y y) const {
    std::vector<double> heights(summary_.points.size(), NAN);
    for (std::size_t k = 0; k < summary_.points.size(); ++k) {
      const PointSummary& point = summary_.points[k];
      if (point.whole() && point.figures[index_].figure.count > 0) heights[k] = y(point.figures[index_]);
    }
    for (const auto& joined : looks_.joined) {
      Line line;
      line.colour = looks_.of_point[joined.front()].colour;
      for (const std::size_t k : joined) {
        if (looks_.of_point[k].colour != kGrey) line.colour = looks_.of_point[k].colour;
        if (std::isfinite(heights[k])) line.points.emplace_back(summary_.points[k].seconds.median, heights[k]);
      }
      if (line.points.size() > 1) plot.lines.push_back(line);
    }
    for (std::size_t k = 0; k < summary_.points.size(); ++k) {
      if (!std::isfinite(heights[k])) continue;
      Mark mark = mark_of(k);
      mark.y = heights[k];
      mark.pale = summary_.points[k].figures[index_].below_floor;
      plot.marks.push_back(mark);
    }
  }

  Plot error() const {
    Plot plot = against_time("error");
    const bool itself = figure_.compares() == Compares::kItself;
    plot.title = (itself ? "" : "Error of ") + figure_.name + " against time";
    plot.y = {with_unit((itself ? "" : "error of ") + figure_.name, factor() == 100.0 ? "%" : figure_.unit()),
              true};
    const double floor = summary_.references[index_].floor;
    if (std::isfinite(floor)) plot.floor = factor() * floor;
    Line front;
    front.front = true;
    put(plot, [&](const PointFigure& figure) { return factor() * figure.error.value; });
    for (const Mark& mark : plot.marks) {
      if (mark.front) front.points.emplace_back(mark.x, mark.y);
    }
    std::sort(front.points.begin(), front.points.end());
    if (front.points.size() > 1) plot.lines.insert(plot.lines.begin(), front);
    return plot;
  }

  Plot value() const {
    Plot plot = against_time("value");
    plot.title = figure_.name + " against time";
    plot.y = {with_unit(figure_.name, figure_.unit()), false};
    const Reference& reference = summary_.references[index_];
    if (reference.there) {
      plot.level = reference.value.value;
      plot.has_level =
          figure_.compares() == Compares::kValue || reference.count > 0 || reference.value.curve.empty();
    }
    put(plot, [](const PointFigure& figure) { return figure.figure.mean.value; });
    for (Mark& mark : plot.marks) mark.front = false;
    return plot;
  }

  Plot curves() const {
    Plot plot;
    plot.name = "curve-" + figure_.name;
    plot.title = figure_.name;
    plot.x = {figure_.axes().x, false};
    plot.y = {figure_.axes().y, false};
    plot.legend = looks_.legend;
    // Lines have no shape, so what shapes tell is not there.
    std::erase_if(plot.legend, [](const LegendEntry& entry) { return entry.colour < 0; });
    for (LegendEntry& entry : plot.legend)
      entry.shape = entry.shape == LegendEntry::kHeading ? entry.shape : LegendEntry::kAnyShape;
    while (!plot.legend.empty() && plot.legend.back().shape == LegendEntry::kHeading) plot.legend.pop_back();
    if (!looks_.depth.empty()) plot.legend.push_back({looks_.depth_text, 0, LegendEntry::kHeading});
    const auto add = [&plot](const Curve& curve, Line line) {
      for (std::size_t i = 0; i < curve.x.size(); ++i) line.points.emplace_back(curve.x[i], curve.y[i]);
      if (line.points.size() > 1) plot.lines.push_back(line);
    };
    for (std::size_t k = 0; k < summary_.points.size(); ++k) {
      if (k == plan_.finest) continue;
      Line line;
      line.colour = looks_.of_point[k].colour;
      line.point = k;
      if (!looks_.depth.empty()) line.opacity = 0.25 + 0.75 * looks_.depth[k];
      add(summary_.points[k].figures[index_].figure.mean.curve, line);
    }
    Line reference;
    reference.reference = true;
    if (plan_.finest != StudyPlan::npos) reference.point = plan_.finest;
    const Reference& against = summary_.references[index_];
    const bool known = against.there && !against.value.curve.empty();
    if (known) add(against.value.curve, reference);
    if (known) plot.title += ", the reference dashed";
    return plot;
  }

  const StudyPlan& plan_;
  const Summary& summary_;
  std::size_t index_;
  const Figure& figure_;
  Looks looks_;
};

}  // namespace

std::string error_text(const Figure& figure, double error) {
  if (!std::isfinite(error)) return "-";
  if (is_share(figure.compares())) return short_number(100.0 * error) + " %";
  return short_number(error) + (figure.unit().empty() ? "" : " " + figure.unit());
}

std::string point_text(const StudyPlan& plan, const Summary& summary, std::size_t point, std::size_t figure) {
  const PointSummary& p = summary.points[point];
  std::string text = p.point.text();
  if (point == plan.finest) text += "\nthe reference";
  if (!p.refused.empty()) return text + "\nrefused: " + p.refused;
  text += "\n" + short_number(p.seconds.median) + " s";
  if (p.seconds.high > p.seconds.low)
    text += " (" + short_number(p.seconds.low) + " to " + short_number(p.seconds.high) + ")";
  text += ", " + std::to_string(p.particles) + " particles, " + std::to_string(p.steps) + " steps";
  const PointFigure& f = p.figures[figure];
  const Figure& of = plan.study.figures[figure];
  if (f.figure.count > 0)
    text += "\n" + of.name + " " + short_number(f.figure.mean.value, 4) +
            (of.unit().empty() ? "" : " " + of.unit());
  if (std::isfinite(f.error.value))
    text += "\nerror " + error_text(of, f.error.value) + (f.below_floor ? ", under twice the noise floor" : "");
  if (p.gave_out > 0)
    text += "\n" + std::to_string(p.gave_out) + " of " + std::to_string(p.runs) + " gave out: " + p.words;
  return text;
}

std::vector<Plot> charts_of(const StudyHead& head, const StudyPlan& plan, const Summary& summary,
                            std::size_t figure) {
  return Charts(head, plan, summary, figure).all();
}

}  // namespace repose
