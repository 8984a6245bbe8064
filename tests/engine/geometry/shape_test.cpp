// Repose tests: solids with a closed formula: distances against brute force over their own triangles, volumes
// and sections against textbook formulas, refusals.
#include "engine/geometry/shape.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/geometry/mesh_solid.h"
#include "engine/geometry/outline.h"
#include "tests/engine/geometry/geometry_rig.h"

namespace repose {
namespace {

using Type = ShapeDescription::Type;
constexpr double kPi = std::numbers::pi;

std::shared_ptr<const Shape> built(const ShapeDescription& description) {
  auto shape = make_shape(description, ".", 0.1);
  EXPECT_TRUE(shape) << (shape ? "" : shape.error().text());
  return shape ? *shape : nullptr;
}

std::string refusal(const ShapeDescription& description) {
  const auto shape = make_shape(description, ".", 0.1);
  if (shape) return "";
  EXPECT_EQ(shape.error().kind, ErrorKind::kBadScene);
  return shape.error().text();
}

ShapeDescription plane(const Vec3& normal) {
  ShapeDescription d;
  d.type = Type::kPlane;
  d.normal = normal;
  return d;
}

ShapeDescription box(const Vec3& lower, const Vec3& upper) {
  ShapeDescription d;
  d.type = Type::kBox;
  d.lower = lower;
  d.upper = upper;
  return d;
}

ShapeDescription sphere(const Vec3& center, double radius) {
  ShapeDescription d;
  d.type = Type::kSphere;
  d.center = center;
  d.radius = radius;
  return d;
}

ShapeDescription cylinder(const Vec3& center, const Vec3& axis, double radius, double height) {
  ShapeDescription d;
  d.type = Type::kCylinder;
  d.center = center;
  d.axis = axis;
  d.radius = radius;
  d.height = height;
  return d;
}

ShapeDescription revolution(const std::vector<std::vector<double>>& profile) {
  ShapeDescription d;
  d.type = Type::kRevolution;
  d.profile = profile;
  return d;
}

ShapeDescription placed(ShapeDescription d) {
  d.rotation_axis = {1, 2, -1};
  d.rotation_angle = 37;
  d.translation = {0.3, -0.2, 0.5};
  return d;
}

/// A glass with a thick foot: an outline with a hollow, off and on the axis.
ShapeDescription glass() {
  return revolution({{0, 0}, {0.5, 0}, {0.8, 1.2}, {0.7, 1.2}, {0.4, 0.2}, {0, 0.3}});
}

std::vector<ShapeDescription> finite_shapes() {
  ShapeDescription smooth = glass();
  smooth.smooth = true;
  return {box({-1, -0.5, 0}, {0.5, 1, 2}),
          sphere({0.1, 0.2, 0.3}, 0.7),
          cylinder({0, 0.1, 0}, {1, 2, 2}, 0.5, 1.1),
          glass(),
          smooth,
          revolution({{0.5, 0}, {1, 0}, {0.75, 0.4}})};
}

/// Compares distance and sign with the triangles of the shape; `coarseness` is how far those are off.
void expect_distance_of_surface(const ShapeDescription& description, double coarseness) {
  const auto shape = built(description);
  const TriangleMesh mesh = shape->surface(1.0);
  std::mt19937_64 random(7);
  for (int k = 0; k < 400; ++k) {
    const Vec3 x = point_within(Vec3::Constant(-2), Vec3::Constant(2.5), random);
    const double distance = shape->signed_distance(x), expected = mesh_distance(mesh, x);
    EXPECT_NEAR(std::abs(distance), expected, coarseness) << x.transpose();
    if (expected > 2 * coarseness) {
      EXPECT_EQ(distance<0, winding_number(mesh, x)> 0.5) << x.transpose();
    }
  }
}

TEST(Shape, BoxDistance_IsThatOfItsTriangles) {
  expect_distance_of_surface(box({-1, -0.5, 0}, {0.5, 1, 2}), 1e-12);
  expect_distance_of_surface(placed(box({-1, -0.5, 0}, {0.5, 1, 2})), 1e-12);
}

TEST(Shape, RoundDistance_IsThatOfItsTriangles) {
  // The sagitta of a chord of n sides is r (1 - cos(pi / n)), and twice that at the corner of a quad.
  for (const auto& description : {sphere({0.1, 0.2, 0.3}, 0.7), cylinder({0, 0.1, 0}, {1, 2, 2}, 0.5, 1.1),
                                  glass(), revolution({{0.5, 0}, {1, 0}, {0.75, 0.4}})}) {
    expect_distance_of_surface(description, 4e-3);
    expect_distance_of_surface(placed(description), 4e-3);
  }
}

TEST(Shape, SphereDistance_IsRadial) {
  const auto shape = built(sphere({1, 2, 3}, 0.5));
  EXPECT_DOUBLE_EQ(shape->signed_distance({1, 2, 5}), 1.5);
  EXPECT_DOUBLE_EQ(shape->signed_distance({1, 2, 3}), -0.5);
}

TEST(Shape, SmoothRevolution_PassesThroughCornersAndStaysOutOfTheAxis) {
  ShapeDescription d = glass();
  d.smooth = true;
  const auto shape = built(d);
  for (const auto& corner : d.profile) {
    EXPECT_NEAR(shape->signed_distance({corner[0], corner[1], 0}), 0, 1e-12);
  }
  for (const Vec3& v : shape->surface(1).vertices) EXPECT_TRUE(v.allFinite());
}

TEST(Shape, SmoothRevolution_DistanceIsThatOfItsOutline) {
  ShapeDescription d = glass();
  d.smooth = true;
  const auto shape = built(d);
  const auto outline = *make_outline(d.profile, true);
  std::mt19937_64 random(5);
  for (int k = 0; k < 20000; ++k) {
    const Vec3 x = point_within({0, -0.5, 0}, {1.2, 1.8, 0}, random);
    double nearest = 1e9;
    bool inside = false;
    for (std::size_t i = 0; i < outline.size(); ++i) {
      const Vec3 a(outline[i][0], outline[i][1], 0);
      const Corner& next = outline[(i + 1) % outline.size()];
      const Vec3 b(next[0], next[1], 0);
      if (a[0] != 0 || b[0] != 0) nearest = std::min(nearest, segment_distance(x, a, b));
      const bool spans = (a[1] > x[1]) != (b[1] > x[1]);
      if (spans && x[0] < a[0] + (x[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0])) inside = !inside;
    }
    EXPECT_NEAR(shape->signed_distance(x), inside ? -nearest : nearest, 1e-12);
  }
}

TEST(Shape, SmoothRevolution_NeverCrossesTheAxis) {
  const auto outline = make_outline({{0, 0}, {1, 0}, {0, 0.5}, {0.3, 0.9}, {0.6, 1}, {0, 1}}, true);
  ASSERT_TRUE(outline) << outline.error().text();
  for (const Corner& corner : *outline) EXPECT_GE(corner[0], 0);
}

TEST(Shape, SmoothRevolution_MirroredPolesMakeABall) {
  std::vector<std::vector<double>> profile;
  for (int k = 0; k <= 12; ++k)
    profile.push_back({k % 12 ? std::sin(kPi * k / 12) : 0.0, -std::cos(kPi * k / 12)});
  ShapeDescription d = revolution(profile);
  d.smooth = true;
  EXPECT_NEAR(built(d)->volume(), 4.0 / 3 * kPi, 4.0 / 3 * kPi * 1e-3);
}

TEST(Shape, Distance_NeverChangesFasterThanTheWay) {
  std::mt19937_64 random(11);
  for (const ShapeDescription& description : finite_shapes()) {
    const auto shape = built(placed(description));
    for (int k = 0; k < 5000; ++k) {
      const Vec3 a = point_within(Vec3::Constant(-2), Vec3::Constant(2), random);
      const double reach = std::pow(10.0, -4 * unit_number(random));
      const Vec3 b = a + point_within(Vec3::Constant(-reach), Vec3::Constant(reach), random);
      EXPECT_LE(std::abs(shape->signed_distance(a) - shape->signed_distance(b)), (a - b).norm() + 1e-14);
    }
  }
}

TEST(Shape, Volume_IsExact) {
  EXPECT_DOUBLE_EQ(built(box({-1, -0.5, 0}, {0.5, 1, 2}))->volume(), 4.5);
  EXPECT_DOUBLE_EQ(built(sphere({1, 2, 3}, 0.5))->volume(), 4.0 / 3 * kPi * 0.125);
  EXPECT_DOUBLE_EQ(built(cylinder({0, 1, 0}, {1, 1, 0}, 0.5, 3))->volume(), kPi * 0.25 * 3);
  EXPECT_DOUBLE_EQ(built(revolution({{0, 0}, {2, 0}, {2, 3}, {0, 3}}))->volume(), kPi * 4 * 3);
  EXPECT_DOUBLE_EQ(built(revolution({{0, 0}, {2, 0}, {0, 3}}))->volume(), kPi * 4 * 3 / 3);
  // Pappus: the area of the triangle times the way of its centroid.
  EXPECT_NEAR(built(revolution({{0.75, 0.4}, {1, 0}, {0.5, 0}}))->volume(), 0.1 * 2 * kPi * 0.75, 1e-15);
  EXPECT_TRUE(std::isinf(built(plane({0, 1, 0}))->volume()));
}

TEST(Shape, Surface_IsClosedOrientedAndHoldsTheVolume) {
  for (const ShapeDescription& description : finite_shapes()) {
    const auto shape = built(placed(description));
    const TriangleMesh mesh = shape->surface(1.0);
    const auto closed = make_solid(mesh, "surface");
    ASSERT_TRUE(closed) << closed.error().text();
    EXPECT_GT(enclosed_volume(mesh), 0);
    EXPECT_NEAR(enclosed_volume(mesh) / shape->volume(), 1, 0.01);
  }
}

TEST(Shape, Bounds_HoldTheSurfaceTightly) {
  for (const ShapeDescription& description : finite_shapes()) {
    for (const ShapeDescription& d : {description, placed(description)}) {
      const auto shape = built(d);
      const Bounds bounds = shape->bounds(), drawn = bounds_of(shape->surface(1.0));
      const double chord = d.type == Type::kBox ? 1e-12 : 5e-3;  // what the triangles of round solids lack
      EXPECT_TRUE((drawn.lower.array() >= bounds.lower.array() - 1e-12).all());
      EXPECT_TRUE((drawn.upper.array() <= bounds.upper.array() + 1e-12).all());
      EXPECT_LT((drawn.lower - bounds.lower).norm(), chord);
      EXPECT_LT((drawn.upper - bounds.upper).norm(), chord);
    }
  }
}

TEST(Shape, Normal_PointsOutwards) {
  EXPECT_LT((built(plane({0, 3, 4}))->normal({1, 2, 3}, 1e-3) - Vec3(0, 0.6, 0.8)).norm(), 1e-15);
  const auto ball = built(sphere({1, 0, 0}, 0.5));
  EXPECT_LT((ball->normal({1, 2, 0}, 1e-3) - Vec3::UnitY()).norm(), 1e-15);
  EXPECT_DOUBLE_EQ(ball->normal({1, 0, 0}, 1e-3).norm(), 1);
  const auto turned = built(placed(cylinder({0, 0, 0}, {0, 1, 0}, 0.5, 1)));
  const Vec3 x(1.5, 1, 2);
  const Vec3 foot = x - turned->signed_distance(x) * turned->normal(x, 1e-5);
  EXPECT_NEAR(turned->signed_distance(foot), 0, 1e-6);
}

TEST(Shape, Placement_QuarterTurnsAreExact) {
  ShapeDescription d = box({0, 0, 0}, {1, 2, 3});
  d.rotation_axis = {0, 0, 5};
  d.rotation_angle = 90;
  d.translation = {10, 0, 0};
  const Bounds bounds = built(d)->bounds();
  EXPECT_EQ(bounds.lower, Vec3(8, 0, 0));
  EXPECT_EQ(bounds.upper, Vec3(10, 1, 3));
  d.rotation_angle = -270 - 720;
  EXPECT_EQ(built(d)->bounds().lower, Vec3(8, 0, 0));
  d.rotation_angle = 180;
  EXPECT_EQ(built(d)->bounds().lower, Vec3(9, -2, 0));
  d.rotation_angle = 270;
  EXPECT_EQ(built(d)->bounds().lower, Vec3(10, -1, 0));
}

TEST(Shape, Placement_TurnsBeforeItMoves) {
  ShapeDescription d = sphere({1, 0, 0}, 0.5);
  d.rotation_axis = {0, 1, 0};
  d.rotation_angle = 90;
  d.translation = {0, 0, 5};
  EXPECT_NEAR(built(d)->signed_distance({0, 0, 4}), -0.5, 1e-15);
}

TEST(Shape, SectionArea_IsExactWhereItIsGiven) {
  EXPECT_DOUBLE_EQ(*built(box({1, 2, -1}, {4, 6, 1}))->section_area(2), 12);
  EXPECT_DOUBLE_EQ(*built(sphere({5, 5, 0.3}, 0.5))->section_area(2), kPi * 0.16);
  EXPECT_DOUBLE_EQ(*built(cylinder({3, 3, -1}, {0, 0, 2}, 0.5, 2))->section_area(2), kPi * 0.25);
  EXPECT_DOUBLE_EQ(*built(cylinder({3, 3, 0.3}, {0, 1, 0}, 0.5, 2))->section_area(2), 0.8 * 2);
  EXPECT_DOUBLE_EQ(*built(revolution({{0, 0}, {2, 0}, {0, 3}}))->section_area(2), 6);
  ShapeDescription ring = revolution({{1, -1}, {2, -1}, {2, 1}, {1, 1}});
  ring.axis = {0, 0, 1};
  EXPECT_DOUBLE_EQ(*built(ring)->section_area(2), 3 * kPi);
  ShapeDescription tilted = box({1, 2, -1}, {4, 6, 1});
  tilted.rotation_axis = {0, 0, 1};
  tilted.rotation_angle = 33;
  EXPECT_DOUBLE_EQ(*built(tilted)->section_area(2), 12);
}

TEST(Shape, SectionArea_RefusesWhatItCannotGive) {
  const auto refuses = [](const ShapeDescription& d) {
    const auto area = built(d)->section_area(2);
    return !area && area.error().text().find("z = 0") != std::string::npos;
  };
  EXPECT_TRUE(refuses(box({0, 0, 0}, {1, 1, 1})));
  EXPECT_TRUE(refuses(sphere({0, 0, 2}, 0.5)));
  EXPECT_TRUE(refuses(cylinder({0, 0, 0}, {0, 1, 1}, 0.5, 1)));
  EXPECT_TRUE(refuses(cylinder({0, 0, 1}, {0, 0, 1}, 0.5, 1)));
  EXPECT_TRUE(refuses(placed(box({0, 0, -1}, {1, 1, 1}))));
  ShapeDescription moved = box({0, 0, -1}, {1, 1, 1});
  moved.rotation_axis = {0, 0, 1};
  moved.rotation_angle = 30;
  moved.translation = {0, 0, 5};
  EXPECT_TRUE(refuses(moved));
  EXPECT_TRUE(refuses(plane({0, 1, 0})));
}

TEST(Shape, DegenerateSizes_AreRefusedByName) {
  EXPECT_NE(refusal(plane({0, 0, 0})).find("normal"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, 0, 1})).find("upper"), std::string::npos);
  EXPECT_NE(refusal(box({0, 0, 0}, {1, std::nan(""), 1})).find("upper"), std::string::npos);
  EXPECT_NE(refusal(sphere({0, 0, 0}, 0)).find("radius"), std::string::npos);
  EXPECT_NE(refusal(cylinder({0, 0, 0}, {0, 0, 0}, 1, 1)).find("axis"), std::string::npos);
  EXPECT_NE(refusal(cylinder({0, 0, 0}, {0, 1, 0}, 1, -1)).find("height"), std::string::npos);
  ShapeDescription turned = sphere({0, 0, 0}, 1);
  turned.rotation_axis = Vec3::Zero();
  EXPECT_NE(refusal(turned).find("rotation_axis"), std::string::npos);
}

TEST(Shape, BadProfiles_AreRefused) {
  EXPECT_NE(refusal(revolution({{0, 0}, {1, 0}})).find("at least 3"), std::string::npos);
  EXPECT_NE(refusal(revolution({{0, 0}, {1, 0}, {0, 0}})).find("at least 3"), std::string::npos);
  EXPECT_NE(refusal(revolution({{0, 0}, {-1, 0}, {0, 1}})).find("corner 1"), std::string::npos);
  EXPECT_NE(refusal(revolution({{0, 0}, {1, 0}, {1, 0}, {0, 1}})).find("twice"), std::string::npos);
  EXPECT_NE(refusal(revolution({{0.1, 0}, {1, 1}, {1, 0}, {0.1, 1}})).find("meets itself"), std::string::npos);
  EXPECT_NE(refusal(revolution({{0, 0}, {0, 1}, {0, 2}})).find("nothing"), std::string::npos);
}

TEST(Shape, ProfileThatRepeatsItsFirstCorner_IsTheSame) {
  EXPECT_DOUBLE_EQ(built(revolution({{0, 0}, {2, 0}, {0, 3}, {0, 0}}))->volume(), 4 * kPi);
}

}  // namespace
}  // namespace repose
