// Repose tests: the balance of momentum of an implicit step as a whole, over blocks, sets and materials, in
// double precision: the product of the linear system is the derivative of the residual, symmetric where it
// promises to be, and sand answers in the solve as it does after the step.
#include "engine/implicit/momentum_balance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "engine/compiler/compiler.h"
#include "engine/reading/reader.h"
#include "engine/step/stepper.h"

namespace repose {
namespace {

using Vector = NodeField<double>;

/// Two bodies that touch, over several blocks.
constexpr const char* kTwo =
    R"json({"repose": 1, "name": "two", "grid": {"spacing": 0.01, "precision": "double"},
  "time": {"integrator": "implicit", "max_step": 1e-4},
  "materials": {"low": {"type": "drucker_prager", "friction_angle": 30},
                "high": {"type": "elastic", "youngs_modulus": 1e6}},
  "bodies": [{"name": "a", "material": "low", "shape": {"type": "box", "lower": [0, 0, -0.025], "upper": [0.06, 0.04, 0.025]}},
             {"name": "b", "material": "high",
              "shape": {"type": "box", "lower": [0, 0.04, -0.025], "upper": [0.06, 0.07, 0.025]}}]})json";

/// An implicit step of a scene with random velocities that strain sand to and fro by some tenths of a percent.
class Balance {
 public:
  explicit Balance(std::vector<std::string> overrides, double strain = 3e-3)
      : compiled_(compile(std::move(overrides))) {
    // One step of the scene's own fills the nodes.
    Stepper<double> stepper(compiled_.plan, 1);
    EXPECT_TRUE(stepper.step(state(), std::numeric_limits<double>::infinity()).accepted);
    blocks_.begin(state(), kStep);
    active_.begin_step(state(), 0.0);
    sweep_.begin();
    sweep_.follow_topology();
    system_.follow_topology();
    balance_.follow_topology();
    contacts_.clear(state().grid.size());
    system_.prepare();
    balance_.begin();
    at = random(strain * state().spacing / kStep);
  }

  State<double>& state() { return compiled_.state; }
  /// m/s on nodes with mass.
  Vector random(double size) {
    std::uniform_real_distribution<double> number(-size, size);
    Vector made = system_.vector();
    for_each_value([&](std::size_t k) { made.values.data()[k] = number(engine_); });
    return made;
  }
  template <class Visit>
  void for_each_value(Visit visit) {
    for (std::size_t b = 0; b < state().grid.size(); ++b) {
      const double* const nodes = state().nodes.block(b);
      for (std::size_t k = 0; k < kBlockValues; ++k) {
        if (k % kNodeValues != 0 && nodes[k - k % kNodeValues] > 0.0) visit(b * kBlockValues + k);
      }
    }
  }
  /// r at `at` + length x.
  std::vector<double> residual(double length, const Vector& x) {
    Vector v = system_.vector();
    for_each_value(
        [&](std::size_t k) { v.values.data()[k] = at.values.data()[k] + length * x.values.data()[k]; });
    EXPECT_TRUE(balance_.evaluate(v));
    return values(balance_.residual());
  }
  void linearize() {
    EXPECT_TRUE(balance_.evaluate(at));
    balance_.linearize(at, false);
  }
  std::vector<double> product(const Vector& x) {
    Vector y = system_.vector();
    system_.apply(x, y);
    return values(y);
  }
  std::vector<double> values(const Vector& x) {
    std::vector<double> found;
    for_each_value([&](std::size_t k) { found.push_back(x.values.data()[k]); });
    return found;
  }

  Vector at;

 private:
  static constexpr double kStep = 1e-3;

  static CompiledScene<double> compile(std::vector<std::string> overrides) {
    const auto scene = read_scene_text(kTwo, "two.json", ".", {std::move(overrides), false});
    EXPECT_TRUE(scene) << (scene ? "" : scene.error().text());
    auto compiled = compile_scene<double>(*scene, {});
    EXPECT_TRUE(compiled) << (compiled ? "" : compiled.error().text());
    ParticleSweep<double>::claim_scratch(compiled->plan.scratch);
    return std::move(*compiled);
  }

  std::mt19937 engine_{11};
  CompiledScene<double> compiled_;
  Threads threads_{1};
  ActiveBlocks<double> active_{compiled_.plan};
  StopWish wish_;
  BlockSweep<double> blocks_{compiled_.plan, threads_, active_.set(), wish_};
  ParticleSweep<double> sweep_{blocks_};
  ContactSet<double> contacts_;
  TangentSystem<double> system_{sweep_, contacts_, Preconditioner::kMass};
  MomentumBalance<double> balance_{*compiled_.plan.implicit, sweep_, contacts_, system_};
};

double dot(const std::vector<double>& x, const std::vector<double>& y) {
  double sum = 0.0;
  for (std::size_t k = 0; k < x.size(); ++k) sum += x[k] * y[k];
  return sum;
}
double length(const std::vector<double>& x) {
  return std::sqrt(dot(x, x));
}

const std::vector<std::vector<std::string>> kScenes{
    {},
    {R"(materials.high={"type": "neo_hookean", "youngs_modulus": 1e6})"},
    {R"(grid={"spacing": 0.01, "precision": "double", "plane_strain": "z"})"},
    {R"(grid={"spacing": 0.01, "precision": "double", "transfer": "flip", "stencil": "cubic"})"},
    {R"(grid={"spacing": 0.01, "precision": "double", "transfer": "apic", "stencil": "linear"})"},
    {R"(materials.low.hardening={"h0": 35, "h1": 9, "h2": 0.3, "h3": 10})"},
    {"volume_correction={}"},
};

/// |A x - (r(v + h x) - r(v - h x))/2h| over |A x|.
double product_error(const std::vector<std::string>& overrides) {
  Balance balance(overrides);
  balance.linearize();
  double largest = 0.0;
  for (int round = 0; round < 3; ++round) {
    const Vector x = balance.random(1.0);
    const std::vector<double> product = balance.product(x);
    constexpr double kLength = 1e-8;  // so short that no particle comes to the rim of its cone
    const std::vector<double> high = balance.residual(kLength, x), low = balance.residual(-kLength, x);
    std::vector<double> difference(product.size());
    for (std::size_t k = 0; k < product.size(); ++k)
      difference[k] = product[k] - (high[k] - low[k]) / (2.0 * kLength);
    EXPECT_GT(product.size(), 100u);
    largest = std::max(largest, length(difference) / length(product));
  }
  return largest;
}

std::vector<std::string> with(std::vector<std::string> scene, const std::string& more) {
  scene.push_back(more);
  return scene;
}

/// That `figure` is below the bound in `modes`, and above the other one in the one that is otherwise.
template <class Figure>
void expect_in_every_scene(Figure figure, const std::vector<std::string>& modes, double bound,
                           const std::string& otherwise, double least) {
  for (const auto& scene : kScenes) {
    for (const std::string& mode : modes) {
      EXPECT_LT(figure(with(scene, "implicit.mode=" + mode)), bound)
          << testing::PrintToString(scene) << " " << mode;
    }
    EXPECT_GT(figure(with(scene, "implicit.mode=" + otherwise)), least) << testing::PrintToString(scene);
  }
}

TEST(MomentumBalance, Product_IsTheDerivativeOfTheResidual) {
  expect_in_every_scene(product_error, {"exact", "lagged", "unilateral"}, 1e-7, "projected", 1e-5);
}

/// |x A y - y A x| over |x| |A y|.
double asymmetry(const std::vector<std::string>& overrides) {
  Balance balance(overrides);
  balance.linearize();
  const Vector x = balance.random(1.0), y = balance.random(1.0);
  const std::vector<double> ay = balance.product(y);
  return std::abs(dot(balance.values(x), ay) - dot(balance.values(y), balance.product(x))) /
         (length(balance.values(x)) * length(ay));
}

TEST(MomentumBalance, Product_IsSymmetricButInExact) {
  expect_in_every_scene(asymmetry, {"projected", "lagged", "unilateral"}, 1e-12, "exact", 1e-6);
}

// Sand that has opened closes before it carries load, in the solve as after it.
TEST(MomentumBalance, VolumeThatSandGained_IsClosedInTheSolve) {
  const std::vector<std::string> sand{
      R"(bodies=[{"name": "a", "material": "low", "shape": {"type": "box", "lower": [0, 0, -0.025], "upper": [0.06, 0.04, 0.025]}}])",
      "gravity.acceleration=[0, 0, 0]", "volume_correction={}"};
  for (const double gained : {0.0, 0.5}) {
    Balance balance(sand, 1e-3);
    auto& set = balance.state().sets.front();
    const std::size_t channel = set.extra_index("volume_gained");
    ASSERT_LT(channel, set.extra.size());
    std::fill_n(set.extra[channel].values.data(), set.count, gained);
    const Vector none = balance.random(0.0);
    const std::vector<double> r = balance.residual(0.0, none);
    // Without load r is m dv.
    std::vector<double> momentum;
    balance.for_each_value([&](std::size_t k) {
      momentum.push_back(balance.state().nodes.values.data()[k - k % kNodeValues] *
                         balance.at.values.data()[k]);
    });
    std::vector<double> impulse(r.size());
    for (std::size_t k = 0; k < r.size(); ++k) impulse[k] = r[k] - momentum[k];
    if (gained > 0.0) {
      EXPECT_LT(length(impulse), 1e-9 * length(momentum));
    } else {
      EXPECT_GT(length(impulse), 1e-2 * length(momentum)) << "the control";
    }
  }
}

}  // namespace
}  // namespace repose
