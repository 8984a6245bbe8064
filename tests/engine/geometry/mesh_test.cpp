// Repose tests: meshes: the check that they are solids, the level set against brute force, and where a scene
// may read from. The bunny and the bowl are those that the scenes use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "engine/geometry/mesh_shape.h"
#include "tests/engine/geometry/geometry_rig.h"
#include "tests/engine/geometry/mesh_files.h"
#include "tests/engine/geometry/mesh_rig.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

std::string without_last_line(std::string text) {
  text.pop_back();
  return text.substr(0, text.rfind('\n') + 1);
}

TriangleMesh box_mesh() {
  return *read_obj(kBoxObj, "box.obj");
}

TriangleMesh turned(TriangleMesh mesh) {
  for (Index3& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh joined(TriangleMesh a, const TriangleMesh& b, double scale, const Vec3& shift) {
  const auto first = static_cast<std::int32_t>(a.vertices.size());
  for (const Vec3& v : b.vertices) a.vertices.push_back(scale * v + shift);
  for (const Index3& t : b.triangles) a.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
  return a;
}

Result<std::shared_ptr<const Shape>> load(const fs::path& folder, const std::string& file, double spacing = 0.1,
                                          bool allow_outside = false) {
  ShapeDescription d;
  d.type = ShapeDescription::Type::kMesh;
  d.file = file;
  return make_shape(d, folder.string(), spacing, allow_outside);
}

fs::path scene_meshes() {
  return fs::path(REPOSE_SCENES) / "meshes";
}

TEST(Mesh, ObjBox_HasItsVolume) {
  const auto mesh = solid_from_obj(kBoxObj);
  ASSERT_TRUE(mesh) << mesh.error().text();
  EXPECT_EQ(mesh->triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(enclosed_volume(*mesh), 6);
  EXPECT_EQ(bounds_of(*mesh).upper, Vec3(1, 2, 3));
}

TEST(Mesh, InsideOut_IsTurned) {
  const TriangleMesh mesh = turned(box_mesh());
  EXPECT_DOUBLE_EQ(enclosed_volume(mesh), -6);
  EXPECT_DOUBLE_EQ(enclosed_volume(*make_solid(mesh, "box")), 6);
}

TEST(Mesh, FarFromItsOrigin_KeepsItsVolume) {
  TriangleMesh mesh = box_mesh();
  for (Vec3& v : mesh.vertices) v += Vec3::Constant(1e6);
  EXPECT_NEAR(enclosed_volume(mesh), 6, 1e-8);
}

TEST(Mesh, Open_IsRefusedWithItsBoundary) {
  const std::string text = refusal(solid_from_obj(without_last_line(kBoxObj)));
  EXPECT_TRUE(has(text, "box.obj: open mesh: 4 boundary edges; first at vertex 0")) << text;
}

TEST(Mesh, SplitVertices_AreJoined) {
  TriangleMesh split;
  const TriangleMesh whole = box_mesh();
  for (const Index3& t : whole.triangles) {
    const auto first = static_cast<std::int32_t>(split.vertices.size());
    for (const std::int32_t i : t) split.vertices.push_back(whole.vertices[i]);
    split.triangles.push_back({first, first + 1, first + 2});
  }
  const auto mesh = make_solid(split, "soup");
  ASSERT_TRUE(mesh) << mesh.error().text();
  EXPECT_DOUBLE_EQ(enclosed_volume(*mesh), 6);
}

TEST(Mesh, WrongTopology_IsRefused) {
  TriangleMesh one_turned = box_mesh();
  std::swap(one_turned.triangles[0][1], one_turned.triangles[0][2]);
  EXPECT_TRUE(has(refusal(make_solid(one_turned, "m")), "3 edges whose triangles face opposite ways"));
  TriangleMesh doubled = box_mesh();
  doubled.triangles.push_back(doubled.triangles[0]);
  EXPECT_TRUE(has(refusal(make_solid(doubled, "m")), "edges of more than two triangles"));
  TriangleMesh flat = box_mesh();
  for (Vec3& v : flat.vertices) v[2] = 0.01 * v[0];
  EXPECT_FALSE(refusal(make_solid(flat, "m")).empty());
  EXPECT_TRUE(has(refusal(make_solid({}, "m")), "without triangles"));
}

TEST(Mesh, Cavity_IsRefusedAndTwoPiecesAreNot) {
  const Vec3 inside(0.25, 0.5, 0.75);
  EXPECT_TRUE(has(refusal(make_solid(joined(box_mesh(), turned(box_mesh()), 0.5, inside), "m")), "cavity"));
  const auto two = make_solid(joined(box_mesh(), box_mesh(), 0.5, {5, 0, 0}), "m");
  ASSERT_TRUE(two);
  EXPECT_DOUBLE_EQ(enclosed_volume(*two), 6.75);
}

TEST(Mesh, PiecesThatOverlap_HaveTheVolumeOfTheirUnion) {
  const auto volume = [](const TriangleMesh& mesh) {
    const auto closed = make_solid(mesh, "pieces");
    EXPECT_TRUE(closed);
    const auto shape = MeshShape::make(*closed, 0.1);
    EXPECT_TRUE(shape);
    return (*shape)->volume();
  };
  const double one = volume(box_mesh());
  EXPECT_NEAR(volume(joined(box_mesh(), box_mesh(), 1.0, {10, 0, 0})), 2.0 * one, 1e-9);
  EXPECT_NEAR(volume(joined(box_mesh(), box_mesh(), 0.5, {0.25, 0.5, 0.75})), one, 0.01 * one) << "nested";
  EXPECT_NEAR(volume(joined(box_mesh(), box_mesh(), 1.0, {0.5, 0, 0})), 1.5 * one, 0.01 * one);
}

TEST(Mesh, ShapesOfOneFile_ShareIt) {
  KnownMeshes known;
  ShapeDescription d;
  d.type = ShapeDescription::Type::kMesh;
  d.file = "bunny.obj";
  for (int k = 0; k < 3; ++k) {
    d.translation = {double(k), 0, 0};
    ASSERT_TRUE(make_shape(d, scene_meshes().string(), 0.01, false, &known));
  }
  EXPECT_EQ(known.size(), 1u);
  d.scale = 2.0;
  ASSERT_TRUE(make_shape(d, scene_meshes().string(), 0.01, false, &known));
  EXPECT_EQ(known.size(), 2u);
}

TEST(Mesh, Paths_StayInTheFolder) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "scene/sub");
  folder.write("outside.obj", kBoxObj);
  folder.write("scene/sub/box.obj", kBoxObj);
  fs::create_symlink(folder.path() / "outside.obj", folder.path() / "scene/link.obj");
  const fs::path scene = folder.path() / "scene";
  const std::string absolute = (folder.path() / "outside.obj").string();

  EXPECT_TRUE(load(scene, "sub/box.obj"));
  EXPECT_TRUE(load(scene, "sub/../sub/box.obj"));
  for (const std::string& file : {std::string("../outside.obj"), std::string("link.obj"), absolute,
                                  std::string("sub/../../outside.obj"), std::string("../not_there.obj")}) {
    const auto shape = load(scene, file);
    ASSERT_FALSE(shape) << file;
    EXPECT_EQ(shape.error().kind, ErrorKind::kBadScene) << file;
    EXPECT_TRUE(has(shape.error().text(), "leaves the scene's folder"));
  }
  EXPECT_TRUE(load(scene, "../outside.obj", 0.1, true));
  EXPECT_TRUE(load(scene, "link.obj", 0.1, true));
  EXPECT_TRUE(load(scene, absolute, 0.1, true));
}

TEST(Mesh, MissingFile_NamesThePathTried) {
  const TemporaryFolder folder;
  fs::create_directories(folder.path() / "directory.obj");
  for (const std::string file : {"none.obj", "directory.obj"}) {
    const auto shape = load(folder.path(), file);
    ASSERT_FALSE(shape);
    EXPECT_EQ(shape.error().kind, ErrorKind::kNoInput);
    EXPECT_EQ(shape.error().where, (fs::canonical(folder.path()) / file).string());
  }
}

TEST(Mesh, OtherFormats_AreRefused) {
  const TemporaryFolder folder;
  folder.write("box.stl", kBoxObj);
  const auto shape = load(folder.path(), "box.stl");
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().kind, ErrorKind::kBadScene);
}

TEST(Mesh, TooFineForMemory_IsRefused) {
  const TemporaryFolder folder;
  folder.write("box.obj", kBoxObj);
  const auto shape = load(folder.path(), "box.obj", 1e-5);
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().kind, ErrorKind::kMemory);
}

TEST(Mesh, BoxLevelSet_IsTheBoxNearAndFar) {
  const TemporaryFolder folder;
  folder.write("box.obj", kBoxObj);
  const auto shape = load(folder.path(), "box.obj", 0.1);
  ASSERT_TRUE(shape) << shape.error().text();
  EXPECT_DOUBLE_EQ((*shape)->volume(), 6);
  EXPECT_NEAR((*shape)->signed_distance({0.5, 1, -0.123}), 0.123, 1e-5);
  EXPECT_NEAR((*shape)->signed_distance({0.5, 1, 0.123}), -0.123, 1e-5);
  EXPECT_NEAR((*shape)->signed_distance({0.5, 1, 100}), 97, 1e-9);
  EXPECT_NEAR((*shape)->signed_distance({1e8, 1, 1}), 1e8 - 1, 1);
  EXPECT_NEAR((*shape)->signed_distance({0.5, 1, 1.5}), -0.4, 1e-6);  // deep inside: the band of four cells
}

TEST(Mesh, ScaleAndPlacement_Apply) {
  const TemporaryFolder folder;
  folder.write("box.obj", kBoxObj);
  ShapeDescription d;
  d.type = ShapeDescription::Type::kMesh;
  d.file = "box.obj";
  d.scale = 2;
  d.rotation_axis = {0, 0, 1};
  d.rotation_angle = 90;
  d.translation = {0, 0, 10};
  const auto shape = make_shape(d, folder.path().string(), 0.1);
  ASSERT_TRUE(shape);
  EXPECT_DOUBLE_EQ((*shape)->volume(), 48);
  EXPECT_EQ((*shape)->bounds().lower, Vec3(-4, 0, 10));
  EXPECT_EQ((*shape)->bounds().upper, Vec3(0, 2, 16));
  EXPECT_NEAR((*shape)->signed_distance({-4.2, 1, 12}), 0.2, 1e-5);
  EXPECT_LT(((*shape)->normal({-4.2, 1, 12}, 0.05) + Vec3::UnitX()).norm(), 1e-4);
  EXPECT_FALSE((*shape)->section_area(2));
}

/// Sign by winding number, distance by brute force, at points near and in the bounds of a mesh.
void expect_level_set(const std::string& file, double spacing) {
  const auto shape = load(scene_meshes(), file, spacing);
  ASSERT_TRUE(shape) << shape.error().text();
  const TriangleMesh mesh = (*shape)->surface(1);
  const Bounds bounds = (*shape)->bounds();
  const Vec3 margin = Vec3::Constant(6 * spacing);
  const double band = 4 * spacing;
  std::mt19937_64 random(3);
  for (int k = 0; k < 400; ++k) {
    const Vec3 x = point_within(bounds.lower - margin, bounds.upper + margin, random);
    const double distance = (*shape)->signed_distance(x), truth = mesh_distance(mesh, x);
    const bool inside = winding_number(mesh, x) > 0.5;
    // Interpolation adds a little at creases of the surface, and cuts the ridges between two sides of it.
    EXPECT_LE(std::abs(distance), truth + 0.1 * spacing) << x.transpose();
    EXPECT_GE(std::abs(distance), std::min(truth, band) - 0.3 * spacing) << x.transpose();
    if (truth > 0.1 * spacing) {
      EXPECT_EQ(distance < 0, inside) << x.transpose();
    }
  }
}

TEST(Mesh, BunnyLevelSet_IsItsDistance) {
  expect_level_set("bunny.obj", 0.005);
}

TEST(Mesh, BowlLevelSet_IsItsDistance) {
  expect_level_set("bowl.obj", 0.005);
}

TEST(Mesh, SceneMeshes_AreSolidsOfTheirSize) {
  const auto bunny = read_mesh((scene_meshes() / "bunny.obj").string());
  ASSERT_TRUE(bunny) << bunny.error().text();
  const auto solid = make_solid(*bunny, "bunny.obj");
  ASSERT_TRUE(solid) << solid.error().text();
  EXPECT_EQ(solid->triangles.size(), 3674u);
  const Bounds bounds = bounds_of(*solid);
  EXPECT_NEAR(bounds.lower[1], 0, 1e-9);
  EXPECT_NEAR(bounds.upper[1], 0.2, 1e-9);
  EXPECT_NEAR(bounds.lower[0] + bounds.upper[0], 0, 2e-5);
  EXPECT_NEAR(bounds.lower[2] + bounds.upper[2], 0, 2e-5);
  // A bunny fills something like a third of its box.
  const double filled = enclosed_volume(*solid) / (bounds.upper - bounds.lower).prod();
  EXPECT_GT(filled, 0.25);
  EXPECT_LT(filled, 0.45);
}

}  // namespace
}  // namespace repose
