#include "apps/repose/study/run_result.h"

#include <json/writer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "apps/repose/base/json_file.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

std::vector<double> numbers_of(const Json::Value& list) {
  std::vector<double> numbers;
  for (const Json::Value& number : list) numbers.push_back(number.isNumeric() ? number.asDouble() : NAN);
  return numbers;
}

bool is_result(const Json::Value& json) {
  if (!json.isObject() || !json["code"].isInt() || !json["steps"].isInt64() || !json["threads"].isInt() ||
      !json["particles"].isUInt64() || !json["figures"].isObject())
    return false;
  for (const char* key : {"words", "build", "inputs", "hash", "target"}) {
    if (!json[key].isString()) return false;
  }
  for (const char* key : {"spacing", "time", "seconds", "peak_bytes"}) {
    if (!json[key].isNumeric() && !json[key].isNull()) return false;
  }
  const Json::Value& figures = json["figures"];
  return std::all_of(figures.begin(), figures.end(), [](const Json::Value& entry) {
    return entry.isObject() &&
           (!entry["curve"].isObject() || (entry["curve"]["x"].isArray() && entry["curve"]["y"].isArray()));
  });
}

}  // namespace

Json::Value number_json(double value) {
  return std::isfinite(value) ? Json::Value(value) : Json::Value();
}

Json::Value to_json(const Curve& curve) {
  Json::Value json(Json::objectValue);
  json["x"] = json["y"] = Json::Value(Json::arrayValue);
  for (const double x : curve.x) json["x"].append(number_json(x));
  for (const double y : curve.y) json["y"].append(number_json(y));
  return json;
}

Json::Value to_json(const RunResult& run) {
  Json::Value json;
  json["code"] = run.code;
  json["words"] = run.words;
  json["build"] = run.build;
  json["inputs"] = run.inputs;
  json["hash"] = run.hash;
  json["spacing"] = run.spacing;
  json["time"] = run.time;
  json["seconds"] = run.seconds;
  json["peak_bytes"] = run.peak_bytes;
  json["particles"] = Json::UInt64(run.particles);
  json["steps"] = Json::Int64(run.steps);
  json["threads"] = run.threads;
  json["target"] = run.target;
  json["figures"] = Json::Value(Json::objectValue);
  for (const auto& [name, figure] : run.figures) {
    Json::Value& entry = json["figures"][name];
    entry["value"] = figure.there() ? number_json(figure.value) : Json::Value();
    if (!figure.there()) entry["why"] = figure.why;
    if (!figure.curve.empty()) entry["curve"] = to_json(figure.curve);
  }
  return json;
}

Result<RunResult> read_run_result(const std::string& path) {
  auto read = read_json_file(path);
  if (!read && read.error().kind == ErrorKind::kNoInput) return read.error();
  if (!read || !is_result(*read))
    return Error{ErrorKind::kIo, "is not what a run of a study writes; remove it, and the run is made again",
                 path};
  const Json::Value& json = *read;
  RunResult run;
  run.code = json["code"].asInt();
  run.words = json["words"].asString();
  run.build = json["build"].asString();
  run.inputs = json["inputs"].asString();
  run.hash = json["hash"].asString();
  run.spacing = json["spacing"].asDouble();
  run.time = json["time"].asDouble();
  run.seconds = json["seconds"].asDouble();
  run.peak_bytes = json["peak_bytes"].asDouble();
  run.particles = json["particles"].asUInt64();
  run.steps = json["steps"].asInt64();
  run.threads = json["threads"].asInt();
  run.target = json["target"].asString();
  for (const std::string& name : json["figures"].getMemberNames()) {
    const Json::Value& entry = json["figures"][name];
    FigureValue& figure = run.figures[name];
    if (entry["value"].isNumeric()) figure.value = entry["value"].asDouble();
    if (!entry["value"].isNumeric())
      figure.why = entry["why"].isString() ? entry["why"].asString() : "it is no number";
    if (entry["curve"].isObject())
      figure.curve = {numbers_of(entry["curve"]["x"]), numbers_of(entry["curve"]["y"])};
  }
  return run;
}

Result<void> write_run_result(const RunResult& run, const std::string& path) {
  Json::StreamWriterBuilder writer;
  writer["indentation"] = "";
  return write_text(path, Json::writeString(writer, to_json(run)) + "\n");
}

std::string fingerprint(const std::string& text) {
  std::uint64_t hash = 0xcbf29ce484222325ull;
  for (const char c : text) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3ull;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(hash));
  return digits;
}

}  // namespace repose
