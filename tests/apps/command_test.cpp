// Repose tests: the commands that look without running: plan, check, bench, info, movie, schema.
#include <gmock/gmock.h>

#include <fstream>
#include <iterator>
#include <sstream>

#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Command = CommandTest;

TEST_F(Command, Help_NamesEveryCommand) {
  const Finished help = repose({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* name : {"run", "plan", "check", "bench", "info", "movie", "schema"}) {
    EXPECT_THAT(help.out, HasSubstr(std::string("\n  ") + name + " "));
    const Finished detail = repose({name, "--help"});
    EXPECT_EQ(detail.code, 0) << name;
    EXPECT_THAT(detail.out, HasSubstr("Usage: repose " + std::string(name)));
  }
}

TEST_F(Command, ManualPage_NamesEveryCommand) {
  std::ifstream file(REPOSE_SCENES "/../repose/repose.1");
  const std::string page((std::istreambuf_iterator<char>(file)), {});
  ASSERT_NE(page, "");
  const std::string help = repose({"--help"}).out;
  std::istringstream lines(help.substr(help.find("Subcommands:") + 12));
  std::size_t commands = 0;
  for (std::string line, name; std::getline(lines, line);) {
    if (!(std::istringstream(line) >> name)) continue;
    EXPECT_THAT(page, HasSubstr("\n.It Cm " + name + "\n"));
    ++commands;
  }
  EXPECT_GT(commands, 10u);
}

TEST_F(Command, Bench_WritesEveryFigure) {
  const std::string file = path("bench.json");
  ASSERT_EQ(repose({"bench", tiny_scene(), "--steps", "20", "--threads", "2", "--json", file}).code, 0);
  const Json::Value json = read_json(file);
  EXPECT_EQ(json["particles"], 1000);
  EXPECT_EQ(json["steps"], 20);
  EXPECT_EQ(json["threads"], 2);
  EXPECT_NE(json["target"].asString(), "");
  double phases = 0.0;
  for (const char* phase : {"sort", "scatter", "nodes", "acceptance", "gather"}) {
    ASSERT_TRUE(json["phases"][phase].isDouble()) << phase;
    phases += json["phases"][phase].asDouble();
  }
  EXPECT_GT(phases, 0.0);
  EXPECT_LE(phases, json["ns_per_particle_step"].asDouble());
  EXPECT_GE(json["bytes_per_particle"].asDouble(), 21 * 4 + 4) << "x, v, C, strain and id";
  EXPECT_GT(json["grid_bytes"].asInt64(), 0);
  EXPECT_NEAR(json["grid_bytes_per_block"].asDouble() * json["blocks"].asDouble(),
              json["grid_bytes"].asDouble(), 1.0);
  EXPECT_GT(json["scratch_bytes"].asInt64(), 2 * 2 * 8 * 8 * 8 * 4 * 4) << "two arenas a thread";
  EXPECT_GT(json["peak_rss_bytes"].asInt64(), json["grid_bytes"].asInt64());
  EXPECT_EQ(json["hash"].asString().size(), 16u);
}

TEST_F(Command, BenchTwice_EqualHashWhateverTheThreads) {
  ASSERT_EQ(repose({"bench", tiny_scene(), "--steps", "30", "--threads", "1", "--json", path("a.json")}).code,
            0);
  ASSERT_EQ(repose({"bench", tiny_scene(), "--steps", "30", "--threads", "3", "--json", path("b.json")}).code,
            0);
  EXPECT_EQ(read_json(path("a.json"))["hash"], read_json(path("b.json"))["hash"]);
}

TEST_F(Command, Plan_TellsEffectsAndPasses) {
  const Finished plan = repose({"plan", tiny_scene()});
  ASSERT_EQ(plan.code, 0) << plan.err;
  EXPECT_THAT(plan.out, ::testing::ContainsRegex("gravity +on .*gravity.acceleration is not zero"));
  EXPECT_THAT(plan.out, ::testing::ContainsRegex("collider +on .*1 in 'colliders'"));
  EXPECT_THAT(plan.out, ::testing::ContainsRegex("volume_correction +off .*no key 'volume_correction'"));
  for (const char* pass : {"nodes near solids", "stress", "scatter", "node velocity", "gravity", "collide",
                           "gather", "advance", "trial strain", "return map"}) {
    EXPECT_THAT(plan.out, HasSubstr(std::string("\n    ") + pass)) << plan.out;
  }
  EXPECT_THAT(plan.out, HasSubstr("particles           1000\n"));
  EXPECT_FALSE(std::filesystem::exists(path("out"))) << "a plan writes nothing";
}

/// "at most about 12 % of a heap's outline", of a plan.
double error_planned(const std::string& plan) {
  const std::string before = "at most about ";
  const std::size_t at = plan.find(before);
  return at == std::string::npos ? 0.0 : std::stod(plan.substr(at + before.size()));
}

TEST_F(Command, Plan_TellsTheErrorOfTheGrid) {
  const Finished coarse = repose({"plan", tiny_scene()}),
                 fine = repose({"plan", tiny_scene(), "--quality", "reference"});
  EXPECT_THAT(coarse.out, HasSubstr("has 5 cells along an edge")) << "1000 particles, 8 a cell";
  EXPECT_THAT(fine.out, HasSubstr("has 10 cells along an edge"));
  EXPECT_GT(error_planned(fine.out), 0.0);
  EXPECT_GE(error_planned(coarse.out), 1.6 * error_planned(fine.out)) << "half the cells";
  const Finished rubber = repose({"plan", tiny_scene(), "--set", "materials.sand={\"type\": \"elastic\"}"});
  ASSERT_EQ(rubber.code, 0) << rubber.err;
  EXPECT_EQ(error_planned(rubber.out), 0.0) << "rubber makes no heaps";
}

TEST_F(Command, Plan_TellsWhatMovingMeshesTake) {
  for (int file = 1; file <= 4; ++file) {
    const double x = 0.01 * file;
    std::ofstream(path("wedge.000" + std::to_string(file) + ".obj"))
        << "v " << x << " 0 0\nv " << x + 0.3 << " 0 0\nv " << x << " 0 0.3\nv " << x
        << " 0.3 0\nf 1 2 3\nf 1 4 2\nf 2 4 3\nf 3 4 1\n";
  }
  const std::string wedge = R"({"name": "wedge", "shape": {"type": "mesh", "file": "wedge.####.obj"},
                               "frames": {"count": 4, "rate": 50}})";
  const std::string scene = tiny_scene();
  const Finished moving = repose({"plan", scene, "--set", "colliders=[" + wedge + "]"});
  ASSERT_EQ(moving.code, 0) << moving.err;
  EXPECT_THAT(moving.out, HasSubstr("for the level sets of moving meshes: 3 files, "))
      << "of 0.06 s, at 50 a second";
  EXPECT_THAT(repose({"plan", scene}).out, Not(HasSubstr("level sets")));
}

TEST_F(Command, PlanWithoutColliders_HasNoPassForThem) {
  const Finished plan = repose({"plan", tiny_scene(), "--set", "colliders=[]"});
  EXPECT_THAT(plan.out, HasSubstr("no entry in 'colliders'"));
  EXPECT_THAT(plan.out, Not(HasSubstr("collide, friction")));
}

TEST_F(Command, Check_CountsParticles) {
  const Finished check = repose({"check", tiny_scene()});
  EXPECT_EQ(check.code, 0);
  EXPECT_EQ(check.out, path("tiny.json") + ": good; 1000 particles\n");
}

TEST_F(Command, CheckOfAnAngleThatCannotYield_Warns) {
  // The cone through triaxial compression holds plane strain for ever from sin phi = 3/(1 + 2 sqrt 3) on, 42.2
  // degrees.
  const Finished steep = repose({"check", tiny_scene(), "--set", "materials.sand.friction_angle=43"});
  EXPECT_EQ(steep.code, 0);
  EXPECT_THAT(steep.out, HasSubstr("warning: materials.sand"));
  EXPECT_THAT(steep.out, HasSubstr("plane strain"));
  const Finished flat = repose({"check", tiny_scene(), "--set", "materials.sand.friction_angle=42"});
  EXPECT_THAT(flat.out, Not(HasSubstr("warning")));
}

TEST_F(Command, CheckOfABodyInsideASolid_WarnsOfEachBody) {
  // The box reaches four cells into the plane.
  const Finished sunk = repose({"check", tiny_scene(), "--set", "bodies.box.shape.lower=[0,-0.08,0]"});
  EXPECT_EQ(sunk.code, 0);
  EXPECT_THAT(sunk.out,
              ::testing::ContainsRegex("warning: bodies.box: [0-9]+ of 2000 particles start inside solids, "
                                       "the deepest 4 cells \\(0.08 m\\) inside "
                                       "colliders.ground"));
  const std::size_t at = sunk.out.find("bodies.box: ") + 12;
  EXPECT_NEAR(std::atof(sunk.out.c_str() + at), 700.0, 20.0)
      << "7 of 20 half cells are deeper than half a cell";
  const Finished touching = repose({"check", tiny_scene(), "--set", "bodies.box.shape.lower=[0,-0.009,0]"});
  EXPECT_THAT(touching.out, Not(HasSubstr("warning"))) << "less than half a cell is a matter of sampling";
}

TEST_F(Command, CheckOfEveryScene_Good) {
  for (const auto& entry : std::filesystem::directory_iterator(REPOSE_SCENES)) {
    if (entry.path().extension() != ".json") continue;
    const Finished check = repose({"check", entry.path().string()});
    EXPECT_EQ(check.code, 0) << check.err;
    EXPECT_THAT(check.out, Not(HasSubstr("warning"))) << check.out;
  }
}

TEST_F(Command, Info_TellsOfRunPointsAndCheckpoint) {
  const std::string out = path("out");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", out, "--frames", "2"}).code, 0);
  const Finished info =
      repose({"info", out, out + "/tiny.points.0002.vdb", out + "/tiny.state.0002.checkpoint"});
  EXPECT_EQ(info.code, 0) << info.err;
  EXPECT_THAT(info.out, HasSubstr("run of tiny by Repose"));
  EXPECT_THAT(info.out, HasSubstr("frames  2, "));
  EXPECT_THAT(info.out, HasSubstr("hash " + hash_of_last_frame(out)));
  EXPECT_THAT(info.out, HasSubstr("no particle was ever inside a solid"));
  EXPECT_THAT(info.out, HasSubstr("1000 points, spacing 0.02 m"));
  EXPECT_THAT(info.out, HasSubstr("attributes P v id pscale"));
  EXPECT_THAT(info.out, HasSubstr("checkpoint after frame 2"));
}

TEST_F(Command, InfoOfPoints_IsTheSameForEveryFormat) {
  const std::string out = path("out");
  ASSERT_EQ(
      repose({"run", tiny_scene(R"(, "output": {"ply": true, "vtp": true})"), "--out", out, "--frames", "1"})
          .code,
      0);
  const auto lines = [&](const std::string& ending) {
    const Finished info = repose({"info", out + "/tiny.points.0001." + ending});
    EXPECT_EQ(info.code, 0) << info.err;
    EXPECT_THAT(info.out, HasSubstr(": 1000 points"));
    return info.out.substr(info.out.find("  fastest"));
  };
  EXPECT_THAT(lines("vtp"), HasSubstr("attributes P v id pscale"));
  EXPECT_EQ(lines("vtp"), lines("ply"));
  EXPECT_EQ(lines("vtp"), lines("vdb"));
}

TEST_F(Command, InfoOfAllInAFolder_TellsWhatItCan) {
  const std::string out = path("out");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", out, "--frames", "1"}).code, 0);
  const Finished info = repose({"info", out + "/run.json", out + "/scene.json", out + "/tiny.points.0001.vdb"});
  EXPECT_EQ(info.code, 64) << "of the scene, which is no file of particles";
  EXPECT_THAT(info.err, HasSubstr(out + "/scene.json: is not what info can read"));
  EXPECT_THAT(info.out, HasSubstr("run of tiny by Repose"));
  EXPECT_THAT(info.out, HasSubstr("1000 points"));
}

TEST_F(Command, InfoOfARunIntoASolid_TellsTheDeepest) {
  // The box starts with its lower half inside the ground.
  const std::string out = path("out");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", out, "--frames", "1", "--set",
                    "bodies.box.shape.lower=[0,-0.08,0]", "--set", "gravity={\"acceleration\": [0, 0, 0]}"})
                .code,
            0);
  const Json::Value deepest = read_json(out + "/run.json")["frames"][0]["deepest"];
  EXPECT_EQ(deepest["solid"], "ground");
  EXPECT_GT(deepest["cells"].asDouble(), 3.5);
  EXPECT_LT(deepest["cells"].asDouble(), 4.5);
  EXPECT_THAT(repose({"info", out}).out, HasSubstr("inside 'ground', at frame 1"));
}

TEST_F(Command, Movie_WritesFilmAndPictures) {
  const std::string out = path("out");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", out, "--frames", "3"}).code, 0);
  const Finished movie =
      repose({"movie", out, "--width", "96", "--height", "64", "--pictures", "--first", "2", "--last", "3"});
  ASSERT_EQ(movie.code, 0) << movie.err;
  EXPECT_EQ(movie.out, out + "/tiny.mp4\n");
  const Finished probe =
      run_program({"ffprobe", "-v", "error", "-count_frames", "-select_streams", "v", "-show_entries",
                   "stream=width,height,nb_read_frames", "-of", "csv=p=0", out + "/tiny.mp4"});
  EXPECT_EQ(probe.out, "96,64,2\n") << probe.err;
  EXPECT_FALSE(std::filesystem::exists(out + "/tiny.points.0001.png"));
  EXPECT_TRUE(std::filesystem::exists(out + "/tiny.points.0002.png"));
  EXPECT_TRUE(std::filesystem::exists(out + "/tiny.points.0003.png"));
}

TEST_F(Command, MovieOfTheFramesThatWereWritten_CountsFramesOfTheRun) {
  const std::string out = path("out");
  ASSERT_EQ(repose({"run", tiny_scene(), "--out", out, "--frames", "2-3"}).code, 0);
  const Finished movie =
      repose({"movie", out, "--width", "96", "--height", "64", "--pictures", "--first", "3"});
  ASSERT_EQ(movie.code, 0) << movie.err;
  EXPECT_FALSE(std::filesystem::exists(out + "/tiny.points.0002.png"));
  EXPECT_TRUE(std::filesystem::exists(out + "/tiny.points.0003.png"));
}

TEST_F(Command, Schema_IsJson) {
  const Finished schema = repose({"schema"});
  EXPECT_EQ(schema.code, 0);
  write("schema.json", schema.out);
  EXPECT_EQ(read_json(path("schema.json"))["type"], "object");
  EXPECT_THAT(repose({"schema", "--reference"}).out, HasSubstr("\n## `grid`\n"));
}

}  // namespace
}  // namespace repose
