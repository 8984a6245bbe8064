// Repose: checks and names that all point formats share.
#include "engine/io/point_layout.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <set>
#include <span>
#include <utility>

namespace repose {
namespace {

constexpr std::array<const char*, 2> kPairSuffix{"_x", "_y"};
constexpr std::array<const char*, 4> kFourSuffix{"_x", "_y", "_z", "_w"};
constexpr std::array<const char*, 3> kVectorSuffix{"_x", "_y", "_z"};
constexpr std::array<const char*, 6> kSymmetricSuffix{"_xx", "_yy", "_zz", "_xy", "_yz", "_xz"};
constexpr std::array<const char*, 9> kMatrixSuffix{"_xx", "_xy", "_xz", "_yx", "_yy",
                                                   "_yz", "_zx", "_zy", "_zz"};

std::span<const char* const> suffixes(int components) {
  switch (components) {
    case 2:
      return kPairSuffix;
    case 3:
      return kVectorSuffix;
    case 4:
      return kFourSuffix;
    case 6:
      return kSymmetricSuffix;
    case 9:
      return kMatrixSuffix;
    default:
      return {};
  }
}

bool is_letter(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

bool is_plain_name(const std::string& name) {
  if (name.empty() || name.size() > 64 || !is_letter(name[0])) return false;
  return std::all_of(name.begin(), name.end(),
                     [](char c) { return is_letter(c) || (c >= '0' && c <= '9') || c == '_'; });
}

Result<void> check_attributes(const PointCloud& points, const std::string& path) {
  // The names of the fixed arrays in any of the formats.
  std::set<std::string> taken{"P", "v",  "id", "pscale", "radius", "x",   "y",
                              "z", "vx", "vy", "vz",     "float",  "int", "property"};
  for (const PointAttribute& attribute : points.attributes) {
    const int n = attribute.components;
    const std::string label = "attribute '" + attribute.name + "' ";
    const auto refuse = [&](const std::string& why) { return Error{ErrorKind::kUsage, label + why, path}; };
    if (!has_layout(n)) {
      return refuse("has " + std::to_string(n) + " components; 1, 2, 3, 4, 6 and 9 can be written");
    }
    if (!is_plain_name(attribute.name)) {
      return refuse("must have a name of letters, digits and _, at most 64, that starts with a letter");
    }
    if (attribute.values.size() != points.size() * static_cast<std::size_t>(n)) {
      return refuse("has " + std::to_string(attribute.values.size()) + " values for " +
                    std::to_string(points.size()) + " particles of " + std::to_string(n) + " components");
    }
    bool fresh = taken.insert(attribute.name).second;
    for (int k = 0; n > 1 && k < n; ++k) fresh &= taken.insert(component_name(attribute, k)).second;
    if (!fresh) return refuse("has a name, or a component's name, that another array has");
  }
  return {};
}

// Length of the group of scalars at `first` that are the components of one attribute; 1 where there is none.
std::size_t group_length(const std::vector<PointAttribute>& scalars, std::size_t first) {
  for (const int components : {9, 6, 4, 3, 2}) {
    const auto names = suffixes(components);
    const std::string& start = scalars[first].name;
    const std::string suffix = names[0];
    if (first + names.size() > scalars.size() || start.size() <= suffix.size() || !start.ends_with(suffix))
      continue;
    const std::string stem = start.substr(0, start.size() - suffix.size());
    bool all = true;
    for (std::size_t k = 0; k < names.size(); ++k) {
      all &= scalars[first + k].components == 1 && scalars[first + k].name == stem + names[k];
    }
    if (all) return names.size();
  }
  return 1;
}

PointAttribute interleaved(std::span<const PointAttribute> group) {
  const std::size_t n = group.size();
  const std::string& start = group[0].name;
  PointAttribute joined{start.substr(0, start.rfind('_')), static_cast<int>(n), {}};
  joined.values.resize(group[0].values.size() * n);
  for (std::size_t k = 0; k < n; ++k) {
    for (std::size_t p = 0; p < group[k].values.size(); ++p) joined.values[p * n + k] = group[k].values[p];
  }
  return joined;
}

}  // namespace

Result<void> check_cloud(const PointCloud& points, const std::string& path) {
  const std::size_t n = points.size();
  if (points.velocity.size() != n || points.id.size() != n || points.radius.size() != n) {
    return Error{ErrorKind::kUsage,
                 "cannot hold " + std::to_string(n) + " positions, " + std::to_string(points.velocity.size()) +
                     " velocities, " + std::to_string(points.id.size()) + " ids and " +
                     std::to_string(points.radius.size()) + " radii; each particle has one of each",
                 path};
  }
  for (std::size_t p = 0; p < n; ++p) {
    for (const double x : points.position[p]) {
      if (std::isfinite(x)) continue;
      return Error{ErrorKind::kIo, "particle " + std::to_string(points.id[p]) + " has no finite position",
                   path};
    }
  }
  return check_attributes(points, path);
}

bool has_layout(int components) {
  return components == 1 || !suffixes(components).empty();
}

std::string component_name(const PointAttribute& attribute, int k) {
  const auto names = suffixes(attribute.components);
  return names.empty() ? attribute.name : attribute.name + names[static_cast<std::size_t>(k)];
}

std::vector<PointAttribute> join_components(std::vector<PointAttribute> scalars) {
  std::vector<PointAttribute> joined;
  for (std::size_t first = 0; first < scalars.size();) {
    const std::size_t length = group_length(scalars, first);
    if (length == 1) {
      joined.push_back(std::move(scalars[first]));
    } else {
      joined.push_back(interleaved({&scalars[first], length}));
    }
    first += length;
  }
  return joined;
}

bool needs_double(const PointCloud& points) {
  double largest = 0.0;
  for (const auto& x : points.position) {
    largest = std::max({largest, std::abs(x[0]), std::abs(x[1]), std::abs(x[2])});
  }
  constexpr double kHalfUlp = 1.0 / (1 << 24);  // of float, relative
  return largest * kHalfUlp > 1e-4 * points.spacing;
}

}  // namespace repose
