#include "engine/effect/host_inlet.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/seed_lattice.h"

namespace repose {

template <class Real>
void put_at(const Vec3& x, const Surroundings& around, std::size_t p, SetEdit<Real>& added) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto at = static_cast<std::size_t>(axis);
    const bool flat = axis == around.flat_axis;
    const double cells = x[axis] / around.spacing, cell = std::floor(cells);
    const double offset = std::floor((cells - cell) / kLatticeStep) * kLatticeStep;
    added.newcomers.position[axis][p] = static_cast<Real>(flat ? 0.5 : offset);
    added.cells[p][at] = (flat ? 0 : static_cast<std::int32_t>(cell)) + around.origin_cells[at];
  }
}

template <class Real>
const typename HostInlets<Real>::Inlet* HostInlets<Real>::find(const std::string& name) const {
  const auto found =
      std::find_if(inlets_.begin(), inlets_.end(), [&](const Inlet& inlet) { return inlet.name == name; });
  return found == inlets_.end() ? nullptr : &*found;
}

template <class Real>
std::vector<std::string> HostInlets<Real>::names() const {
  std::vector<std::string> names;
  for (const Inlet& inlet : inlets_) names.push_back(inlet.name);
  return names;
}

template <class Real>
void HostInlets<Real>::add(const Inlet& inlet, std::size_t count, const double* positions,
                           const float* velocities, State<Real>& state, ParticleEdit<Real>& edit,
                           const std::function<void(ParticleSet<Real>&)>& then) const {
  SetEdit<Real>& added = edit.add(state, inlet.place.set, count);
  const auto place = [positions](std::size_t p) {
    return Vec3(positions[3 * p], positions[3 * p + 1], positions[3 * p + 2]);
  };
  for (std::size_t p = 0; p < count; ++p) {
    put_at(place(p), surroundings_, p, added);
    for (int axis = 0; velocities != nullptr && axis < 3; ++axis) {
      if (axis == surroundings_.flat_axis) continue;
      added.newcomers.velocity[axis][p] = static_cast<Real>(velocities[3 * p + static_cast<std::size_t>(axis)]);
    }
  }
  const double now = state.counters.time;
  Newcomers<Real> newcomers{
      added.newcomers, 0, count, inlet.description, surroundings_, place, [now](std::size_t) { return now; }};
  initialize_(newcomers);
  then(added.newcomers);
  state.ledger.emitted[inlet.place.entry] += count;
}

template <class Real>
std::size_t HostInlets<Real>::remove(std::vector<std::uint32_t> ids, State<Real>& state,
                                     ParticleEdit<Real>& edit) const {
  std::sort(ids.begin(), ids.end());
  std::size_t all = 0;
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    const ParticleSet<Real>& set = state.sets[k];
    std::vector<std::uint32_t>& removed = edit.sets[k].removed;
    for (std::uint32_t p = 0; p < set.count; ++p) {
      if (std::binary_search(ids.begin(), ids.end(), set.id[p])) removed.push_back(p);
    }
    state.ledger.removed[outlet_ * state.sets.size() + k] += removed.size();
    all += removed.size();
  }
  return all;
}

#define REPOSE_INSTANTIATE(Real)                                                       \
  template void put_at(const Vec3&, const Surroundings&, std::size_t, SetEdit<Real>&); \
  template class HostInlets<Real>;
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
