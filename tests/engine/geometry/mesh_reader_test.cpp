// Repose tests: mesh files, OBJ and PLY: what other programs write is read, and what is wrong is refused where
// it stands.
#include <gtest/gtest.h>

#include <algorithm>

#include "engine/geometry/mesh_shape.h"
#include "tests/engine/geometry/mesh_rig.h"

namespace repose {
namespace {

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

TEST(Mesh, ObjWithWindowsLineEnds_IsTheSame) {
  std::string text;
  for (const char c : kBoxObj) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  ASSERT_TRUE(solid_from_obj(text));
  EXPECT_DOUBLE_EQ(enclosed_volume(*solid_from_obj(text)), 6);
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

}  // namespace
}  // namespace repose
