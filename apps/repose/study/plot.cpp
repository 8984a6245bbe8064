#include "apps/repose/study/plot.h"

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace repose {
namespace {

constexpr double kWidth = 640.0, kHeight = 420.0;
constexpr double kLeft = 90.0, kRight = 18.0, kBottom = 56.0, kTitle = 34.0, kLegendRow = 20.0, kStrip = 26.0;
constexpr const char* kInk = "#1d2430";
constexpr const char* kFaint = "#6b7480";
constexpr const char* kGrid = "#e6e9ee";
/// Letters that stand on lines.
constexpr const char* kHalo =
    " stroke=\"#ffffff\" stroke-width=\"3\" stroke-linejoin=\"round\" paint-order=\"stroke\"";
/// Okabe and Ito's, which people who see few colours tell apart, in an order that starts calm.
constexpr const char* kPalette[kColours] = {"#0072b2", "#d55e00", "#009e73", "#cc79a7",
                                            "#e69f00", "#56b4e9", "#5b5f66", "#8c5a2b"};

[[gnu::format(printf, 1, 2)]] std::string format(const char* form, ...) {
  char text[512];
  std::va_list list;
  va_start(list, form);
  std::vsnprintf(text, sizeof text, form, list);
  va_end(list);
  return text;
}

struct Range {
  double low = INFINITY, high = -INFINITY;
  void take(double value, bool log) {
    if (!std::isfinite(value) || (log && !(value > 0.0))) return;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  void widen(bool log, double share) {
    if (!(low <= high)) low = log ? 1.0 : 0.0, high = log ? 10.0 : 1.0;
    if (log) {
      const double room = std::max(std::pow(high / low, share), 1.25);
      low /= room;
      high *= room;
      return;
    }
    const double room = high > low ? share * (high - low) : std::max(0.05 * std::abs(high), 1e-12);
    low -= room;
    high += room;
  }
};

class Drawing {
 public:
  explicit Drawing(const Plot& plot);
  std::string text();

 private:
  double across(double x) const { return kLeft + share(x, x_, plot_.x.log) * (kWidth - kLeft - kRight); }
  double down(double y) const { return bottom() - share(y, y_, plot_.y.log) * (bottom() - top()); }
  static double share(double v, const Range& range, bool log) {
    if (log) return (std::log(v) - std::log(range.low)) / (std::log(range.high) - std::log(range.low));
    return (v - range.low) / (range.high - range.low);
  }
  double top() const { return top_ + (plot_.margin.empty() ? 0.0 : kStrip); }
  double bottom() const { return kHeight - kBottom; }
  bool shows(double x, double y) const {
    return std::isfinite(x) && std::isfinite(y) && !(plot_.x.log && x <= 0.0) && !(plot_.y.log && y <= 0.0);
  }

  void ranges();
  void place_legend();
  void axes();
  void floor();
  void lines();
  void marks();
  void strip();
  void words(double x, double y, const char* anchor, double size, const char* colour, const std::string& text,
             const char* more = "");
  void shape(int index, double x, double y, double r, const char* fill, const char* stroke, double width);

  const Plot& plot_;
  Range x_, y_;
  double top_ = kTitle;
  std::vector<std::pair<double, double>> legend_;
  std::string out_;
};

Drawing::Drawing(const Plot& plot) : plot_(plot) {
  place_legend();
  ranges();
}

void Drawing::ranges() {
  for (const Mark& mark : plot_.marks) {
    if (!std::isfinite(mark.x) || !std::isfinite(mark.y)) continue;
    for (const double x : {mark.x, mark.x_low, mark.x_high}) x_.take(x, plot_.x.log);
    y_.take(mark.y, plot_.y.log);
  }
  for (const Line& line : plot_.lines) {
    for (const auto& [x, y] : line.points) {
      x_.take(x, plot_.x.log);
      y_.take(y, plot_.y.log);
    }
  }
  for (const Mark& mark : plot_.margin) x_.take(mark.x, plot_.x.log);
  if (plot_.floor > 0.0) {
    y_.take(plot_.floor, plot_.y.log);
    y_.take(2.0 * plot_.floor, plot_.y.log);
  }
  if (plot_.has_level) y_.take(plot_.level, plot_.y.log);
  if (plot_.from_zero) y_.take(0.0, false);
  const bool curves = plot_.marks.empty() && !plot_.lines.empty();
  if (!curves || plot_.x.log) x_.widen(plot_.x.log, 0.06);
  if (curves && !(x_.high > x_.low)) x_.widen(false, 0.06);
  y_.widen(plot_.y.log, 0.08);
  if (plot_.from_zero && y_.low < 0.0 && y_.low > -0.1 * y_.high) y_.low = 0.0;
}

/// Entries in rows, as many as fit; letters of this size are about 6.6 wide.
void Drawing::place_legend() {
  double x = kLeft, y = kTitle + 6.0;
  for (const LegendEntry& entry : plot_.legend) {
    const double mark = entry.shape == LegendEntry::kHeading ? 8.0 : 33.0;
    const double width = mark + 6.7 * static_cast<double>(entry.text.size());
    if (x > kLeft && x + width > kWidth - kRight) {
      x = kLeft;
      y += kLegendRow;
    }
    legend_.emplace_back(x, y);
    x += width;
  }
  top_ = plot_.legend.empty() ? kTitle + 4.0 : y + kLegendRow - 2.0;
}

void Drawing::words(double x, double y, const char* anchor, double size, const char* colour,
                    const std::string& text, const char* more) {
  out_ += format("<text x=\"%.1f\" y=\"%.1f\" text-anchor=\"%s\" font-size=\"%g\" fill=\"%s\"%s>", x, y, anchor,
                 size, colour, more) +
          escaped(text) + "</text>\n";
}

void Drawing::axes() {
  const std::vector<double> along = ticks(x_.low, x_.high, plot_.x.log),
                            up = ticks(y_.low, y_.high, plot_.y.log);
  const std::vector<std::string> along_texts = tick_texts(along), up_texts = tick_texts(up);
  for (std::size_t k = 0; k < along.size(); ++k) {
    out_ += format("<path d=\"M%.1f %.1fV%.1f\" stroke=\"%s\"/>\n", across(along[k]), top(), bottom(), kGrid);
    words(across(along[k]), bottom() + 18.0, "middle", 12.0, kInk, along_texts[k]);
  }
  for (std::size_t k = 0; k < up.size(); ++k) {
    out_ += format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\"/>\n", kLeft, down(up[k]), kWidth - kRight, kGrid);
    words(kLeft - 8.0, down(up[k]) + 4.0, "end", 12.0, kInk, up_texts[k]);
  }
  out_ += format("<path d=\"M%.1f %.1fV%.1fH%.1f\" fill=\"none\" stroke=\"%s\"/>\n", kLeft, top(), bottom(),
                 kWidth - kRight, kInk);
  words(0.5 * (kLeft + kWidth - kRight), kHeight - 14.0, "middle", 13.0, kInk, plot_.x.label);
  out_ += format("<g transform=\"translate(18 %.1f) rotate(-90)\">", 0.5 * (top() + bottom()));
  words(0.0, 0.0, "middle", 13.0, kInk, plot_.y.label);
  out_ += "</g>\n";
  words(kLeft, 22.0, "start", 15.0, kInk, plot_.title, " font-weight=\"600\"");
  for (std::size_t k = 0; k < plot_.legend.size(); ++k) {
    const LegendEntry& entry = plot_.legend[k];
    const auto [x, y] = legend_[k];
    if (entry.shape == LegendEntry::kHeading) {
      words(x, y + 8.0, "start", 12.0, kFaint, entry.text);
      continue;
    }
    if (entry.shape == LegendEntry::kAnyShape) {
      out_ += format("<path d=\"M%.1f %.1fh14\" stroke=\"%s\" stroke-width=\"3\"/>\n", x, y + 4.0,
                     colour_of(entry.colour));
    } else {
      shape(entry.shape, x + 7.0, y + 4.0, 4.5, entry.colour < 0 ? kFaint : colour_of(entry.colour), "none",
            0.0);
    }
    words(x + 19.0, y + 8.0, "start", 12.0, kInk, entry.text);
  }
}

void Drawing::floor() {
  if (plot_.has_level) {
    out_ +=
        format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\" stroke-width=\"1.5\" stroke-dasharray=\"6 4\"/>\n",
               kLeft, down(plot_.level), kWidth - kRight, kInk);
    words(kLeft + 6.0, down(plot_.level) - 5.0, "start", 11.0, kFaint, "reference", kHalo);
  }
  if (!(plot_.floor > 0.0)) return;
  const double edge = down(2.0 * plot_.floor), line = down(plot_.floor);
  out_ += format(
      "<rect class=\"floor\" x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"url(#hatch-%s)\"/>\n",
      kLeft, edge, kWidth - kLeft - kRight, std::max(0.0, bottom() - edge), plot_.name.c_str());
  out_ += format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\" stroke-dasharray=\"2 3\"/>\n", kLeft, edge,
                 kWidth - kRight, kFaint);
  out_ += format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\"/>\n", kLeft, line, kWidth - kRight, kFaint);
  words(kLeft + 6.0, line - 4.0, "start", 11.0, kFaint, "noise floor", kHalo);
  words(kLeft + 6.0, edge - 4.0, "start", 11.0, kFaint, "twice the noise floor", kHalo);
}

void Drawing::lines() {
  for (const Line& line : plot_.lines) {
    std::string path;
    for (const auto& [x, y] : line.points) {
      if (shows(x, y)) path += format("%c%.1f %.1f", path.empty() ? 'M' : 'L', across(x), down(y));
    }
    if (path.empty()) continue;
    const std::string tie = line.point == Line::kNoPoint
                                ? ""
                                : " class=\"curve\" data-point=\"" + std::to_string(line.point) + "\"";
    const char* const colour = line.front || line.reference ? kInk : colour_of(line.colour);
    const std::string more =
        line.front ? " stroke-width=\"7\" stroke-opacity=\"0.13\" stroke-linecap=\"round\" class=\"front\""
        : line.reference ? " stroke-width=\"1.8\" stroke-dasharray=\"6 4\""
                         : format(" stroke-width=\"1.6\" stroke-opacity=\"%.2g\"", line.opacity);
    out_ += "<path" + tie + " d=\"" + path + "\" fill=\"none\" stroke-linejoin=\"round\" stroke=\"" + colour +
            "\"" + more + "/>\n";
  }
}

void Drawing::shape(int index, double x, double y, double r, const char* fill, const char* stroke,
                    double width) {
  const std::string paint = format(" fill=\"%s\" stroke=\"%s\" stroke-width=\"%g\"", fill, stroke, width);
  switch (index % kShapes) {
    case 0:
      out_ += format("<circle cx=\"%.1f\" cy=\"%.1f\" r=\"%.1f\"", x, y, r) + paint + "/>";
      break;
    case 1:
      out_ += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\"", x - 0.9 * r, y - 0.9 * r,
                     1.8 * r, 1.8 * r) +
              paint + "/>";
      break;
    case 2:
      out_ += format("<path d=\"M%.1f %.1fl%.1f %.1fh%.1fz\"", x, y - 1.2 * r, 1.15 * r, 2.1 * r, -2.3 * r) +
              paint + "/>";
      break;
    case 3:
      out_ += format("<path d=\"M%.1f %.1fl%.1f %.1fl%.1f %.1fl%.1f %.1fz\"", x, y - 1.3 * r, 1.3 * r, 1.3 * r,
                     -1.3 * r, 1.3 * r, -1.3 * r, -1.3 * r) +
              paint + "/>";
      break;
    default:
      out_ += format("<path d=\"M%.1f %.1fl%.1f %.1fh%.1fz\"", x, y + 1.2 * r, 1.15 * r, -2.1 * r, -2.3 * r) +
              paint + "/>";
  }
}

void Drawing::marks() {
  for (const Mark& mark : plot_.marks) {
    // Where errors are drawn by their size, one of 0 lies on the lower edge.
    const bool none = plot_.y.log && mark.y == 0.0;
    if (!none && !shows(mark.x, mark.y)) continue;
    const double x = across(mark.x), y = none ? bottom() : down(mark.y);
    const char* const colour = mark.pale ? "#9aa2ad" : colour_of(mark.colour);
    out_ += "<g class=\"mark" + std::string(mark.front ? " on-front" : "") + "\" data-point=\"" +
            std::to_string(mark.point) + "\"><title>" + escaped(mark.title) + "</title>";
    if (mark.x_high > mark.x_low)
      out_ += format("<path d=\"M%.1f %.1fH%.1f\" stroke=\"%s\" stroke-width=\"1.4\"/>", across(mark.x_low), y,
                     across(mark.x_high), colour);
    if (mark.reference) {
      shape(mark.shape, x, y, 6.0, "#ffffff", kInk, 1.8);
    } else {
      shape(mark.shape, x, y, mark.front ? 6.2 : 5.0, mark.pale ? "#ffffff" : colour,
            mark.front ? kInk : colour, 1.6);
    }
    out_ += "</g>\n";
  }
}

/// Points that gave out, above the plot at the time that they took until then; at its left end those that never
/// began.
void Drawing::strip() {
  if (plot_.margin.empty()) return;
  const double y = top_ + 0.5 * kStrip - 1.0;
  out_ += format("<rect x=\"%.1f\" y=\"%.1f\" width=\"%.1f\" height=\"%.1f\" fill=\"#faf1ee\"/>\n", kLeft, top_,
                 kWidth - kLeft - kRight, kStrip - 4.0);
  words(kLeft - 8.0, y + 3.0, "end", 11.0, "#a33c1f", "gave out");
  double refused = kLeft + 10.0;
  for (const Mark& mark : plot_.margin) {
    const bool began = shows(mark.x, 1.0);
    const double x = began ? across(mark.x) : refused;
    if (!began) refused += 14.0;
    out_ +=
        "<g class=\"mark gave-out\" data-point=\"" + std::to_string(mark.point) + "\"><title>" +
        escaped(mark.title) + "</title>" +
        format("<rect x=\"%.1f\" y=\"%.1f\" width=\"14\" height=\"14\" fill=\"#fff\" fill-opacity=\"0\"/>",
               x - 7.0, y - 7.0) +
        format("<path d=\"M%.1f %.1fl8 8m0 -8l-8 8\" fill=\"none\" stroke=\"%s\" stroke-width=\"2\"/></g>\n",
               x - 4.0, y - 4.0, colour_of(mark.colour));
  }
}

std::string Drawing::text() {
  out_ = format(
             "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 %g %g\" width=\"%g\" height=\"%g\" "
             "role=\"img\" "
             "font-family=\"Helvetica, Arial, 'Liberation Sans', sans-serif\" data-name=\"",
             kWidth, kHeight, kWidth, kHeight) +
         escaped(plot_.name) + "\">\n<title>" + escaped(plot_.title) + "</title>\n";
  if (plot_.floor > 0.0)
    out_ += "<defs><pattern id=\"hatch-" + plot_.name +
            "\" width=\"6\" height=\"6\" patternUnits=\"userSpaceOnUse\" "
            "patternTransform=\"rotate(45)\"><rect width=\"6\" height=\"6\" fill=\"#f4f5f7\"/><path d=\"M0 "
            "0V6\" stroke=\"#d5d9df\" stroke-width=\"2\"/></pattern></defs>\n";
  out_ += format("<rect width=\"%g\" height=\"%g\" fill=\"#ffffff\"/>\n", kWidth, kHeight);
  floor();
  axes();
  lines();
  marks();
  strip();
  return out_ + "</svg>\n";
}

}  // namespace

const char* colour_of(int index) {
  return kPalette[static_cast<std::size_t>(index) % kColours];
}

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
      case '&':
        safe += "&amp;";
        break;
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += c;
    }
  }
  return safe;
}

std::vector<double> ticks(double low, double high, bool log) {
  std::vector<double> places;
  if (!(high > low)) return {low};
  if (log) {
    const double decades = std::log10(high / low);
    const int stride = static_cast<int>(std::ceil(decades / 7.0));
    for (int k = static_cast<int>(std::floor(std::log10(low)));
         k <= static_cast<int>(std::ceil(std::log10(high))); ++k) {
      if (stride > 1 && k % stride != 0) continue;
      for (const double part : {1.0, 2.0, 5.0}) {
        if (part != 1.0 && decades > 2.6) continue;
        const double place = part * std::pow(10.0, k);
        if (place >= low && place <= high) places.push_back(place);
      }
    }
    if (places.size() >= 2) return places;
    places.clear();  // less than two of these lie there: as on a plain axis
  }
  const double rough = (high - low) / 6.0, unit = std::pow(10.0, std::floor(std::log10(rough)));
  const double step = unit * (rough / unit < 1.5   ? 1.0
                              : rough / unit < 3.5 ? 2.0
                              : rough / unit < 7.5 ? 5.0
                                                   : 10.0);
  for (double k = std::ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; k += 1.0)
    places.push_back(k == 0.0 ? 0.0 : k * step);
  return places;
}

std::vector<std::string> tick_texts(const std::vector<double>& ticks) {
  std::vector<std::string> texts;
  for (int digits = 3; digits < 9; ++digits) {
    texts.clear();
    for (const double tick : ticks) texts.push_back(short_number(tick, digits));
    if (std::adjacent_find(texts.begin(), texts.end()) != texts.end()) continue;
    // Rounded ones may still differ, and lie: 1.125 as 1.12.
    const auto lies = [&](std::size_t k) {
      return std::abs(std::atof(texts[k].c_str()) - ticks[k]) > 1e-6 * std::abs(ticks[k]);
    };
    bool right = true;
    for (std::size_t k = 0; k < ticks.size(); ++k) right = right && !lies(k);
    if (right) break;
  }
  return texts;
}

std::string svg(const Plot& plot) {
  return Drawing(plot).text();
}

}  // namespace repose
