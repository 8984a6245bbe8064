// Repose tests: the step as a list: a scene pays for what it names and for nothing else, a list in which a pass
// reads what nobody provides is found out, and a pass gets what it has declared.
#include "engine/plan/step_plan.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "engine/compiler/compiler.h"
#include "engine/compiler/figures.h"
#include "engine/reading/reader.h"

namespace repose {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr Handle<"temperature", Place::kScratch> kTemperature;
constexpr Handle<"salt", Place::kExtra> kSalt;
constexpr Handle<"map of wells", Place::kFact> kWells;
constexpr auto kNothing = [](const auto&, auto&&...) {};

/// The least plan that holds together, of one set.
struct Sound {
  Sound() {
    state.sets.resize(1);
    state.sets[0].name = "sand";
    plan.scatter.resize(1);
    plan.gather.resize(1);
    scatter().add({"stress"}, reads(kHenckyStrain), writes(kKirchhoffStress), kNothing);
    scatter().add({"scatter"}, reads(kPosition, kKirchhoffStress), writes(kNodeMomentum), kNothing);
    add_node_pass("update", reads(kNodeMomentum), writes(kNodeVelocity));
    gather().add({"gather"}, reads(kNodeVelocity), writes(kParticleVelocity, kGradient), kNothing);
    gather().add({"trial"}, reads(kHenckyStrain, kGradient), writes(kTrialStrain), kNothing);
    gather().add({"return"}, reads(kTrialStrain), writes(kHenckyStrain), kNothing);
  }
  SetPasses<float> scatter() { return plan.scatter_of(state, 0); }
  SetPasses<float> gather(std::size_t k = 0) { return plan.gather_of(state, k); }
  template <class Read, class Write>
  void add_node_pass(const char* name, Read read, Write write) {
    plan.nodes.push_back(plan.passes().over_nodes({name}, read, write, kNothing));
  }
  std::string fault() const { return plan.fault(state); }

  State<float> state;
  StepPlan<float> plan;
};

TEST(StepPlan, Sound_HasNoFault) {
  EXPECT_EQ(Sound().fault(), "");
}

TEST(StepPlan, ReadOfWhatNobodyProvides_NamesPassAndHandle) {
  Sound sound;
  sound.gather().add({"melt"}, reads(kTemperature), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "pass 'melt' reads 'temperature', which no earlier pass provides");
}

TEST(StepPlan, ReadBeforeTheWrite_IsAFault) {
  Sound sound;
  std::swap(sound.plan.scatter[0][0], sound.plan.scatter[0][1]);
  EXPECT_EQ(sound.fault(), "pass 'scatter' reads 'stress', which no earlier pass provides");
}

TEST(StepPlan, NodesReadOfTheGather_IsAFault) {
  Sound sound;
  sound.gather().add({"dig"}, reads(), writes(kWells), kNothing);
  sound.add_node_pass("drain", reads(kWells), writes());
  EXPECT_EQ(sound.fault(), "pass 'drain' reads 'map of wells', which no earlier pass provides");
}

// Momentum and velocity of the nodes are one memory at two times; so are trial strain and strain.
TEST(StepPlan, WhatWasOverwritten_IsKnownNoMore) {
  Sound nodes;
  nodes.add_node_pass("late", reads(kNodeMomentum), writes());
  EXPECT_EQ(nodes.fault(), "pass 'late' reads 'node momentum', which no earlier pass provides");
  Sound strain;
  strain.gather().add({"late"}, reads(kTrialStrain), writes(), kNothing);
  EXPECT_EQ(strain.fault(), "pass 'late' reads 'trial strain', which no earlier pass provides");
}

TEST(StepPlan, StepThatLeavesATrialStrain_IsAFault) {
  Sound sound;
  sound.plan.gather[0].pop_back();
  EXPECT_EQ(sound.fault(), "a step of 'sand' leaves no 'strain'");
}

TEST(StepPlan, SetsDoNotProvideForEachOther) {
  Sound sound;
  sound.state.sets.resize(2);
  sound.plan.gather.resize(2);
  sound.gather().add({"a"}, reads(), writes(kTemperature), kNothing);
  sound.gather(1).add({"b"}, reads(kTemperature), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "pass 'b' reads 'temperature', which no earlier pass provides");
}

TEST(StepPlan, GatherReadsScratchOfTheScatter_IsAFault) {
  Sound sound;
  sound.gather().add({"late"}, reads(kKirchhoffStress), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "pass 'late' reads 'stress', which no earlier pass provides");
}

TEST(StepPlan, ChannelOfTheSet_IsThereFromTheStart) {
  Sound sound;
  sound.gather().add({"dissolve"}, reads(kSalt), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "pass 'dissolve' reads 'salt', which no earlier pass provides");
  sound.state.sets[0].extra.push_back({"salt", {}});
  EXPECT_EQ(sound.fault(), "");
}

TEST(StepPlan, OrderPasses_ProvideForAll) {
  Sound sound;
  sound.plan.sort.push_back(
      sound.plan.passes().after_sort({"wells"}, reads(kTopology), writes(kWells), kNothing));
  sound.add_node_pass("drain", reads(kWells), writes());
  sound.gather().add({"wet"}, reads(kWells), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "");
}

TEST(StepPlan, HandleThatIsNotDeclared_NeedsNoProvider) {
  Sound sound;
  sound.gather().add({"warm"}, reads(when(false, kTemperature)), writes(), kNothing);
  EXPECT_EQ(sound.fault(), "");
  EXPECT_THAT(sound.plan.gather[0].back().description.reads, IsEmpty());
}

TEST(StepPlan, Scratch_IsWhatItsHandlesAskFor) {
  StepPlan<float> plan;
  State<float> state;
  state.sets.resize(1);
  plan.gather.resize(1);
  const auto size_with = [&](auto handle) {
    plan.gather_of(state, 0).add({"any"}, reads(), writes(handle), kNothing);
    return plan.scratch.size();
  };
  EXPECT_EQ(size_with(kParticleVelocity), 0u) << "a channel";
  EXPECT_EQ(size_with(kTemperature), kChunk);
  EXPECT_EQ(size_with(kTemperature), kChunk) << "once";
  EXPECT_EQ(size_with(kKirchhoffStress), 7 * kChunk);
  EXPECT_GE(size_with(kNodeMomentum), 7 * kChunk + kArenaValues);
}

/// Runs a pass on a chunk of one particle.
template <class Add>
void run_on_one(State<float>& state, Add add) {
  state.sets.resize(1);
  ParticleSet<float>& set = state.sets[0];
  set.extra.push_back({"salt", {}});
  set.allocate(1);
  StepPlan<float> plan;
  plan.gather.resize(1);
  add(plan.gather_of(state, 0));
  Scratch<float> scratch(plan.scratch);
  Chunk<float> chunk{set, 0, set.span(0, 1), scratch, 0.5f, 0.1, 2.0, 0, Vec3(0, 0, 0)};
  for (const auto& pass : plan.gather[0]) pass.run(chunk);
}

TEST(Access, WhatOnePassWrites_TheNextReads) {
  State<float> state;
  run_on_one(state, [](SetPasses<float> passes) {
    passes.add({"heat"}, reads(kPosition), writes(kTemperature), [](const auto& at) {
      EXPECT_NE(at.read(kPosition)[2], nullptr);
      *at.write(kTemperature) = 300.0f;
    });
    passes.add({"dissolve"}, reads(kTemperature), writes(kSalt, kHenckyStrain), [](const auto& at) {
      *at.write(kSalt) = *at.read(kTemperature) * at.dt();
      at.write(kHenckyStrain)[5][0] = 7.0f;
    });
  });
  EXPECT_EQ(state.sets[0].extra[0].values[0], 150.0f);
  EXPECT_EQ(state.sets[0].strain[5][0], 7.0f);
}

TEST(Access, WhatIsNotDeclared_IsNull) {
  State<float> state;
  run_on_one(state, [](SetPasses<float> passes) {
    passes.add({"maybe"}, reads(when(false, kTemperature)), writes(when(false, kHenckyStrain)),
               [](const auto& at) {
                 EXPECT_EQ(at.read(kTemperature), nullptr);
                 EXPECT_EQ(at.write(kHenckyStrain)[0], nullptr);
                 EXPECT_EQ(at.span().position[0], nullptr);
               });
  });
}

template <class At, class Handle>
concept CanRead = requires(const At& at, Handle handle) {
  at.read(handle);
};
template <class At, class Handle>
concept CanWrite = requires(const At& at, Handle handle) {
  at.write(handle);
};

template <class Read, class Write>
using OnChunk = ChunkAccess<float, Read, Write>;
using Declares = OnChunk<decltype(reads(kYieldSlope, kNodeVelocity)), decltype(writes(kCohesion, kSalt))>;
static_assert(CanRead<Declares, decltype(kYieldSlope)> && CanRead<Declares, decltype(kSalt)>);
static_assert(CanRead<Declares, decltype(kNodeVelocity)> && !CanWrite<Declares, decltype(kNodeVelocity)>);
static_assert(CanWrite<Declares, decltype(kCohesion)> && !CanWrite<Declares, decltype(kYieldSlope)>);
static_assert(!CanRead<Declares, decltype(kDilatancy)> && !CanWrite<Declares, decltype(kPosition)>);

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
  names.order = names_of(compiled->plan.sort);
  names.prepare = names_of(compiled->plan.prepare);
  names.nodes = names_of(compiled->plan.nodes);
  for (const std::string& name : names_of(compiled->plan.applied)) names.nodes.push_back(name);
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
  EXPECT_THAT(with.gather, ElementsAre(ElementsAre("gather", "places before motion", "advance", "count flow",
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
