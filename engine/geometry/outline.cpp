// Repose: from the corners of a profile to a clean outline. Edges along the axis are part of the polygon but
// not of the surface, so a profile may touch the axis as often as it likes, and cross itself nowhere.
#include "engine/geometry/outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>

namespace repose {
namespace {

constexpr int kPointsPerSpan = 16;

Corner blend(const Corner& a, const Corner& b, double t, double ta, double tb) {
  const double s = (t - ta) / (tb - ta);
  return {(1 - s) * a[0] + s * b[0], (1 - s) * a[1] + s * b[1]};
}

double knot_step(const Corner& a, const Corner& b) {
  const double r = b[0] - a[0], h = b[1] - a[1];
  return std::sqrt(std::sqrt(r * r + h * h));
}

/// The span from b to c of a centripetal Catmull-Rom spline, by the pyramid of Barry and Goldman (1988). With
/// centripetal knots a span has neither cusp nor loop (Yuksel, Schaefer and Keyser 2011), which even knots have
/// where short spans meet long ones.
void append_span(const Corner& a, const Corner& b, const Corner& c, const Corner& d, std::vector<Corner>& out) {
  const double tb = knot_step(a, b), tc = tb + knot_step(b, c), td = tc + knot_step(c, d);
  out.push_back(b);
  for (int k = 1; k < kPointsPerSpan; ++k) {
    const double t = tb + (tc - tb) * k / kPointsPerSpan;
    const Corner ab = blend(a, b, t, 0, tb), bc = blend(b, c, t, tb, tc), cd = blend(c, d, t, tc, td);
    const Corner left = blend(ab, bc, t, 0, tc), right = blend(bc, cd, t, tb, td);
    Corner point = blend(left, right, t, tb, tc);
    point[0] = std::max(point[0], 0.0);
    out.push_back(point);
  }
}

/// Rounds a profile. One that starts and ends on the axis is mirrored there, which makes its poles smooth.
std::vector<Corner> rounded(const std::vector<Corner>& corners) {
  const int count = static_cast<int>(corners.size());
  const bool open = corners.front()[0] == 0 && corners.back()[0] == 0;
  const auto corner = [&](int i) -> Corner {
    if (!open) return corners[(i + count) % count];
    if (i < 0) return {-corners[1][0], corners[1][1]};
    if (i >= count) return {-corners[count - 2][0], corners[count - 2][1]};
    return corners[i];
  };
  std::vector<Corner> out;
  for (int i = 0; i < (open ? count - 1 : count); ++i) {
    append_span(corner(i - 1), corner(i), corner(i + 1), corner(i + 2), out);
  }
  if (open) out.push_back(corners.back());
  return out;
}

double cross(const Corner& a, const Corner& b, const Corner& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

bool between(const Corner& a, const Corner& b, const Corner& p) {
  return std::min(a[0], b[0]) <= p[0] && p[0] <= std::max(a[0], b[0]) && std::min(a[1], b[1]) <= p[1] &&
         p[1] <= std::max(a[1], b[1]);
}

/// Whether the closed segments ab and cd have a point in common.
bool meet(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
  const double abc = cross(a, b, c), abd = cross(a, b, d), cda = cross(c, d, a), cdb = cross(c, d, b);
  const auto opposite = [](double x, double y) { return (x < 0 && y > 0) || (x > 0 && y < 0); };
  if (opposite(abc, abd) && opposite(cda, cdb)) return true;
  return (abc == 0 && between(a, b, c)) || (abd == 0 && between(a, b, d)) || (cda == 0 && between(c, d, a)) ||
         (cdb == 0 && between(c, d, b));
}

Error bad_profile(const std::string& message) {
  return {ErrorKind::kBadScene, "profile: " + message, {}};
}

std::string text(const Corner& c) {
  return "[" + std::to_string(c[0]) + ", " + std::to_string(c[1]) + "]";
}

Result<std::vector<Corner>> read_corners(const std::vector<std::vector<double>>& profile) {
  std::vector<Corner> corners;
  for (const auto& row : profile) {
    if (row.size() != 2 || !std::isfinite(row[0]) || !std::isfinite(row[1]) || row[0] < 0) {
      return bad_profile("corner " + std::to_string(corners.size()) + " must be [radius >= 0, height]");
    }
    corners.push_back({row[0], row[1]});
  }
  if (corners.size() > 1 && corners.front() == corners.back()) corners.pop_back();
  if (corners.size() < 3) return bad_profile("needs at least 3 different corners [radius, height]");
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Corner& next = corners[(i + 1) % corners.size()];
    if (corners[i] == next) return bad_profile("corner " + text(next) + " is given twice in a row");
  }
  return corners;
}

Result<void> check_simple(const std::vector<Corner>& outline) {
  const std::size_t count = outline.size();
  const auto on_axis = [&](std::size_t i) { return outline[i][0] == 0 && outline[(i + 1) % count][0] == 0; };
  for (std::size_t i = 0; i < count; ++i) {
    if (on_axis(i)) continue;
    for (std::size_t j = i + 2; j < count; ++j) {
      if (on_axis(j) || (j + 1) % count == i) continue;
      if (meet(outline[i], outline[i + 1], outline[j], outline[(j + 1) % count])) {
        return bad_profile("the outline meets itself near " + text(outline[i]) + " and " + text(outline[j]) +
                           "; it must be a simple loop");
      }
    }
  }
  return {};
}

}  // namespace

Result<std::vector<Corner>> make_outline(const std::vector<std::vector<double>>& profile, bool smooth) {
  auto corners = read_corners(profile);
  if (!corners) return corners;
  std::vector<Corner> outline = smooth ? rounded(*corners) : *corners;
  if (auto simple = check_simple(outline); !simple) return simple.error();
  if (enclosed_area(outline) < 0) std::reverse(outline.begin(), outline.end());
  if (!(swept_volume(outline) > 0)) return bad_profile("the outline encloses nothing");
  return outline;
}

double swept_volume(const std::vector<Corner>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& [r0, h0] = outline[i];
    const auto& [r1, h1] = outline[(i + 1) % outline.size()];
    sum += (h1 - h0) * (r0 * r0 + r0 * r1 + r1 * r1);
  }
  return std::numbers::pi / 3 * sum;
}

double enclosed_area(const std::vector<Corner>& outline) {
  double sum = 0;
  for (std::size_t i = 0; i < outline.size(); ++i) {
    const auto& [r0, h0] = outline[i];
    const auto& [r1, h1] = outline[(i + 1) % outline.size()];
    sum += (r0 + r1) * (h1 - h0) / 2;
  }
  return sum;
}

}  // namespace repose
