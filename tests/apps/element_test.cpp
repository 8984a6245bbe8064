// Repose tests: `repose element`: what it leaves, and what is wrong arguments.
#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <sstream>

#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class ElementCommand : public CommandTest {
 protected:
  /// Rows of element.csv, by head.
  std::vector<std::map<std::string, std::string>> rows(const std::string& folder) const {
    std::istringstream csv(bytes_of(folder + "/element.csv"));
    std::vector<std::string> head;
    std::vector<std::map<std::string, std::string>> all;
    for (std::string line; std::getline(csv, line);) {
      std::vector<std::string> cells;
      std::istringstream row(line + ",");
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      if (head.empty()) {
        head = cells;
        continue;
      }
      EXPECT_EQ(cells.size(), head.size()) << line;
      all.emplace_back();
      for (std::size_t k = 0; k < cells.size(); ++k) all.back()[head[k]] = cells[k];
    }
    return all;
  }
};

TEST_F(ElementCommand, Triaxial_LeavesTableAndPage) {
  const Finished done =
      repose({"element", tiny_scene(), "--path", "triaxial", "--steps", "200", "--out", path("out")});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_THAT(done.out, HasSubstr("no part of an element, and left out: gravity, collider"));
  const auto table = rows(path("out"));
  ASSERT_EQ(table.size(), 201u);
  EXPECT_EQ(table.front().at("q [Pa]").substr(0, 2).empty(), false);
  EXPECT_NEAR(std::stod(table.front().at("p [Pa]")), 353.7, 1e-3) << "a thousandth of Young's modulus";
  // The default sand has 35 degrees: q/p = 6 sin(phi) / (3 - sin(phi)).
  const double sine = std::sin(35.0 * M_PI / 180.0);
  EXPECT_NEAR(std::stod(table.back().at("q/p [-]")), 6.0 * sine / (3.0 - sine), 1e-6);
  EXPECT_NEAR(std::stod(table.back().at("mobilized_friction_angle [degrees]")), 35.0, 1e-5);
  EXPECT_NEAR(std::stod(table.back().at("strain_zz [-]")), -0.1, 1e-10);
  const std::string page = bytes_of(path("out") + "/index.html");
  EXPECT_THAT(page, HasSubstr("<svg"));
  EXPECT_THAT(page, HasSubstr("volumetric strain"));
  EXPECT_THAT(page, Not(HasSubstr("src=")));
  EXPECT_THAT(page, Not(HasSubstr("href=")));
  for (const char* plot : {"ratio", "deviator", "volume", "path"})
    EXPECT_THAT(bytes_of(path("out") + "/" + plot + ".svg"), HasSubstr("</svg>")) << plot;
}

TEST_F(ElementCommand, SameCommand_SameBytes) {
  const std::string scene = tiny_scene();
  for (const char* out : {"one", "two"})
    ASSERT_EQ(
        repose({"element", scene, "--path", "simple_shear", "--steps", "50", "--out", path(out), "--quiet"})
            .code,
        0);
  for (const char* file : {"element.csv", "index.html", "path.svg"})
    EXPECT_EQ(bytes_of(path("one") + "/" + file), bytes_of(path("two") + "/" + file)) << file;
}

TEST_F(ElementCommand, FileOfSteps_IsDriven) {
  const std::string steps = write("steps.csv", "de_zz,repeat\n-1e-4,20\n1e-4,10\n");
  const Finished done = repose({"element", tiny_scene(), "--path", steps, "--out", path("out"), "--quiet"});
  EXPECT_EQ(done.code, 0) << done.err;
  EXPECT_EQ(done.out, "");
  const auto table = rows(path("out"));
  ASSERT_EQ(table.size(), 31u);
  EXPECT_NEAR(std::stod(table.back().at("strain_zz [-]")), -1e-3, 1e-12);
}

TEST_F(ElementCommand, WrongArguments_SayWhatWouldBeRight) {
  const std::string scene = tiny_scene();
  EXPECT_THAT(refusal(64, {"element", scene, "--path", "triaxal"}), HasSubstr("did you mean \"triaxial\"?"));
  EXPECT_THAT(refusal(64, {"element", scene}), HasSubstr("--path"));
  EXPECT_THAT(refusal(64, {"element", scene, "--path", "oedometric", "--material", "sant"}),
              HasSubstr("--material: no material \"sant\"; did you mean \"sand\"?"));
  EXPECT_THAT(refusal(64, {"element", scene, "--path", "triaxial", "--hold", "volume"}),
              HasSubstr("--hold: is for"));
  EXPECT_THAT(refusal(64, {"element", scene, "--path", "simple_shear", "--hold", "both"}),
              HasSubstr("'both' is not one of stress, volume"));
  EXPECT_THAT(refusal(64, {"element", scene, "--path", "oedometric", "--strain", "3", "--steps", "2"}),
              HasSubstr("--steps: steps of 1.5 are too long"));
  const std::string steps = write("steps.csv", "de_zz\n-1e-4\noops\n");
  EXPECT_THAT(refusal(64, {"element", scene, "--path", steps, "--steps", "5"}),
              HasSubstr("--steps: is what the file"));
  EXPECT_THAT(refusal(65, {"element", scene, "--path", steps}),
              HasSubstr("steps.csv:3: de_zz: found \"oops\""));
  EXPECT_THAT(refusal(65, {"element", scene, "--path", "triaxial", "--set",
                           "materials.sand.variation={\"friction\":0.1}"}),
              HasSubstr("\"materials.sand.variation\" changes sand by its place"));
  EXPECT_THAT(
      refusal(70, {"element", scene, "--path", "triaxial", "--pressure", "1e12", "--out", path("none")}),
      HasSubstr("the pressure before the path: no strain holds sigma_zz"));
}

}  // namespace
}  // namespace repose
