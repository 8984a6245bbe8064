#include "apps/repose/study/report.h"

#include <json/writer.h>

#include <cmath>
#include <filesystem>

#include "engine/io/atomic_file.h"

namespace repose {
namespace {

Json::Value settings_json(const Point& point) {
  Json::Value json(Json::objectValue);
  for (const Setting& setting : point.settings) json[setting.key] = setting.value;
  return json;
}

Json::Value figure_json(const Figure& figure, const PointFigure& of) {
  Json::Value json;
  json["value"] = of.figure.count > 0 ? number_json(of.figure.mean.value) : Json::Value();
  json["unit"] = figure.unit();
  json["seeds"] = Json::UInt64(of.figure.count);
  json["scatter"] = number_json(of.figure.scatter);
  json["error"] = number_json(of.error.value);
  if (std::isfinite(of.error.largest)) json["largest_error"] = of.error.largest;
  json["under_twice_the_floor"] = of.below_floor;
  json["front"] = of.front;
  if (!of.figure.mean.curve.empty()) json["curve"] = to_json(of.figure.mean.curve);
  return json;
}

Json::Value point_json(const StudyPlan& plan, const PointSummary& point) {
  Json::Value json;
  json["settings"] = settings_json(point.point);
  json["state"] = point.state();
  json["words"] = point.refused.empty() ? point.words : point.refused;
  json["code"] = point.refused.empty() ? point.code : static_cast<int>(ErrorKind::kBadScene);
  json["runs"] = Json::UInt64(point.runs);
  json["gave_out"] = Json::UInt64(point.gave_out);
  json["seconds"]["median"] = number_json(point.seconds.median);
  json["seconds"]["low"] = number_json(point.seconds.low);
  json["seconds"]["high"] = number_json(point.seconds.high);
  json["peak_bytes"] = point.peak_bytes;
  json["particles"] = Json::UInt64(point.particles);
  json["steps"] = Json::Int64(point.steps);
  json["spacing"] = point.spacing;
  json["time"] = point.time;
  for (std::size_t f = 0; f < plan.study.figures.size(); ++f)
    json["figures"][plan.study.figures[f].name] = figure_json(plan.study.figures[f], point.figures[f]);
  return json;
}

std::string csv_text(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

}  // namespace

Json::Value StudyReport::json() const {
  Json::Value json;
  json["repose"] = version;
  json["build"] = build;
  json["machine"] = machine;
  json["scene"]["name"] = head.name;
  json["scene"]["hash"] = scene_hash;
  json["design"] = kDesigns[static_cast<int>(plan.study.design)].name;
  json["seeds"] = Json::Int64(plan.study.seeds);
  json["repeat"] = Json::Int64(plan.study.repeat);
  json["parallel"] = parallel;
  json["runs"] = Json::UInt64(runs.size());
  json["runs_left"] = Json::UInt64(left);
  json["finest"] = plan.finest == StudyPlan::npos ? Json::Value() : Json::Value(Json::UInt64(plan.finest));
  json["vary"] = Json::Value(Json::arrayValue);
  for (const Vary& vary : head.vary) {
    Json::Value entry;
    entry["key"] = vary.key;
    for (const std::string& value : vary.values) entry["values"].append(value);
    json["vary"].append(entry);
  }
  for (std::size_t f = 0; f < plan.study.figures.size(); ++f) {
    const Figure& figure = plan.study.figures[f];
    const Reference& reference = summary.references[f];
    Json::Value& entry = json["figures"][figure.name];
    entry["type"] = figure.type();
    entry["unit"] = figure.unit();
    entry["error_is_share"] = is_share(figure.compares());
    if (!reference.there) continue;
    entry["reference"]["source"] = reference.source;
    entry["reference"]["value"] = number_json(reference.value.value);
    entry["reference"]["runs"] = Json::UInt64(reference.count);
    entry["reference"]["scatter"] = number_json(reference.scatter);
    entry["noise_floor"] = number_json(reference.floor);
    if (!reference.value.curve.empty()) entry["reference"]["curve"] = to_json(reference.value.curve);
  }
  json["points"] = Json::Value(Json::arrayValue);
  for (const PointSummary& point : summary.points) json["points"].append(point_json(plan, point));
  return json;
}

std::string StudyReport::csv() const {
  std::string text = "point,seed,repeat,reference";
  for (const Vary& vary : head.vary) text += "," + csv_text(vary.key);
  text += ",settings,code,words,spacing [m],particles,steps,time [s],seconds,threads,target,peak [bytes],hash";
  for (const Figure& figure : plan.study.figures)
    text += "," + csv_text(figure.name + (figure.unit().empty() ? "" : " [" + figure.unit() + "]"));
  text += "\n";
  const auto head_of = [&](std::size_t point) {
    const Point& p = plan.points[point];
    std::string line = point == plan.finest ? ",1" : ",0";
    for (const Vary& vary : head.vary) {
      std::string value;
      for (const Setting& setting : p.settings) value = setting.key == vary.key ? setting.value : value;
      line += "," + csv_text(value);
    }
    return line + "," + csv_text(p.text());
  };
  for (std::size_t point = 0; point < plan.points.size(); ++point) {
    if (!plan.refused[point].empty())
      text += std::to_string(point) + ",0,0" + head_of(point) + ",65," + csv_text(plan.refused[point]) +
              std::string(9 + plan.study.figures.size(), ',') + "\n";
  }
  for (const StudyRun& run : runs) {
    const RunResult& r = run.result;
    text += std::to_string(run.point) + "," + std::to_string(run.seed) + "," + std::to_string(run.repeat) +
            head_of(run.point) + "," + std::to_string(r.code) + "," + csv_text(r.words) + "," +
            short_number(r.spacing, 9) + "," + std::to_string(r.particles) + "," + std::to_string(r.steps) +
            "," + short_number(r.time, 9) + "," + short_number(r.seconds, 6) + "," + std::to_string(r.threads) +
            "," + r.target + "," + short_number(r.peak_bytes, 12) + "," + r.hash;
    for (const Figure& figure : plan.study.figures) {
      const auto found = r.figures.find(figure.name);
      text += ",";
      if (found != r.figures.end() && found->second.there()) text += short_number(found->second.value, 9);
    }
    text += "\n";
  }
  return text;
}

Result<void> write_report(const StudyReport& report, const std::string& folder) {
  Json::StreamWriterBuilder writer;
  writer["indentation"] = " ";
  if (auto written = write_text(folder + "/study.json", Json::writeString(writer, report.json()) + "\n");
      !written)
    return written;
  if (auto written = write_text(folder + "/study.csv", report.csv()); !written) return written;
  for (std::size_t f = 0; f < report.plan.study.figures.size(); ++f) {
    for (const Plot& plot : charts_of(report.head, report.plan, report.summary, f)) {
      if (auto written = write_text(folder + "/" + plot.name + ".svg", svg(plot)); !written) return written;
    }
  }
  return write_text(folder + "/index.html", report.page());
}

}  // namespace repose
