// Repose tests: the battery: units do not matter. A scene in other metres, kilograms and seconds is the same
// scene: to the last bit where the units differ by powers of two, and by no more than rounding where they
// differ by a thousand.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

constexpr double kSpacing = 0.0247;  // m

/// How many of the new units the old ones are.
struct Units {
  double length = 1.0, mass = 1.0, time = 1.0;
};

std::string text(double value) {
  char buffer[40];
  std::snprintf(buffer, sizeof buffer, "%.17g", value);
  return buffer;
}

std::string list(const std::vector<double>& values, double unit) {
  std::string all = "[";
  for (const double value : values) all += (all.size() > 1 ? "," : "") + text(value * unit);
  return all + "]";
}

/// Sand falls onto an elastic block and a floor that slides below, past a ball that turns, with a spout; every
/// number that has a unit is scaled.
Scene scene_in(const Units& u, const std::vector<std::string>& overrides) {
  const double speed = u.length / u.time, pressure = u.mass / (u.length * u.time * u.time),
               density = u.mass / (u.length * u.length * u.length);
  const auto l = [&](std::vector<double> v) { return list(v, u.length); };
  const auto v = [&](std::vector<double> w) { return list(w, speed); };
  const auto material = [&](const char* type, double rho, double modulus) {
    return std::string(R"({"type": ")") + type + R"(", "density": )" + text(rho * density) +
           R"(, "youngs_modulus": )" + text(modulus * pressure) + R"(, "poisson_ratio": 0.3})";
  };
  return scene_of(R"({"repose": 1, "name": "units", "grid": {"spacing": )" + text(kSpacing * u.length) +
                      R"(, "velocity_loss": )" + text(10.0 / u.time) + R"(}, "time": {"frames_per_second": )" +
                      text(24.0 / u.time) + R"(, "max_step": )" + text(0.002 * u.time) +
                      R"(}, "materials": {"sand": )" + material("drucker_prager", 1600, 4e5) + R"(, "gel": )" +
                      material("elastic", 900, 2e5) + R"(, "rubber": )" + material("neo_hookean", 1100, 3e5) +
                      R"(}, "bodies": [
    {"name": "rain", "material": "sand", "velocity": )" +
                      v({0.5, -3, 0.2}) + R"(,
     "shape": {"type": "sphere", "center": )" +
                      l({0.0203, 0.2011, 0.0107}) + R"(, "radius": )" + text(0.0713 * u.length) +
                      R"(}},
    {"name": "block", "material": "gel", "angular_velocity": )" +
                      list({0, 3, 0}, 1.0 / u.time) + R"(,
     "shape": {"type": "box", "lower": )" +
                      l({-0.0903, 0.0017, -0.0911}) + R"(, "upper": )" + l({0.0907, 0.1013, 0.0931}) +
                      R"(}},
    {"name": "cube", "material": "rubber",
     "shape": {"type": "box", "lower": )" +
                      l({0.2003, 0.0017, -0.0311}) + R"(, "upper": )" + l({0.2507, 0.0513, 0.0331}) +
                      R"(}}],
  "gravity": {"acceleration": )" +
                      list({0, -9.81, 0}, speed / u.time) + R"(},
  "emitters": [{"name": "spout", "material": "sand", "type": "disc", "center": )" +
                      l({-0.2, 0.2, 0}) + R"(, "normal": [0, -1, 0], "radius": )" + text(0.0307 * u.length) +
                      R"(, "speed": )" + text(2.0 * speed) + R"(}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.6,
     "motion": {"keys": [{"time": 0}, {"time": )" +
                      text(u.time) + R"(, "translation": )" + l({0.5, 0, 0.2}) + R"(}]}},
    {"name": "ball", "friction": 0.3, "shape": {"type": "sphere", "center": )" +
                      l({0.1501, 0.0607, 0}) + R"(, "radius": )" + text(0.0611 * u.length) + R"(},
     "motion": {"pivot": )" +
                      l({0.1, 0, 0}) + R"(, "keys": [{"time": 0}, {"time": )" + text(u.time) +
                      R"(, "rotation_angle": 90}]}}]})",
                  overrides);
}

/// The largest differences of two clouds, of which the second is in other units; shares of a cell and of the
/// fastest speed.
struct Difference {
  double particles = 0.0, position = 0.0, velocity = 0.0, strain = 0.0;
};

Difference difference(const PointCloud& a, const PointCloud& b, const Units& u, double spacing) {
  Difference d;
  d.particles = std::abs(static_cast<double>(a.size()) - static_cast<double>(b.size()));
  if (d.particles > 0.0) return d;
  double fastest = 0.0;
  for (const auto& v : a.velocity)
    fastest = std::max(fastest, std::hypot(double(v[0]), double(v[1]), double(v[2])));
  for (std::size_t p = 0; p < a.size(); ++p) {
    d.particles += a.id[p] == b.id[p] ? 0.0 : 1.0;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      d.position =
          std::max(d.position, std::abs(b.position[p][axis] / u.length - a.position[p][axis]) / spacing);
      const double v = static_cast<double>(b.velocity[p][axis]) * u.time / u.length;
      d.velocity = std::max(d.velocity, std::abs(v - static_cast<double>(a.velocity[p][axis])) / fastest);
    }
  }
  const auto &e = a.attributes.back().values, &f = b.attributes.back().values;
  EXPECT_EQ(e.size(), 6 * a.size());
  for (std::size_t k = 0; k < e.size(); ++k)
    d.strain = std::max(d.strain, std::abs(double(e[k]) - double(f[k])));
  return d;
}

Difference after(int steps, const Units& u, const std::vector<std::string>& overrides) {
  const auto here = simulate(scene_in({}, overrides)), there = simulate(scene_in(u, overrides));
  EXPECT_TRUE(run_steps(*here, steps));
  EXPECT_TRUE(run_steps(*there, steps));
  const PointsWanted wanted{{OutputAttribute::kElasticStrain}};
  EXPECT_NEAR(there->counters().time, here->counters().time * u.time, 1e-5 * there->counters().time);
  EXPECT_GT(here->diagnose().elastic_energy, 0.0) << "there is something to compare";
  return difference(here->points(wanted), there->points(wanted), u, kSpacing);
}

const std::vector<std::vector<std::string>> kKinds{
    {"grid.precision=single"},
    {"grid.precision=double"},
    {"grid.precision=single", "grid.stencil=cubic", "grid.transfer=aflip"},
    {"grid.precision=double", "grid.transfer=rpic"},
    // Converged, so that rounding does not decide when a solve is good enough.
    {"grid.precision=double", "time.integrator=implicit", "implicit.tolerance=1e-9"},
};

std::string name_of(const std::vector<std::string>& kind) {
  std::string name;
  for (const std::string& word : kind) name += (name.empty() ? "" : " ") + word.substr(word.find('=') + 1);
  return name;
}

bool implicit(const std::vector<std::string>& kind) {
  return kind.size() > 1 && kind[1] == "time.integrator=implicit";
}

TEST(Battery, Rescaling_ByPowersOfTwoIsExact) {
  battery::Case c(50, "other units");
  for (const auto& kind : kKinds) {
    double worst = 0.0;
    std::vector<Units> all{{0x1p-8, 0x1p10, 0x1p-5}, {0x1p9, 1, 1}, {1, 0x1p-12, 1}, {1, 1, 0x1p7}};
    if (implicit(kind)) all.resize(1);
    for (const Units& u : all) {
      const Difference d = after(implicit(kind) ? 5 : 60, u, kind);
      worst = std::max({worst, d.particles, d.position, d.velocity, d.strain});
    }
    c.at_most("by powers of two, " + name_of(kind), worst, 0.0);
  }
}

TEST(Battery, Rescaling_ByAThousandIsRounding) {
  battery::Case c(50, "other units");
  for (const auto& kind : kKinds) {
    Difference worst;
    std::vector<Units> all{{1e-3, 1e3, 1e-3}, {1e3, 1, 1}, {1, 1e-3, 1}, {1, 1, 1e3}};
    if (implicit(kind)) all.resize(1);
    for (const Units& u : all) {
      const Difference d = after(10, u, kind);
      worst.particles = std::max(worst.particles, d.particles);
      worst.position = std::max(worst.position, d.position);
      worst.velocity = std::max(worst.velocity, d.velocity);
      worst.strain = std::max(worst.strain, d.strain);
    }
    const std::string by = "by a thousand, 10 steps, " + name_of(kind) + ", ";
    c.at_most(by + "particles", worst.particles, 0.0);
    c.at_most(by + "places in cells", worst.position, 1e-5);
    c.at_most(by + "velocities of the fastest", worst.velocity, 1e-5);
    c.at_most(by + "strains", worst.strain, 1e-5);
  }
}

}  // namespace
}  // namespace repose
