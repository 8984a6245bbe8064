// Repose: what the program that parses VDB files makes of them. All throw what OpenVDB throws, and Refusal.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/point_cloud.h"
#include "engine/io/surface.h"
#include "engine/vdb/record.h"

namespace repose {

/// A file that can be read, and does not hold what it should.
struct Refusal {
  ErrorKind kind;
  std::string why;
};

/// Reads a grid of any file and tells it (engine/vdb/values.h), with the beginning of the answer and without
/// its end. Refuses (65) a grid that there is not, that has values of another type or some that are not finite.
void tell_floats(const std::string& file, const std::string& grid, RecordWriter& record);
void tell_vectors(const std::string& file, const std::string& grid, RecordWriter& record);

/// The first grid of points. Refuses (74) a file that has none.
PointCloud parse_points(const std::string& file);

std::vector<GridFigures> parse_figures(const std::string& file);

}  // namespace repose
