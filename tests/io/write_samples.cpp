// Repose tests: writes a cloud in every format, with the figures of it that foreign_readers.py compares what
// other programs read with. Usage: write_samples FOLDER
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <random>

#include "engine/io/point_cloud.h"

namespace repose {
namespace {

/// 500 points in ten metres about (3, -2, 1): several leaves, both signs.
PointCloud sample(std::size_t count) {
  PointCloud points;
  points.spacing = 0.05;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(-5.0, 5.0);
  PointAttribute age{"age", 1, {}};
  for (std::size_t p = 0; p < count; ++p) {
    points.position.push_back({3 + unit(random), -2 + unit(random), 1 + unit(random)});
    points.velocity.push_back({float(p), -1.0f, 0.5f});
    points.id.push_back(static_cast<std::uint32_t>(3 * p + 1));
    points.radius.push_back(0.02f);
    age.values.push_back(static_cast<float>(unit(random)));
  }
  points.attributes.push_back(std::move(age));
  return points;
}

void write_figures(const PointCloud& points, const std::string& path) {
  std::array<double, 3> lower{1e300, 1e300, 1e300}, upper{-1e300, -1e300, -1e300};
  for (const auto& x : points.position) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      lower[axis] = std::min(lower[axis], x[axis]);
      upper[axis] = std::max(upper[axis], x[axis]);
    }
  }
  char text[512];
  std::snprintf(
      text, sizeof text,
      "{\"count\": %zu, \"first_ids\": [%u, %u, %u], \"bounds\": [[%.9g, %.9g, %.9g], [%.9g, %.9g, %.9g]], "
      "\"spacing\": %.9g, \"attributes\": [\"age\"]}\n",
      points.size(), points.id[0], points.id[1], points.id[2], lower[0], lower[1], lower[2], upper[0], upper[1],
      upper[2], points.spacing);
  std::ofstream(path) << text;
}

int write_all(const std::string& folder) {
  std::filesystem::create_directories(folder);
  const PointCloud points = sample(500);
  const std::string stem = folder + "/out.points";
  for (const auto& written : {write_vdb_points(points, stem + ".0001.vdb"),
                              write_ply(points, stem + ".0001.ply"), write_vtp(points, stem + ".0001.vtp")}) {
    if (written) continue;
    std::fprintf(stderr, "%s\n", written.error().text().c_str());
    return 1;
  }
  write_figures(points, stem + ".json");
  return 0;
}

}  // namespace
}  // namespace repose

int main(int count, char** words) {
  return count == 2 ? repose::write_all(words[1]) : 64;
}
