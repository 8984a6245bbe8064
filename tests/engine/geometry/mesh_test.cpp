// Repose tests: meshes: reading OBJ and PLY, the check that they are solids, the level set against brute force,
// and where a scene may read from. The bunny and the bowl are those that the scenes use.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <filesystem>

#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_shape.h"
#include "engine/geometry/mesh_solid.h"
#include "tests/engine/geometry/geometry_rig.h"
#include "tests/engine/geometry/mesh_files.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

/// A box from 0 to (1, 2, 3), its faces as quads, counter-clockwise from outside.
const std::string kBoxObj =
    "# a box\n"
    "v 0 0 0\nv 1 0 0\nv 1 2 0\nv 0 2 0\nv 0 0 3\nv 1 0 3\nv 1 2 3\nv 0 2 3\n"
    "f 1 4 3 2\nf 5/1 6/2 7/3 8/4\nf 1//1 2//1 6//2 5//3\nf 2/1/1 3/1/1 7/1/1 6/1/1\nf -6 -5 -1 -2\nf 1 5 8 4 "
    "# last\n";

std::string without_last_line(std::string text) {
  text.pop_back();
  return text.substr(0, text.rfind('\n') + 1);
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

Result<TriangleMesh> solid_from_obj(const std::string& text) {
  auto mesh = read_obj(text, "box.obj");
  return mesh ? make_solid(std::move(*mesh), "box.obj") : std::move(mesh);
}

std::string refusal(const Result<TriangleMesh>& mesh) {
  if (mesh) return "";
  EXPECT_EQ(mesh.error().kind, ErrorKind::kBadScene);
  return mesh.error().text();
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
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

std::string ply_text() {
  return "ply\nformat ascii 1.0\ncomment a tetrahedron\nelement vertex 4\nproperty double x\nproperty float "
         "quality\nproperty double y\nproperty double z\nelement edge 1\nproperty int first\nelement face "
         "4\nproperty list uchar int vertex_indices\nproperty uchar red\nend_header\n"
         "0 9 0 0\n1 9 0 0\n0 9 1 0\n0 9 0 1\n7\n3 0 2 1 255\n3 0 1 3 255\n3 1 2 3 255\n3 0 3 2 255\n";
}

template <class T>
void append(std::string& bytes, T value) {
  bytes.append(reinterpret_cast<const char*>(&value), sizeof(T));
}

std::string ply_binary() {
  std::string bytes =
      "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty "
      "float z\nelement face 4\nproperty list uchar uint vertex_index\nend_header\n";
  for (const float c : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 0.f, 1.f}) append(bytes, c);
  for (const auto& t : {Index3{0, 2, 1}, Index3{0, 1, 3}, Index3{1, 2, 3}, Index3{0, 3, 2}}) {
    append(bytes, std::uint8_t{3});
    for (const std::int32_t i : t) append(bytes, static_cast<std::uint32_t>(i));
  }
  return bytes;
}

TEST(Mesh, ObjBox_HasItsVolume) {
  const auto mesh = solid_from_obj(kBoxObj);
  ASSERT_TRUE(mesh) << mesh.error().text();
  EXPECT_EQ(mesh->triangles.size(), 12u);
  EXPECT_DOUBLE_EQ(enclosed_volume(*mesh), 6);
  EXPECT_EQ(bounds_of(*mesh).upper, Vec3(1, 2, 3));
}

TEST(Mesh, ObjWithWindowsLineEnds_IsTheSame) {
  std::string text;
  for (const char c : kBoxObj) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  ASSERT_TRUE(solid_from_obj(text));
  EXPECT_DOUBLE_EQ(enclosed_volume(*solid_from_obj(text)), 6);
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

TEST(Mesh, BadObj_IsRefusedAtItsLine) {
  const auto text = [](const std::string& obj) { return refusal(read_obj(obj, "box.obj")); };
  EXPECT_TRUE(has(text(replaced(kBoxObj, "f 1 4 3 2", "f 1 4 3 9")), "box.obj:10: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "f 1 4 3 2", "f 0 4 3 2")), "box.obj:10: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "f 1 4 3 2", "f -9 4 3 2")), "box.obj:10: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "f 1 4 3 2", "f 1 4")), "box.obj:10: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "v 1 0 0", "v 1 nan 0")), "box.obj:3: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "v 1 0 0", "v 1e999 0 0")), "box.obj:3: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "v 1 0 0", "v 1 0")), "box.obj:3: "));
  EXPECT_TRUE(has(text(replaced(kBoxObj, "v 1 0 0", "v 1 0 x")), "box.obj:3: "));
}

/// A channel with a U for a section, 0.3 x 0.3 with a notch 0.1 wide down to 0.1, 2 long; its two ends are one
/// polygon of eight corners each.
std::string channel_obj() {
  const double u[8][2] = {{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}};
  std::string text;
  for (const int z : {0, 2}) {
    for (const auto& at : u)
      text += "v " + std::to_string(at[0]) + " " + std::to_string(at[1]) + " " + std::to_string(z) + "\n";
  }
  text += "f 8 7 6 5 4 3 2 1\nf 9 10 11 12 13 14 15 16\n";
  for (int k = 0; k < 8; ++k) {
    const int a = k + 1, b = (k + 1) % 8 + 1;
    text += "f " + std::to_string(a) + " " + std::to_string(b) + " " + std::to_string(b + 8) + " " +
            std::to_string(a + 8) + "\n";
  }
  return text;
}

TEST(Mesh, ConcavePolygons_LeaveTheNotchOpen) {
  for (const bool turned_over : {false, true}) {
    std::string text = channel_obj();
    if (turned_over)
      text = replaced(replaced(text, "f 8 7 6 5 4 3 2 1", "f 3 2 1 8 7 6 5 4"), "f 9 10 11 12 13 14 15 16",
                      "f 13 14 15 16 9 10 11 12");
    auto mesh = read_obj(text, "channel.obj");
    ASSERT_TRUE(mesh) << mesh.error().text();
    const auto closed = make_solid(std::move(*mesh), "channel.obj");
    ASSERT_TRUE(closed) << closed.error().text();
    EXPECT_NEAR(enclosed_volume(*closed), 2.0 * (9.0 - 2.0), 1e-12);
    const auto shape = MeshShape::make(*closed, 0.2);
    ASSERT_TRUE(shape);
    EXPECT_GT((*shape)->signed_distance({1.5, 2.0, 0.0}), 0.2) << "the mouth of the notch is no lid";
    EXPECT_GT((*shape)->signed_distance({1.5, 2.0, 1.0}), 0.3);
    EXPECT_LT((*shape)->signed_distance({0.5, 2.0, 1.0}), -0.3);
  }
}

TEST(Mesh, PolygonThatCrossesItself_IsRefusedAtItsLine) {
  const auto text = refusal(read_obj("v 0 0 0\nv 3 0 0\nv 0 2 0\nv 3 1 0\nf 1 2 3 4\n", "bow.obj"));
  EXPECT_TRUE(has(text, "bow.obj:5: ")) << text;
  EXPECT_TRUE(has(text, "crosses itself")) << text;
  const auto uneven =
      refusal(read_obj("v 0 0 0\nv 4 0 0\nv 0 2 0\nv 1 1 0\nv 2 3 0\nf 1 2 3 4 5\n", "bow.obj"));
  EXPECT_TRUE(has(uneven, "bow.obj:6: ")) << uneven;
}

TEST(Mesh, ObjAsOtherProgramsWriteIt_IsTheSame) {
  const auto volume = [](const std::string& text) {
    auto mesh = read_obj(text, "box.obj");
    if (!mesh) return -1.0;
    const auto closed = make_solid(std::move(*mesh), "box.obj");
    return closed ? enclosed_volume(*closed) : -2.0;
  };
  const double right = volume(kBoxObj);
  EXPECT_GT(right, 0.0);
  EXPECT_EQ(volume("\xEF\xBB\xBF" + std::string(kBoxObj)), right) << "a byte-order mark";
  EXPECT_EQ(volume(replaced(kBoxObj, "f 1 4 3 2", "f 1 4 \\\n 3 2")), right) << "a line that goes on";
  std::string old_ends = kBoxObj;
  std::replace(old_ends.begin(), old_ends.end(), '\n', '\r');
  EXPECT_EQ(volume(old_ends), right);
  const auto wrong = refusal(read_obj(replaced(kBoxObj, "f 1 4 3 2", "f 1 4 \\\n 3 9"), "box.obj"));
  EXPECT_TRUE(has(wrong, "box.obj:10: ")) << wrong;
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

TEST(Mesh, Ply_TextAndBinaryHaveTheirVolume) {
  for (const std::string& bytes : {ply_text(), ply_binary()}) {
    auto mesh = read_ply(bytes, "t.ply");
    ASSERT_TRUE(mesh) << mesh.error().text();
    const auto closed = make_solid(std::move(*mesh), "t.ply");
    ASSERT_TRUE(closed) << closed.error().text();
    EXPECT_NEAR(enclosed_volume(*closed), 1.0 / 6, 1e-15);
  }
}

TEST(Mesh, BadPly_IsRefused) {
  const auto text = [](const std::string& bytes) { return refusal(read_ply(bytes, "t.ply")); };
  EXPECT_TRUE(has(text("plough\n"), "t.ply:1"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "format ascii 1.0\n", "")), "format"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "ascii", "binary_big_endian")), "t.ply:2"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "vertex 4", "vertex 4000000000")), "more rows than the file"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "double z", "double w")), "x, y and z"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "3 0 2 1 255", "3 0 2 4 255")), "t.ply:20: face 0"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "3 0 2 1 255", "3 0 2 -1 255")), "t.ply:20: face 0"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "3 0 2 1 255", "3 0 2 0.5 255")), "t.ply:20: face 0"));
  EXPECT_TRUE(has(text(replaced(ply_text(), "1 9 0 0", "inf 9 0 0")), "t.ply:16: vertex 1 is not finite"));
}

TEST(Mesh, PlyCutAnywhere_IsRefused) {
  const std::string binary = ply_binary();
  for (std::size_t size = 0; size < binary.size(); ++size) {
    EXPECT_FALSE(read_ply(std::string_view(binary).substr(0, size), "t.ply")) << size;
  }
  std::string hostile = binary;
  hostile[hostile.size() - 13] = '\x7f';  // a list of 127 numbers in the last 12 bytes
  EXPECT_FALSE(read_ply(hostile, "t.ply"));
  const std::string wide = replaced(ply_text(), "list uchar int", "list uint int");
  EXPECT_FALSE(read_ply(replaced(wide, "3 0 2 1 255", "4000000000 0 2 1 255"), "t.ply"));
}

TEST(Mesh, Paths_StayInTheFolder) {
  const Folder folder;
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
  const Folder folder;
  fs::create_directories(folder.path() / "directory.obj");
  for (const std::string file : {"none.obj", "directory.obj"}) {
    const auto shape = load(folder.path(), file);
    ASSERT_FALSE(shape);
    EXPECT_EQ(shape.error().kind, ErrorKind::kNoInput);
    EXPECT_EQ(shape.error().where, (fs::canonical(folder.path()) / file).string());
  }
}

TEST(Mesh, OtherFormats_AreRefused) {
  const Folder folder;
  folder.write("box.stl", kBoxObj);
  const auto shape = load(folder.path(), "box.stl");
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().kind, ErrorKind::kBadScene);
}

TEST(Mesh, TooFineForMemory_IsRefused) {
  const Folder folder;
  folder.write("box.obj", kBoxObj);
  const auto shape = load(folder.path(), "box.obj", 1e-5);
  ASSERT_FALSE(shape);
  EXPECT_EQ(shape.error().kind, ErrorKind::kMemory);
}

TEST(Mesh, BoxLevelSet_IsTheBoxNearAndFar) {
  const Folder folder;
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
  const Folder folder;
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
