// Repose tests: what tests of motions that are known exactly share: the scenes, the formulas once more in this
// file's own words, and how far from them particles are.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "engine/compiler/compiler.h"
#include "engine/effect/manufactured.h"
#include "engine/simulation/points.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"

namespace repose::manufactured {

using std::numbers::pi;

constexpr const char* kVortex = R"json({"repose": 1, "name": "vortex", "parameters": {"cells": 32},
  "grid": {"spacing": "= 1 / cells", "precision": "double", "plane_strain": "z"},
  "materials": {"gel": {"type": "neo_hookean", "density": 1000, "youngs_modulus": 1e4, "poisson_ratio": 0.3}},
  "bodies": [{"name": "ring", "material": "gel", "particles_per_cell": 36,
              "shape": {"type": "revolution", "axis": [0, 0, 1],
                        "profile": [["= 0.75 - 2 / cells", -1], ["= 1.25 + 2 / cells", -1],
                                    ["= 1.25 + 2 / cells", 1], ["= 0.75 - 2 / cells", 1]]}}],
  "pins": [{"name": "hub", "shape": {"type": "cylinder", "center": [0, 0, -1], "axis": [0, 0, 1], "radius": 0.75,
                                     "height": 2}},
           {"name": "rim", "shape": {"type": "revolution", "axis": [0, 0, 1],
                                     "profile": [[1.25, -1], [1.75, -1], [1.75, 1], [1.25, 1]]}}],
  "manufactured": {"ring": {"type": "generalized_vortex", "angle": 20}},
  "gravity": {"acceleration": [0, 0, 0]}})json";

constexpr const char* kBox = R"json({"repose": 1, "name": "box", "parameters": {"cells": 32},
  "grid": {"spacing": "= 1 / cells", "precision": "double", "plane_strain": "z",
           "periodic": {"x": {"lower": 0, "length": 1}, "y": {"lower": 0, "length": 1}}},
  "materials": {"gel": {"type": "neo_hookean", "density": 1000, "youngs_modulus": 1e4, "poisson_ratio": 0.3}},
  "bodies": [{"name": "box", "material": "gel", "particles_per_cell": 36,
              "shape": {"type": "box", "lower": [0, 0, -1], "upper": [1, 1, 1]}}],
  "manufactured": {"box": {"type": "axis_aligned", "amplitude": [0.05, -0.05, 0]}},
  "gravity": {"acceleration": [0, 0, 0]}})json";

constexpr double kAmplitude = 0.05;

inline std::string cells(int number) {
  return "parameters.cells=" + std::to_string(number);
}

inline Vec3 turned(const Vec3& X, double angle) {
  return {std::cos(angle) * X[0] - std::sin(angle) * X[1], std::sin(angle) * X[0] + std::cos(angle) * X[1],
          X[2]};
}
inline double share(double radius) {
  const double s = (radius - 1.0) / 0.5;
  return std::abs(s) < 0.5 ? 1.0 - 8.0 * s * s + 16.0 * s * s * s * s : 0.0;
}
inline Vec3 vortex_place(const Vec3& X, double t) {
  return turned(X, pi * std::sin(pi * t) * share(std::hypot(X[0], X[1])));
}
inline Vec3 box_place(const Vec3& X, double t, const Vec3& amplitude, const Elasticity& e) {
  const double now = std::sin(pi * std::sqrt(e.youngs_modulus / e.density) * t);
  Vec3 x = X;
  for (int i = 0; i < 3; ++i) x[i] += amplitude[i] * now * std::sin(2.0 * pi * X[i]);
  return x;
}

using Force = std::function<Vec3(const ManufacturedSolution&, const Vec3&, double, const Elasticity&)>;

/// The pass of the effect with another force, for controls.
template <class Real>
void push_by(const Force& force, const Scene& scene, CompiledScene<Real>& compiled) {
  for (auto& pass : compiled.plan.scatter[0]) {
    if (pass.description.effect != Manufactured::kName) continue;
    pass =
        PassMaker<Real>(compiled.plan.scratch, compiled.plan.tables, &compiled.state.sets[0])
            .over_particles(
                {pass.description.name, pass.description.reason},
                reads(kP2gVelocity, Manufactured::kX, Manufactured::kY, Manufactured::kZ), writes(kP2gVelocity),
                [force, solution = scene.effect<Manufactured>().list[0],
                 e = scene.materials[0].elasticity()](const auto& at) {
                  const auto told = at.write(kP2gVelocity);
                  for (std::size_t p = 0; p < at.count(); ++p) {
                    const Vec3 X(double(at.read(Manufactured::kX)[p]), double(at.read(Manufactured::kY)[p]),
                                 double(at.read(Manufactured::kZ)[p]));
                    const Vec3 b = double(at.dt()) * force(solution, X, at.time(), e);
                    for (std::size_t i = 0; i < 3; ++i)
                      told[i][p] = static_cast<Real>(double(told[i][p]) + b[static_cast<int>(i)]);
                  }
                });
  }
}
struct Clouds {
  PointCloud start, end;
};

/// How a scene moves by `time`; by another force than its own, if one is given.
template <class Real>
Clouds moved(const Scene& scene, double time, const Force& force) {
  auto compiled = compile_scene<Real>(scene, {});
  if (!compiled) throw std::runtime_error(compiled.error().text());
  if (force) push_by(force, scene, *compiled);
  State<Real> state = std::move(compiled->state);
  Stepper<Real> stepper(std::move(compiled->plan), 2);
  const auto points = [&] { return make_points(scene, state, *stepper.plan().kernels); };
  Clouds clouds{points(), {}};
  while (state.counters.time < time - 1e-9) {
    const StepReport step = stepper.step(state, time - state.counters.time);
    EXPECT_TRUE(step.accepted);
    if (!step.accepted) break;
    state.counters.time += step.dt;
  }
  clouds.end = points();
  return clouds;
}

struct Errors {
  double rms = 0.0;       ///< m
  double relative = 0.0;  ///< largest, as a share of the distance from the origin
};

/// Differences from where the formula has each particle; modulo `period`, in the plane.
template <class Place>
Errors errors_of(const Clouds& clouds, Place place, double period = 1e9) {
  Errors errors;
  for (std::size_t p = 0; p < clouds.end.size(); ++p) {
    const auto &from = clouds.start.position[p], &to = clouds.end.position[p];
    const Vec3 expected = place(Vec3(from[0], from[1], from[2]));
    double square = 0.0;
    for (int i = 0; i < 2; ++i) {
      const double away = to[static_cast<std::size_t>(i)] - expected[i];
      square += std::pow(away - period * std::round(away / period), 2);
    }
    errors.rms += square;
    errors.relative = std::max(errors.relative, std::sqrt(square) / std::hypot(from[0], from[1]));
  }
  errors.rms = std::sqrt(errors.rms / static_cast<double>(clouds.end.size()));
  return errors;
}

inline double order(const Errors& coarse, const Errors& fine) {
  return std::log2(coarse.rms / fine.rms);
}

template <class Real>
Errors vortex(const std::vector<std::string>& overrides, const Force& force = nullptr) {
  const auto back = [](const Vec3& X) { return X; };
  return errors_of(moved<Real>(scene_of(kVortex, overrides), 1.0, force), back);
}

/// After a quarter of the period, when all is stretched most, or more quarters.
template <class Real>
Errors box(const std::vector<std::string>& overrides, int quarters, const Force& force = nullptr) {
  const Scene scene = scene_of(kBox, overrides);
  const Elasticity e = scene.materials[0].elasticity();
  const double time = 0.5 * quarters / std::sqrt(e.youngs_modulus / e.density);
  const auto place = [&](const Vec3& X) { return box_place(X, time, {kAmplitude, -kAmplitude, 0.0}, e); };
  return errors_of(moved<Real>(scene, time, force), place, 1.0);
}

inline const Force kNone = [](const ManufacturedSolution&, const Vec3&, double, const Elasticity&) -> Vec3 {
  return Vec3::Zero();
};

}  // namespace repose::manufactured
