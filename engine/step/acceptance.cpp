#include "engine/step/acceptance.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/vector.h"
#include "engine/plan/transfer_passes.h"

namespace repose {

std::string refusal_text(const FailedParticle& particle) {
  return "particle " + std::to_string(particle.id) + " of '" + particle.set + "' " + particle.reason;
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
    case NewtonEnd::kInterrupted:
      return "it was interrupted";
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
  sweep.kernels().node.bound(moving_.of_block(sweep.state(), block), bounds_[block]);
}

namespace {

template <class Real>
FailedParticle particle_at(const State<Real>& state, const ParticleSet<Real>& set, std::size_t occupied,
                           std::size_t p) {
  FailedParticle failed;
  failed.set = set.name;
  failed.id = set.id[p];
  failed.block = state.grid.occupied_coordinates(occupied);
  failed.position = to_triple(state.world(failed.block, set, p));
  failed.velocity = failed.trial_velocity =
      to_triple(Vec3(double(set.velocity[0][p]), double(set.velocity[1][p]), double(set.velocity[2][p])));
  failed.determinant = 1.0;
  return failed;
}

}  // namespace

/// By its velocity and what its C tells nodes a cell away; one that is not a number comes first.
template <class Real>
FailedParticle fastest_particle(const State<Real>& state, std::string what, std::string advice) {
  FailedParticle fastest;
  double most = -1.0;
  for_each_in_blocks(state, [&](const ParticleSet<Real>& set, std::size_t occupied, std::size_t p) {
    double size = 0.0;
    for (const auto& v : set.velocity) size += double(v[p]) * double(v[p]);
    for (const auto& c : set.affine)
      size += !set.keeps_affine ? 0.0 : double(c[p]) * double(c[p]) * state.spacing * state.spacing;
    if (size <= most) return;
    most = std::isnan(size) ? std::numeric_limits<double>::infinity() : size;
    fastest = particle_at(state, set, occupied, p);
  });
  fastest.reason = std::move(what);
  fastest.advice = std::move(advice);
  return fastest;
}

template <class Real>
std::optional<FailedParticle> spoilt_particle(const State<Real>& state) {
  std::optional<FailedParticle> found;
  for_each_in_blocks(state, [&](const ParticleSet<Real>& set, std::size_t occupied, std::size_t p) {
    if (found) return;
    bool finite = true;
    set.for_each_real([&](const AlignedArray<Real>& channel) { finite = finite && std::isfinite(channel[p]); });
    if (finite) return;
    found = particle_at(state, set, occupied, p);
    found->reason = "has a value that is not finite";
    found->advice = "go on from an earlier checkpoint, with a smaller time.sound or a finer grid.spacing";
  });
  return found;
}

template <class Real>
bool Acceptance<Real>::bounded(const State<Real>& state, std::size_t occupied, Real dt) const {
  Real low[3] = {}, high[3] = {};
  bool first = true;
  for (const std::int32_t n : state.grid.neighbours(occupied)) {
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
std::optional<FailedParticle> Acceptance<Real>::check(BlockSweep<Real>& sweep) {
  suspects_.clear();
  for (const std::int32_t occupied : sweep.active().moving) {
    if (!bounded(sweep.state(), static_cast<std::size_t>(occupied), sweep.dt())) suspects_.push_back(occupied);
  }
  found_.resize(suspects_.size());
  sweep.over(suspects_,
             [&](OccupiedBlock<Real>& block) { found_[block.position] = check_block(sweep, block); });
  for (const auto& failed : found_) {
    if (failed) return failed;
  }
  return std::nullopt;
}

template <class Real>
std::optional<FailedParticle> Acceptance<Real>::check_block(const BlockSweep<Real>& sweep,
                                                            OccupiedBlock<Real>& block) const {
  moving_.load(block);
  const Kernels<Real>& kernels = sweep.kernels();
  const auto gather = kernels.transfer[transfer_.stencil][transfer_.transfer].gather;
  GatherInput<Real> in{};
  in.lattice = make_lattice(block.state, transfer_);
  for (std::size_t axis = 0; axis < 3; ++axis) in.moving[axis] = block.scratch.at(velocity_) + axis * kChunk;
  for (std::size_t k = 0; k < kAffineComponents; ++k) in.gradient[k] = block.scratch.at(gradient_) + k * kChunk;
  std::optional<FailedParticle> failed;
  block.for_each_chunk([&](std::size_t, Chunk<Real>& chunk) {
    if (failed) return;
    in.particles = chunk.particles;
    gather(in, block.scratch.at(moving_.place()));
    const std::size_t p = kernels.particle.first_failed(in.moving, in.gradient, chunk.particles.count, block.dt,
                                                        in.lattice.spacing);
    if (p < chunk.particles.count) failed = failure(block, chunk, p, in);
  });
  return failed;
}

template <class Real>
FailedParticle Acceptance<Real>::failure(const OccupiedBlock<Real>& block, const Chunk<Real>& chunk,
                                         std::size_t p, const GatherInput<Real>& trial) const {
  const State<Real>& state = block.state;
  FailedParticle failed;
  failed.set = chunk.set.name;
  failed.id = chunk.set.id[chunk.first + p];
  failed.block = state.grid.occupied_coordinates(block.occupied);
  std::array<double, 3> offset{};
  Mat3 map = Mat3::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const auto along = static_cast<std::size_t>(axis);
    offset[along] = chunk.particles.position[axis][p];
    failed.velocity[along] = chunk.particles.velocity[axis][p];
    failed.trial_velocity[along] = trial.moving[axis][p];
    for (int c = 0; c < 3; ++c) map(axis, c) += static_cast<double>(chunk.dt) * trial.gradient[3 * axis + c][p];
  }
  failed.position = to_triple(state.world(failed.block, offset));
  failed.determinant = map.determinant();
  const bool finite = to_vec3(failed.trial_velocity).allFinite() && std::isfinite(failed.determinant);
  const double along = to_vec3(failed.trial_velocity).cwiseAbs().maxCoeff();
  const bool far = along * static_cast<double>(chunk.dt) > state.spacing && failed.determinant > 0.0;
  failed.reason = !finite ? "is not finite" : far ? "would move over a cell" : "would be turned inside out";
  failed.advice = "smaller time.sound or a finer grid.spacing may help";
  return failed;
}

template class Acceptance<float>;
template class Acceptance<double>;
template FailedParticle fastest_particle(const State<float>&, std::string, std::string);
template FailedParticle fastest_particle(const State<double>&, std::string, std::string);
template std::optional<FailedParticle> spoilt_particle(const State<float>&);
template std::optional<FailedParticle> spoilt_particle(const State<double>&);

}  // namespace repose
