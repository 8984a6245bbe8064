// Repose tests: paths from files: they come to what built-in paths come to, and what is wrong in one is told by
// file, line and column.
#include <gmock/gmock.h>

#include "tests/element/element_test_rig.h"
#include "tests/temporary_folder.h"

namespace repose {
namespace {

using ::testing::HasSubstr;

class PathFile : public ::testing::Test {
 protected:
  std::string write(const std::string& text) const {
    folder_.write("path.csv", text);
    return folder_.path("path.csv");
  }
  Path path_of(const std::string& text, double pressure = 0.0) const {
    auto path = read_path(write(text), pressure, 1.0);
    if (!path) throw std::runtime_error(path.error().text());
    return *path;
  }
  /// The message without its folder.
  std::string refusal(const std::string& text) const {
    const auto path = read_path(write(text), 0.0, 1.0);
    if (path) return "";
    EXPECT_EQ(path.error().kind, ErrorKind::kBadScene);
    return path.error().text().substr(folder_.path().string().size() + 1);
  }

  TemporaryFolder folder_;
};

TEST_F(PathFile, GradientsOfVelocity_AreTheShearOfTheBuiltInPath) {
  const auto built_in = driven(sand_scene(), simple_shear_path(1e3, {0.02, 100, 1.0}, true));
  const auto read = driven(sand_scene(), path_of("# shear\ndt [s],L_xz [1/s],repeat\n2e-4,1,100\n", 1e3));
  ASSERT_EQ(read.size(), built_in.size());
  for (std::size_t k = 0; k < read.size(); ++k) {
    for (std::size_t i = 0; i < 6; ++i)
      ASSERT_NEAR(read[k].stress[i], built_in[k].stress[i], 1e-8) << k << " " << i;
  }
}

TEST_F(PathFile, IncrementsOfStrain_AreTheCompressionOfTheBuiltInPath) {
  const auto built_in = driven(sand_scene(), oedometric_path(0.0, {0.02, 100, 1.0}));
  const auto read = driven(sand_scene(), path_of("de_zz,repeat\n-2e-4,100\n"));
  EXPECT_NEAR(read.back().stress[5], built_in.back().stress[5], 1e-8 * std::abs(read.back().stress[5]));
  EXPECT_NEAR(read.back().time, 0.02, 1e-12) << "|de| / rate";
  // There and back again, sheared too: strains of a path that closes are none.
  const ElementState closed =
      driven(sand_scene(), path_of("de_zz,de_xy\n-1e-3,0\n0,2e-3\n0,-2e-3\n1e-3,0\n")).back();
  for (const double strain : closed.strain) EXPECT_NEAR(strain, 0.0, 1e-8);
}

TEST_F(PathFile, WhatIsWrong_IsToldByLineAndColumn) {
  EXPECT_EQ(refusal("dt [s],L_xq [1/s]\n"), "path.csv:1: column \"L_xq\" is unknown; did you mean \"L_xx\"?");
  EXPECT_EQ(refusal("dt [ms],L_xx [1/s]\n"), "path.csv:1: column \"dt\" is in s, not in \"ms\"");
  EXPECT_EQ(refusal("de_xx,de_xx\n"), "path.csv:1: column \"de_xx\" is there twice");
  EXPECT_EQ(refusal("dt [s]\n1\n"), "path.csv:1: has no column of L_xx ... L_zz, nor of de_xx ... de_xz");
  EXPECT_EQ(refusal("L_xx [1/s]\n1\n"), "path.csv:1: has gradients L, and so needs a column \"dt [s]\"");
  EXPECT_THAT(refusal("dt [s],L_xx [1/s],de_xx\n"), HasSubstr("a path is told by one of them"));
  EXPECT_EQ(refusal("de_xx\n0.1\n\nx\n"), "path.csv:4: de_xx: found \"x\"; expected a number");
  EXPECT_EQ(refusal("de_xx\nnan\n"), "path.csv:2: de_xx: found \"nan\"; expected a number");
  EXPECT_EQ(refusal("de_xx,de_yy\n0.1\n"), "path.csv:2: has 1 values for 2 columns");
  EXPECT_EQ(refusal("dt [s],de_xx\n0,0.1\n"), "path.csv:2: dt: 0 must be greater than 0 s");
  EXPECT_EQ(refusal("de_xx,repeat\n0.1,1.5\n"), "path.csv:2: repeat: 1.5 must be a whole number, at least 1");
  EXPECT_THAT(refusal("de_xx\n7\n"), HasSubstr("path.csv:2: de: a strain of 7 in one step"));
  EXPECT_THAT(refusal("de_xx\n"), HasSubstr("holds no step"));
  EXPECT_THAT(refusal(""), HasSubstr("path.csv:1: holds no step"));
  const auto missing = read_path("/nowhere/path.csv", 0.0, 1.0);
  ASSERT_FALSE(missing);
  EXPECT_EQ(missing.error().kind, ErrorKind::kNoInput);
}

TEST_F(PathFile, StepThatTurnsTheElementInsideOut_IsRefusedWithItsLine) {
  Element element = element_of(sand_scene());
  const auto states = drive(element, path_of("dt [s],L_zz [1/s]\n0.1,-1\n1,-2\n"));
  ASSERT_FALSE(states);
  EXPECT_EQ(states.error().kind, ErrorKind::kBadScene);
  EXPECT_THAT(states.error().text(), HasSubstr("path.csv:3: turns the element inside out, det(I + dt L) = -1"));
}

}  // namespace
}  // namespace repose
