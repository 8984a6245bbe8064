// Repose: what all point formats agree on: which clouds can be written, how an attribute of several components
// is named where a format knows scalars alone, and when float positions are not good enough.
#pragma once

#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/io/point_cloud.h"

namespace repose {

/// Refuses a cloud that no format could hold: arrays of unequal length, attributes with other than 1, 2, 3, 4,
/// 6 or 9 components, names that are not [A-Za-z][A-Za-z0-9_]* or are taken (64), positions that are not finite
/// (74). `path` names the file in the error.
Result<void> check_cloud(const PointCloud& points, const std::string& path);

/// Whether files have a form for that many components.
bool has_layout(int components);

/// Name of component `k`: "stress_xx". Up to four are x y z w; six are xx yy zz xy yz xz, a symmetric tensor in
/// the order of VTK; nine are xx xy xz yx ... row by row. A single component keeps the plain name.
std::string component_name(const PointAttribute& attribute, int k);

/// Undoes component_name: consecutive scalar attributes that name all components of one become that one.
std::vector<PointAttribute> join_components(std::vector<PointAttribute> scalars);

/// True where rounding a position to float could move it by more than 1e-4 cells.
bool needs_double(const PointCloud& points);

}  // namespace repose
