// Repose tests: a body alone keeps its momentum and its angular momentum. Both follow from the transfer (Jiang
// et al. 2015) and from a stress that is symmetric, so in double only rounding is left; energy must not grow.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/physics/physics_rig.h"
#include "tests/physics/validation.h"

namespace repose {
namespace {

/// An elastic bar that flies, tumbles and rings.
constexpr const char* kSpinner = R"json({"repose": 1, "name": "spinner",
  "grid": {"spacing": 0.02, "precision": "double"},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e5, "poisson_ratio": 0.3}},
  "bodies": [{"name": "bar", "material": "rubber", "velocity": [0.7, -0.4, 0.3], "angular_velocity": [2, 5, -3],
              "shape": {"type": "box", "lower": [-0.2, -0.06, -0.1], "upper": [0.2, 0.06, 0.1]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

struct Drift {
  double momentum = 0.0, angular = 0.0, energy_gain = 0.0;  // relative, largest over the steps
};

double energy(const Diagnostics& d) {
  return d.kinetic_energy + d.affine_energy + d.elastic_energy;
}

Drift drift(const std::vector<std::string>& overrides) {
  const auto simulation = simulate(scene_of(kSpinner, overrides));
  const Diagnostics start = simulation->diagnose();
  Drift worst;
  for (int k = 0; k < 15; ++k) {
    if (!run_steps(*simulation, 20)) break;
    const Diagnostics now = simulation->diagnose();
    worst.momentum = figures::further(worst.momentum, change(start.momentum, now.momentum));
    worst.angular = figures::further(worst.angular, change(start.angular_momentum, now.angular_momentum));
    worst.energy_gain = std::max(worst.energy_gain, energy(now) / energy(start) - 1.0);
  }
  return worst;
}

TEST(Validation, SpinningElasticBodyInDouble_KeepsBothMomenta) {
  const Drift worst = drift({}), pulled = drift({"gravity.acceleration=[0,-1e-6,0]"});
  report("energy_gain_double", worst.energy_gain);
  EXPECT_LT(worst.energy_gain, 1e-3);
  Validation row("a body alone keeps its momenta in 300 steps, double",
                 "Jiang et al. 2015, conservation of momenta");
  row.at_most("change of momentum, of itself", worst.momentum, 1e-12);
  row.control("gravity of 1e-6 m/s^2", pulled.momentum);
  row.at_most("change of angular momentum, of itself", worst.angular, 1e-10);
  row.control("gravity of 1e-6 m/s^2", pulled.angular);
}

TEST(Conservation, SpinningElasticBodyInFloat_KeepsBothMomenta) {
  const Drift worst = drift({"grid.precision=single"});
  report("momentum_drift_float", worst.momentum);
  report("angular_momentum_drift_float", worst.angular);
  EXPECT_LT(worst.momentum, 1e-5);
  EXPECT_LT(worst.angular, 1e-4);
}

}  // namespace
}  // namespace repose
