// Repose: the page of a study: one file that opens from a disk, with its plots, its table and its data in it.
#include "apps/repose/study/page.h"

#include <json/writer.h>

#include <algorithm>
#include <cmath>

#include "apps/repose/study/report.h"

namespace repose {
namespace {

/// Text within HTML; numbers that a table sorts by.
std::string element(const std::string& name, const std::string& text, const std::string& more = "") {
  return "<" + name + (more.empty() ? "" : " " + more) + ">" + escaped(text) + "</" + name + ">";
}

std::string cell(const std::string& text, const std::string& sort, const std::string& kind = "",
                 const std::string& faint = "") {
  return "<td" + (kind.empty() ? "" : " class=\"" + kind + "\"") + " data-sort=\"" + escaped(sort) + "\">" +
         escaped(text) + (faint.empty() ? "" : " <span class=\"faint\">" + escaped(faint) + "</span>") +
         "</td>";
}

std::string number_cell(double value, int digits, const std::string& faint = "", const std::string& kind = "") {
  const bool there = std::isfinite(value);
  return cell(there ? short_number(value, digits) : "", there ? short_number(value, 12) : "", kind, faint);
}

std::string counted(std::size_t count, const std::string& one, const std::string& more) {
  return std::to_string(count) + " " + (count == 1 ? one : more);
}

class Page {
 public:
  explicit Page(const StudyReport& report) : report_(report), plan_(report.plan), summary_(report.summary) {}
  std::string text() const;

 private:
  std::string top() const;
  std::string figure(std::size_t f) const;
  std::string against(std::size_t f) const;
  std::string front(std::size_t f) const;
  std::string table() const;
  std::string row(std::size_t k) const;
  std::string gave_out() const;
  bool any_incomplete() const {
    return std::any_of(summary_.points.begin(), summary_.points.end(),
                       [](const PointSummary& p) { return p.gave_out > 0 || !p.refused.empty() || !p.made(); });
  }
  std::string method() const;
  std::string data() const;

  const StudyReport& report_;
  const StudyPlan& plan_;
  const Summary& summary_;
};

std::string Page::top() const {
  const auto& runs = report_.runs;
  std::string facts;
  const auto fact = [&facts](const std::string& text) { facts += element("span", text); };
  fact(counted(plan_.points.size(), "point", "points"));
  fact(counted(runs.size(), "run", "runs"));
  if (!runs.empty())
    fact(counted(static_cast<std::size_t>(runs[0].result.threads), "thread", "threads") + ", " +
         runs[0].result.target);
  fact(report_.machine);
  fact("repose " + report_.version + ", build " + report_.build.substr(0, 8));
  std::string varied;
  for (const Vary& vary : report_.head.vary) {
    varied += (varied.empty() ? "Varied: " : "; ") + vary.key + " ";
    for (std::size_t k = 0; k < vary.values.size(); ++k) varied += (k > 0 ? ", " : "") + vary.values[k];
  }
  std::string links;
  for (const Figure& figure : plan_.study.figures)
    links += element("a", figure.name, "href=\"#" + escaped(figure.name) + "\"");
  links +=
      element("a", "all points", "href=\"#points\"") + element("a", "how it was measured", "href=\"#method\"");
  std::string html = "<header>" + element("h1", report_.head.name + ": accuracy against time") +
                     "<p class=\"facts\">" + facts + "</p>";
  if (!varied.empty())
    html += element("p", varied + (plan_.study.design == Design::kOneByOne
                                       ? "; one by one, all else as the scene is written."
                                       : "."));
  if (report_.left > 0)
    html += element("p",
                    "Not finished: " + counted(report_.left, "run is", "runs are") +
                        " still to be made. The same command goes on.",
                    "class=\"faint\"");
  return html + "<nav>" + links + "</nav></header>\n";
}

/// What errors are measured against, and how far that can be trusted.
std::string Page::against(std::size_t f) const {
  const Reference& reference = summary_.references[f];
  const Figure& figure = plan_.study.figures[f];
  if (!reference.there) return "No reference: values alone.";
  std::string text;
  if (figure.compares() == Compares::kItself) {
    text = "The figure is an error by itself: " + reference.source + ".";
  } else {
    text = "Reference: " + reference.source;
    if (figure.compares() == Compares::kValue || reference.count > 0)
      text +=
          "; " + short_number(reference.value.value, 5) + (figure.unit().empty() ? "" : " " + figure.unit());
    text += ".";
  }
  if (reference.count == 1) text += " One run has no scatter, so there is no noise floor.";
  if (std::isfinite(reference.floor) && reference.floor > 0.0)
    text += " Noise floor " + error_text(figure, reference.floor) + ".";
  if (reference.count == 0) return text;
  double finest = INFINITY;
  for (std::size_t k = 0; k < summary_.points.size(); ++k) {
    if (k != plan_.finest && summary_.points[k].whole()) finest = std::min(finest, summary_.points[k].spacing);
  }
  const double times = finest / summary_.points[plan_.finest].spacing;
  if (times < 1.99)
    text += " It is " + (times < 1.01 ? std::string("no") : short_number(times) + " times") +
            " finer than the finest point beside it, so its own error is in none of these: near it they look "
            "smaller than they are.";
  return text;
}

std::string Page::front(std::size_t f) const {
  std::vector<std::size_t> order;
  for (std::size_t k = 0; k < summary_.points.size(); ++k) {
    if (summary_.points[k].figures[f].front) order.push_back(k);
  }
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return summary_.points[a].seconds.median < summary_.points[b].seconds.median;
  });
  if (order.empty()) return "";
  std::string items;
  for (const std::size_t k : order) {
    items += "<li data-point=\"" + std::to_string(k) + "\" data-text=\"" +
             escaped(point_text(plan_, summary_, k, f)) + "\"><b>" +
             escaped(short_number(summary_.points[k].seconds.median)) + " s, " +
             escaped(error_text(plan_.study.figures[f], summary_.points[k].figures[f].error.value)) + "</b> " +
             escaped(summary_.points[k].point.text()) + "</li>";
  }
  return "<div class=\"front-list\"><p class=\"faint\">On the front, where nothing is both faster and "
         "nearer:</p><ul>" +
         items + "</ul></div>";
}

std::string Page::figure(std::size_t f) const {
  const Figure& figure = plan_.study.figures[f];
  std::string html = "<section id=\"" + escaped(figure.name) + "\">" + element("h2", figure.name) +
                     element("p", against(f)) + "<div class=\"plots\">";
  for (const Plot& plot : charts_of(report_.head, plan_, summary_, f))
    html += "<figure>" + svg(plot) + "<button type=\"button\" hidden title=\"" + escaped(plot.name) +
            ".svg\">SVG</button></figure>\n";
  return html + front(f) + "</div></section>\n";
}

std::string Page::row(std::size_t k) const {
  const PointSummary& p = summary_.points[k];
  const bool bad = p.gave_out > 0 || !p.refused.empty();
  const std::string text = p.point.text() + (bad ? "\n" + (p.refused.empty() ? p.words : p.refused) : "");
  std::string html = "<tr data-text=\"" + escaped(text) + "\" data-point=\"" + std::to_string(k) + "\"" +
                     (bad ? " class=\"gave-out\"" : "") + ">";
  html += cell(std::to_string(k + 1) + (k == plan_.finest ? " reference" : ""), std::to_string(k), "word");
  if (report_.head.vary.empty()) html += cell(p.point.text(), p.point.text(), "word");
  for (std::size_t v = 0; v < report_.head.vary.size(); ++v) {
    std::string value;
    for (const Setting& setting : p.point.settings)
      value = setting.key == report_.head.vary[v].key ? setting.value : value;
    const bool written = value.empty();
    if (written) value = report_.head.written[v].empty() ? "default" : report_.head.written[v];
    html += cell(written ? "" : value, value, "word", written ? value : "");
  }
  const std::string state =
      p.gave_out > 0 ? std::to_string(p.gave_out) + " of " + std::to_string(p.runs) + " gave out" : p.state();
  if (any_incomplete()) html += bad || !p.made() ? cell(state, state, "word") : cell("", state, "word", state);
  const std::string spread = p.seconds.high > p.seconds.low
                                 ? short_number(p.seconds.low) + "\u2013" + short_number(p.seconds.high)
                                 : "";
  html += number_cell(p.seconds.median, 3, spread);
  html += p.particles > 0 ? number_cell(static_cast<double>(p.particles), 9) : cell("", "");
  html += p.steps > 0 ? number_cell(static_cast<double>(p.steps), 9) : cell("", "");
  html += p.peak_bytes > 0.0 ? number_cell(1e-6 * p.peak_bytes, 3) : cell("", "");
  for (std::size_t f = 0; f < plan_.study.figures.size(); ++f) {
    const PointFigure& of = p.figures[f];
    const double scale = is_share(plan_.study.figures[f].compares()) ? 100.0 : 1.0;
    const std::string kind = of.front ? "on-front" : of.below_floor ? "pale" : "";
    html += number_cell(of.figure.count > 0 ? of.figure.mean.value : NAN, 4, "", scale == 100.0 ? "" : kind);
    if (summary_.references[f].there && scale == 100.0)
      html += number_cell(scale * of.error.value, 3, "", kind);
  }
  return html + "</tr>\n";
}

std::string Page::table() const {
  std::string head;
  const auto column = [&head](const std::string& name, const char* kind = "") {
    head += "<th scope=\"col\" aria-sort=\"none\"" +
            std::string(*kind != 0 ? " class=\"" + std::string(kind) + "\"" : "") +
            "><button type=\"button\">" + escaped(name) + "</button></th>";
  };
  column("point", "word");
  if (report_.head.vary.empty()) column("settings", "word");
  for (const Vary& vary : report_.head.vary) column(vary.key, "word");
  if (any_incomplete()) column("state", "word");
  for (const char* name : {"time [s]", "particles", "steps", "memory [MB]"}) column(name);
  for (std::size_t f = 0; f < plan_.study.figures.size(); ++f) {
    const Figure& figure = plan_.study.figures[f];
    column(figure.name + (figure.unit().empty() ? "" : " [" + figure.unit() + "]"));
    if (summary_.references[f].there && is_share(figure.compares())) column(figure.name + " error [%]");
  }
  std::string rows;
  for (std::size_t k = 0; k < summary_.points.size(); ++k) rows += row(k);
  return "<section id=\"points\">" + element("h2", "All points") +
         element("p",
                 "A heading sorts. Errors on a front are bold; those under twice the noise floor are grey: "
                 "they cannot be told from none.") +
         "<div class=\"table\"><table><thead><tr>" + head + "</tr></thead><tbody>\n" + rows +
         "</tbody></table></div></section>\n";
}

/// The words of what was refused or gave out.
std::string Page::gave_out() const {
  std::string items;
  for (std::size_t k = 0; k < summary_.points.size(); ++k) {
    const PointSummary& p = summary_.points[k];
    if (p.refused.empty() && p.gave_out == 0) continue;
    items += "<li data-point=\"" + std::to_string(k) + "\">" + element("b", p.point.text()) + " " +
             element("span", p.refused.empty() ? p.words : p.refused, "class=\"words\"") + "</li>";
  }
  return items.empty() ? ""
                       : "<section id=\"gave-out\">" + element("h2", "What gave out") + "<ul>" + items +
                             "</ul></section>\n";
}

std::string Page::method() const {
  std::string html = "<section id=\"method\">" + element("h2", "How it was measured");
  html += element("p",
                  "Each run is a process of its own. Its time is that of its steps alone: not of setting up, "
                  "of measuring, or of any "
                  "output. Plots have the median over seeds and repetitions, with a bar from the lower to the "
                  "upper quartile.");
  html += element(
      "p", "Each point was run with " + counted(static_cast<std::size_t>(plan_.study.seeds), "seed", "seeds") +
               " for the places of particles, each timed " +
               (plan_.study.repeat == 1 ? std::string("once") : std::to_string(plan_.study.repeat) + " times") +
               (report_.parallel > 1
                    ? ", " + std::to_string(report_.parallel) + " runs side by side, which slows each of them."
                    : ", one run after another.") +
               " A figure is the mean over seeds, its error the distance of that mean from the reference.");
  html += element(
      "p",
      "The noise floor is the standard error that the scatter of runs with other seeds alone gives "
      "such a distance: s \u221a(1/n + 1/m), with s the standard deviation of single runs, n the seeds "
      "of a point and m those of the reference; s/\u221an where the reference is known. What lies below "
      "twice of it is hatched.");
  return html + "</section>\n";
}

/// A script ends where its text says so, so "<" is written otherwise.
std::string Page::data() const {
  Json::StreamWriterBuilder writer;
  writer["indentation"] = "";
  std::string safe;
  for (const char c : Json::writeString(writer, report_.json()))
    safe += c == '<' ? std::string("\\u003c") : std::string(1, c);
  return safe;
}

std::string Page::text() const {
  std::string html =
      "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
      element("title", report_.head.name + ": accuracy against time") + "\n<style>\n" + kPageStyle +
      "</style>\n</head>\n<body>\n<main>\n" + top();
  for (std::size_t f = 0; f < plan_.study.figures.size(); ++f) html += figure(f);
  html += table() + gave_out() + method();
  html += "<footer>Scene " + escaped(report_.scene_hash) +
          ". <button type=\"button\" id=\"save-data\" hidden>data as JSON</button> Every run stands in "
          "study.csv beside this page.</footer>\n";
  html +=
      "</main>\n<div id=\"tip\" role=\"status\" hidden></div>\n<script type=\"application/json\" "
      "id=\"study-data\">" +
      data() + "</script>\n<script>\n" + kPageScript + "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace

std::string StudyReport::page() const {
  return Page(*this).text();
}

}  // namespace repose
