// Repose tests: motions that are known exactly. The body forces are compared with the balance of momentum by
// numerical differentiation; then bodies must move as the formula says. That they do so the better the finer
// the grid is a case of tests/stability.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "engine/state/state_hash.h"
#include "tests/physics/manufactured_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

using namespace manufactured;

// Numerical differentiation, of fourth order.

constexpr double kStep = 5e-4;

Vec3 slope(const std::function<Vec3(double)>& f) {
  const double h = kStep;
  return (f(-2.0 * h) - f(2.0 * h) + 8.0 * (f(h) - f(-h))) / (12.0 * h);
}
template <class Place>
Mat3 first_piola(Place place, const Vec3& X, double t, const Elasticity& e) {
  Mat3 F;
  for (int j = 0; j < 3; ++j)
    F.col(j) = slope([&](double h) -> Vec3 { return place(X + h * Vec3::Unit(j), t); });
  const Mat3 out = F.inverse().transpose();
  return e.lambda() * std::log(F.determinant()) * out + e.mu() * (F - out);
}
/// What a body must feel to move so: a - Div P / rho.
template <class Place>
Vec3 balance(Place place, const Vec3& X, double t, const Elasticity& e) {
  const auto velocity = [&](double s) -> Vec3 {
    return slope([&](double h) -> Vec3 { return place(X, s + h); });
  };
  Vec3 b = slope([&](double h) -> Vec3 { return velocity(t + h); });
  for (int j = 0; j < 3; ++j) {
    b -= slope([&](double h) -> Vec3 { return first_piola(place, X + h * Vec3::Unit(j), t, e).col(j); }) /
         e.density;
  }
  return b;
}

/// The term of the vortex in question turned around: -R (g' h)^2 along e_Theta is + in the version that
/// circulates.
Vec3 circulating_vortex_force(const ManufacturedSolution& vortex, const Vec3& X, double t,
                              const Elasticity& e) {
  const double most = vortex.angle * pi / 180.0;
  const double radius = std::hypot(X[0], X[1]), turn = most * std::sin(pi * t) * share(radius);
  const double rate = most * pi * std::cos(pi * t) * share(radius);
  const Vec3 along = Vec3(-X[1], X[0], 0.0) / radius;
  return vortex.force(X, t, e) + 2.0 * radius * rate * rate * std::sin(turn) * along;
}

constexpr const char* kVortexSource = "Kamojjala et al. 2015, generalized vortex";

TEST(Validation, ManufacturedForces_AreThoseOfTheBalanceOfMomentum) {
  ManufacturedSolution vortex, box;
  vortex.type = ManufacturedSolution::Type::kGeneralizedVortex;
  box.type = ManufacturedSolution::Type::kAxisAligned;
  box.amplitude = {0.05, -0.04, 0.03};
  const Elasticity gel{1000.0, 1e4, 0.3};
  double vortex_error = 0.0, vortex_size = 0.0, control = 0.0, box_error = 0.0, box_size = 0.0;
  for (int k = 0; k < 200; ++k) {
    const double t = 0.05 + 0.0045 * k, radius = 0.76 + 0.48 * (k * 37 % 200) / 200.0;
    const Vec3 X = turned({radius, 0.0, 0.3}, 0.1 * k);
    const Vec3 b = balance(vortex_place, X, t, gel);
    vortex_error = figures::further(vortex_error, (vortex.force(X, t, gel) - b).norm());
    control = figures::further(control, (circulating_vortex_force(vortex, X, t, gel) - b).norm());
    vortex_size = std::max(vortex_size, b.norm());
    const auto place = [&](const Vec3& Y, double s) { return box_place(Y, s, box.amplitude, gel); };
    const Vec3 c = balance(place, X, t, gel);
    box_error = figures::further(box_error, (box.force(X, t, gel) - c).norm());
    box_size = std::max(box_size, c.norm());
  }
  report("axis_aligned_force_error", box_error / box_size);
  EXPECT_LT(box_error, 1e-6 * box_size);
  Validation row("body force of the vortex: rho b = rho a - Div P, by differences", kVortexSource);
  row.at_most("off the balance of momentum, of the largest", vortex_error / vortex_size, 1e-6);
  row.control("the other sign of one term, as it is also found", control / vortex_size);
}

TEST(Validation, ManufacturedVortex_IsWhereItBeganAtItsHalfPeriod) {
  const Errors coarse = vortex<double>({cells(16)}), fine = vortex<double>({cells(32)});
  report("vortex_rms_16_cells", coarse.rms, "m");
  report("vortex_rms_32_cells", fine.rms, "m");
  report("vortex_order", order(coarse, fine));
  EXPECT_LT(fine.relative, 0.02);
  EXPECT_GT(order(coarse, fine), 1.4);
  Validation row("ring that turns by 20 degrees and back, driven by its body force", kVortexSource);
  row.at_most("particles off where they began, of their radius, 16 cells a metre", 100.0 * coarse.relative, 2.0,
              "%");
  row.control("without the force", 100.0 * vortex<double>({cells(16)}, kNone).relative);
}

TEST(ManufacturedVortex, WithTheOtherSign_IsTold) {
  const double right = vortex<double>({cells(24)}).rms;
  const double other = vortex<double>({cells(24)}, circulating_vortex_force).rms;
  report("vortex_rms_24_cells", right, "m");
  report("vortex_rms_24_cells_other_sign", other, "m");
  EXPECT_LT(right, 0.001);
  EXPECT_GT(other, 2.5 * right);
}

TEST(ManufacturedVortex, InFloat_IsWhereItBegan) {
  const Errors errors = vortex<float>({cells(16)});
  report("vortex_relative_float", errors.relative);
  EXPECT_LT(errors.relative, 0.02);
}

TEST(ManufacturedVortex, InEveryTransferThatKeepsSpin_IsWhereItBegan) {
  for (const char* transfer : {"apic", "flip", "aflip"}) {
    const Errors errors = vortex<double>({cells(16), std::string("grid.transfer=") + transfer});
    report(std::string("vortex_relative_") + transfer, errors.relative);
    EXPECT_LT(errors.relative, 0.02) << transfer;
  }
}

TEST(ManufacturedBox, AfterAPeriod_ConvergesByTheSecondOrder) {
  const Errors coarse = box<double>({cells(16)}, 4), middle = box<double>({cells(32)}, 4),
               fine = box<double>({cells(64)}, 4);
  report("box_rms_16_cells", coarse.rms, "m");
  report("box_rms_32_cells", middle.rms, "m");
  report("box_rms_64_cells", fine.rms, "m");
  report("box_order_16_to_32", order(coarse, middle));
  report("box_order_32_to_64", order(middle, fine));
  EXPECT_GT(order(coarse, middle), 1.6);
  EXPECT_GT(order(middle, fine), 1.6);
  EXPECT_LT(fine.rms, 0.002 * kAmplitude);
}

TEST(Validation, ManufacturedBox_IsWhereItShouldBeWhenStretchedMost) {
  const Errors coarse = box<double>({cells(16)}, 1), fine = box<double>({cells(32)}, 1);
  report("stretched_box_rms_16_cells", coarse.rms, "m");
  EXPECT_GT(order(coarse, fine), 0.9);
  Validation row("box that stretches by sin(2 pi X), driven by its body force",
                 "Wallstedt and Guilkey 2008, axis-aligned displacement");
  row.at_most("rms distance from the formula after a quarter period, of the amplitude, 32 cells a metre",
              100.0 * fine.rms / kAmplitude, 0.5, "%");
  row.control("without the force", 100.0 * box<double>({cells(32)}, 1, kNone).rms / kAmplitude);
}

TEST(ManufacturedBox, InFloat_DiffersLittle) {
  const Errors single = box<float>({cells(32)}, 4), both = box<double>({cells(32)}, 4);
  report("box_rms_float", single.rms, "m");
  EXPECT_NEAR(single.rms, both.rms, 0.05 * both.rms);
}

// A step may be tried again, so what is pushed is what the nodes are told and not the particles.
TEST(ManufacturedBox, StepThatIsRefused_LeavesParticles) {
  const Scene scene = scene_of(kBox);
  auto compiled = compile_scene<double>(scene, {});
  ASSERT_TRUE(compiled);
  compiled->plan.limits = {10.0, 1e6, 1e6, 1e6, 1e6, compiled->plan.limits.sets};
  Stepper<double> stepper(std::move(compiled->plan), 1);
  compiled->state.counters.time = 0.1;
  EXPECT_TRUE(stepper.sort_if_due(compiled->state));
  const std::uint64_t before = state_hash(compiled->state);
  EXPECT_FALSE(stepper.step(compiled->state, std::numeric_limits<double>::infinity()).accepted);
  EXPECT_EQ(state_hash(compiled->state), before);
}

/// A bar of 25 m, as wide as space repeats, held at x <= 0: period 4 L / sqrt(E / rho) = 10 s.
constexpr const char* kBar = R"json({"repose": 1, "name": "bar", "parameters": {"dx": 0.390625},
  "grid": {"spacing": "= dx", "precision": "double", "plane_strain": "z",
           "periodic": {"y": {"lower": 0, "length": "= 8 * dx"}}},
  "materials": {"gel": {"type": "elastic", "density": 1, "youngs_modulus": 100, "poisson_ratio": 0}},
  "bodies": [{"name": "bar", "material": "gel", "particles_per_cell": 16,
              "shape": {"type": "box", "lower": ["= -4 * dx", 0, -1], "upper": [25, "= 8 * dx", 1]}}],
  "pins": [{"name": "wall", "shape": {"type": "box", "lower": [-25, -25, -1], "upper": [0, 25, 1]}}],
  "manufactured": {"bar": {"type": "bar_mode", "length": 25, "speed": 0.1}},
  "gravity": {"acceleration": [0, 0, 0]}})json";

struct Ringing {
  double period = 0.0;  ///< s, over ten
  double first = 0.0;   ///< m/s, the mean velocity at its largest in the first half period
  double loss = 0.0;    ///< of the mean velocity's largest, after ten periods
};

Ringing ring(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kBar, overrides), 1);
  const double spacing = 25.0 / 64.0, mass = 25.0 * 8.0 * spacing * spacing;  // of what is free, a cell thick
  double last_time = 0.0, last = 0.0, after = 0.0;
  std::vector<double> crossings;
  Ringing ringing;
  while (simulation->counters().time < 103.0 && run_steps(*simulation, 1)) {
    const double time = simulation->counters().time, mean = simulation->diagnose().momentum[0] / mass;
    if (time < 3.0) ringing.first = std::max(ringing.first, std::abs(mean));
    if (time > 97.0) after = std::max(after, std::abs(mean));
    if (last * mean < 0.0) crossings.push_back(last_time + (time - last_time) * last / (last - mean));
    last_time = time;
    last = mean;
  }
  ringing.period = 2.0 * (crossings.back() - crossings.front()) / static_cast<double>(crossings.size() - 1);
  ringing.loss = 1.0 - after / ringing.first;
  return ringing;
}

TEST(Validation, BarInItsFirstMode_RingsInItsPeriod) {
  const Ringing ringing = ring({}), stiffer = ring({"materials.gel.youngs_modulus=103"});
  report("bar_loss_after_10_periods", ringing.loss);
  EXPECT_NEAR(ringing.first, 0.1 * 2.0 / pi, 0.005 * 0.1);
  EXPECT_LT(ringing.loss, 0.05);
  Validation row("fixed-free bar of 64 cells in its first mode: period 4 L sqrt(rho / E)",
                 "d'Alembert 1747; the bar of Nguyen 2014, axial vibration");
  row.within("period over ten", ringing.period, 9.9, 10.1, "s");
  row.control("E larger by 3 %", stiffer.period);
}

}  // namespace
}  // namespace repose
