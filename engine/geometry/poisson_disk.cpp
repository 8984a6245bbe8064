// Repose: Bridson's Poisson-disk sampling. Differences to the paper: every cell of the shape throws one dart,
// so a shape of several pieces is filled; points lie on the lattice of offsets before their distance is tested,
// so the least distance holds for what the particles store.
#include "engine/geometry/poisson_disk.h"

#include <algorithm>

namespace repose {
namespace {

constexpr int kTries = 30;  // of Bridson, section 2

// Density times radius^d of Bridson's points with kTries tries. Measured for this code, three cells away from
// the walls, at two seeds each: 0.5766 and 0.5770 in a box of 50^3 cells with 8 particles per cell, 0.6146 and
// 0.6151 in a square of 400^2 cells with 4. (Saturated packings hold 0.733 and 0.696, at many times the cost:
// packing fractions 0.384 and 0.547, Feder 1980, Tarjus et al. 1991, over pi/6 and pi/4.)
constexpr double kFilling3 = 0.577;
constexpr double kFilling2 = 0.615;

using Point = std::array<double, 3>;  // in cells from the lower corner of the box

/// A stream of random numbers.
class Stream {
 public:
  explicit Stream(std::uint64_t seed) : state_(mix(seed)) {}

  std::uint64_t next() { return mix(state_++); }
  double unit() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  std::size_t below(std::size_t count) { return static_cast<std::size_t>(((next() >> 32) * count) >> 32); }

 private:
  std::uint64_t state_;
};

class Sampler {
 public:
  Sampler(const Shape& shape, const CellBox& box, const SeedOptions& options)
      : shape_(shape),
        box_(box),
        radius_(poisson_radius(options.particles_per_cell, box.dimension())),
        side_(radius_ / std::sqrt(static_cast<double>(box.dimension()))),
        random_(options.seed) {
    for (int k = 0; k < 3; ++k) {
      const double cells = static_cast<double>(box.upper[k]) - box.lower[k];
      size_[k] = k == box.flat_axis ? 1 : static_cast<std::int64_t>(cells / side_) + 1;
    }
    list_neighbours();
  }

  double squares() const {
    return static_cast<double>(size_[0]) * static_cast<double>(size_[1]) * static_cast<double>(size_[2]);
  }

  const std::vector<Point>& fill() {
    grid_.assign(static_cast<std::size_t>(size_[0] * size_[1] * size_[2]), -1);
    box_.for_each_cell_near(shape_, [&](const Index3& cell, double) {
      Point dart;
      for (int k = 0; k < 3; ++k) dart[k] = on_lattice(k, cell[k] - box_.lower[k] + random_.unit());
      if (fits(dart)) spread_from(dart);
    });
    return points_;
  }

 private:
  double on_lattice(int axis, double x) const {
    return axis == box_.flat_axis ? 0.5 : std::floor(x * static_cast<double>(kLattice)) * kLatticeStep;
  }

  std::int64_t square(int axis, double x) const {
    return axis == box_.flat_axis ? 0 : static_cast<std::int64_t>(x / side_);
  }

  /// Squares of the grid that a disc about a point of square 0 can reach, nearest first: they answer soonest.
  void list_neighbours() {
    std::vector<std::pair<int, std::array<int, 3>>> found;
    for (int x = -2; x <= 2; ++x) {
      for (int y = -2; y <= 2; ++y) {
        for (int z = -2; z <= 2; ++z) {
          const std::array<int, 3> step{x, y, z};
          if (box_.flat_axis >= 0 && step[box_.flat_axis] != 0) continue;
          int gap = 0, reach = 0;  // squared, in sides of a square: to its nearest point, to its middle
          for (const int s : step) {
            gap += s == 0 ? 0 : (std::abs(s) - 1) * (std::abs(s) - 1);
            reach += s * s;
          }
          if (gap < box_.dimension()) found.push_back({reach, step});
        }
      }
    }
    std::sort(found.begin(), found.end());
    for (const auto& [reach, step] : found) neighbours_.push_back(step);
  }

  bool fits(const Point& p) const {
    for (int k = 0; k < 3; ++k) {
      if (!(p[k] >= 0 && p[k] < static_cast<double>(box_.upper[k]) - box_.lower[k])) return false;
    }
    return is_free(p) && shape_.signed_distance(box_.position(box_.lower, p)) < 0;
  }

  bool is_free(const Point& p) const {
    const std::array<std::int64_t, 3> at{square(0, p[0]), square(1, p[1]), square(2, p[2])};
    for (const auto& step : neighbours_) {
      const std::int64_t x = at[0] + step[0], y = at[1] + step[1], z = at[2] + step[2];
      if (x < 0 || y < 0 || z < 0 || x >= size_[0] || y >= size_[1] || z >= size_[2]) continue;
      const std::int32_t other = grid_[static_cast<std::size_t>((x * size_[1] + y) * size_[2] + z)];
      if (other < 0) continue;
      const Point& q = points_[other];
      const double dx = p[0] - q[0], dy = p[1] - q[1], dz = p[2] - q[2];
      if (dx * dx + dy * dy + dz * dz < radius_ * radius_) return false;
    }
    return true;
  }

  void add(const Point& p) {
    const std::int64_t at = (square(0, p[0]) * size_[1] + square(1, p[1])) * size_[2] + square(2, p[2]);
    grid_[static_cast<std::size_t>(at)] = static_cast<std::int32_t>(points_.size());
    active_.push_back(points_.size());
    points_.push_back(p);
  }

  /// A point in the ring from radius to twice the radius about `p`, by rejection: exact, and free of sin.
  Point near(const Point& p) {
    while (true) {
      Point step;
      double square = 0;
      for (int k = 0; k < 3; ++k) {
        step[k] = k == box_.flat_axis ? 0.0 : (2 * random_.unit() - 1) * 2 * radius_;
        square += step[k] * step[k];
      }
      if (square < radius_ * radius_ || square >= 4 * radius_ * radius_) continue;
      return {on_lattice(0, p[0] + step[0]), on_lattice(1, p[1] + step[1]), on_lattice(2, p[2] + step[2])};
    }
  }

  void spread_from(const Point& first) {
    add(first);
    while (!active_.empty()) {
      const std::size_t slot = random_.below(active_.size());
      const Point from = points_[active_[slot]];
      bool added = false;
      for (int k = 0; k < kTries && !added; ++k) {
        const Point candidate = near(from);
        added = fits(candidate);
        if (added) add(candidate);
      }
      if (added) continue;
      active_[slot] = active_.back();
      active_.pop_back();
    }
  }

  const Shape& shape_;
  const CellBox& box_;
  double radius_;  // in cells, as side_
  double side_;    // of a grid square: its diagonal is the radius, so it holds one point at most
  Stream random_;
  std::array<std::int64_t, 3> size_{};
  std::vector<std::array<int, 3>> neighbours_;
  std::vector<std::int32_t> grid_;
  std::vector<Point> points_;
  std::vector<std::size_t> active_;
};

}  // namespace

double poisson_radius(std::int64_t particles_per_cell, int dimension) {
  const auto density = static_cast<double>(particles_per_cell);
  const double radius = dimension == 3 ? std::cbrt(kFilling3 / density) : std::sqrt(kFilling2 / density);
  // Onto the lattice: the last bit of a library's cbrt must not reach the particles.
  return std::nearbyint(radius * static_cast<double>(kLattice)) * kLatticeStep;
}

Result<Seeds> seed_poisson_disk(const Shape& shape, const CellBox& box, const SeedOptions& options) {
  Sampler sampler(shape, box, options);
  if (sampler.squares() > 2147483647.0) {
    return Error{
        ErrorKind::kMemory, "the shape's bounds are too large for Poisson-disk sampling; use jittered", {}};
  }
  std::vector<Point> points = sampler.fill();
  Seeds seeds;
  seeds.cell.reserve(points.size());
  seeds.offset.reserve(points.size());
  const auto key = [](const Point& p) {
    return std::array<double, 6>{std::floor(p[0]), std::floor(p[1]), std::floor(p[2]), p[0], p[1], p[2]};
  };
  std::sort(points.begin(), points.end(), [&](const Point& a, const Point& b) { return key(a) < key(b); });
  for (const Point& p : points) {
    Index3 cell;
    std::array<double, 3> offset;
    for (int k = 0; k < 3; ++k) {
      const double whole = std::floor(p[k]);
      cell[k] = box.lower[k] + static_cast<std::int32_t>(whole);
      offset[k] = p[k] - whole;
    }
    seeds.cell.push_back(cell);
    seeds.offset.push_back(to_float(offset));
  }
  return seeds;
}

}  // namespace repose
