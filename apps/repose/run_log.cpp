#include "apps/repose/run_log.h"

#include <json/writer.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "apps/repose/base/json_file.h"
#include "engine/compiler/figures.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

Json::Value vector_json(const Triple& v) {
  Json::Value json(Json::arrayValue);
  for (const double component : v) json.append(component);
  return json;
}

Json::Value limits_json(const FrameReport& frame) {
  Json::Value json(Json::objectValue);
  for (std::size_t k = 0; k < frame.limits.size(); ++k) {
    if (frame.limits[k] > 0) json[limit_name(static_cast<Limit>(k))] = Json::Int64(frame.limits[k]);
  }
  return json;
}

void add_figures(const Diagnostics& d, double spacing, Json::Value& row) {
  row["particles"] = Json::UInt64(d.particles);
  row["mass"] = d.mass;
  row["volume"] = d.volume;
  row["energy"] = energy_json(d);
  row["momentum"] = vector_json(d.momentum);
  row["angular_momentum"] = vector_json(d.angular_momentum);
  row["center_of_mass"] = vector_json(d.center_of_mass);
  row["lower"] = vector_json(d.lower);
  row["upper"] = vector_json(d.upper);
  row["max_speed"] = d.max_speed;
  row["deepest"]["meters"] = d.deepest;
  row["deepest"]["cells"] = d.deepest / spacing;
  if (!d.deepest_solid.empty()) {
    row["deepest"]["solid"] = d.deepest_solid;
    row["deepest"]["id"] = d.deepest_id;
  }
}

/// Masses in kg under the plain names; numbers of particles, which add up exactly, beside them.
void add_ledger(const LedgerReport& ledger, Json::Value& json) {
  json["emitted"] = ledger.emitted.mass;
  json["removed"] = ledger.removed.mass;
  json["held"] = ledger.held.mass;
  json["particles"]["initial"] = Json::UInt64(ledger.initial);
  json["particles"]["emitted"] = Json::UInt64(ledger.emitted.particles);
  json["particles"]["removed"] = Json::UInt64(ledger.removed.particles);
  json["particles"]["held"] = Json::UInt64(ledger.held.particles);
  const auto add = [&json](const char* list, const LedgerReport::Entry& entry) {
    json[list][entry.name]["kg"] = entry.mass;
    json[list][entry.name]["particles"] = Json::UInt64(entry.particles);
  };
  for (const auto& emitter : ledger.emitters) add("emitters", emitter);
  for (const auto& sink : ledger.sinks) add("sinks", sink);
}

std::string hex(std::uint64_t value) {
  char text[17];
  std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
  return text;
}

/// Whether a row holds what readers of logs ask for.
bool is_row(const Json::Value& row) {
  return row.isObject() && row["frame"].isInt64() && row["time"].isNumeric() && row["steps"].isInt64() &&
         row["particles"].isUInt64() && row["mass"].isNumeric() && row["hash"].isString() &&
         row["seconds"].isObject() && row["seconds"]["wall"].isNumeric() && row["deepest"].isObject() &&
         row["deepest"]["cells"].isNumeric();
}

/// Whether it is a log: a file that was edited, or is of another program, must not end this one.
bool is_log(const Json::Value& log) {
  if (!log.isObject() || !log["scene"].isObject() || !log["frames"].isArray()) return false;
  const bool head = log["scene"]["name"].isString() && log["scene"]["folder"].isString() &&
                    log["repose"].isString() && log["target"].isString() && log["threads"].isInt() &&
                    log["end"].isString();
  return head && std::all_of(log["frames"].begin(), log["frames"].end(), is_row);
}

}  // namespace

std::string one_line(const Json::Value& json) {
  Json::StreamWriterBuilder builder;
  builder["indentation"] = "";
  return Json::writeString(builder, json);
}

RunLog::RunLog(const Scene& scene, const std::string& quality, const Simulation& simulation) {
  log_["repose"] = REPOSE_VERSION;
  log_["compiler"] = __VERSION__;
  log_["target"] = target_name(simulation.target());
  log_["threads"] = simulation.threads();
  log_["scene"]["name"] = scene.name;
  log_["scene"]["quality"] = quality;
  log_["scene"]["hash"] = scene_hash(scene);
  log_["scene"]["folder"] =
      std::filesystem::absolute(scene.folder.empty() ? "." : scene.folder).lexically_normal().string();
  log_["scene"]["spacing"] = scene.grid.spacing;
  log_["scene"]["frames_per_second"] = scene.time.frames_per_second;
  log_["precision"] = scene.grid.precision == Precision::kSingle ? "single" : "double";
  log_["integrator"]["choice"] = simulation.integrator().implicit ? "implicit" : "explicit";
  log_["integrator"]["reason"] = simulation.integrator().reason;
  for (const EffectStatus& effect : effect_status(scene)) {
    Json::Value& json = log_["effects"][effect.name];
    json["on"] = effect.on;
    json["why"] = effect.reason;
    json["bytes_per_particle"] = Json::UInt64(effect.bytes_per_particle);
  }
  log_["warnings"] = Json::Value(Json::arrayValue);
  log_["frames"] = Json::Value(Json::arrayValue);
  log_["end"] = kRunning;
  if (!scene.output.steps) return;
  log_["steps"] = Json::Value(Json::arrayValue);
  count_left_out(0);
  steps_.emplace(scene.output.residuals);
}

std::string RunLog::continue_from(const std::string& path, const Counters& last) {
  const auto read = read_json_file(path);
  if (!read && read.error().kind == ErrorKind::kNoInput) return "";
  if (!read || !is_log(*read)) {
    std::error_code failure;
    std::filesystem::rename(path, path + ".damaged", failure);
    return path + " is damaged, so the figures of the frames up to " + std::to_string(last.frame) +
           " are lost" + (failure ? "" : "; it lies beside the new one as run.json.damaged");
  }
  const Json::Value& old = *read;
  for (const Json::Value& frame : old["frames"]) {
    if (frame["frame"].asInt64() <= last.frame) log_["frames"].append(frame);
  }
  if (old["steps"].isArray() && !old["steps"].empty()) {
    Json::Value& steps = log_["steps"] = Json::Value(Json::arrayValue);
    for (const Json::Value& step : old["steps"]) {
      if (step.isObject() && step["step"].isInt64() && step["step"].asInt64() <= last.step) steps.append(step);
    }
  }
  if (log_.isMember("steps")) count_left_out(last.step);
  for (const Json::Value& warning : old["warnings"]) {
    if (warning.isString()) warn(warning.asString());
  }
  return "";
}

void RunLog::warn(const std::string& warning) {
  Json::Value& warnings = log_["warnings"];
  if (std::find(warnings.begin(), warnings.end(), Json::Value(warning)) == warnings.end())
    warnings.append(warning);
}

/// Of so many steps, those that have no row.
void RunLog::count_left_out(std::int64_t steps) {
  log_["steps_left_out"] = Json::Int64(steps - std::int64_t{log_["steps"].size()});
}

void RunLog::begin_steps(Simulation& simulation) {
  if (steps_ && room_for_steps()) steps_->begin(simulation);
}

void RunLog::add_step(const StepReport& report, Simulation& simulation, std::int64_t frame) {
  if (!steps_) return;
  if (room_for_steps()) log_["steps"].append(steps_->row(report, simulation, frame));
  count_left_out(simulation.counters().step);
}

const Json::Value& RunLog::add(const FrameReport& frame, Simulation& simulation) {
  Json::Value row;
  row["frame"] = Json::Int64(frame.frame);
  row["time"] = frame.time;
  if (frame.resumed) row["resumed"] = true;  // steps, dt, limits and seconds are those since then
  row["steps"] = Json::Int64(frame.steps);
  row["dt"]["least"] = frame.least_dt;
  row["dt"]["largest"] = frame.largest_dt;
  row["bound_by"] = limits_json(frame);
  row["redone"] = Json::Int64(frame.redone);
  if (frame.redone > 0) row["redone_because"] = frame.first_refusal;
  if (frame.newton_iterations > 0) {
    row["newton_iterations"] = Json::Int64(frame.newton_iterations);
    row["linear_iterations"] = Json::Int64(frame.linear_iterations);
  }
  row["solver_iterations"] = Json::Int64(frame.linear_iterations);  // none in explicit steps
  row["seconds"]["wall"] = frame.seconds;
  for (std::size_t k = 0; k < kPhaseNames.size(); ++k)
    row["seconds"][kPhaseNames[k]] = frame.profile.seconds[k];
  add_figures(simulation.diagnose(), log_["scene"]["spacing"].asDouble(), row);
  add_ledger(simulation.ledger(), row["ledger"]);
  // A height where nothing lies is null: JSON knows no other word for it.
  for (const Measurement& m : simulation.measurements()) {
    row["probes"][m.probe][m.quantity] = std::isfinite(m.value) ? Json::Value(m.value) : Json::Value();
  }
  row["asleep"] = Json::UInt64(simulation.particles_asleep());
  row["blocks"] = Json::UInt64(simulation.memory().blocks);
  row["hash"] = hex(simulation.hash());
  if (log_.isMember("steps")) count_left_out(simulation.counters().step);
  return log_["frames"].append(row);
}

void RunLog::add_written(const WrittenFrame& written) {
  for (Json::Value& row : log_["frames"]) {
    if (row["frame"].asInt64() != written.frame) continue;
    for (const auto& [kind, seconds] : written.seconds) row["seconds"]["output"][kind] = seconds;
    row["output_bytes"] = written.bytes;
  }
}

const Json::Value* RunLog::row_of(std::int64_t frame) const {
  for (const Json::Value& row : log_["frames"]) {
    if (row["frame"].asInt64() == frame) return &row;
  }
  return nullptr;
}

bool RunLog::knows_files_of(std::int64_t frame) const {
  const Json::Value* const row = row_of(frame);
  return row != nullptr && row->isMember("output_bytes");
}

bool RunLog::has_row(std::int64_t frame) const {
  return frame == 0 || row_of(frame) != nullptr;
}

Result<void> RunLog::write(const std::string& path) const {
  Json::StreamWriterBuilder builder;
  builder["indentation"] = " ";
  const std::string text = Json::writeString(builder, log_) + "\n";
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  if (auto written = file->write(text.data(), text.size()); !written) return written;
  return file->commit();
}

Result<void> RunLog::write_probes(const Simulation& simulation, const std::string& path) const {
  const std::vector<Measurement> columns = simulation.measurements();
  if (columns.empty()) return {};
  std::string text = "frame,time [s]";
  for (const Measurement& m : columns) {
    text += "," + m.probe + "." + m.quantity + (m.unit.empty() ? "" : " [" + m.unit + "]");
  }
  text += "\n";
  const auto add_number = [&text](const Json::Value& value) {
    char digits[32];
    std::snprintf(digits, sizeof digits, ",%.9g", value.isNumeric() ? value.asDouble() : 0.0);
    text += value.isNumeric() ? digits : ",";
  };
  for (const Json::Value& row : log_["frames"]) {
    text += std::to_string(row["frame"].asInt64());
    add_number(row["time"]);
    const Json::Value& probes = row["probes"];
    for (const Measurement& m : columns) {
      const bool there = probes.isObject() && probes[m.probe].isObject();
      add_number(there ? probes[m.probe][m.quantity] : Json::Value());
    }
    text += "\n";
  }
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  if (auto written = file->write(text.data(), text.size()); !written) return written;
  return file->commit();
}

Result<Json::Value> read_run_log(const std::string& folder) {
  const std::string path = folder + "/run.json";
  auto log = read_json_file(path);
  if (!log && log.error().kind == ErrorKind::kNoInput)
    return Error{ErrorKind::kNoInput, "cannot be read; is this the folder of a run?", path};
  if (!log || !is_log(*log))
    return Error{ErrorKind::kIo, "is not the log of a run; give a folder that run has written", path};
  return log;
}

}  // namespace repose
