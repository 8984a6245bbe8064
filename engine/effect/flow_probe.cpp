#include "engine/effect/flow_probe.h"

#include <algorithm>
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
  const double reach = radius_of_particles();
  near_.clear();
  near_begin_.assign(1, 0);
  for (std::size_t occupied = 0; occupied < state.grid.occupied_blocks().size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    for (std::size_t k = 0; k < planes_.size(); ++k) {
      const FlowPlane& plane = planes_[k];
      const double origin = plane.normal.dot(state.world(block, {0, 0, 0}) - plane.point) / state.spacing;
      if (std::abs(origin + 2.0 * plane.normal.sum()) < reach) near_.push_back({k, origin});
    }
    near_begin_.push_back(near_.size());
  }
}

std::span<const FlowCounts::Near> FlowCounts::near(std::size_t occupied) const {
  return std::span(near_).subspan(near_begin_[occupied], near_begin_[occupied + 1] - near_begin_[occupied]);
}

template <class Real>
void FlowCounts::note_places(std::size_t occupied, const std::array<const Real*, 3>& x, std::size_t count,
                             const std::array<Real*, 3>& before) const {
  if (near(occupied).empty()) return;
  for (std::size_t axis = 0; axis < 3; ++axis) std::copy_n(x[axis], count, before[axis]);
}

template <class Real>
void FlowCounts::count(std::size_t occupied, std::size_t set, const std::array<const Real*, 3>& x,
                       std::size_t count, const std::array<const Real*, 3>& before) {
  const std::size_t sets = crossings_.size() / planes_.size();
  for (const Near& at : near(occupied)) {
    const Vec3& n = planes_[at.plane].normal;
    const auto is_beyond = [&](const std::array<const Real*, 3>& place, std::size_t p) {
      return at.origin + n[0] * double(place[0][p]) + n[1] * double(place[1][p]) + n[2] * double(place[2][p]) >
             0.0;
    };
    std::int64_t forth = 0, back = 0;
    for (std::size_t p = 0; p < count; ++p) {
      const bool was = is_beyond(before, p), is = is_beyond(x, p);
      forth += is && !was ? 1 : 0;
      back += was && !is ? 1 : 0;
    }
    Crossings& crossings = crossings_[at.plane * sets + set];
    if (forth > 0) crossings.forth += forth;
    if (back > 0) crossings.back += back;
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
  template void FlowCounts::note_places(std::size_t, const std::array<const Real*, 3>&, std::size_t,        \
                                        const std::array<Real*, 3>&) const;                                 \
  template void FlowCounts::count(std::size_t, std::size_t, const std::array<const Real*, 3>&, std::size_t, \
                                  const std::array<const Real*, 3>&);                                       \
  template void FlowCounts::take(const State<Real>&, std::size_t, double*);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
