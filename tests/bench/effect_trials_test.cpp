// Repose tests: what holds for every effect that is asked for, so a new one has these tests by its examples: it
// comes on, alone, and keeps the same bits over threads, instruction sets and checkpoints.
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cctype>
#include <filesystem>
#include <map>
#include <ostream>
#include <set>

#include "bench/effect_bench.h"
#include "engine/compiler/compiler.h"
#include "engine/compiler/figures.h"
#include "tests/physics/physics_rig.h"

namespace repose {

void PrintTo(const EffectTrial& trial, std::ostream* out) {
  *out << trial.asked;
}

namespace {

/// Time enough for an emitter to emit.
constexpr int kSteps = 40;
constexpr int kImplicitSteps = 8;
constexpr double kMostApart = 0.2;

class EffectTrials : public testing::TestWithParam<EffectTrial> {
 protected:
  /// 16384 particles in the middle of the bench's scene.
  static Scene scene(const std::vector<std::string>& base, const std::vector<std::string>& more) {
    std::vector<std::string> overrides{R"(bodies.column.shape.lower=["= 56 * dx", "= 5 * dx", "= 56 * dx"])",
                                       R"(bodies.column.shape.upper=["= 72 * dx", "= 13 * dx", "= 72 * dx"])"};
    overrides.insert(overrides.end(), base.begin(), base.end());
    overrides.insert(overrides.end(), more.begin(), more.end());
    return scene_file("probe_column.json", overrides);
  }
  static Scene without() { return scene(GetParam().base, {}); }
  static Scene with() { return scene(GetParam().base, GetParam().overrides); }

  /// The same in implicit steps, ten times as long as explicit ones.
  static Scene with_implicit() {
    std::vector<std::string> overrides = GetParam().overrides;
    overrides.insert(overrides.end(),
                     {"time.integrator=implicit", "time.max_step=2e-3", "implicit.tolerance=1e-3"});
    return scene(GetParam().base, overrides);
  }
  /// Whether implicit steps cannot have it.
  static bool explicit_only() {
    bool only = false;
    const Scene asked = with();
    for_each_effect(asked.effects, [&only](const auto& effect) {
      only = only || (effect.on() && effect.explicit_only() != nullptr);
    });
    return only;
  }

  static std::uint64_t hash_after(int threads, Target target = best_target()) {
    return hash_after(with(), kSteps, threads, target);
  }
  static std::uint64_t hash_after(const Scene& scene, int steps, int threads, Target target) {
    const auto simulation = simulate(scene, threads, target);
    EXPECT_TRUE(run_steps(*simulation, steps));
    return simulation->hash();
  }

  // Without this the library would never start more threads than the machine has cores.
  tbb::global_control control_{tbb::global_control::max_allowed_parallelism, 2};
};

std::map<std::string, EffectStatus> by_name(const Scene& scene) {
  std::map<std::string, EffectStatus> all;
  for (EffectStatus& status : effect_status(scene)) all[status.name] = status;
  return all;
}

/// What a simulation is made of, and where it starts.
std::string made_of(const Scene& scene) {
  const auto simulation = simulate(scene, 1);
  std::string text = std::to_string(simulation->hash());
  for (const PassReport& pass : simulation->passes()) text += "; " + pass.name;
  const auto compiled = compile_scene<float>(scene, {});
  EXPECT_TRUE(compiled);
  if (compiled->plan.sleep) text += "; sleep";
  return text;
}

TEST(EffectTrialList, EveryEffectHasAnExample) {
  const Effects effects;
  for_each_effect(effects, [](const auto& effect) { EXPECT_FALSE(effect.examples().empty()) << effect.kName; });
}

TEST_P(EffectTrials, TurnItOnAndNothingElse) {
  auto before = by_name(without());
  for (const auto& [name, after] : by_name(with())) {
    EXPECT_NE(after.reason, "") << name;
    if (name == GetParam().effect) {
      EXPECT_TRUE(after.on);
      continue;
    }
    EXPECT_EQ(after.on, before[name].on) << name;
    EXPECT_EQ(after.bytes_per_particle, before[name].bytes_per_particle) << name;
  }
  EXPECT_NE(made_of(with()), made_of(without())) << "asked for, but nothing came of it";
}

TEST_P(EffectTrials, ThreadsAndInstructionSets_SameBits) {
  const std::uint64_t one = hash_after(1);
  EXPECT_EQ(hash_after(2), one);
  if (!target_supported(Target::kAvx2)) return;
  EXPECT_EQ(hash_after(2, Target::kAvx2), one) << "AVX2";
}

TEST_P(EffectTrials, SavedAndLoaded_GoesOnWithTheSameBits) {
  const std::string path =
      std::filesystem::temp_directory_path().string() + "/repose_trial_" + std::to_string(getpid());
  const auto saved = simulate(with(), 1);
  ASSERT_TRUE(run_steps(*saved, kSteps / 2));
  const Result<void> save = saved->save(path);
  ASSERT_TRUE(save) << save.error().text();
  const auto loaded = simulate(with(), 2);
  const Result<void> load = loaded->load(path);
  std::filesystem::remove_all(path);
  ASSERT_TRUE(load) << load.error().text();
  ASSERT_TRUE(run_steps(*loaded, kSteps - kSteps / 2));
  EXPECT_EQ(loaded->hash(), hash_after(1));
}

TEST_P(EffectTrials, ImplicitSteps_ThreadsAndInstructionSets_SameBits) {
  if (explicit_only()) {
    const auto refused = compile_scene<float>(with_implicit(), {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::kBadScene) << refused.error().text();
    return;
  }
  const std::uint64_t one = hash_after(with_implicit(), kImplicitSteps, 1, best_target());
  EXPECT_EQ(hash_after(with_implicit(), kImplicitSteps, 2, best_target()), one);
  if (!target_supported(Target::kAvx2)) return;
  EXPECT_EQ(hash_after(with_implicit(), kImplicitSteps, 2, Target::kAvx2), one) << "AVX2";
}

/// Where particles have gone, m, in the order of their ids.
std::vector<double> ways(const PointCloud& start, const PointCloud& end) {
  std::vector<double> all;
  for (std::size_t p = 0; p < std::min(start.size(), end.size()); ++p) {
    for (std::size_t axis = 0; axis < 3; ++axis) all.push_back(end.position[p][axis] - start.position[p][axis]);
  }
  return all;
}

/// What an effect asks of nodes holds within the solve, too: in steps ten times as long as explicit ones,
/// particles go where they go in those, but for what backward Euler damps.
TEST_P(EffectTrials, LongImplicitSteps_GoWhereExplicitOnesGo) {
  if (explicit_only()) return;
  const auto implicit = simulate(with_implicit(), 2), steps = simulate(with(), 2),
             bare = simulate(without(), 2);
  const PointCloud start = implicit->points();
  ASSERT_TRUE(run_steps(*implicit, kImplicitSteps));
  ASSERT_TRUE(run_until(*steps, implicit->counters().time));
  ASSERT_TRUE(run_until(*bare, implicit->counters().time));
  const std::vector<double> a = ways(start, implicit->points()), b = ways(start, steps->points()),
                            without_it = ways(start, bare->points());
  double square = 0.0, square_without = 0.0, apart = 0.0;
  for (std::size_t k = 0; k < std::min(a.size(), b.size()); ++k) {
    square += b[k] * b[k];
    square_without += k < without_it.size() ? without_it[k] * without_it[k] : 0.0;
    apart += (a[k] - b[k]) * (a[k] - b[k]);
  }
  square = std::max(square, square_without);
  RecordProperty("apart", std::to_string(std::sqrt(apart / square)));
  EXPECT_LT(std::sqrt(apart / square), kMostApart);
}

INSTANTIATE_TEST_SUITE_P(All, EffectTrials, testing::ValuesIn(effect_trials()), [](const auto& parameter) {
  std::string name = std::to_string(parameter.index) + "_";
  for (const char c : parameter.param.asked) name += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';
  return name;
});

TEST(EffectCosts, OfEffectsThatWereNotMeasured_RowsStay) {
  const Cost kept[] = {{"step", 20.0}, {"gravity", 1.0}, {"age", 0.5}};
  EffectCost dear{{{"age", {}, {}}, "age"}, 11.0, 1.1}, cheap{{{"age", {}, {}}, "age"}, 10.2, 1.02};
  EXPECT_EQ(to_cost_rows({dear, cheap}, kept),
            "    {\"step\", 20.0},\n    {\"gravity\", 1.0},\n    {\"age\", 2.0},\n")
      << "a tenth of the step that stands there, on whichever machine";
  EXPECT_EQ(to_cost_rows({dear}, {}), "    {\"step\", 10.0},\n    {\"age\", 1.0},\n");
}

}  // namespace
}  // namespace repose
