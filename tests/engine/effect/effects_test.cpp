// Repose tests: what holds for every effect of the list, so a new one has these tests without new code: a name
// of its own, keys that the schema knows, and nothing at all where the scene does not ask for it. What effects
// do when they are asked for: tests/bench/effect_trials_test.cpp.
#include "engine/effect/effects.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <json/json.h>

#include <set>
#include <sstream>

#include "engine/compiler/compiler.h"
#include "engine/compiler/figures.h"
#include "engine/reading/reader.h"
#include "tests/engine/effect/key_names.h"

namespace repose {
namespace {

using ::testing::IsEmpty;

Json::Value parsed_schema() {
  Json::Value schema;
  std::istringstream(scene_schema()) >> schema;
  return schema;
}

/// A scene that names nothing but what it must, without gravity.
Scene plain_scene(const std::string& precision) {
  auto scene = read_scene_text(R"json({"repose": 1, "name": "plain", "grid": {"spacing": 0.1},
    "materials": {"sand": {"type": "drucker_prager"}},
    "bodies": [{"name": "a", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]}}],
    "gravity": {"acceleration": [0, 0, 0]}})json",
                               "plain.json", ".", {{"grid.precision=" + precision}, false});
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
  return *scene;
}

template <class Passes>
void expect_core(const Passes& passes) {
  for (const auto& pass : passes) EXPECT_EQ(pass.description.reason, "") << pass.description.name;
}

/// Nothing is in the plan for the sake of a key, and nothing in the state beyond what every particle has.
template <class Real>
void expect_nothing_asked_for(const Scene& scene) {
  const auto compiled = compile_scene<Real>(scene, {});
  ASSERT_TRUE(compiled) << compiled.error().text();
  const StepPlan<Real>& plan = compiled->plan;
  EXPECT_THAT(plan.events, IsEmpty());
  EXPECT_THAT(plan.prepare, IsEmpty());
  EXPECT_THAT(plan.measures, IsEmpty());
  EXPECT_THAT(plan.speeds, IsEmpty());
  EXPECT_THAT(plan.disturbances, IsEmpty());
  EXPECT_FALSE(plan.sleep);
  expect_core(plan.sort);
  expect_core(plan.nodes);
  EXPECT_EQ(plan.nodes.size(), 1u) << "p/m";
  for (const auto& passes : plan.scatter) expect_core(passes);
  for (const auto& passes : plan.gather) {
    expect_core(passes);
    EXPECT_EQ(passes.size(), 4u) << "gather, advance, trial strain, return map";
  }
  EXPECT_EQ(compiled->state.sets.size(), 1u);
  EXPECT_THAT(compiled->state.sets[0].extra, IsEmpty());
  EXPECT_THAT(compiled->state.tallies, IsEmpty());
  EXPECT_FALSE(compiled->state.ledger.open());
  EXPECT_EQ(compiled->state.counters.unseen_motion, 0.0);
}

TEST(EveryEffect, HasANameOfItsOwn) {
  std::set<std::string> names;
  const Effects effects;
  for_each_effect(effects, [&](const auto& effect) {
    EXPECT_NE(std::string(effect.kName), "");
    EXPECT_TRUE(names.insert(effect.kName).second) << effect.kName;
  });
  EXPECT_EQ(names.size(), std::tuple_size_v<Effects>);
}

TEST(EveryEffect, ByDefault_IsOffAndSaysWhatWouldAskForIt) {
  const Effects effects;
  const SetDescription set{"a", "sand", DruckerPragerParameters{}};
  for_each_effect(effects, [&](const auto& effect) {
    EXPECT_EQ(effect.on(), std::string(effect.kName) == Gravity::kName) << effect.kName;
    EXPECT_NE(effect.why(), "") << effect.kName;
    EXPECT_THAT(effect.channels(set), IsEmpty()) << effect.kName;
    EXPECT_THAT(effect.inlets(), IsEmpty()) << effect.kName;
    EXPECT_THAT(effect.outlets(), IsEmpty()) << effect.kName;
    EXPECT_EQ(effect.particles_by(1e9, 0.1, -1), 0.0) << effect.kName;
  });
}

TEST(EveryEffect, NotAskedFor_AddsNoPassAndNoByte) {
  for (const char* precision : {"single", "double"}) {
    Scene scene = plain_scene(precision);
    scene.effects = Effects{};  // as a host would leave them
    scene.effect<Gravity>().acceleration = Vec3::Zero();
    for (const EffectStatus& effect : effect_status(scene)) {
      EXPECT_FALSE(effect.on) << effect.name;
      EXPECT_NE(effect.reason, "") << effect.name;
      EXPECT_EQ(effect.bytes_per_particle, 0u) << effect.name;
    }
    scene.grid.precision == Precision::kSingle ? expect_nothing_asked_for<float>(scene)
                                               : expect_nothing_asked_for<double>(scene);
  }
}

TEST(EveryEffect, HasKeysThatTheSchemaKnows) {
  const Json::Value schema = parsed_schema();
  Json::Value sand;
  for (const Json::Value& form : schema["properties"]["materials"]["additionalProperties"]["oneOf"]) {
    if (form["properties"]["type"]["const"] == DruckerPragerParameters::kName) sand = form["properties"];
  }
  std::set<std::string> all;
  Effects effects;
  for_each_effect(effects, [&](auto& effect) {
    KeyNames of_scene, of_sand;
    effect.declare(of_scene, {});
    effect.declare_in_cone(of_sand, "sand");
    EXPECT_FALSE(of_scene.names.empty() && of_sand.names.empty()) << effect.kName;
    for (const std::string& key : of_scene.names) {
      EXPECT_TRUE(schema["properties"].isMember(key)) << key;
      EXPECT_TRUE(all.insert(key).second) << key << " is the key of another effect";
    }
    for (const std::string& key : of_sand.names) {
      EXPECT_TRUE(sand.isMember(key)) << key;
      EXPECT_TRUE(all.insert("materials." + key).second) << key << " is the key of another effect";
    }
  });
}

}  // namespace
}  // namespace repose
