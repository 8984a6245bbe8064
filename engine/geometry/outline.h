// Repose: the outline of a solid of revolution: a simple polygon in the half-plane of radius and height.
#pragma once

#include <array>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// A corner of an outline: radius and height in metres.
using Corner = std::array<double, 2>;

/// Makes a closed outline of [radius, height] rows: drops a last corner that repeats the first, rounds if
/// `smooth`, and turns it counter-clockwise (radius to the right, height up). Refuses (65) fewer than 3
/// corners, negative radii, repeated corners, outlines that cross themselves or enclose nothing.
Result<std::vector<Corner>> make_outline(const std::vector<std::vector<double>>& profile, bool smooth);

/// Volume of the solid that a counter-clockwise outline sweeps (m^3): a sum of frustums.
double swept_volume(const std::vector<Corner>& outline);

/// Area inside a counter-clockwise outline (m^2).
double enclosed_area(const std::vector<Corner>& outline);

}  // namespace repose
