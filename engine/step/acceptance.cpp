// Repose: whether a step may be made, decided before any particle is written, and the particle for whose sake
// it may not. The rest of the stepper stands in stepper.cpp.
#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/plan/chunks.h"
#include "engine/plan/transfer_stages.h"
#include "engine/step/stepper.h"

namespace repose {

std::string refusal_text(const Offender& offender) {
  return "particle " + std::to_string(offender.id) + " of '" + offender.set + "' " + offender.reason;
}

std::string unsolved_text(const ImplicitReport& report) {
  switch (report.newton.end) {
    case NewtonEnd::kConverged:
    case NewtonEnd::kStalled:
      break;
    case NewtonEnd::kIterations:
      return "it needs more than implicit.newton_iterations";
    case NewtonEnd::kNoDescent:
      return "no step along its direction lowers the residual";
    case NewtonEnd::kUnsolved:
      return std::string("the linear solver gave up (") + status_name(report.linear) + ")";
    case NewtonEnd::kUndefined:
      return "the residual has no value where it starts, or where contacts put it";
  }
  return "";
}

/// The particle for whose sake no step is short enough.
template <class Real>
Offender Stepper<Real>::fastest(const State<Real>& state) const {
  Offender offender;
  double most = -1.0;
  for (const auto& set : state.sets) {
    for (std::size_t p = 0; p < set.count; ++p) {
      const Vec3 v(double(set.velocity[0][p]), double(set.velocity[1][p]), double(set.velocity[2][p]));
      double size = v.squaredNorm();
      for (const auto& c : set.affine)
        size += !set.keeps_affine ? 0.0 : double(c[p]) * double(c[p]) * state.spacing * state.spacing;
      if (size <= most) continue;
      most = std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
      offender.set = set.name;
      offender.id = set.id[p];
      offender.velocity = offender.trial_velocity = v;
    }
  }
  offender.determinant = 1.0;
  offender.reason = "is too fast for any step";
  return offender;
}

template <class Real>
bool Stepper<Real>::bounded(const State<Real>& state, std::size_t owner, Real dt) const {
  Real low[3] = {}, high[3] = {};
  bool first = true;
  for (const std::int32_t n : state.grid.neighbours(owner)) {
    if (n < 0) continue;
    const VelocityBounds<Real>& bounds = bounds_[static_cast<std::size_t>(n)];
    if (!bounds.finite) return false;
    if (bounds.empty) continue;
    for (int axis = 0; axis < 3; ++axis) {
      low[axis] = first ? bounds.low[axis] : std::min(low[axis], bounds.low[axis]);
      high[axis] = first ? bounds.high[axis] : std::max(high[axis], bounds.high[axis]);
    }
    first = false;
  }
  // A particle's v is a weighted mean of node velocities; with all of them within a distance delta of some
  // velocity, |C| <= D^-1 delta sum w |x_i - x_p| <= delta sqrt(3 D^-1), and the stencil's bound covers that of
  // gradients as well.
  double half_diagonal = 0.0, fastest = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double extent = 0.5 * (static_cast<double>(high[axis]) - static_cast<double>(low[axis]));
    half_diagonal += extent * extent;
    fastest = std::max(
        {fastest, std::abs(static_cast<double>(low[axis])), std::abs(static_cast<double>(high[axis]))});
  }
  const double steps = static_cast<double>(dt) / state.spacing;
  const double gradient = std::sqrt(half_diagonal) * plan_.transfer.nodes().gradient_bound;
  return fastest * steps < 0.999 && gradient * steps < 0.999;
}

template <class Real>
std::optional<Offender> Stepper<Real>::inspect(State<Real>& state, Real dt) {
  const PhaseTimer timer(profile_, Phase::kInspect);
  suspects_.clear();
  const auto look = [&](std::size_t owner) {
    if (!bounded(state, owner, dt)) suspects_.push_back(static_cast<std::int32_t>(owner));
  };
  if (rest_) {
    for (const std::int32_t owner : rest_->attendance().awake) look(static_cast<std::size_t>(owner));
  } else {
    for (std::size_t owner = 0; owner < state.grid.owners().size(); ++owner) look(owner);
  }
  found_.resize(suspects_.size());
  threads_.for_each(suspects_.size(), [&](std::size_t i) {
    found_[i] = inspect_block(state, static_cast<std::size_t>(suspects_[i]), dt);
  });
  for (const auto& offender : found_) {
    if (offender) return offender;
  }
  return std::nullopt;
}

template <class Real>
std::optional<Offender> Stepper<Real>::inspect_block(State<Real>& state, std::size_t owner, Real dt) {
  Scratch<Real>& mine = scratch();
  load_arenas(state, owner, mine);
  const Lattice<Real> lattice = make_lattice(state, plan_.transfer);
  const auto kernel = plan_.kernels->transfer[plan_.transfer.stencil][plan_.transfer.transfer].gather;
  std::optional<Offender> offender;
  for_each_chunk(state, owner, owner, dt, scratch(), [&](std::size_t, Chunk<Real>& chunk) {
    if (offender) return;
    GatherInput<Real> in{};
    in.particles = chunk.particles;
    in.lattice = lattice;
    for (std::size_t axis = 0; axis < 3; ++axis) in.moving[axis] = mine.velocity.data() + axis * kChunk;
    for (std::size_t k = 0; k < kAffineComponents; ++k) in.gradient[k] = mine.gradient.data() + k * kChunk;
    kernel(in, mine.arena.data());
    const std::size_t p =
        plan_.kernels->inspect(in.moving, in.gradient, chunk.particles.count, dt, lattice.spacing);
    if (p < chunk.particles.count) offender = accuse(state, owner, chunk, p, in);
  });
  return offender;
}

template <class Real>
Offender Stepper<Real>::accuse(const State<Real>& state, std::size_t owner, const Chunk<Real>& chunk,
                               std::size_t p, const GatherInput<Real>& trial) const {
  Offender offender;
  offender.set = chunk.set.name;
  offender.id = chunk.set.id[chunk.first + p];
  offender.block = state.grid.blocks()[static_cast<std::size_t>(state.grid.owners()[owner])];
  std::array<double, 3> offset{};
  Mat3 map = Mat3::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    offset[static_cast<std::size_t>(axis)] = chunk.particles.position[axis][p];
    offender.velocity[axis] = chunk.particles.velocity[axis][p];
    offender.trial_velocity[axis] = trial.moving[axis][p];
    for (int c = 0; c < 3; ++c) map(axis, c) += static_cast<double>(chunk.dt) * trial.gradient[3 * axis + c][p];
  }
  offender.position = state.world(offender.block, offset);
  offender.determinant = map.determinant();
  const bool finite = offender.trial_velocity.allFinite() && std::isfinite(offender.determinant);
  offender.reason = !finite                       ? "is not finite"
                    : offender.determinant <= 0.0 ? "would be turned inside out"
                                                  : "would move over a cell";
  return offender;
}

#define REPOSE_INSTANTIATE(Real)                                      \
  template Offender Stepper<Real>::fastest(const State<Real>&) const; \
  template std::optional<Offender> Stepper<Real>::inspect(State<Real>&, Real);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
