// Repose tests: scene_bench as its users run it: its tables have the figures of `repose bench`, one row per
// size and number of threads, and rows that must agree do.
#include <gmock/gmock.h>
#include <json/json.h>

#include <fstream>
#include <set>
#include <sstream>

#include "tests/apps/command_rig.h"

namespace repose {
namespace {

using ::testing::HasSubstr;

class SceneBench : public CommandTest {
 protected:
  Finished scene_bench(std::vector<std::string> words) const {
    words.insert(words.begin(), REPOSE_SCENE_BENCH);
    return run_program(std::move(words));
  }
};

std::vector<std::vector<std::string>> read_csv(const std::string& file) {
  std::vector<std::vector<std::string>> rows;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) {
    std::istringstream cells(line);
    rows.emplace_back();
    for (std::string cell; std::getline(cells, cell, ',');) rows.back().push_back(cell);
  }
  return rows;
}

/// Keys of figures, nested ones under their path.
std::set<std::string> keys(const Json::Value& json, const std::string& prefix = "") {
  std::set<std::string> all;
  for (const std::string& key : json.getMemberNames()) {
    if (json[key].isObject()) {
      all.merge(keys(json[key], prefix + key + "."));
    } else {
      all.insert(prefix + key);
    }
  }
  return all;
}

TEST_F(SceneBench, TinySizes_TableOfTheFiguresOfBench) {
  const std::string scene = tiny_scene();
  ASSERT_EQ(repose({"bench", scene, "--steps", "5", "--threads", "1", "--json", path("bench.json")}).code, 0);
  std::set<std::string> columns = keys(read_json(path("bench.json")));
  columns.merge(std::set<std::string>{"scene", "spacing", "asked_particles", "repeats"});

  const Finished bench = scene_bench({"--scenes", scene, "--sizes", "0,4000", "--threads", "1,2", "--steps",
                                      "5", "--repeats", "2", "--csv", path("a.csv"), "--json", path("a.json")});
  ASSERT_EQ(bench.code, 0) << bench.err;
  const auto csv = read_csv(path("a.csv"));
  ASSERT_EQ(csv.size(), 1u + 2u * 2u);
  EXPECT_EQ(std::set<std::string>(csv[0].begin(), csv[0].end()), columns);
  for (const auto& row : csv) EXPECT_EQ(row.size(), csv[0].size());

  const Json::Value rows = read_json(path("a.json"));
  ASSERT_EQ(rows.size(), 4u);
  for (const Json::Value& row : rows) EXPECT_EQ(keys(row), columns);
  EXPECT_EQ(rows[0]["hash"], read_json(path("bench.json"))["hash"]);
  for (const Json::ArrayIndex size : {0u, 2u}) {
    EXPECT_EQ(rows[size]["threads"], 1);
    EXPECT_EQ(rows[size + 1]["threads"], 2);
    EXPECT_EQ(rows[size]["hash"], rows[size + 1]["hash"]) << "threads change no bit";
  }
  EXPECT_NE(rows[0]["hash"], rows[2]["hash"]);
  EXPECT_EQ(rows[0]["particles"], 1000);
  EXPECT_NEAR(rows[2]["particles"].asDouble(), 4000.0, 800.0);
}

TEST_F(SceneBench, SizeBeyondMemory_LeftOutAndSaid) {
  const Finished bench = scene_bench({"--scenes", tiny_scene(), "--sizes", "0,3e9", "--threads", "1", "--steps",
                                      "1", "--repeats", "1", "--json", path("a.json")});
  ASSERT_EQ(bench.code, 0) << bench.err;
  EXPECT_EQ(read_json(path("a.json")).size(), 1u);
  EXPECT_THAT(bench.err, HasSubstr("3e+09 particles left out"));
}

TEST_F(SceneBench, WrongWordsOrScene_Refused) {
  EXPECT_EQ(scene_bench({"--repeats", "0"}).code, 64);
  EXPECT_EQ(scene_bench({"--scenes", path("none.json")}).code, 66);
  EXPECT_EQ(scene_bench({"--scenes", tiny_scene(), "--csv", path("none/a.csv")}).code, 73);
}

}  // namespace
}  // namespace repose
