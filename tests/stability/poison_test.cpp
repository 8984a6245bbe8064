// Repose tests: the battery: a value that is no number, put into each field of a particle. The step in which it
// acts is refused, a particle is named, and nothing of it is shown.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/state/state_hash.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"
#include "tests/stability/child.h"

namespace repose {
namespace {

/// Sand with all that keeps a number per particle.
constexpr const char* kScene = R"json({"repose": 1, "name": "poison", "grid": {"spacing": 0.02},
  "time": {"frames": 4, "frames_per_second": 200, "max_step": 0.001},
  "materials": {"sand": {"type": "drucker_prager", "hardening": {}, "dilatancy": {},
    "moisture": {"initial": 0.25},
                         "variation": {"friction": 0.1, "length": 0.1}}},
  "volume_correction": {}, "age": {},
  "bodies": [{"name": "box", "material": "sand", "velocity": [0.1, 0, 0],
              "shape": {"type": "box", "lower": [0, 0.02, 0], "upper": [0.1, 0.1, 0.1]}}],
  "colliders": [{"name": "ground", "shape": {"type": "plane"}, "friction": 0.4}]})json";

/// The channels of a set by name, as `for_each_real` visits them, less position.
template <class Real>
std::vector<std::pair<std::string, AlignedArray<Real>*>> channels_of(ParticleSet<Real>& set) {
  std::vector<std::string> names;
  for (const char* axis : {"x", "y", "z"}) names.push_back(std::string("position.") + axis);
  for (const char* axis : {"x", "y", "z"}) names.push_back(std::string("velocity.") + axis);
  for (int k = 0; set.keeps_affine && k < kAffineComponents; ++k)
    names.push_back("affine." + std::to_string(k));
  for (int k = 0; k < kStrainComponents; ++k) names.push_back("strain." + std::to_string(k));
  for (const auto& channel : set.extra) names.push_back(channel.name);
  std::vector<std::pair<std::string, AlignedArray<Real>*>> result;
  std::size_t k = 0;
  set.for_each_real([&](AlignedArray<Real>& channel) { result.emplace_back(names[k++], &channel); });
  return result;
}

template <class Real>
bool finite(ParticleSet<Real>& set) {
  bool all = true;
  set.for_each_real([&](const AlignedArray<Real>& channel) {
    for (std::size_t p = 0; p < set.count; ++p) all = all && std::isfinite(channel[p]);
  });
  return all;
}

struct Found {
  double fields = 0.0;     ///< that were poisoned
  double accepted = 0.0;   ///< steps that went on with it
  double spread = 0.0;     ///< of these, those after which another value than the poisoned one is no number
  double nameless = 0.0;   ///< refusals that name no particle
  double elsewhere = 0.0;  ///< cells along an axis from the poisoned one to the one named, at most
  double changed = 0.0;    ///< refusals that changed the state
  std::string which;       ///< fields of steps that went on
};

template <class Real>
struct Run {
  explicit Run(const Scene& scene) {
    auto compiled = compile_scene<Real>(scene, {});
    if (!compiled) throw std::runtime_error(compiled.error().text());
    state = std::move(compiled->state);
    stepper.emplace(std::move(compiled->plan), 2);
    for (int k = 0; k < 3; ++k) EXPECT_TRUE(step().accepted);
    EXPECT_TRUE(stepper->sort_if_due(state));
  }

  StepReport step() {
    const StepReport report = stepper->step(state, std::numeric_limits<double>::infinity());
    if (report.accepted) FrameClock::advance_freely(state.counters, report.dt);
    return report;
  }
  Vec3 place_of(std::uint32_t id) const {
    Vec3 place = Vec3::Zero();
    for_each_particle(state, [&](const auto& set, std::size_t p, const Vec3& x) {
      if (set.id[p] == id) place = x;
    });
    return place;
  }

  State<Real> state;
  std::optional<Stepper<Real>> stepper;
};

template <class Real>
void poison(const Scene& scene, std::size_t k, Real value, Found& found) {
  Run<Real> run(scene);
  ParticleSet<Real>& set = run.state.sets[0];
  const auto [name, channel] = channels_of(set)[k];
  const std::size_t p = set.count / 2;
  const std::uint32_t id = set.id[p];
  const Vec3 place = run.place_of(id);
  const Real before = (*channel)[p];
  (*channel)[p] = value;
  const std::uint64_t poisoned = state_hash(run.state);
  found.fields += 1.0;
  const StepReport report = run.step();
  if (!report.accepted) {
    found.changed += state_hash(run.state) == poisoned ? 0.0 : 1.0;
    found.nameless += report.failed ? 0.0 : 1.0;
    if (!report.failed) return;
    const Vec3 way = to_vec3(report.failed->position) - place;
    found.elsewhere = std::max(found.elsewhere, way.cwiseAbs().maxCoeff() / run.state.spacing);
    return;
  }
  found.accepted += 1.0;
  if (found.which.find(name) == std::string::npos) found.which += name + " ";
  const auto now = std::find(set.id.data(), set.id.data() + set.count, id) - set.id.data();
  (*channel)[static_cast<std::size_t>(now)] = before;
  found.spread += finite(set) ? 0.0 : 1.0;
}

/// Whether a field is one that every particle has; else a law or an effect asked for it.
bool of_every_particle(const std::string& name) {
  return name.find('.') != std::string::npos;
}

/// All but places, which are looked at apart, and the time of birth, which acts on nothing.
template <class Real>
void poison_all(const std::vector<std::string>& overrides, bool every_particle, Found& found) {
  const Scene scene = scene_of(kScene, overrides);
  Run<Real> untouched(scene);
  EXPECT_TRUE(untouched.step().accepted) << "the control: without poison it goes on";
  const auto channels = channels_of(untouched.state.sets[0]);
  constexpr Real kInfinity = std::numeric_limits<Real>::infinity();
  for (std::size_t k = 0; k < channels.size(); ++k) {
    const std::string& name = channels[k].first;
    if (name.rfind("position", 0) == 0 || name == "birth" || of_every_particle(name) != every_particle)
      continue;
    for (const Real value : {std::numeric_limits<Real>::quiet_NaN(), kInfinity, -kInfinity})
      poison(scene, k, value, found);
  }
}

Found poison_with(const std::string& integrator, bool every_particle) {
  Found found;
  const std::string how = "time.integrator=" + integrator;
  poison_all<float>({how}, every_particle, found);
  poison_all<double>({how, "grid.precision=double"}, every_particle, found);
  poison_all<float>({how, "grid.transfer=aflip", "grid.stencil=cubic"}, every_particle, found);
  return found;
}

TEST(Battery, Case42_PoisonInAParticleIsCaughtInTheSameStep) {
  battery::Case c(42, "NaN and infinity in each field");
  for (const std::string integrator : {"explicit", "implicit"}) {
    const Found found = poison_with(integrator, true);
    c.at_least("fields and values of every particle, " + integrator, found.fields, 150.0);
    c.at_most("steps that went on with it, " + integrator, found.accepted, 0.0);
    c.at_most("refusals that name no particle, " + integrator, found.nameless, 0.0);
    // The node between them is within the reach of both.
    c.at_most("cells from the poisoned to the one that is named, " + integrator, found.elsewhere, 4.0);
    c.at_most("refusals that changed the state, " + integrator, found.changed, 0.0);
    EXPECT_EQ(found.which, "") << integrator;
  }
}

// Nobody looks at them: some pass into the strain within the step, others into none that a step tells.
TEST(Battery, Case42_PoisonInANumberOfAnEffectIsCaughtInTheSameStep) {
  battery::Case c(42, "NaN and infinity in each field");
  const char* const why =
      "a frame that carries it is not published; to look in each step costs a load a number";
  for (const std::string integrator : {"explicit", "implicit"}) {
    const Found found = poison_with(integrator, false);
    c.at_least("fields and values of effects, " + integrator, found.fields, 45.0);
    c.at_most("steps that went on with it, effects, " + integrator, found.accepted, 0.0, "", {54.0, why});
    c.at_most("of them, that spread it, effects, " + integrator, found.spread, 0.0, "", {15.0, why});
  }
}

/// How a step ends that finds a place which is no number; in a child, since kernels trust places.
stability::ChildEnd step_from_a_place_that_is_none() {
  return stability::run_in_child(
      [] {
        auto compiled = compile_scene<float>(scene_of(kScene), {});
        State<float> state = std::move(compiled->state);
        Stepper<float> stepper(std::move(compiled->plan), 1);
        if (!stepper.sort_if_due(state)) return 3;
        state.sets[0].position[1][7] = std::numeric_limits<float>::quiet_NaN();
        const StepReport report = stepper.step(state, 1.0);
        return report.accepted ? 2 : report.failed || report.error ? 0 : 4;
      },
      {});
}

// A kernel reads where it should not, and the child ends by a signal.
TEST(Battery, Case42_PlaceThatIsNoNumberIsCaught) {
  battery::Case c(42, "NaN and infinity in each field");
  const stability::ChildEnd end = step_from_a_place_that_is_none();
  const bool caught = end.signal == 0 && !end.hung && end.code == 0;
  c.at_most("places that are no number and are not refused", caught ? 0.0 : 1.0, 0.0, "",
            {1.0, "steps make none, hosts' are refused, files have checksums; a debug build validates"});
}

}  // namespace
}  // namespace repose
