#include "engine/plan/rest.h"

#include <algorithm>
#include <cmath>

namespace repose {
namespace {

constexpr std::uint8_t kFar = 3;

/// A sleeping block's nodes may go this many times the way that let it fall asleep: else neighbours that are
/// about to sleep keep one another awake.
constexpr double kPatience = 5.0;

template <class Real>
Index3 block_of(const State<Real>& state, std::size_t owner) {
  return state.grid.blocks()[static_cast<std::size_t>(state.grid.owners()[owner])];
}

template <class Real>
std::uint32_t particles_of(const State<Real>& state, std::size_t owner) {
  std::uint32_t sum = 0;
  for (const auto& set : state.sets) sum += set.begin[owner + 1] - set.begin[owner];
  return sum;
}

/// Calls visit(block) for a block and its 26 neighbours.
template <class Visit>
void for_each_around(const Index3& block, Visit visit) {
  for (int n = 0; n < kNeighbours; ++n) {
    visit(Index3{block[0] + n / 9 - 1, block[1] + n / 3 % 3 - 1, block[2] + n % 3 - 1});
  }
}

/// Goes on; returns how far it is from where it began, m.
double go(std::array<double, 3>& way, const std::array<double, 3>& velocity, double dt) {
  double square = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    way[axis] += velocity[axis] * dt;
    square += way[axis] * way[axis];
  }
  return std::sqrt(square);
}

}  // namespace

template <class Real>
void Rest<Real>::before_order(const State<Real>& state) {
  const std::size_t owners = state.grid.owners().size();
  old_blocks_.resize(owners);
  old_counts_.resize(owners);
  for (std::size_t owner = 0; owner < owners; ++owner) {
    old_blocks_[owner] = block_of(state, owner);
    old_counts_[owner] = particles_of(state, owner);
  }
  old_ = state.rest;
}

/// `wakes(block, old owners)`: whether an owner at the block wakes that sleeps and has another number of
/// particles.
template <class Real>
template <class Wakes>
void Rest<Real>::carry_over(State<Real>& state, Wakes wakes) {
  listed_ = false;
  RestField& rest = state.rest;
  rest.resize(state.grid.owners().size());
  if (old_.asleep.size() != old_blocks_.size()) return;  // before the first step: all are awake
  OldOwners old;
  for (std::size_t k = 0; k < old_blocks_.size(); ++k) old.emplace(old_blocks_[k], k);
  std::vector<std::uint8_t> stays(old_blocks_.size(), 0);
  for (std::size_t owner = 0; owner < rest.asleep.size(); ++owner) {
    const Index3 block = block_of(state, owner);
    const auto found = old.find(block);
    if (found == old.end()) continue;
    stays[found->second] = 1;
    rest.take(owner, old_, found->second);
    if (rest.asleep[owner] == 0 || old_counts_[found->second] == particles_of(state, owner)) continue;
    if (wakes(block, old)) rest.wake(owner);
  }
  for (const auto& [block, k] : old) {
    if (stays[k] != 0) continue;
    for_each_around(block, [&](const Index3& next) {
      const std::int32_t owner = state.grid.find_owner(state.topology.wrap(next));
      if (owner >= 0 && rest.asleep[static_cast<std::size_t>(owner)] != 0)
        rest.wake(static_cast<std::size_t>(owner));
    });
  }
}

template <class Real>
void Rest<Real>::after_order(State<Real>& state) {
  carry_over(state, [&](const Index3& block, const OldOwners& old) {
    bool beside_awake = false;
    for_each_around(block, [&](const Index3& next) {
      const auto found = old.find(state.topology.wrap(next));
      beside_awake = beside_awake || (found != old.end() && old_.asleep[found->second] == 0);
    });
    return beside_awake;
  });
}

template <class Real>
void Rest<Real>::after_edit(State<Real>& state) {
  carry_over(state, [](const Index3&, const OldOwners&) { return true; });
}

template <class Real>
const Attendance& Rest<Real>::attend(State<Real>& state, const std::vector<Disturbance<Real>>& disturbances,
                                     double to) {
  RestField& rest = state.rest;
  const double from = state.counters.time;
  for (std::size_t owner = 0; owner < rest.asleep.size() && !disturbances.empty(); ++owner) {
    if (rest.asleep[owner] == 0) continue;
    const Index3 block = block_of(state, owner);
    const bool reached = std::any_of(disturbances.begin(), disturbances.end(), [&](const Disturbance<Real>& d) {
      return d.reaches(state, block, from, to);
    });
    if (!reached) continue;
    rest.wake(owner);
    listed_ = false;
  }
  if (!listed_) list(state);
  return attendance_;
}

template <class Real>
void Rest<Real>::list(const State<Real>& state) {
  const RestField& rest = state.rest;
  const std::size_t owners = rest.asleep.size();
  distance_.assign(owners, kFar);
  reached_.assign(state.grid.size(), 0);
  attendance_.awake.clear();
  attendance_.margin.clear();
  attendance_.blocks.clear();
  for (std::size_t owner = 0; owner < owners; ++owner) {
    if (rest.asleep[owner] != 0) continue;
    distance_[owner] = 0;
    attendance_.awake.push_back(static_cast<std::int32_t>(owner));
  }
  for (std::uint8_t ring = 1; ring < kFar; ++ring) {
    for (std::size_t owner = 0; owner < owners; ++owner) {
      if (distance_[owner] != ring - 1) continue;
      for (const std::int32_t block : state.grid.neighbours(owner)) {
        const std::int32_t other = block < 0 ? -1 : state.grid.owner_of_block(static_cast<std::size_t>(block));
        if (other >= 0)
          distance_[static_cast<std::size_t>(other)] =
              std::min(distance_[static_cast<std::size_t>(other)], ring);
      }
    }
  }
  for (std::size_t owner = 0; owner < owners; ++owner) {
    if (distance_[owner] == 1) attendance_.margin.push_back(static_cast<std::int32_t>(owner));
    if (distance_[owner] == kFar) continue;
    for (const std::int32_t block : state.grid.neighbours(owner)) {
      if (block >= 0) reached_[static_cast<std::size_t>(block)] = 1;
    }
  }
  for (std::size_t block = 0; block < reached_.size(); ++block) {
    if (reached_[block] != 0) attendance_.blocks.push_back(static_cast<std::int32_t>(block));
  }
  for (std::size_t colour = 0; colour < attendance_.scatter.size(); ++colour) {
    auto& list = attendance_.scatter[colour];
    list.clear();
    for (const std::int32_t owner : state.grid.colour(static_cast<int>(colour))) {
      if (distance_[static_cast<std::size_t>(owner)] != kFar) list.push_back(owner);
    }
  }
  listed_ = true;
}

template <class Real>
void Rest<Real>::wake_margin(State<Real>& state, double dt, std::span<const Stir> stirs) {
  RestField& rest = state.rest;
  for (std::size_t k = 0; k < stirs.size(); ++k) {
    const auto owner = static_cast<std::size_t>(attendance_.margin[k]);
    if (rest.asleep[owner] == 0) continue;  // woken by an earlier try of this step
    const double way = go(rest.way[owner], stirs[k].velocity, dt);
    // Not a number wakes too: inspection will say whose it is.
    if (stirs[k].speed <= rule_.wake_speed && way <= kPatience * rule_.way) continue;
    rest.wake(owner);
    attendance_.awake.push_back(attendance_.margin[k]);
    listed_ = false;
  }
}

template <class Real>
void Rest<Real>::settle(State<Real>& state, double dt, std::span<const Stir> stirs) {
  RestField& rest = state.rest;
  for (const std::int32_t k : attendance_.awake) {
    const auto owner = static_cast<std::size_t>(k);
    const double way = go(rest.way[owner], stirs[owner].velocity, dt);
    rest.calm[owner] += dt;
    if (stirs[owner].speed >= rule_.speed) rest.begin_anew(owner);
    if (rest.calm[owner] < rule_.after) continue;
    rest.begin_anew(owner);
    if (way > rule_.way) continue;
    rest.asleep[owner] = 1;
    listed_ = false;
  }
}

template <class Real>
std::size_t Rest<Real>::bytes() const {
  std::size_t sum =
      attendance_.awake.capacity() + attendance_.margin.capacity() + attendance_.blocks.capacity();
  for (const auto& list : attendance_.scatter) sum += list.capacity();
  return sum * sizeof(std::int32_t) + distance_.capacity() + reached_.capacity() +
         old_blocks_.capacity() * (sizeof(Index3) + sizeof(std::uint32_t) + 33);
}

template class Rest<float>;
template class Rest<double>;

}  // namespace repose
