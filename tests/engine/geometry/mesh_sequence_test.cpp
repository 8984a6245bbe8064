// Repose tests: meshes that succeed one another: where the surface stands between frames, how far and how fast
// it goes, and what is refused before a run begins.
#include "engine/geometry/mesh_sequence.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/engine/geometry/geometry_rig.h"
#include "tests/engine/geometry/mesh_files.h"
#include "tests/engine/reading/scene_errors_rig.h"

namespace repose {
namespace {

constexpr double kSpacing = 0.05;

ShapeDescription mesh_shape(const std::string& file = "m.####.obj") {
  ShapeDescription shape;
  shape.type = ShapeDescription::Type::kMesh;
  shape.file = file;
  return shape;
}

SequenceDescription frames(std::int64_t count, bool repeat = false, double start = 0.0) {
  SequenceDescription description;
  description.count = count;
  description.rate = 10.0;
  description.start = start;
  description.repeat = repeat;
  return description;
}

std::shared_ptr<const MeshSequence> sequence(const TemporaryFolder& folder,
                                             const SequenceDescription& description) {
  auto made = MeshSequence::make(mesh_shape(), description, folder.path().string(), kSpacing, false);
  EXPECT_TRUE(made) << made.error().text();
  return made ? *made : nullptr;
}

TriangleMesh box(const Vec3& by = {0, 0, 0}) {
  return moved(box_of_squares({0, 0, 0}, {0.4, 0.5, 0.6}, {2, 2, 2}), by);
}

/// A box that has become a wedge: each corner goes another way.
TriangleMesh twisted() {
  TriangleMesh mesh = box();
  for (Vec3& v : mesh.vertices) v = {v[0] + 0.3 * v[1], v[1] + 0.2 * v[2] * v[0], 1.2 * v[2] + 0.05};
  return mesh;
}

TEST(MeshSequence, BetweenFrames_IsTheInterpolatedMesh) {
  const TemporaryFolder folder;
  write_frame(folder, "m", 1, box());
  write_frame(folder, "m", 2, twisted());
  const auto shapes = sequence(folder, frames(2));
  std::mt19937_64 random(5);
  for (const double share : {0.0, 0.3, 0.5, 0.9, 1.0}) {
    const auto shape = shapes->at(0.1 * share);
    TriangleMesh truth = box();
    const TriangleMesh end = twisted();
    for (std::size_t i = 0; i < truth.vertices.size(); ++i) {
      truth.vertices[i] += share * (end.vertices[i] - truth.vertices[i]);
    }
    double worst = 0.0;
    for (int k = 0; k < 400; ++k) {
      const Vec3 x = point_within({-0.2, -0.2, -0.2}, {0.9, 0.9, 1.0}, random);
      const double sign = winding_number(truth, x) > 0.5 ? -1.0 : 1.0,
                   distance = sign * mesh_distance(truth, x);
      const double found = shape->signed_distance(x);
      EXPECT_LE(std::abs(found), std::abs(distance) + 0.1 * kSpacing) << share << " at " << x.transpose();
      if (std::abs(distance) > kSpacing) continue;
      worst = std::max(worst, std::abs(found - distance));
    }
    EXPECT_LT(worst, 0.15 * kSpacing) << share;
  }
}

TEST(MeshSequence, PlateFasterThanItIsThick_DoesNotVanish) {
  const TemporaryFolder folder;
  const TriangleMesh plate = box_of_squares({0, 0, 0}, {0.1, 0.6, 0.6}, {1, 3, 3});
  write_frame(folder, "m", 1, plate);
  write_frame(folder, "m", 2, moved(plate, {1, 0, 0}));
  const auto half = sequence(folder, frames(2))->at(0.05);
  EXPECT_NEAR(half->signed_distance({0.55, 0.3, 0.3}), -0.05, 1e-5);
  EXPECT_NEAR(half->signed_distance({0.67, 0.3, 0.3}), 0.07, 1e-5);
  const MorphedShape::Beside beside = half->beside({0.62, 0.3, 0.3});
  const Vec3 normal = half->normal({0.62, 0.3, 0.3}, 0.01, beside.way);
  EXPECT_LT((normal - Vec3(1, 0, 0)).norm(), 1e-5);
  EXPECT_LT((MorphedShape::way(beside, normal) - Vec3(1, 0, 0)).norm(), 1e-12);
}

TEST(MeshSequence, OtherTriangles_LevelSetsAreInterpolated) {
  const TemporaryFolder folder;
  write_frame(folder, "m", 1, box());
  write_frame(folder, "m", 2, moved(box_of_squares({0, 0, 0}, {0.4, 0.5, 0.6}, {3, 1, 2}), {0.05, 0, 0}));
  const auto shapes = sequence(folder, frames(2));
  const Vec3 x(0.44, 0.25, 0.3);
  for (const double share : {0.0, 0.25, 1.0}) {
    const auto shape = shapes->at(0.1 * share);
    const MorphedShape::Beside beside = shape->beside(x);
    EXPECT_NEAR(beside.distance, 0.04 - 0.05 * share, 1e-5);
    EXPECT_LT((MorphedShape::way(beside, shape->normal(x, 0.01)) - Vec3(0.05, 0, 0)).norm(), 1e-4);
  }
  EXPECT_NEAR(shapes->fastest(0.0, 0.1), 0.5, 1e-9);
}

TEST(MeshSequence, Time_RestsOutsideAndRepeatsWhereAsked) {
  const TemporaryFolder folder;
  for (int k = 0; k < 3; ++k) write_frame(folder, "m", k + 1, box({0.1 * k * (3 - k), 0, 0}));  // 0, 0.2, 0.2
  const auto side = [&](const std::shared_ptr<const MeshSequence>& shapes, double time) {
    return shapes->at(time)->bounds().upper[0] - 0.4;
  };
  const auto once = sequence(folder, frames(3, false, 1.0)), always = sequence(folder, frames(3, true, 1.0));
  for (const double time : {0.0, 1.0}) {
    EXPECT_NEAR(side(once, time), 0.0, 1e-12);
    EXPECT_NEAR(side(always, time), 0.0, 1e-12);
  }
  EXPECT_NEAR(side(once, 1.05), 0.1, 1e-12);
  EXPECT_NEAR(side(once, 1.2), 0.2, 1e-12);
  EXPECT_NEAR(side(once, 7.0), 0.2, 1e-12);
  EXPECT_NEAR(side(always, 1.25), 0.1, 1e-12) << "from the last to the first";
  EXPECT_NEAR(side(always, 1.05 + 0.9), 0.1, 1e-9);
  EXPECT_NEAR(once->fastest(1.05, 1.06), 2.0, 1e-9);
  EXPECT_EQ(once->fastest(1.11, 1.19), 0.0) << "the second and the third are alike";
  EXPECT_EQ(once->fastest(0.0, 1.0), 0.0);
  EXPECT_EQ(once->fastest(1.3, 9.0), 0.0);
  EXPECT_NEAR(always->fastest(1.25, 1.26), 2.0, 1e-9);
  EXPECT_NEAR(once->moving_share(0.95, 1.05), 0.5, 1e-12);
  EXPECT_NEAR(once->moving_share(1.15, 1.25), 0.5, 1e-9);
  EXPECT_EQ(once->moving_share(2.0, 2.1), 0.0);
}

TEST(MeshSequence, Windows_HoldTheirWay) {
  const TemporaryFolder folder;
  for (int k = 0; k < 3; ++k) write_frame(folder, "m", k + 1, box({0.35 * k, 0, 0}));
  const auto shapes = sequence(folder, frames(3));
  for (int k = 0; k <= 300; ++k) {
    const double time = 0.001 * k, begin = shapes->window(time, 0.1);
    EXPECT_LE(begin, time + 1e-12);
    const double way = shapes->at(time)->bounds().upper[0] - shapes->at(begin)->bounds().upper[0];
    EXPECT_LE(way, 0.1 + 1e-9) << time;
  }
}

TEST(MeshSequence, FrameFile_FillsOneRowOfSigns) {
  EXPECT_EQ(frame_file("a/plough.####.obj", 7), "a/plough.0007.obj");
  EXPECT_EQ(frame_file("p#.ply", 123), "p123.ply");
  EXPECT_EQ(frame_file("p.obj", 1), "");
  EXPECT_EQ(frame_file("p#q#.obj", 1), "");
}

TEST(MeshSequence, BadFiles_AreRefusedByName) {
  const TemporaryFolder folder;
  write_frame(folder, "m", 1, box());
  TriangleMesh open = box();
  open.triangles.pop_back();
  write_frame(folder, "m", 2, open);
  const auto refusal = [&](std::int64_t count) {
    const auto made = MeshSequence::make(mesh_shape(), frames(count), folder.path().string(), kSpacing, false);
    return made ? std::string() : made.error().text();
  };
  EXPECT_EQ(refusal(1), "");
  EXPECT_NE(refusal(2).find("m.0002.obj: open mesh"), std::string::npos) << refusal(2);
  write_frame(folder, "m", 2, box());
  EXPECT_NE(refusal(3).find("m.0003.obj: there is no such mesh file"), std::string::npos) << refusal(3);
  folder.write("m.0003.obj", "v 1 0 x\n");
  EXPECT_NE(refusal(3).find("m.0003.obj:1: "), std::string::npos) << refusal(3);
  const auto fine = MeshSequence::make(mesh_shape(), frames(1), folder.path().string(), 1e-5, false);
  ASSERT_FALSE(fine);
  EXPECT_EQ(fine.error().kind, ErrorKind::kMemory);
  const auto outside =
      MeshSequence::make(mesh_shape("../m.####.obj"), frames(1), folder.path().string(), kSpacing, false);
  ASSERT_FALSE(outside);
  EXPECT_EQ(outside.error().kind, ErrorKind::kBadScene);
}

TEST(MeshSequence, WrongKeys_AreRefusedAtTheirPlace) {
  const auto text = [](const std::string& shape, const std::string& more) {
    return errors(with(R"("shape": {"type": "plane"}})",
                       R"("shape": )" + shape + R"(, "frames": {"count": 3})" + more + "}"));
  };
  const std::string mesh = R"({"type": "mesh", "file": "m.##.obj"})";
  EXPECT_EQ(text(mesh, ""), "");
  EXPECT_NE(text(R"({"type": "plane"})", "").find("colliders[0].frames: needs a shape of type \"mesh\""),
            std::string::npos)
      << text(R"({"type": "plane"})", "");
  EXPECT_NE(text(R"({"type": "mesh", "file": "m.obj"})", "").find("one row of \"#\""), std::string::npos);
  EXPECT_NE(text(mesh, R"(, "motion": {"keys": [{"time": 0}]})").find("no \"motion\" beside them"),
            std::string::npos);
}

}  // namespace
}  // namespace repose
