#include "apps/repose/trouble.h"

#include <json/json.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

#include "apps/repose/output_folder.h"
#include "apps/repose/scene_picture.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

constexpr std::size_t kSteps = 50, kNeighboursTold = 40;
constexpr double kNeighbourhood = 2.0, kInPicture = 12.0;  // cells

template <class Numbers>
Json::Value list_of(const Numbers& numbers) {
  Json::Value list(Json::arrayValue);
  for (const auto number : numbers) list.append(number);
  return list;
}

double distance(const std::array<double, 3>& a, const Triple& b) {
  return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

/// The particles about a place, nearest first.
std::vector<std::size_t> around(const PointCloud& points, const Triple& place, double reach) {
  std::vector<std::size_t> near;
  for (std::size_t p = 0; p < points.size(); ++p) {
    if (distance(points.position[p], place) <= reach) near.push_back(p);
  }
  std::sort(near.begin(), near.end(), [&](std::size_t a, std::size_t b) {
    return distance(points.position[a], place) < distance(points.position[b], place);
  });
  return near;
}

Json::Value particle_json(const FailedParticle& failed) {
  Json::Value particle;
  particle["set"] = failed.set;
  particle["id"] = failed.id;
  particle["reason"] = failed.reason;
  particle["advice"] = failed.advice;
  particle["determinant"] = failed.determinant;
  particle["block"] = list_of(failed.block);
  particle["position"] = list_of(failed.position);
  particle["velocity"] = list_of(failed.velocity);
  particle["trial_velocity"] = list_of(failed.trial_velocity);
  return particle;
}

Json::Value neighbour_json(const PointCloud& points, std::size_t p, const Triple& place) {
  Json::Value neighbour;
  neighbour["id"] = points.id[p];
  neighbour["distance"] = distance(points.position[p], place);
  neighbour["position"] = list_of(points.position[p]);
  neighbour["velocity"] = list_of(points.velocity[p]);
  for (const PointAttribute& attribute : points.attributes) {
    const std::size_t width = attribute.values.size() / points.size();
    Json::Value& values = neighbour[attribute.name];
    for (std::size_t k = 0; k < width; ++k) values.append(attribute.values[p * width + k]);
  }
  return neighbour;
}

/// The place from a dozen cells away; the particle in blue.
Image picture_of(const Scene& scene, const Simulation& simulation, const PointCloud& points,
                 const FailedParticle& failed) {
  const double reach = kInPicture * scene.grid.spacing;
  std::vector<Grain> grains;
  for (Grain& grain : grains_of(points)) {
    const std::array<double, 3> at{grain.position[0], grain.position[1], grain.position[2]};
    if (distance(at, failed.position) > reach) continue;
    grain.material = 0;
    if (grain.id == failed.id) {
      grain.material = 1;
      grain.radius *= 1.5f;
    }
    grains.push_back(grain);
  }
  Camera camera;
  camera.width = 960;
  camera.height = 540;
  camera.up = scene.up == UpAxis::kY ? Vec3(0, 1, 0) : Vec3(0, 0, 1);
  camera.target = to_vec3(failed.position);
  const Vec3 from = scene.up == UpAxis::kY ? Vec3(0.45, 0.32, 1.0) : Vec3(0.45, -1.0, 0.32);
  camera.eye = camera.target + 2.5 * reach * from.normalized();
  const auto solids =
      draw_solids(scene, solids_at(simulation.solids(), simulation.counters().time), 4.0 * reach);
  return render_grains(grains, solids, camera, Light{}, RenderOptions{});
}

}  // namespace

void Trouble::note(const StepReport& step, const Counters& counters) {
  steps_.push_back({step, counters});
  if (steps_.size() > kSteps) steps_.pop_front();
}

Result<void> Trouble::write(const Error& error, const Scene& scene, Simulation& simulation,
                            const std::string& folder) const {
  std::error_code ignored;
  std::filesystem::create_directories(folder, ignored);
  Json::Value json;
  json["error"] = error.text();
  json["step"] = Json::Int64(simulation.counters().step);
  json["time"] = simulation.counters().time;
  json["memory_blocks"] = Json::UInt64(simulation.memory().blocks);
  for (const Step& step : steps_) {
    Json::Value row;
    row["step"] = Json::Int64(step.after.step);
    row["time"] = step.after.time;
    row["dt"] = step.report.dt;
    row["limit"] = limit_name(step.report.limit);
    row["redone"] = step.report.redone;
    row["max_speed"] = step.after.max_speed;
    row["max_gradient"] = step.after.max_gradient;
    if (const auto& energy = step.report.energy) {
      row["energy"]["kinetic"] = energy->kinetic;
      row["energy"]["affine"] = energy->affine;
      row["energy"]["elastic"] = energy->elastic;
      row["energy"]["potential"] = energy->potential;
      row["energy"]["given"] = energy->given;
    }
    json["last_steps"].append(row);
  }
  if (const auto& failed = simulation.failed_particle()) {
    json["particle"] = particle_json(*failed);
    const PointCloud points = simulation.points(
        {{OutputAttribute::kElasticStrain, OutputAttribute::kPressure, OutputAttribute::kChannels}});
    auto near = around(points, failed->position, kNeighbourhood * scene.grid.spacing);
    near.resize(std::min(near.size(), kNeighboursTold));
    for (const std::size_t p : near) json["neighbours"].append(neighbour_json(points, p, failed->position));
    const bool finite = to_vec3(failed->position).allFinite();
    if (finite) {
      if (auto drawn =
              write_png(picture_of(scene, simulation, points, *failed), folder + "/" + diagnostics::kPicture);
          !drawn)
        return drawn;
    }
  }
  if (auto written = write_text(folder + "/" + diagnostics::kFailure, json.toStyledString()); !written)
    return written;
  if (auto saved = simulation.save(folder + "/" + diagnostics::kState); !saved) return saved;
  return write_text(folder + "/" + diagnostics::kScene, scene.canonical + "\n");
}

}  // namespace repose
