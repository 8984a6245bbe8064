// Repose tests: the step as a list: a scene pays for what it names and for nothing else, and a list in which a
// pass reads what nobody provides is refused.
#include "engine/plan/step_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "engine/scene/compiler.h"
#include "engine/scene/figures.h"
#include "engine/scene/reader.h"

namespace repose {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ParticlePass<float> particle_pass(const std::string& name, std::vector<std::string> reads,
                                  std::vector<std::string> writes) {
  return {{name, "", std::move(reads), std::move(writes)}, {}};
}

NodePass<float> node_pass(const std::string& name, std::vector<std::string> reads,
                          std::vector<std::string> writes) {
  return {{name, "", std::move(reads), std::move(writes)}, {}};
}

/// The least plan that holds together.
StepPlan<float> sound_plan() {
  StepPlan<float> plan;
  plan.scatter = {{particle_pass("stress", {"strain"}, {"tau"}),
                   particle_pass("scatter", {"position", "tau"}, {"node momentum"})}};
  plan.nodes = {node_pass("update", {"node momentum"}, {"node velocity"})};
  plan.gather = {{particle_pass("gather", {"node velocity"}, {"velocity"})}};
  return plan;
}

std::string refusal(const StepPlan<float>& plan) {
  const auto valid = plan.validate(State<float>());
  return valid ? "" : valid.error().text();
}

TEST(StepPlan, Sound_IsAccepted) {
  EXPECT_EQ(refusal(sound_plan()), "");
}

TEST(StepPlan, ReadOfWhatNobodyProvides_NamesStageAndQuantity) {
  StepPlan<float> plan = sound_plan();
  plan.nodes.push_back(node_pass("melt", {"temperature"}, {}));
  EXPECT_EQ(refusal(plan), "stage 'melt' reads 'temperature', which no earlier stage provides");
}

TEST(StepPlan, ReadBeforeTheWrite_IsRefused) {
  StepPlan<float> plan = sound_plan();
  std::swap(plan.scatter[0][0], plan.scatter[0][1]);
  EXPECT_EQ(refusal(plan), "stage 'scatter' reads 'tau', which no earlier stage provides");
}

TEST(StepPlan, NodesReadOfTheGather_IsRefused) {
  StepPlan<float> plan = sound_plan();
  plan.gather[0].push_back(particle_pass("measure", {"velocity"}, {"speed"}));
  plan.nodes.push_back(node_pass("limit", {"speed"}, {}));
  EXPECT_EQ(refusal(plan), "stage 'limit' reads 'speed', which no earlier stage provides");
}

TEST(StepPlan, SetsDoNotProvideForEachOther) {
  StepPlan<float> plan = sound_plan();
  plan.gather = {{particle_pass("a", {"node velocity"}, {"trace"})}, {particle_pass("b", {"trace"}, {})}};
  EXPECT_EQ(refusal(plan), "stage 'b' reads 'trace', which no earlier stage provides");
}

TEST(StepPlan, GatherReadsScratchOfTheScatter_IsRefused) {
  StepPlan<float> plan = sound_plan();
  plan.gather[0].push_back(particle_pass("late", {"tau"}, {}));
  EXPECT_EQ(refusal(plan), "stage 'late' reads 'tau', which no earlier stage provides");
}

TEST(StepPlan, OrderPasses_ProvideForAll) {
  StepPlan<float> plan = sound_plan();
  plan.order.push_back({{"tables", "", {"topology"}, {"contacts"}}, {}});
  plan.nodes.push_back(node_pass("collide", {"contacts"}, {}));
  plan.gather[0].push_back(particle_pass("push", {"contacts"}, {}));
  EXPECT_EQ(refusal(plan), "");
}

/// What a scene compiles to, as lists of names.
struct Names {
  std::vector<std::string> events, order, prepare, nodes, measures;
  std::vector<std::vector<std::string>> scatter, gather;
  std::vector<std::vector<std::string>> channels;  ///< per set, beyond those that every particle has
  std::size_t speeds = 0, tallies = 0, bytes = 0;
};

template <class Passes>
std::vector<std::string> names_of(const Passes& passes) {
  std::vector<std::string> names;
  for (const auto& pass : passes) names.push_back(pass.description.name);
  return names;
}

Names compile(const std::vector<std::string>& overrides) {
  const auto scene = read_scene_text(R"json({"repose": 1, "name": "plan", "grid": {"spacing": 0.1},
    "materials": {"sand": {"type": "drucker_prager"}, "rubber": {"type": "elastic"}},
    "bodies": [{"name": "a", "material": "sand",
                "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]}}],
    "colliders": [], "gravity": {"acceleration": [0, 0, 0]}})json",
                                     "plan.json", ".", {overrides, false});
  EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
  const auto compiled = compile_scene<float>(*scene, {});
  EXPECT_TRUE(compiled) << (compiled ? "" : compiled.error().text());
  Names names;
  names.events = names_of(compiled->plan.events);
  names.order = names_of(compiled->plan.order);
  names.prepare = names_of(compiled->plan.prepare);
  names.nodes = names_of(compiled->plan.nodes);
  for (const std::string& name : names_of(compiled->plan.holds)) names.nodes.push_back(name);
  names.measures = names_of(compiled->plan.measures);
  names.speeds = compiled->plan.speeds.size();
  names.tallies = compiled->state.tallies.size();
  names.bytes = bytes_per_particle(*scene);
  for (const auto& passes : compiled->plan.scatter) names.scatter.push_back(names_of(passes));
  for (const auto& passes : compiled->plan.gather) names.gather.push_back(names_of(passes));
  for (const auto& set : compiled->state.sets) {
    auto& channels = names.channels.emplace_back();
    for (const auto& channel : set.extra) channels.push_back(channel.name);
  }
  return names;
}

constexpr const char* kTwoBodies = R"json(bodies=[
  {"name": "a", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 1]}},
  {"name": "b", "material": "rubber", "shape": {"type": "box", "lower": [2, 0, 0], "upper": [3, 1, 1]}}])json";

TEST(CompiledPlan, SceneThatNamesNothing_IsTheCore) {
  const Names names = compile({});
  EXPECT_THAT(names.events, IsEmpty());
  EXPECT_THAT(names.order, IsEmpty());
  EXPECT_THAT(names.scatter, ElementsAre(ElementsAre("stress", "scatter")));
  EXPECT_THAT(names.nodes, ElementsAre("node velocity"));
  EXPECT_THAT(names.gather, ElementsAre(ElementsAre("gather", "advance", "trial strain", "return map")));
  EXPECT_THAT(names.channels, ElementsAre(IsEmpty()));
  EXPECT_THAT(names.prepare, IsEmpty());
  EXPECT_THAT(names.measures, IsEmpty());
  EXPECT_EQ(names.speeds + names.tallies, 0u);
}

TEST(CompiledPlan, Gravity_IsOneNodePass) {
  EXPECT_THAT(compile({"gravity.acceleration=[0,-9.81,0]"}).nodes, ElementsAre("node velocity", "gravity"));
}

TEST(CompiledPlan, Collider_IsOneOrderPassAndOneNodePass) {
  const Names names = compile({R"json(colliders=[{"name": "floor", "shape": {"type": "plane"}}])json"});
  EXPECT_THAT(names.order, ElementsAre("nodes near solids"));
  EXPECT_THAT(names.nodes, ElementsAre("node velocity", "collide, friction"));
}

constexpr const char* kFloor = R"json(colliders=[{"name": "floor", "shape": {"type": "plane"}}])json";

TEST(CompiledPlan, ColliderAtRest_PreparesNothingAndBoundsNoStep) {
  const Names names = compile({kFloor});
  EXPECT_THAT(names.prepare, IsEmpty());
  EXPECT_EQ(names.speeds, 0u);
}

TEST(CompiledPlan, ColliderThatMoves_PreparesPosesAndBoundsTheStep) {
  const Names names = compile({R"json(colliders=[
    {"name": "floor", "shape": {"type": "plane"}, "motion": {"keys": [{"time": 0}]}}])json"});
  EXPECT_THAT(names.prepare, ElementsAre("poses of solids"));
  EXPECT_THAT(names.nodes, ElementsAre("node velocity", "collide, friction"));
  EXPECT_EQ(names.speeds, 1u);
}

TEST(CompiledPlan, Pin_IsOneOrderPassAndOneNodePassBeforeSolids) {
  const Names names =
      compile({kFloor, R"json(pins=[{"name": "a", "shape": {"type": "sphere", "radius": 1}}])json"});
  EXPECT_THAT(names.order, ElementsAre("pinned nodes", "nodes near solids"));
  EXPECT_THAT(names.nodes, ElementsAre("node velocity", "pins", "collide, friction"));
}

TEST(CompiledPlan, ProbeOfFlow_CountsAroundTheMotion) {
  const Names without = compile({}), with = compile({R"json(probes=[{"name": "door", "type": "flow"}])json"});
  EXPECT_THAT(with.order, ElementsAre("blocks near planes of flow"));
  EXPECT_THAT(with.gather, ElementsAre(ElementsAre("gather", "sides of planes", "advance", "count flow",
                                                   "trial strain", "return map")));
  EXPECT_THAT(with.measures, ElementsAre("probe door"));
  EXPECT_EQ(with.nodes, without.nodes);
  EXPECT_EQ(with.bytes, without.bytes);
  EXPECT_EQ(with.tallies, 4u);
}

TEST(CompiledPlan, OtherProbes_AreNoPassOfTheStep) {
  const Names without = compile({kFloor}),
              with = compile({kFloor, R"json(probes=[{"name": "e", "type": "energy"},
    {"name": "f", "type": "force", "collider": "floor"},
    {"name": "s", "type": "surface", "from": [0, 0, 0], "to": [1, 0, 0]}])json"});
  EXPECT_THAT(with.measures, ElementsAre("probe e", "probe f", "probe s"));
  EXPECT_EQ(with.order, without.order);
  EXPECT_EQ(with.nodes, without.nodes);
  EXPECT_EQ(with.gather, without.gather);
}

TEST(CompiledPlan, CollideComesAfterGravity) {
  const Names names = compile({R"json(colliders=[{"name": "floor", "shape": {"type": "plane"}}])json",
                               "gravity.acceleration=[0,-9.81,0]"});
  EXPECT_THAT(names.nodes, ElementsAre("node velocity", "gravity", "collide, friction"));
}

TEST(CompiledPlan, VolumeCorrection_IsOneChannelAndTwoPasses) {
  const Names without = compile({}), with = compile({"volume_correction={}"});
  EXPECT_THAT(with.channels, ElementsAre(ElementsAre("volume_gained")));
  EXPECT_THAT(with.gather,
              ElementsAre(ElementsAre("gather", "advance", "trial strain", "volume correction, before",
                                      "return map", "volume correction, after")));
  EXPECT_EQ(with.bytes, without.bytes + sizeof(float));
  EXPECT_EQ(with.nodes, without.nodes);
}

constexpr const char* kSpout = R"json(emitters=[
  {"name": "spout", "material": "sand", "type": "disc", "center": [0, 2, 0], "radius": 0.3, "speed": 1}])json";

TEST(CompiledPlan, EmitterAndSink_AreOneEventEachAndNoBytes) {
  const Names without = compile({});
  const Names sink = compile({R"json(sinks=[{"name": "drain", "shape": {"type": "plane"}}])json"});
  EXPECT_THAT(sink.events, ElementsAre("sinks"));
  EXPECT_EQ(sink.bytes, without.bytes);
  EXPECT_EQ(sink.nodes, without.nodes);
  EXPECT_EQ(sink.gather, without.gather);
  const Names both = compile({kSpout, R"json(sinks=[{"name": "drain", "shape": {"type": "plane"}}])json"});
  EXPECT_THAT(both.events, ElementsAre("emit", "sinks"));
  EXPECT_EQ(both.bytes, without.bytes);
  EXPECT_EQ(both.order, without.order);
  ASSERT_EQ(both.gather.size(), 2u) << "an emitter's particles are a set";
  EXPECT_EQ(both.gather[1], without.gather[0]);
  EXPECT_EQ(both.channels, (std::vector<std::vector<std::string>>{{}, {}}));
}

TEST(CompiledPlan, SetsOfEmitters_HaveTheChannelsOfTheirMaterial) {
  const Names names = compile({kSpout, "volume_correction={}"});
  EXPECT_THAT(names.channels, ElementsAre(ElementsAre("volume_gained"), ElementsAre("volume_gained")));
}

TEST(CompiledPlan, Elastic_HasNoReturnMapAndNoVolumeToCorrect) {
  const Names names = compile({kTwoBodies, "volume_correction={}"});
  ASSERT_EQ(names.gather.size(), 2u);
  EXPECT_THAT(names.gather[1], ElementsAre("gather", "advance", "trial strain"));
  EXPECT_THAT(names.channels, ElementsAre(ElementsAre("volume_gained"), IsEmpty()));
}

TEST(CompiledPlan, EffectStatus_AgreesWithTheScene) {
  const auto scene = read_scene(REPOSE_SCENES "/hourglass.json");
  ASSERT_TRUE(scene);
  for (const EffectStatus& effect : effect_status(*scene)) {
    const std::set<std::string> asked{"gravity", "collider", "hardening", "volume_correction"};
    EXPECT_EQ(effect.on, asked.contains(effect.name)) << effect.name;
    EXPECT_NE(effect.reason, "") << effect.name;
  }
}

}  // namespace
}  // namespace repose
