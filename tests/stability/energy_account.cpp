#include "tests/stability/energy_account.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace repose::stability {

EnergyAccount::EnergyAccount(const Scene& scene, Simulation& simulation)
    : simulation_(simulation), gravity_(scene.effect<Gravity>().acceleration) {
  const auto& probes = scene.effect<Probes>().list;
  judged_ = !probes.empty() && probes[0].type == ProbeDescription::Type::kEnergy &&
            kStencilFigures[static_cast<std::size_t>(scene.grid.stencil)].constant_d;
  for (int axis = 0; axis < 3; ++axis) {
    if (scene.grid.periodic[static_cast<std::size_t>(axis)].length > 0.0 && gravity_[axis] != 0.0)
      judged_ = false;
  }
  sources_ = scene.effect<Emitters>().on() || scene.effect<Sinks>().on();
  const double fall = std::sqrt(2.0 * gravity_.norm() * scene.grid.spacing);
  for (const Emitter& emitter : scene.effect<Emitters>().list) {
    const double speed = emitter.type == Emitter::Type::kVolume ? emitter.velocity.norm() : emitter.speed;
    emitted_speed_ = std::max(emitted_speed_, speed * (1.0 + emitter.spread) + fall);
  }
  allowed_ = simulation.integrator().implicit ? 1e-4 : 1e-2;
  if (!judged_) return;
  last_ = sums();
  first_ = last_.all();
  first_motion_ = first_ - last_.potential;
  look_at_extent();
  count_sources(0.0);
  given_ = moved_ = 0.0;
  finite_ = std::isfinite(first_);
}

EnergyAccount::Sums EnergyAccount::sums() const {
  std::map<std::string, double> found;
  for (const Measurement& figure : simulation_.measurements()) {
    if (found.count(figure.quantity) == 0) found[figure.quantity] = figure.value;
  }
  return {found["kinetic"], found["affine"], found["elastic"], found["potential"], found["work_of_solids"]};
}

void EnergyAccount::look_at_extent() {
  const Diagnostics now = simulation_.diagnose();
  if (now.particles == 0 || gravity_.norm() == 0.0) return;
  const Vec3 along = gravity_.normalized();
  double low = 0.0, high = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double a = along[static_cast<int>(axis)] * now.lower[axis],
                 b = along[static_cast<int>(axis)] * now.upper[axis];
    low += std::min(a, b);
    high += std::max(a, b);
  }
  low_ = extent_known_ ? std::min(low_, low) : low;
  high_ = extent_known_ ? std::max(high_, high) : high;
  extent_known_ = true;
}

void EnergyAccount::count_sources(double dt) {
  if (!sources_) return;
  const PointCloud points = simulation_.points({{}, true});
  std::map<std::uint32_t, Seen> now;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const Vec3 x(points.position[p][0], points.position[p][1], points.position[p][2]);
    const Vec3 v(points.velocity[p][0], points.velocity[p][1], points.velocity[p][2]);
    const double mass = points.mass[p], potential = -mass * gravity_.dot(x),
                 kinetic = 0.5 * mass * v.squaredNorm();
    now[points.id[p]] = {kinetic + potential};
    if (seen_.erase(points.id[p]) > 0) continue;
    const double begun = 0.5 * mass * emitted_speed_ * emitted_speed_;
    given_ += std::max(kinetic, begun) + potential + mass * gravity_.norm() * emitted_speed_ * dt;
    moved_ += std::max(kinetic, begun);
  }
  for (const auto& [id, gone] : seen_) given_ -= gone.energy;
  seen_ = std::move(now);
}

void EnergyAccount::weigh() {
  last_ = sums();
  const double now = last_.all();
  finite_ = finite_ && std::isfinite(now);
  const LedgerReport ledger = simulation_.ledger();
  const double weight = (ledger.held.mass + ledger.removed.mass) * gravity_.norm() * (high_ - low_);
  const double work = past_work_ + last_.work;
  const double scale = std::max({first_motion_, weight, std::abs(work), moved_});
  const double surplus = now - first_ - work - given_;
  const double share = surplus <= 0.0 ? 0.0
                       : scale > 0.0  ? surplus / scale
                                      : std::numeric_limits<double>::infinity();
  worst_ = std::max(worst_, share);
}

void EnergyAccount::after_step(double dt) {
  if (!judged_) return;
  count_sources(dt);
  look_at_extent();
  weigh();
}

void EnergyAccount::after_frame() {
  if (!judged_) return;
  count_sources(0.0);
  look_at_extent();
  weigh();
  past_work_ += last_.work;
  last_.work = 0.0;
}

std::string EnergyAccount::text() const {
  char text[320];
  std::snprintf(text, sizeof text,
                "surplus %.3g of the scale, allowed %.0e (first %.3g J in motion and strain; now kinetic %.3g, "
                "affine %.3g, "
                "elastic %.3g J; work of solids %.3g, sources %.3g J)",
                worst_, allowed_, first_motion_, last_.kinetic, last_.affine, last_.elastic,
                past_work_ + last_.work, given_);
  return text;
}

}  // namespace repose::stability
