#include "engine/step/acceptance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/plan/transfer_passes.h"

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

template <class Real>
Acceptance<Real>::Acceptance(StepPlan<Real>& plan)
    : transfer_(plan.transfer),
      moving_(plan),
      velocity_(plan.scratch.place(kVelocityRoom.kInfo)),
      gradient_(plan.scratch.place(kGradientRoom.kInfo)) {}

template <class Real>
void Acceptance<Real>::bound(const BlockSweep<Real>& sweep, std::size_t block) {
  sweep.kernels().bound(moving_.of_block(sweep.state(), block), bounds_[block]);
}

/// The particle for whose sake no step is short enough.
template <class Real>
Offender fastest_particle(const State<Real>& state) {
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
bool Acceptance<Real>::bounded(const State<Real>& state, std::size_t owner, Real dt) const {
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
  const double gradient = std::sqrt(half_diagonal) * transfer_.nodes().gradient_bound;
  return fastest * steps < 0.999 && gradient * steps < 0.999;
}

template <class Real>
std::optional<Offender> Acceptance<Real>::inspect(BlockSweep<Real>& sweep) {
  suspects_.clear();
  for (const std::int32_t owner : sweep.active().moving) {
    if (!bounded(sweep.state(), static_cast<std::size_t>(owner), sweep.dt())) suspects_.push_back(owner);
  }
  found_.resize(suspects_.size());
  sweep.over(suspects_,
             [&](OccupiedBlock<Real>& block) { found_[block.position] = inspect_block(sweep, block); });
  for (const auto& offender : found_) {
    if (offender) return offender;
  }
  return std::nullopt;
}

template <class Real>
std::optional<Offender> Acceptance<Real>::inspect_block(const BlockSweep<Real>& sweep,
                                                        OccupiedBlock<Real>& block) const {
  moving_.load(block);
  const Kernels<Real>& kernels = sweep.kernels();
  const auto gather = kernels.transfer[transfer_.stencil][transfer_.transfer].gather;
  GatherInput<Real> in{};
  in.lattice = make_lattice(block.state, transfer_);
  for (std::size_t axis = 0; axis < 3; ++axis) in.moving[axis] = block.scratch.at(velocity_) + axis * kChunk;
  for (std::size_t k = 0; k < kAffineComponents; ++k) in.gradient[k] = block.scratch.at(gradient_) + k * kChunk;
  std::optional<Offender> offender;
  block.for_each_chunk([&](std::size_t, Chunk<Real>& chunk) {
    if (offender) return;
    in.particles = chunk.particles;
    gather(in, block.scratch.at(moving_.place()));
    const std::size_t p =
        kernels.inspect(in.moving, in.gradient, chunk.particles.count, block.dt, in.lattice.spacing);
    if (p < chunk.particles.count) offender = accuse(block, chunk, p, in);
  });
  return offender;
}

template <class Real>
Offender Acceptance<Real>::accuse(const OccupiedBlock<Real>& block, const Chunk<Real>& chunk, std::size_t p,
                                  const GatherInput<Real>& trial) const {
  const State<Real>& state = block.state;
  Offender offender;
  offender.set = chunk.set.name;
  offender.id = chunk.set.id[chunk.first + p];
  offender.block = state.grid.coordinates_of_owner(block.owner);
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

template class Acceptance<float>;
template class Acceptance<double>;
template Offender fastest_particle(const State<float>&);
template Offender fastest_particle(const State<double>&);

}  // namespace repose
