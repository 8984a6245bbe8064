// Repose: points and figures of grids as the program that parses VDB files tells them, both ways.
#pragma once

#include <vector>

#include "engine/io/point_cloud.h"
#include "engine/io/surface.h"
#include "engine/vdb/record.h"

namespace repose {

void tell_points(RecordWriter& record, const PointCloud& points);
void tell_figures(RecordWriter& record, const std::vector<GridFigures>& figures);

/// All arrays of the cloud have as many entries as it has particles. Throw BadRecord.
PointCloud take_points(RecordReader& record);
std::vector<GridFigures> take_figures(RecordReader& record);

}  // namespace repose
