#include "bench/scene_bench.h"

#include <json/json.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <thread>

#include "apps/repose/measure.h"
#include "engine/reading/reader.h"

namespace repose {
namespace {

/// One measurement to be made.
struct Case {
  std::string scene;     ///< path
  double spacing = 0.0;  ///< m; 0: the scene's
  int threads = 1;
  std::int64_t steps = 1;
};

Json::Value as_json(const Error& error) {
  Json::Value json;
  json["error"] = error.text();
  json["kind"] = static_cast<int>(error.kind);
  return json;
}

Json::Value run(const Case& what) {
  ReadOptions reading;
  if (what.spacing > 0.0) {
    char text[64];
    std::snprintf(text, sizeof text, "grid.spacing=%.17g", what.spacing);
    reading.overrides.push_back(text);
  }
  const auto scene = read_scene(what.scene, reading);
  if (!scene) return as_json(scene.error());
  SimulationOptions options;
  options.threads = what.threads;
  auto simulation = Simulation::create(*scene, options);
  if (!simulation) return as_json(simulation.error());
  auto figures = measure_steps(**simulation, what.steps);
  if (!figures) return as_json(figures.error());
  (*figures)["spacing"] = scene->grid.spacing;
  return *figures;
}

/// Runs a case in a process of its own, so that its peak of memory is its own, and one that is killed for want
/// of memory does not end the others.
Result<Json::Value> run_apart(const Case& what) {
  int ends[2];
  if (pipe(ends) != 0) return Error{ErrorKind::kIo, "no pipe to a measuring process", {}};
  std::fflush(nullptr);
  const pid_t child = fork();
  if (child < 0) return Error{ErrorKind::kIo, "no measuring process could be started", {}};
  if (child == 0) {
    close(ends[0]);
    const std::string text = run(what).toStyledString();
    const ssize_t written = write(ends[1], text.data(), text.size());  // less than a pipe holds
    _exit(written == static_cast<ssize_t>(text.size()) ? 0 : 1);
  }
  close(ends[1]);
  std::string text;
  char piece[4096];
  for (ssize_t got = 0; (got = read(ends[0], piece, sizeof piece)) > 0;)
    text.append(piece, static_cast<std::size_t>(got));
  close(ends[0]);
  int status = 0;
  waitpid(child, &status, 0);
  Json::Value json;
  if (status != 0 || !Json::Reader().parse(text, json)) {
    return Error{ErrorKind::kMemory, "the measuring process was ended; was there enough memory?", what.scene};
  }
  if (json.isMember("error"))
    return Error{static_cast<ErrorKind>(json["kind"].asInt()), json["error"].asString(), {}};
  return json;
}

double median(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Replaces numbers that repeats may change by their medians.
void take_medians(const std::vector<Json::Value>& repeats, Json::Value& row) {
  const auto over = [&](const auto& value_of) {
    std::vector<double> values;
    for (const Json::Value& repeat : repeats) values.push_back(value_of(repeat).asDouble());
    return median(std::move(values));
  };
  for (const char* key : {"seconds", "ns_per_particle_step", "peak_rss_bytes"}) {
    row[key] = over([key](const Json::Value& json) { return json[key]; });
  }
  for (const std::string& phase : row["phases"].getMemberNames()) {
    row["phases"][phase] = over([&phase](const Json::Value& json) { return json["phases"][phase]; });
  }
}

Result<Json::Value> measure_case(const Case& what, int repeats) {
  std::vector<Json::Value> all;
  for (int k = 0; k < repeats; ++k) {
    auto json = run_apart(what);
    if (!json) return json.error();
    if (!all.empty() && (*json)["hash"] != all[0]["hash"]) {
      return Error{ErrorKind::kPhysics, "two runs of the same case end in different states", what.scene};
    }
    all.push_back(std::move(*json));
  }
  Json::Value row = all[0];
  take_medians(all, row);
  row["repeats"] = repeats;
  return row;
}

std::string path_of(const std::string& scene) {
  return scene.find('/') == std::string::npos && scene.find('.') == std::string::npos
             ? std::string(REPOSE_SCENES) + "/" + scene + ".json"
             : scene;
}

std::vector<int> default_threads() {
  std::vector<int> counts;
  const int most = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  for (int count = 1; count < most; count *= 2) counts.push_back(count);
  counts.push_back(most);
  return counts;
}

void tell(const Json::Value& row) {
  std::fprintf(stderr, "%-16s %10.0f particles %3d threads %7.2f ns per particle and step, %.1f bytes, %s\n",
               row["scene"].asCString(), row["particles"].asDouble(), row["threads"].asInt(),
               row["ns_per_particle_step"].asDouble(), row["bytes_per_particle"].asDouble(),
               row["hash"].asCString());
}

/// The rows of one scene and size.
Result<void> bench_size(const SceneBenchArguments& arguments, const std::string& scene, double size,
                        double spacing, Json::Value& rows) {
  std::string hash;
  for (const int threads : arguments.threads.empty() ? default_threads() : arguments.threads) {
    auto row = measure_case({path_of(scene), spacing, threads, arguments.steps}, arguments.repeats);
    if (!row && row.error().kind == ErrorKind::kMemory) {
      std::fprintf(stderr, "%s: about %.3g particles left out: %s\n", scene.c_str(), size,
                   row.error().text().c_str());
      return {};
    }
    if (!row) return row.error();
    (*row)["scene"] = scene;
    (*row)["asked_particles"] = size;
    tell(*row);
    if (!hash.empty() && (*row)["hash"].asString() != hash) {
      return Error{ErrorKind::kPhysics, "the end state depends on the number of threads", scene};
    }
    hash = (*row)["hash"].asString();
    rows.append(std::move(*row));
  }
  return {};
}

/// Figures by column name, with nested ones under their path.
std::map<std::string, std::string> flatten(const Json::Value& row, const std::string& prefix = "") {
  std::map<std::string, std::string> columns;
  for (const std::string& key : row.getMemberNames()) {
    if (row[key].isObject()) {
      columns.merge(flatten(row[key], prefix + key + "."));
    } else {
      columns[prefix + key] = row[key].asString();
    }
  }
  return columns;
}

}  // namespace

Result<Json::Value> bench_scenes(const SceneBenchArguments& arguments) {
  Json::Value rows(Json::arrayValue);
  for (const std::string& scene : arguments.scenes) {
    // How many particles a spacing gives is known when it has given some.
    const auto as_it_stands = run_apart({path_of(scene), 0.0, 1, 1});
    if (!as_it_stands) return as_it_stands.error();
    for (const double size : arguments.sizes) {
      const double ratio = size > 0.0 ? (*as_it_stands)["particles"].asDouble() / size : 1.0;
      const double spacing = size > 0.0 ? (*as_it_stands)["spacing"].asDouble() * std::cbrt(ratio) : 0.0;
      if (auto done = bench_size(arguments, scene, size, spacing, rows); !done) return done.error();
    }
  }
  return rows;
}

std::string to_csv(const Json::Value& rows) {
  std::string text;
  for (const Json::Value& row : rows) {
    const auto columns = flatten(row);
    std::string names, values;
    for (const auto& [name, value] : columns) {
      names += (names.empty() ? "" : ",") + name;
      values += (values.empty() ? "" : ",") + value;
    }
    if (text.empty()) text = names + "\n";
    text += values + "\n";
  }
  return text;
}

}  // namespace repose
