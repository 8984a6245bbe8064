#include "engine/effect/flow_probe.h"

#include <bit>
#include <cmath>

#include "engine/state/block_extent.h"

namespace repose {

FlowCounts::FlowCounts(std::vector<FlowPlane> planes) : planes_(std::move(planes)) {
  for (FlowPlane& plane : planes_) plane.normal.normalize();
}

void FlowCounts::expect_sets(std::size_t sets) {
  crossings_ = std::vector<Crossings>(planes_.size() * sets);
}

template <class Real>
void FlowCounts::follow_topology(const State<Real>& state) {
  // Within it a particle is, and moves by a cell at most.
  const double near = radius_of_particles();
  const auto occupied_blocks = state.grid.occupied_blocks();
  at_origin_.resize(occupied_blocks.size() * planes_.size());
  near_.assign(occupied_blocks.size(), 0);
  for (std::size_t occupied = 0; occupied < occupied_blocks.size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const FlowPlane& plane = planes_[k];
      const double origin = plane.normal.dot(state.world(block, {0, 0, 0}) - plane.point) / state.spacing;
      at_origin_[occupied * planes_.size() + k] = origin;
      if (std::abs(origin + 2.0 * plane.normal.sum()) < near) near_[occupied] |= std::uint32_t{1} << k;
    }
  }
}

template <class Real>
std::uint32_t FlowCounts::sides(std::size_t occupied, const std::array<const Real*, 3>& x,
                                std::size_t p) const {
  std::uint32_t sides = 0;
  for (std::uint32_t rest = near_[occupied]; rest != 0; rest &= rest - 1) {
    const auto k = static_cast<std::size_t>(std::countr_zero(rest));
    const Vec3& n = planes_[k].normal;
    const double distance = at_origin_[occupied * planes_.size() + k] + n[0] * double(x[0][p]) +
                            n[1] * double(x[1][p]) + n[2] * double(x[2][p]);
    if (distance > 0.0) sides |= std::uint32_t{1} << k;
  }
  return sides;
}

template <class Real>
void FlowCounts::note_sides(std::size_t occupied, const std::array<const Real*, 3>& x, std::size_t count,
                            Real* noted) const {
  if (near_[occupied] == 0) return;
  for (std::size_t p = 0; p < count; ++p) noted[p] = static_cast<Real>(sides(occupied, x, p));
}

template <class Real>
void FlowCounts::count(std::size_t occupied, std::size_t set, const std::array<const Real*, 3>& x,
                       std::size_t count, const Real* noted) {
  if (near_[occupied] == 0) return;
  const std::size_t sets = crossings_.size() / planes_.size();
  for (std::size_t p = 0; p < count; ++p) {
    const std::uint32_t now = sides(occupied, x, p);
    for (std::uint32_t rest = now ^ static_cast<std::uint32_t>(noted[p]); rest != 0; rest &= rest - 1) {
      const auto k = static_cast<std::size_t>(std::countr_zero(rest));
      Crossings& crossings = crossings_[k * sets + set];
      ++((now >> k & 1u) != 0 ? crossings.forth : crossings.back);
    }
  }
}

template <class Real>
void FlowCounts::take(const State<Real>& state, std::size_t plane, double* tallies) {
  for (std::size_t set = 0; set < state.sets.size(); ++set) {
    Crossings& crossings = crossings_[plane * state.sets.size() + set];
    const auto forth = static_cast<double>(crossings.forth.exchange(0)),
               back = static_cast<double>(crossings.back.exchange(0));
    tallies[0] += forth;
    tallies[1] += forth * state.sets[set].particle_mass;
    tallies[2] += back;
    tallies[3] += back * state.sets[set].particle_mass;
  }
}

#define REPOSE_INSTANTIATE(Real)                                                                            \
  template void FlowCounts::follow_topology(const State<Real>&);                                            \
  template void FlowCounts::note_sides(std::size_t, const std::array<const Real*, 3>&, std::size_t, Real*)  \
      const;                                                                                                \
  template void FlowCounts::count(std::size_t, std::size_t, const std::array<const Real*, 3>&, std::size_t, \
                                  const Real*);                                                             \
  template void FlowCounts::take(const State<Real>&, std::size_t, double*);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
