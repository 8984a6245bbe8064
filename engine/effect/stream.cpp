#include "engine/effect/stream.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

#include "engine/geometry/seed_lattice.h"

namespace repose {
namespace {

/// Random numbers of one particle, by (seed, serial): equal on every machine.
class Draw {
 public:
  Draw(std::uint64_t seed, std::uint64_t serial) : state_(mix(mix(seed) ^ serial)) {}
  std::uint64_t bits() { return mix(state_ + next_++); }
  /// In (0, 1).
  double number() { return (static_cast<double>(bits() >> 12) + 0.5) * 0x1p-52; }
  /// In the unit ball; with a flat axis, in its section.
  Vec3 in_ball(int flat_axis) {
    for (;;) {
      Vec3 u;
      for (int axis = 0; axis < 3; ++axis) u[axis] = axis == flat_axis ? 0.0 : 2.0 * number() - 1.0;
      if (u.squaredNorm() <= 1.0) return u;
    }
  }

 private:
  std::uint64_t state_, next_ = 0;
};

struct Mouth {
  Vec3 side[2];  // m, half sides
  double area;   // m^2
};

/// The half sides of the square around a disc, or of a rectangle. In plane strain the second is along the flat
/// axis, half a cell.
Mouth mouth_of(const Emitter& emitter, double spacing, int flat_axis) {
  const Vec3 n = emitter.normal.normalized();
  const bool disc = emitter.type == Emitter::Type::kDisc;
  Vec3 first = disc ? n.unitOrthogonal() : Vec3(emitter.direction - emitter.direction.dot(n) * n).normalized();
  double half[2] = {disc ? emitter.radius : emitter.half_width, disc ? emitter.radius : emitter.half_depth};
  if (flat_axis >= 0) {
    const Vec3 flat = Vec3::Unit(flat_axis);
    const bool along_flat = !disc && std::abs(first[flat_axis]) > 0.5;
    first = flat.cross(n);
    half[0] = half[along_flat ? 1 : 0];
    half[1] = 0.5 * spacing;
  }
  const double square = 4.0 * half[0] * half[1];
  return {{half[0] * first, half[1] * n.cross(first)},
          disc && flat_axis < 0 ? 0.25 * std::numbers::pi * square : square};
}

/// The square [-1, 1]^2 on the unit disc, equal areas on equal areas (Shirley and Chiu 1997).
void square_to_disc(double& a, double& b) {
  if (a == 0.0 && b == 0.0) return;
  const bool wide = std::abs(a) > std::abs(b);
  const double r = wide ? a : b, quarter = 0.25 * std::numbers::pi;
  const double angle = wide ? quarter * (b / a) : 2.0 * quarter - quarter * (a / b);
  a = r * std::cos(angle);
  b = r * std::sin(angle);
}

}  // namespace

std::uint64_t Flow::count(double time) const {
  const double crossed = std::floor((std::min(time, end) - start) * rate + 0.5);
  return crossed > 0.0 ? static_cast<std::uint64_t>(std::min(crossed, static_cast<double>(most))) : 0;
}

Flow flow_of(const Emitter& emitter, double spacing, int flat_axis) {
  Flow flow;
  flow.start = emitter.start;
  flow.end = emitter.end;
  flow.particle_volume = spacing * spacing * spacing / static_cast<double>(emitter.particles_per_cell);
  const bool volume = emitter.type == Emitter::Type::kVolume;
  const bool host = emitter.type == Emitter::Type::kHost;
  const double per_second = host     ? 0.0
                            : volume ? emitter.rate
                                     : emitter.speed * mouth_of(emitter, spacing, flat_axis).area;
  flow.rate = per_second / flow.particle_volume;
  double most = 1e18;
  if (emitter.most_particles > 0) most = static_cast<double>(emitter.most_particles);
  if (emitter.most_volume > 0.0) {
    // A volume that is whole particles but for rounding is all of them.
    most = std::min(most, std::floor(emitter.most_volume / flow.particle_volume * (1.0 + 1e-12)));
  }
  flow.most = static_cast<std::uint64_t>(most);
  return flow;
}

Stream::Stream(const Emitter& emitter, std::shared_ptr<const Shape> shape, double spacing, int flat_axis)
    : emitter_(emitter),
      shape_(std::move(shape)),
      flat_axis_(flat_axis),
      flow_(flow_of(emitter, spacing, flat_axis)),
      side_{Vec3::Zero(), Vec3::Zero()} {
  if (emitter.type == Emitter::Type::kVolume) return;
  const Mouth mouth = mouth_of(emitter, spacing, flat_axis);
  const bool disc = emitter.type == Emitter::Type::kDisc, flat = flat_axis >= 0;
  // As far apart as in a body, so that a layer of sites is about as thick.
  const double apart =
      spacing / std::pow(static_cast<double>(emitter.particles_per_cell), flat ? 1.0 / 2.0 : 1.0 / 3.0);
  for (int k = 0; k < 2; ++k) {
    side_[k] = mouth.side[k];
    const double length = disc && !flat ? std::sqrt(mouth.area) : 2.0 * side_[k].norm();
    across_[k] = flat && k == 1 ? 1 : static_cast<std::uint32_t>(std::max(1.0, std::round(length / apart)));
  }
}

/// The place of a serial in the mouth: every layer of serials visits each site once, in an order of its own.
Vec3 Stream::site(std::uint64_t serial) const {
  const std::uint64_t all = sites(), layer = serial / all;
  if (layer_ != layer) {
    order_.resize(all);
    std::iota(order_.begin(), order_.end(), 0u);
    Draw draw(~static_cast<std::uint64_t>(emitter_.seed), layer);
    for (std::size_t i = all; i-- > 1;) std::swap(order_[i], order_[draw.bits() % (i + 1)]);
    layer_ = layer;
  }
  const std::uint32_t at = order_[serial % all];
  Draw draw(static_cast<std::uint64_t>(emitter_.seed), serial);
  double a = 2.0 * (at % across_[0] + draw.number()) / across_[0] - 1.0;
  double b = 2.0 * (at / across_[0] + draw.number()) / across_[1] - 1.0;
  if (flat_axis_ >= 0) return emitter_.center + a * side_[0];
  if (emitter_.type == Emitter::Type::kDisc) square_to_disc(a, b);
  return emitter_.center + a * side_[0] + b * side_[1];
}

Vec3 Stream::place_in_shape(std::uint64_t serial) const {
  const Bounds bounds = shape_->bounds();
  Draw draw(static_cast<std::uint64_t>(emitter_.seed), serial);
  for (;;) {  // ends: the shape fills a share of its bounds that has been checked
    Vec3 x;
    for (int axis = 0; axis < 3; ++axis) {
      x[axis] = bounds.lower[axis] + draw.number() * (bounds.upper[axis] - bounds.lower[axis]);
    }
    if (flat_axis_ >= 0) x[flat_axis_] = 0.0;
    if (shape_->signed_distance(x) < 0.0) return x;
  }
}

Stream::Birth Stream::birth(std::uint64_t serial) const {
  const bool volume = emitter_.type == Emitter::Type::kVolume;
  const Vec3 v = volume ? emitter_.velocity : Vec3(emitter_.speed * emitter_.normal.normalized());
  Birth birth{volume ? place_in_shape(serial) : site(serial), v};
  if (emitter_.spread > 0.0) {
    Draw draw(static_cast<std::uint64_t>(emitter_.seed) ^ 0x9e3779b97f4a7c15u, serial);
    birth.velocity += emitter_.spread * v.norm() * draw.in_ball(flat_axis_);
  }
  if (flat_axis_ >= 0) birth.position[flat_axis_] = 0.0;
  return birth;
}

}  // namespace repose
