// Repose tests: cases 18 to 20 of the battery: a body that spins for long, particles alone for long, and many
// at one place.
#include <algorithm>
#include <cmath>

#include "tests/kernels/samples.h"
#include "tests/stability/small_state.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

/// An elastic ball of 6 cells whose rim turns at 0.2 of the speed of sound: a turn takes a hundred steps or
/// two.
constexpr const char* kBall = R"json({"repose": 1, "name": "ball", "grid": {"spacing": 0.01},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "ball", "material": "rubber", "angular_velocity": [0, 60, 30],
              "shape": {"type": "sphere", "radius": 0.025}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

double energy(const Diagnostics& d) {
  return d.kinetic_energy + d.affine_energy + d.elastic_energy;
}

void spin(Case& asked, const std::string& precision) {
  constexpr int kTurns = 100;
  const Scene scene = scene_of(kBall, {"grid.precision=" + precision});
  const double turn = 2.0 * std::numbers::pi / scene.bodies[0].angular_velocity.norm();
  const auto simulation = simulate(scene, 1);
  const Diagnostics start = simulation->diagnose();
  double before = energy(start), growth = -1.0, drift = 0.0;
  for (int k = 1; k <= kTurns; ++k) {
    if (!run_until(*simulation, k * turn)) return;
    const Diagnostics now = simulation->diagnose();
    growth = std::max(growth, energy(now) / before - 1.0);
    drift = std::max(drift, change(start.angular_momentum, now.angular_momentum));
    before = energy(now);
  }
  report("energy_left_after_100_turns_" + precision, before / energy(start));
  report("steps_of_100_turns_" + precision, static_cast<double>(simulation->counters().step));
  asked.at_most("growth of energy in a turn, " + precision, growth, 0.0);
  asked.at_most("drift of angular momentum, " + precision, drift, 1e-3);
}

TEST(Battery, Case18_SpinOfAHundredTurns_NeverGains) {
  Case asked(18, "spin of 100 turns");
  spin(asked, "single");
  spin(asked, "double");
}

/// Particles in a box of one cell of rubber, all of one block. `isolated` may bind: sound allows more.
constexpr const char* kCell = R"json({"repose": 1, "name": "cell", "grid": {"spacing": 0.01},
  "time": {"sound": 1},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "cell", "material": "rubber", "particles_per_cell": 1,
              "shape": {"type": "box", "lower": [0.01, 0.01, 0.01], "upper": [0.02, 0.02, 0.02]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

/// Kinetic, affine and elastic.
template <class Real>
double energy(SmallState<Real>& state) {
  const auto& parameters = std::get<HenckyParameters>(state.scene().materials[0].parameters);
  const double d = state.state().spacing * state.state().spacing / 4.0;  // of the quadratic stencil
  double sum = 0.0;
  state.for_each([&](const ParticleSet<Real>& set, std::size_t p, const Vec3&) {
    double square = 0.0, slopes = 0.0, strain[6];
    for (const auto& v : set.velocity) square += double{v[p]} * double{v[p]};
    for (const auto& c : set.affine) slopes += double{c[p]} * double{c[p]};
    for (std::size_t k = 0; k < 6; ++k) strain[k] = set.strain[k][p];
    sum += 0.5 * set.particle_mass * (square + d * slopes) +
           set.particle_volume * parameters.energy_density(strain);
  });
  return sum;
}

/// By how much the largest energy of the last tenth of the steps exceeds that of the first, in shares. The
/// particles begin to breathe and shear at random, by 1e-3 of a cell in a step.
template <class Real>
double growth(SmallState<Real>& state, int steps) {
  Samples samples(19);
  constexpr double kStep = 6e-4;  // s, about that of the limit
  state.for_each([&](ParticleSet<Real>& set, std::size_t p, const Vec3&) {
    for (auto& c : set.affine) c[p] = static_cast<Real>(1e-3 / kStep * samples.uniform(-1, 1));
  });
  double early = 0.0, late = 0.0;
  for (int k = 0; k < steps; ++k) {
    const StepReport report = state.step();
    if (!report.accepted) return std::numeric_limits<double>::infinity();
    if (k < steps / 10) early = std::max(early, energy(state));
    if (k >= steps - steps / 10) late = std::max(late, energy(state));
    if (!std::isfinite(late)) return late;
  }
  return late / early - 1.0;
}

template <class Real>
SmallState<Real> cell(int particles) {
  const char* precision = sizeof(Real) == 4 ? "single" : "double";
  return SmallState<Real>(scene_of(kCell, {std::string("grid.precision=") + precision,
                                           "bodies.cell.particles_per_cell=" + std::to_string(particles)}));
}

/// Eight particles about a corner where cells meet, or where the base nodes of particles change.
template <class Real>
double growth_of_cluster(int steps, double corner) {
  SmallState<Real> state = cell<Real>(8);
  state.for_each([&](ParticleSet<Real>& set, std::size_t p, const Vec3&) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const double side = (p >> axis & 1) != 0 ? 1e-3 : -1e-3;
      set.position[axis][p] = static_cast<Real>(corner + side);
    }
  });
  return growth(state, steps);
}

TEST(Battery, Case19_LoneParticlesAtTheLimit_DoNotGrow) {
  Case asked(19, "a particle alone and a cluster, 1e5 steps at the limit");
  constexpr int kSteps = 100000;
  SmallState<float> single = cell<float>(1);
  SmallState<double> wide = cell<double>(1), too_long = cell<double>(1);
  const StepReport first = cell<double>(1).step();
  asked.holds("the limit of a particle alone binds", first.limit == Limit::kIsolated);
  asked.at_most("growth of energy, alone, float", growth(single, kSteps), 0.01);
  asked.at_most("growth of energy, alone, double", growth(wide, kSteps), 0.01);
  asked.at_most("growth of energy, corner of cells, float", growth_of_cluster<float>(kSteps, 2.0), 0.01);
  asked.at_most("growth of energy, change of nodes, double", growth_of_cluster<double>(kSteps, 1.5), 0.01);
  // The default is 0.9 of what is stable.
  too_long.limit_steps_only_by(1.02 / 0.9 * first.dt);
  asked.at_least("control of steps beyond the limit", growth(too_long, 1000), 1.0);
}

/// Falls onto a floor.
constexpr const char* kDrop = R"json({"repose": 1, "name": "drop", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}, "rubber": {"type": "elastic", "youngs_modulus": 3e5}},
  "bodies": [{"name": "cell", "material": "sand", "velocity": [0.2, -1, 0.1],
              "shape": {"type": "box", "lower": [0.01, 0.02, 0.01], "upper": [0.02, 0.03, 0.02]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

/// Largest difference of any number of any particle from the first one's; not a number where one is none.
template <class Real>
double differences(const std::string& material, std::size_t count) {
  SmallState<Real> state(scene_of(
      kDrop, {sizeof(Real) == 4 ? "grid.precision=single" : "grid.precision=double",
              "bodies.cell.material=" + material, "bodies.cell.particles_per_cell=" + std::to_string(count)}));
  EXPECT_EQ(state.set().count, count);
  state.for_each([&](ParticleSet<Real>& set, std::size_t p, const Vec3&) {
    for (auto& channel : set.position) channel[p] = channel[0];
  });
  for (int k = 0; k < 400; ++k) {
    if (!state.step().accepted) return std::numeric_limits<double>::quiet_NaN();
  }
  Worst worst;
  const auto& set = state.set();
  set.for_each_real([&](const AlignedArray<Real>& channel) {
    for (std::size_t p = 0; p < count; ++p) {
      worst.add(std::fabs(double{channel[p]} - double{channel[0]}), std::to_string(p));
    }
  });
  return worst.figure();
}

TEST(Battery, Case20_ManyAtOnePlace_StayEqual) {
  Case asked(20, "2 to 64 particles at one place");
  for (const std::string material : {"sand", "rubber"}) {
    Worst single, wide;
    for (const std::size_t count : {2u, 3u, 8u, 17u, 27u, 64u}) {
      single.add(differences<float>(material, count), std::to_string(count));
      wide.add(differences<double>(material, count), std::to_string(count));
    }
    at_most(asked, "difference between them, " + material + ", float", single, 0);
    at_most(asked, "difference between them, " + material + ", double", wide, 0);
  }
}

}  // namespace
}  // namespace repose::battery
