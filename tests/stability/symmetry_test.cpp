// Repose tests: a scene that is mirrored, or turned by a quarter, does the same. Blocks, colours and the order
// of sums do not turn along, so that bits differ: by no more than rounding in one step, by no more than seeds
// do in what is measured of a run.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "engine/compiler/compilation.h"
#include "engine/compiler/compiler.h"
#include "engine/plan/frame_clock.h"
#include "engine/state/block_sort.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

std::string text(const Vec3& v) {
  char numbers[120];
  std::snprintf(numbers, sizeof numbers, "[%.17g, %.17g, %.17g]", v[0], v[1], v[2]);
  return numbers;
}

std::string box(const Mat3& turn, const Vec3& a, const Vec3& b) {
  const Vec3 p = turn * a, q = turn * b;
  return R"({"type": "box", "lower": )" + text(p.cwiseMin(q)) + R"(, "upper": )" + text(p.cwiseMax(q)) + "}";
}

/// Sand and rubber that fall on a floor, against a wall and over a ball, turned.
Scene turned_scene(const Mat3& turn, const std::vector<std::string>& overrides) {
  const std::string words =
      R"({"repose": 1, "name": "turned", "grid": {"spacing": 0.015625}, "time": {"max_step": 1e-4},
    "materials": {"sand": {"type": "drucker_prager"}, "gel": {"type": "elastic", "youngs_modulus": 3e5}},
    "bodies": [{"name": "sand", "material": "sand", "velocity": )" +
      text(turn * Vec3(0.7, -1, 0.3)) + R"(, "shape": )" +
      box(turn, Vec3(-0.09375, 0, -0.125), Vec3(0.09375, 0.125, 0.0625)) +
      R"(}, {"name": "gel", "material": "gel", "velocity": )" + text(turn * Vec3(-0.5, -1, 0.2)) +
      R"(, "shape": )" + box(turn, Vec3(0.109375, 0.03125, -0.0625), Vec3(0.1875, 0.109375, 0.0625)) +
      R"(}], "colliders": [{"name": "floor", "friction": 0.4, "shape": {"type": "plane", "normal": )" +
      text(turn * Vec3(0, 1, 0)) +
      R"(}}, {"name": "wall", "contact": "slip", "shape": {"type": "plane", "point": )" +
      text(turn * Vec3(0.2, 0, 0)) + R"(, "normal": )" + text(turn * Vec3(-1, 0, 0)) +
      R"(}}, {"name": "ball", "friction": 0.2, "shape": {"type": "sphere", "radius": 0.05, "center": )" +
      text(turn * Vec3(0.01, 0.01, 0.02)) + R"(}}], "gravity": {"acceleration": )" +
      text(turn * Vec3(0, -9.81, 0)) + "}}";
  return scene_of(words, overrides);
}

/// A particle in the scene's frame.
struct Particle {
  Vec3 position, velocity;  ///< cells, m/s
  Mat3 affine, strain;      ///< 1/s, 1

  Particle turned(const Mat3& turn) const {
    return {turn * position, turn * velocity, turn * affine * turn.transpose(),
            turn * strain * turn.transpose()};
  }
};

/// Per set, by id.
using Particles = std::vector<std::map<std::uint32_t, Particle>>;

constexpr int kRow[6] = {0, 0, 0, 1, 1, 2}, kColumn[6] = {0, 1, 2, 1, 2, 2};  // of strain

template <class Real>
Particles particles_of(const State<Real>& state) {
  Particles all(state.sets.size());
  for_each_particle(state, [&](const ParticleSet<Real>& set, std::size_t p, const Vec3& x) {
    Particle particle;
    particle.position = x / state.spacing;
    for (std::size_t i = 0; i < 3; ++i) {
      particle.velocity[static_cast<int>(i)] = double(set.velocity[i][p]);
      for (std::size_t j = 0; j < 3; ++j)
        particle.affine(static_cast<int>(i), static_cast<int>(j)) = double(set.affine[3 * i + j][p]);
    }
    for (std::size_t k = 0; k < 6; ++k) {
      particle.strain(kRow[k], kColumn[k]) = particle.strain(kColumn[k], kRow[k]) = double(set.strain[k][p]);
    }
    all[static_cast<std::size_t>(&set - state.sets.data())][set.id[p]] = particle;
  });
  return all;
}

/// Puts these in the place of a state's own.
template <class Real>
void put(const Particles& particles, const Ownership& ownership, State<Real>& state) {
  std::vector<std::vector<Index3>> cells(state.sets.size());
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    ParticleSet<Real>& set = state.sets[k];
    set.allocate(particles[k].size());
    cells[k].resize(set.count);
    std::size_t p = 0;
    for (const auto& [id, particle] : particles[k]) {
      set.id[p] = id;
      for (std::size_t i = 0; i < 3; ++i) {
        const double x = particle.position[static_cast<int>(i)];
        cells[k][p][i] = static_cast<std::int32_t>(std::floor(x));
        set.position[i][p] = static_cast<Real>(x - std::floor(x));
        set.velocity[i][p] = static_cast<Real>(particle.velocity[static_cast<int>(i)]);
        for (std::size_t j = 0; j < 3; ++j)
          set.affine[3 * i + j][p] =
              static_cast<Real>(particle.affine(static_cast<int>(i), static_cast<int>(j)));
      }
      for (std::size_t n = 0; n < 6; ++n)
        set.strain[n][p] = static_cast<Real>(particle.strain(kRow[n], kColumn[n]));
      ++p;
    }
  }
  place_in_blocks(state, std::move(cells), ownership);
}

/// A step of these particles in the turned scene.
template <class Real>
Particles after_a_step(const Scene& scene, const Particles& start) {
  auto compiled = compile_scene<Real>(scene, {});
  if (!compiled) throw std::runtime_error(compiled.error().text());
  State<Real> state = std::move(compiled->state);
  put(start, transfer_choice(scene).ownership(), state);
  state.counters.max_speed = 3.0;
  Stepper<Real> stepper(std::move(compiled->plan), 2);
  const StepReport step = stepper.step(state, std::numeric_limits<double>::infinity());
  EXPECT_TRUE(step.accepted);
  EXPECT_EQ(step.dt, 1e-4);
  return particles_of(state);
}

/// What a run comes to, positions cut to fractions of a cell that a turn does not round.
template <class Real>
Particles under_way(const std::vector<std::string>& overrides) {
  const Scene scene = turned_scene(Mat3::Identity(), overrides);
  auto compiled = compile_scene<Real>(scene, {});
  if (!compiled) throw std::runtime_error(compiled.error().text());
  State<Real> state = std::move(compiled->state);
  Stepper<Real> stepper(std::move(compiled->plan), 2);
  for (int k = 0; k < 200; ++k) {
    const StepReport step = stepper.step(state, std::numeric_limits<double>::infinity());
    EXPECT_TRUE(step.accepted);
    FrameClock::advance_freely(state.counters, step.dt);
  }
  Particles all = particles_of(state);
  for (auto& set : all) {
    for (auto& [id, particle] : set) {
      for (int i = 0; i < 3; ++i) particle.position[i] = std::round(particle.position[i] * 4096.0) / 4096.0;
    }
  }
  return all;
}

struct Difference {
  double velocity = 0.0, position = 0.0, strain = 0.0;  ///< in eps: over the largest, of a cell, of one
};

template <class Real>
Difference difference(const Mat3& turn, const std::vector<std::string>& overrides) {
  const Particles start = under_way<Real>(overrides);
  Particles turned_start = start;
  for (auto& set : turned_start) {
    for (auto& [id, particle] : set) particle = particle.turned(turn);
  }
  const Particles plain = after_a_step<Real>(turned_scene(Mat3::Identity(), overrides), start);
  const Particles turned = after_a_step<Real>(turned_scene(turn, overrides), turned_start);
  constexpr double kEps = std::numeric_limits<Real>::epsilon();
  Difference worst;
  double speed = 0.0;
  for (std::size_t k = 0; k < plain.size(); ++k) {
    EXPECT_EQ(plain[k].size(), turned[k].size());
    for (const auto& [id, particle] : plain[k]) {
      const Particle expected = particle.turned(turn);
      const Particle& found = turned[k].at(id);
      speed = std::max(speed, particle.velocity.norm());
      worst.velocity = std::max(worst.velocity, (found.velocity - expected.velocity).norm() / kEps);
      worst.position = std::max(worst.position, (found.position - expected.position).norm() / kEps);
      worst.strain = std::max(worst.strain, (found.strain - expected.strain).norm() / kEps);
    }
  }
  worst.velocity /= speed;
  return worst;
}

Mat3 mirror() {
  return Vec3(-1, 1, 1).asDiagonal();
}
Mat3 quarter_about(int axis) {
  const int i = (axis + 1) % 3, j = (axis + 2) % 3;
  Mat3 turn = Mat3::Zero();
  turn(axis, axis) = turn(j, i) = 1.0;
  turn(i, j) = -1.0;
  return turn;
}

template <class Real>
void expect_same_step(battery::Case& result, const std::string& real,
                      const std::vector<std::string>& overrides) {
  const std::pair<const char*, Mat3> turns[] = {
      {"mirrored", mirror()}, {"turned about y", quarter_about(1)}, {"turned about z", quarter_about(2)}};
  for (const auto& [name, turn] : turns) {
    const Difference worst = difference<Real>(turn, overrides);
    const std::string what = real + ", " + name + ": ";
    result.at_most(what + "velocity after a step, over the largest", worst.velocity, 16.0, "eps");
    result.at_most(what + "position, of a cell", worst.position, 16.0, "eps");
    result.at_most(what + "strain", worst.strain, 16.0, "eps");
  }
}

TEST(Battery, Case35_MirroredAndTurnedScene_StepsTheSame) {
  battery::Case result(35, "mirrored and turned: a step");
  expect_same_step<float>(result, "float", {});
  expect_same_step<double>(result, "double", {"grid.precision=double"});
}

TEST(Battery, Case35_OtherScene_IsTold) {
  const Particles start = under_way<double>({"grid.precision=double"});
  const Particles plain =
      after_a_step<double>(turned_scene(Mat3::Identity(), {"grid.precision=double"}), start);
  const Particles other = after_a_step<double>(
      turned_scene(Mat3::Identity(), {"grid.precision=double", "colliders.floor.friction=0.4001"}), start);
  double worst = 0.0;
  for (const auto& [id, particle] : plain[0])
    worst = std::max(worst, (other[0].at(id).velocity - particle.velocity).norm());
  battery::Case result(35, "mirrored and turned, control");
  result.at_least("friction by 1e-4 more: velocity", worst / std::numeric_limits<double>::epsilon(), 1600.0,
                  "eps");
}

/// How far a column runs, over its width: towards +x, -x, or +z.
double run_out(const Mat3& turn, int seed) {
  const Vec3 flat = turn * Vec3(0, 0, 1);
  const std::string axis = std::abs(flat[2]) > 0.5 ? "z" : "x";
  const Vec3 thick(0, 0, 1);
  const std::string words =
      R"({"repose": 1, "name": "column", "grid": {"spacing": 0.01, "plane_strain": ")" + axis + R"("},
    "materials": {"sand": {"type": "drucker_prager", "friction_angle": 30, "cone_matching": "plane_strain"}},
    "bodies": [{"name": "c", "material": "sand", "particles_per_cell": 4, "seed": )" +
      std::to_string(seed) + R"(, "shape": )" + box(turn, Vec3(0, 0, 0) - thick, Vec3(0.1, 0.2, 0) + thick) +
      R"(}], "colliders": [{"name": "floor", "friction": 0.577, "shape": {"type": "plane"}},
    {"name": "wall", "contact": "slip", "shape": {"type": "plane", "normal": )" +
      text(turn * Vec3(1, 0, 0)) + "}}]}";
  const auto simulation = simulate(scene_of(words));
  EXPECT_TRUE(run_until(*simulation, 0.5));
  std::vector<double> way;
  for (const auto& x : simulation->points().position)
    way.push_back((turn.transpose() * Vec3(x[0], x[1], x[2]))[0]);
  std::sort(way.begin(), way.end());
  return way[static_cast<std::size_t>(0.99 * static_cast<double>(way.size() - 1))] / 0.1 - 1.0;
}

TEST(Battery, Case35_MirroredAndTurnedColumn_RunsAsFarWithinSeeds) {
  battery::Case result(35, "mirrored and turned: a column's run-out");
  constexpr int kSeeds = 5;
  const auto runs = [](const Mat3& turn) {
    std::vector<double> all;
    for (int seed = 1; seed <= kSeeds; ++seed) all.push_back(run_out(turn, seed));
    return all;
  };
  const auto mean = [](const std::vector<double>& all) {
    double sum = 0.0;
    for (const double x : all) sum += x / static_cast<double>(all.size());
    return sum;
  };
  const std::vector<double> plain = runs(Mat3::Identity());
  const auto [least, most] = std::minmax_element(plain.begin(), plain.end());
  report("run_out", mean(plain));
  report("run_out_spread", *most - *least);
  for (const auto& [name, turn] :
       {std::pair{"mirrored", mirror()}, std::pair{"turned about y", quarter_about(1)}}) {
    result.at_most(std::string(name) + ": mean of five seeds, over the spread of seeds",
                   std::abs(mean(runs(turn)) - mean(plain)) / (*most - *least), 1.0);
  }
}

}  // namespace
}  // namespace repose
