// Repose tests: particles lie in their shape, as many as asked, alike on every machine, and share its volume.
#include "engine/geometry/seeding.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/geometry/poisson_disk.h"

namespace repose {
namespace {

ShapeDescription sphere(const Vec3& center, double radius) {
  ShapeDescription d;
  d.type = ShapeDescription::Type::kSphere;
  d.center = center;
  d.radius = radius;
  return d;
}

ShapeDescription box(const Vec3& lower, const Vec3& upper) {
  ShapeDescription d;
  d.lower = lower;
  d.upper = upper;
  return d;
}

std::shared_ptr<const Shape> built(const ShapeDescription& description) {
  return *make_shape(description, ".", 0.1);
}

SeedOptions options(double spacing, std::int64_t particles_per_cell, Sampling sampling = Sampling::kJittered) {
  SeedOptions o;
  o.spacing = spacing;
  o.particles_per_cell = particles_per_cell;
  o.sampling = sampling;
  return o;
}

Seeds seeded(const ShapeDescription& description, const SeedOptions& o) {
  auto seeds = seed_shape(*built(description), o);
  EXPECT_TRUE(seeds) << (seeds ? "" : seeds.error().text());
  return seeds ? *seeds : Seeds{};
}

Vec3 position(const Seeds& seeds, std::size_t p) {
  return to_vec3(seeds.cell[p]) + Vec3(seeds.offset[p][0], seeds.offset[p][1], seeds.offset[p][2]);
}

/// Least distance between two seeds, in cells, by sorting along x.
double least_distance(const Seeds& seeds) {
  std::vector<Vec3> points;
  for (std::size_t p = 0; p < seeds.cell.size(); ++p) points.push_back(position(seeds, p));
  std::sort(points.begin(), points.end(), [](const Vec3& a, const Vec3& b) { return a[0] < b[0]; });
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = i + 1; j < points.size() && points[j][0] - points[i][0] < least; ++j) {
      least = std::min(least, (points[j] - points[i]).norm());
    }
  }
  return least;
}

void expect_valid(const ShapeDescription& description, const SeedOptions& o, double tolerance) {
  const auto shape = built(description);
  const Seeds seeds = seeded(description, o);
  ASSERT_EQ(seeds.cell.size(), seeds.offset.size());
  for (std::size_t p = 0; p < seeds.cell.size(); ++p) {
    EXPECT_LT(shape->signed_distance(position(seeds, p) * o.spacing), 0);
    for (const double offset : seeds.offset[p]) {
      EXPECT_TRUE(offset >= 0 && static_cast<float>(offset) < 1.0f);
      EXPECT_EQ(static_cast<double>(static_cast<float>(offset)), offset);
    }
  }
  const double count = static_cast<double>(seeds.cell.size());
  const double cells = shape->volume() / (o.spacing * o.spacing * o.spacing);
  EXPECT_NEAR(count / (cells * static_cast<double>(o.particles_per_cell)), 1, tolerance);
  EXPECT_NEAR(count * seeds.particle_volume / shape->volume(), 1, 1e-12);
}

TEST(Seeding, Jittered_FillsTheShapeToItsVolume) {
  for (const std::int64_t count : {1, 2, 4, 7, 8, 27}) {
    expect_valid(sphere({-0.3, 0.2, 1.1}, 0.5), options(0.05, count), 0.03);
  }
  expect_valid(box({-1, -1, -1}, {1, 0.5, 0.25}), options(0.0625, 8), 1e-12);
}

TEST(Seeding, PoissonDisk_FillsTheShapeToItsVolume) {
  for (const std::int64_t count : {1, 8}) {
    expect_valid(sphere({-0.3, 0.2, 1.1}, 0.5), options(0.04, count, Sampling::kPoissonDisk), 0.08);
  }
}

TEST(Seeding, Jittered_PutsOneInEachSubCell) {
  const Seeds seeds = seeded(box({0, 0, 0}, {4, 4, 4}), options(1, 8));
  ASSERT_EQ(seeds.cell.size(), 512u);
  std::vector<int> held(512, 0);
  for (std::size_t p = 0; p < seeds.cell.size(); ++p) {
    const Vec3 x = position(seeds, p) * 2;
    ++held[static_cast<std::size_t>((std::floor(x[0]) * 8 + std::floor(x[1])) * 8 + std::floor(x[2]))];
  }
  EXPECT_EQ(std::count(held.begin(), held.end(), 1), 512);
}

TEST(Seeding, Jittered_CoversItsSubCellEvenly) {
  const Seeds seeds = seeded(box({0, 0, 0}, {20, 20, 20}), options(1, 1));
  Vec3 sum = Vec3::Zero(), squares = Vec3::Zero();
  double crossed = 0;
  for (const auto& o : seeds.offset) {
    const Vec3 v = Vec3(o[0], o[1], o[2]) - Vec3::Constant(0.5);
    sum += v;
    squares += v.cwiseProduct(v);
    crossed += v[0] * v[1];
  }
  const double count = static_cast<double>(seeds.offset.size());
  for (int k = 0; k < 3; ++k) {
    EXPECT_NEAR(sum[k] / count, 0, 0.01);
    EXPECT_NEAR(squares[k] / count, 1.0 / 12, 0.003);
  }
  EXPECT_NEAR(crossed / count, 0, 0.003);
}

TEST(Seeding, Jittered_IsTheSameWhateverElseIsFilled) {
  const Seeds small = seeded(box({2, 2, 2}, {3, 3, 3}), options(1, 8));
  const Seeds large = seeded(box({-3, 0, 1}, {5, 6, 4}), options(1, 8));
  const auto found = std::find(large.cell.begin(), large.cell.end(), Index3{2, 2, 2});
  ASSERT_NE(found, large.cell.end());
  const auto first = large.offset.begin() + (found - large.cell.begin());
  EXPECT_TRUE(std::equal(small.offset.begin(), small.offset.end(), first));
}

TEST(Seeding, EqualSeeds_GiveEqualParticles) {
  for (const Sampling sampling : {Sampling::kJittered, Sampling::kPoissonDisk}) {
    SeedOptions o = options(0.1, 8, sampling);
    const Seeds a = seeded(sphere({0, 0, 0}, 0.5), o), b = seeded(sphere({0, 0, 0}, 0.5), o);
    EXPECT_EQ(a.cell, b.cell);
    EXPECT_EQ(a.offset, b.offset);
    o.seed = 2;
    EXPECT_NE(seeded(sphere({0, 0, 0}, 0.5), o).offset, a.offset);
  }
}

TEST(Seeding, Particles_AreTheSameOnEveryMachine) {
  // The bits of one particle of each sampling, in lattice steps; a change here changes every scene.
  const auto steps = [](const Seeds& seeds, std::size_t p) {
    std::array<std::int64_t, 3> found;
    for (int k = 0; k < 3; ++k) found[k] = static_cast<std::int64_t>(seeds.offset[p][k] * kLattice);
    return found;
  };
  const Seeds jittered = seeded(box({0, 0, 0}, {4, 4, 4}), options(1, 8));
  const Seeds poisson = seeded(box({0, 0, 0}, {4, 4, 4}), options(1, 8, Sampling::kPoissonDisk));
  EXPECT_EQ(steps(jittered, 100), (std::array<std::int64_t, 3>{662080, 221671, 420175}));
  EXPECT_EQ(steps(poisson, 100), (std::array<std::int64_t, 3>{100872, 289146, 467669}));
  EXPECT_EQ(poisson.cell.size(), 581u);
}

TEST(Seeding, PoissonDisk_KeepsItsDistance) {
  for (const std::int64_t count : {1, 8, 20}) {
    const Seeds seeds = seeded(sphere({0, 0, 0}, 0.6), options(0.1, count, Sampling::kPoissonDisk));
    EXPECT_GE(least_distance(seeds), poisson_radius(count, 3));
    EXPECT_LT(least_distance(seeds), 1.1 * poisson_radius(count, 3));
  }
}

TEST(Seeding, PoissonDisk_LeavesNoHole) {
  // Nothing within a sphere of 1.5 radii: Bridson's ring search would have found such a place.
  const Seeds seeds = seeded(box({0, 0, 0}, {8, 8, 8}), options(1, 8, Sampling::kPoissonDisk));
  const double radius = poisson_radius(8, 3);
  for (double x = 0.1; x < 8; x += 0.39) {
    for (double y = 0.1; y < 8; y += 0.39) {
      for (double z = 0.1; z < 8; z += 0.39) {
        double least = 100;
        for (std::size_t p = 0; p < seeds.cell.size(); ++p) {
          least = std::min(least, (position(seeds, p) - Vec3(x, y, z)).norm());
        }
        EXPECT_LT(least, 1.5 * radius);
      }
    }
  }
}

TEST(Seeding, PoissonDisk_BigBoxHasTheMeanDensity) {
  const Seeds solid = seeded(box({0, 0, 0}, {30, 30, 30}), options(1, 8, Sampling::kPoissonDisk));
  EXPECT_NEAR(static_cast<double>(solid.cell.size()) / (27000 * 8), 1, 0.03);
  SeedOptions flat = options(1, 4, Sampling::kPoissonDisk);
  flat.flat_axis = 2;
  const Seeds slab = seeded(box({0, 0, -1}, {150, 150, 1}), flat);
  EXPECT_NEAR(static_cast<double>(slab.cell.size()) / (22500 * 4), 1, 0.03);
}

TEST(Seeding, PoissonDisk_IsOrderedByCell) {
  const Seeds seeds = seeded(sphere({0, 0, 0}, 1), options(0.1, 8, Sampling::kPoissonDisk));
  EXPECT_TRUE(std::is_sorted(seeds.cell.begin(), seeds.cell.end()));
}

/// Counts how often it is asked.
class Asked : public Shape {
 public:
  explicit Asked(std::shared_ptr<const Shape> of) : of_(std::move(of)) {}
  double signed_distance(const Vec3& x) const override {
    ++times;
    return of_->signed_distance(x);
  }
  Bounds bounds() const override { return of_->bounds(); }
  double volume() const override { return of_->volume(); }
  Result<double> section_area(int axis) const override { return of_->section_area(axis); }
  TriangleMesh surface(double extent) const override { return of_->surface(extent); }

  mutable std::size_t times = 0;

 private:
  std::shared_ptr<const Shape> of_;
};

TEST(Seeding, RodAcrossItsBox_IsNotLookedForEverywhere) {
  ShapeDescription rod;
  rod.type = ShapeDescription::Type::kCylinder;
  rod.axis = {1, 1, 1};
  rod.radius = 0.3;
  rod.height = 30;
  for (const Sampling sampling : {Sampling::kJittered, Sampling::kPoissonDisk}) {
    const Asked shape(built(rod));
    const auto seeds = seed_shape(shape, options(0.1, 4, sampling));
    ASSERT_TRUE(seeds) << seeds.error().text();
    EXPECT_NEAR(static_cast<double>(seeds->cell.size()) / (shape.volume() / 1e-3 * 4), 1, 0.08);
    const Vec3 cells = (shape.bounds().upper - shape.bounds().lower) / 0.1;
    const double others = static_cast<double>(shape.times) - 100.0 * static_cast<double>(seeds->cell.size());
    EXPECT_LT(others, 0.15 * cells.prod());
  }
}

TEST(Seeding, PlaneStrain_LiesInTheFlatCell) {
  for (const Sampling sampling : {Sampling::kJittered, Sampling::kPoissonDisk}) {
    for (int axis = 0; axis < 3; ++axis) {
      SeedOptions o = options(0.02, 4, sampling);
      o.flat_axis = axis;
      Vec3 center(0.4, 0.5, 0.6);
      center[axis] = 0.3;  // the section is smaller than the ball
      const auto shape = built(sphere(center, 0.5));
      const Seeds seeds = seeded(sphere(center, 0.5), o);
      const double area = 3.14159265358979323846 * 0.16;
      EXPECT_NEAR(static_cast<double>(seeds.cell.size()) * seeds.particle_volume / (area * 0.02), 1, 1e-12);
      EXPECT_NEAR(static_cast<double>(seeds.cell.size()) / (area / 0.0004 * 4), 1, 0.06);
      for (std::size_t p = 0; p < seeds.cell.size(); ++p) {
        EXPECT_EQ(seeds.cell[p][axis], 0);
        EXPECT_EQ(seeds.offset[p][axis], 0.5);
        Vec3 x = position(seeds, p) * 0.02;
        x[axis] = 0;
        EXPECT_LT(shape->signed_distance(x), 0);
      }
      const double apart = sampling == Sampling::kPoissonDisk ? poisson_radius(4, 2) : 0.0;
      EXPECT_GE(least_distance(seeds), apart);
    }
  }
}

TEST(Seeding, Refusals_NameTheReason) {
  const auto refusal = [](const ShapeDescription& d, const SeedOptions& o) {
    const auto seeds = seed_shape(*built(d), o);
    if (seeds) return std::string();
    EXPECT_EQ(seeds.error().kind, ErrorKind::kBadScene);
    return seeds.error().message;
  };
  ShapeDescription plane;
  plane.type = ShapeDescription::Type::kPlane;
  EXPECT_NE(refusal(plane, options(0.1, 8)).find("infinite"), std::string::npos);
  EXPECT_NE(refusal(sphere({0.05, 0.05, 0.05}, 1e-6), options(0.1, 1)).find("no particle"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 1, 1}), options(1e-4, 8)).find("2^32"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 1, 1}), options(1e-12, 8)).find("2^31"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 1, 1}), options(0.1, 0)).find("particles_per_cell"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 1, 1}), options(0, 8)).find("spacing"), std::string::npos);
  SeedOptions flat = options(0.1, 4);
  flat.flat_axis = 2;
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 1, 1}), flat).find("z = 0"), std::string::npos);
}

}  // namespace
}  // namespace repose
