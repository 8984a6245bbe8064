#include "engine/compiler/integrator.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "engine/base/costs.h"
#include "engine/compiler/compilation.h"

namespace repose {
namespace {

/// How far below a point a solid lies along `down`, m; 0 where it lies elsewhere. Distances never exceed the
/// true ones, so no step of the way passes through it.
double way_down_to(const Solid& solid, const Vec3& x, const Vec3& down, double near) {
  double way = 0.0;
  for (int k = 0; k < 64; ++k) {
    const double distance = solid.distance(x + way * down);
    if (distance < near) return way;
    way += distance;
  }
  return 0.0;
}

/// The corners of a box.
std::array<Vec3, 8> corners(const Bounds& box) {
  std::array<Vec3, 8> all;
  for (std::size_t k = 0; k < all.size(); ++k) {
    for (int axis = 0; axis < 3; ++axis)
      all[k][axis] = (k >> axis & 1u) != 0 ? box.upper[axis] : box.lower[axis];
  }
  return all;
}

void enclose(const Bounds& more, Bounds& box) {
  box.lower = box.lower.cwiseMin(more.lower);
  box.upper = box.upper.cwiseMax(more.upper);
}

/// The box of all that is there or will begin, m; none where that is nothing.
template <class Real>
Bounds box_of_material(const Compilation<Real>& compilation, const State<Real>& state) {
  Bounds box;
  for_each_particle(state, [&](const auto&, std::size_t, const Vec3& x) { enclose({x, x}, box); });
  for (const AskedEffect<Real>& asked : compilation.effects) enclose(asked.effect->mouths(), box);
  return box;
}

/// How far something may fall at most, m: from the top of the material to the foot of the material, of what
/// solid lies below it, and of solids that end somewhere.
double height_of_fall(const Bounds& box, const std::vector<Solid>& solids, const Vec3& down, double spacing) {
  if (!(box.lower.array() <= box.upper.array()).all()) return 0.0;
  double top = std::numeric_limits<double>::infinity(), foot = -top;
  for (const Vec3& corner : corners(box)) {
    top = std::min(top, corner.dot(down));
    foot = std::max(foot, corner.dot(down));
  }
  for (const Solid& solid : solids_at(solids, 0.0)) {
    const Bounds bounds = solid.shape->bounds();
    const bool ends = bounds.lower.allFinite() && bounds.upper.allFinite();
    for (const Vec3& corner : corners(ends ? bounds : box)) {
      const double way = ends ? 0.0 : way_down_to(solid, corner, down, spacing);
      foot = std::max(foot, corner.dot(down) + way);
    }
  }
  return foot - top;
}

/// The largest speed that something may come to, m/s, as far as that can be known.
template <class Real>
double expected_speed(const Compilation<Real>& compilation, const State<Real>& state) {
  const Bounds box = box_of_material(compilation, state);
  double speed = state.counters.max_speed;
  for (const Inlet& inlet : inlets(compilation.scene)) speed = std::max(speed, inlet.speed);
  const Vec3 gravity = compilation.surroundings.gravity;
  if (const double g = gravity.norm(); g > 0.0) {
    const double height = height_of_fall(box, compilation.surroundings.solids, gravity / g, state.spacing);
    speed = std::sqrt(speed * speed + 2.0 * g * height);
  }
  const Vec3 block = kBlockSide * state.spacing * Vec3::Ones();  // how far nodes reach beyond particles
  for (const AskedEffect<Real>& asked : compilation.effects)
    speed = std::max(speed, asked.effect->top_speed({box.lower - block, box.upper + block}));
  return speed;
}

/// The frame that spans most of the scene's time, s, were there frames without end: how many there are must
/// not matter.
double longest_frame(const TimeDescription& time) {
  double scale = time.scale.empty() ? 1.0 : 0.0;
  for (const auto& key : time.scale) scale = std::max(scale, key[1]);
  return scale / time.frames_per_second;
}

template <class Real>
StepForecast forecast(const Compilation<Real>& compilation, const State<Real>& state) {
  const Scene& scene = compilation.scene;
  StepForecast forecast;
  forecast.frame = longest_frame(scene.time);
  forecast.speed = expected_speed(compilation, state);
  Counters counters = state.counters;
  counters.max_speed = forecast.speed;
  const TransferChoice transfer = transfer_choice(scene);
  StepLimits limits = step_limits(scene);
  forecast.implicit_step = choose_step(limits, transfer, state.spacing, counters, forecast.frame);
  for (const auto& set : state.sets)
    limits.sets.push_back(stiffness_of(material_of(scene, set.material).elasticity()));
  limits.acceleration = compilation.surroundings.gravity.norm();
  forecast.explicit_step = choose_step(limits, transfer, state.spacing, counters, forecast.frame);
  forecast.explicit_cost = step_cost(scene);
  forecast.effects_cost = effects_cost(scene);
  return forecast;
}

/// "27 ns", "3.1 us".
std::string time_text(double nanoseconds) {
  const char* unit = "ns";
  for (const char* longer : {"us", "ms", "s"}) {
    if (nanoseconds < 1000.0) break;
    nanoseconds *= 1e-3;
    unit = longer;
  }
  char text[32];
  std::snprintf(text, sizeof text, "%.3g %s", nanoseconds, unit);
  return text;
}

/// "412 steps per frame (sound) at 27 ns are 11 us per particle".
std::string frame_text(const StepSize& step, double steps, double nanoseconds) {
  char text[96];
  std::snprintf(text, sizeof text, "%.0f step%s per frame (%s) at ", steps, steps > 1.0 ? "s" : "",
                limit_name(step.limit));
  return text + time_text(nanoseconds) + " are " + time_text(steps * nanoseconds) + " per particle";
}

}  // namespace

IntegratorChoice cheaper_integrator(const StepForecast& forecast, std::span<const ImplicitCost> costs) {
  const StepSize &small = forecast.explicit_step, &large = forecast.implicit_step;
  const double many = std::round(forecast.frame / small.dt), few = std::round(forecast.frame / large.dt);
  const double dear = implicit_cost(costs, large.dt / small.dt) + forecast.effects_cost;
  IntegratorChoice choice;
  choice.implicit = few * dear < many * forecast.explicit_cost;
  choice.step = choice.implicit ? large.dt : small.dt;
  choice.nanoseconds = choice.implicit ? dear : forecast.explicit_cost;
  char speed[48];
  std::snprintf(speed, sizeof speed, "; at up to %.3g m/s", forecast.speed);
  choice.reason = "explicit: " + frame_text(small, many, forecast.explicit_cost) +
                  "; implicit: " + frame_text(large, few, dear) + speed +
                  "; cheaper: " + (choice.implicit ? "implicit" : "explicit");
  return choice;
}

template <class Real>
IntegratorChoice choose_integrator(const Compilation<Real>& compilation, const State<Real>& state,
                                   const char* explicit_only) {
  const Integrator asked = compilation.scene.time.integrator;
  const auto given = compilation.options.implicit_costs;
  const std::span<const ImplicitCost> costs = given.empty() ? std::span(kImplicitCosts) : given;
  IntegratorChoice choice;
  choice.reason = asked == Integrator::kAuto && explicit_only != nullptr
                      ? "the key '" + std::string(explicit_only) + "' goes with explicit steps only"
                      : "as time.integrator says";
  if (asked == Integrator::kExplicit || (asked == Integrator::kAuto && explicit_only != nullptr)) return choice;
  const StepForecast forecast = repose::forecast(compilation, state);
  if (asked == Integrator::kAuto) return cheaper_integrator(forecast, costs);
  choice.implicit = true;
  choice.step = forecast.implicit_step.dt;
  choice.nanoseconds = implicit_cost(costs, choice.step / forecast.explicit_step.dt) + forecast.effects_cost;
  return choice;
}

template IntegratorChoice choose_integrator(const Compilation<float>&, const State<float>&, const char*);
template IntegratorChoice choose_integrator(const Compilation<double>&, const State<double>&, const char*);

}  // namespace repose
