#include "engine/sweep/active_blocks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

namespace repose {
namespace {

constexpr std::uint8_t kFar = 3;

/// A sleeping block's nodes may go this many times the way that let it fall asleep: else neighbours that are
/// about to sleep keep one another awake.
constexpr double kPatience = 5.0;

template <class Real>
std::uint32_t particles_of(const State<Real>& state, std::size_t occupied) {
  std::uint32_t sum = 0;
  for (const std::size_t k : state.sets_of_blocks.of(occupied))
    sum += state.sets[k].begin[occupied + 1] - state.sets[k].begin[occupied];
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
ActiveBlocks<Real>::ActiveBlocks(StepPlan<Real>& plan)
    : rule_(plan.sleep),
      disturbances_(plan.disturbances),
      drift_(plan.tables.template get<Real>(kDrift)),
      moving_(plan) {}

template <class Real>
void ActiveBlocks<Real>::before_sort(const State<Real>& state) {
  if (!rule_) return;
  const std::size_t all = state.grid.occupied_blocks().size();
  old_blocks_.resize(all);
  old_counts_.resize(all);
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    old_blocks_[occupied] = state.grid.occupied_coordinates(occupied);
    old_counts_[occupied] = particles_of(state, occupied);
  }
  old_ = state.rest;
}

/// `wakes(block, old occupied blocks)`: whether an occupied block at the block wakes that sleeps and has
/// another number of particles.
template <class Real>
template <class Wakes>
void ActiveBlocks<Real>::carry_over(State<Real>& state, Wakes wakes) {
  listed_ = false;
  if (!rule_) return;
  RestField& rest = state.rest;
  rest.resize(state.grid.occupied_blocks().size());
  if (old_.asleep.size() != old_blocks_.size()) return;  // before the first step: all are awake
  OldOccupiedBlocks old;
  for (std::size_t k = 0; k < old_blocks_.size(); ++k) old.emplace(old_blocks_[k], k);
  std::vector<std::uint8_t> stays(old_blocks_.size(), 0);
  for (std::size_t occupied = 0; occupied < rest.asleep.size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    const auto found = old.find(block);
    if (found == old.end()) continue;
    stays[found->second] = 1;
    rest.take(occupied, old_, found->second);
    if (rest.asleep[occupied] == 0 || old_counts_[found->second] == particles_of(state, occupied)) continue;
    if (wakes(block, old)) rest.wake(occupied);
  }
  for (const auto& [block, k] : old) {
    if (stays[k] != 0) continue;
    for_each_around(block, [&](const Index3& next) {
      const std::int32_t occupied = state.grid.find_occupied(state.topology.wrap(next));
      if (occupied >= 0 && rest.asleep[static_cast<std::size_t>(occupied)] != 0)
        rest.wake(static_cast<std::size_t>(occupied));
    });
  }
}

template <class Real>
void ActiveBlocks<Real>::after_sort(State<Real>& state) {
  carry_over(state, [&](const Index3& block, const OldOccupiedBlocks& old) {
    bool beside_awake = false;
    for_each_around(block, [&](const Index3& next) {
      const auto found = old.find(state.topology.wrap(next));
      beside_awake = beside_awake || (found != old.end() && old_.asleep[found->second] == 0);
    });
    return beside_awake;
  });
}

template <class Real>
void ActiveBlocks<Real>::after_edit(State<Real>& state) {
  carry_over(state, [](const Index3&, const OldOccupiedBlocks&) { return true; });
}

template <class Real>
void ActiveBlocks<Real>::begin_step(State<Real>& state, double to) {
  RestField& rest = state.rest;
  const double from = state.counters.time;
  for (std::size_t occupied = 0; occupied < rest.asleep.size() && !disturbances_.empty(); ++occupied) {
    if (rest.asleep[occupied] == 0) continue;
    const Index3 block = state.grid.occupied_coordinates(occupied);
    const bool reached = std::any_of(
        disturbances_.begin(), disturbances_.end(),
        [&](const Disturbance<Real>& disturbance) { return disturbance.reaches(state, block, from, to); });
    if (!reached) continue;
    rest.wake(occupied);
    listed_ = false;
  }
  refresh(state);
}

/// How far occupied blocks are from one that is awake.
template <class Real>
void ActiveBlocks<Real>::measure_distances(const State<Real>& state) {
  const std::size_t all = state.grid.occupied_blocks().size();
  distance_.assign(all, kFar);
  for (std::size_t occupied = 0; occupied < all; ++occupied) {
    if (state.rest.asleep[occupied] == 0) distance_[occupied] = 0;
  }
  for (std::uint8_t ring = 1; ring < kFar; ++ring) {
    for (std::size_t occupied = 0; occupied < all; ++occupied) {
      if (distance_[occupied] != ring - 1) continue;
      for (const std::int32_t block : state.grid.neighbours(occupied)) {
        const std::int32_t other =
            block < 0 ? -1 : state.grid.occupied_of_block(static_cast<std::size_t>(block));
        if (other < 0) continue;
        std::uint8_t& distance = distance_[static_cast<std::size_t>(other)];
        distance = std::min(distance, ring);
      }
    }
  }
}

template <class Real>
void ActiveBlocks<Real>::list(const State<Real>& state) {
  listed_ = true;
  const BlockGrid& grid = state.grid;
  if (!rule_) {
    set_.moving.resize(grid.occupied_blocks().size());
    std::iota(set_.moving.begin(), set_.moving.end(), 0);
    set_.blocks.resize(grid.size());
    std::iota(set_.blocks.begin(), set_.blocks.end(), 0);
    for (std::size_t colour = 0; colour < set_.scatter.size(); ++colour) {
      const auto occupied_blocks = grid.colour(static_cast<int>(colour));
      set_.scatter[colour].assign(occupied_blocks.begin(), occupied_blocks.end());
    }
    return;
  }
  measure_distances(state);
  set_.moving.clear();
  set_.margin.clear();
  set_.blocks.clear();
  reached_.assign(grid.size(), 0);
  for (std::size_t occupied = 0; occupied < distance_.size(); ++occupied) {
    if (distance_[occupied] == 0) set_.moving.push_back(static_cast<std::int32_t>(occupied));
    if (distance_[occupied] == 1) set_.margin.push_back(static_cast<std::int32_t>(occupied));
    if (distance_[occupied] == kFar) continue;
    for (const std::int32_t block : grid.neighbours(occupied)) {
      if (block >= 0) reached_[static_cast<std::size_t>(block)] = 1;
    }
  }
  for (std::size_t block = 0; block < reached_.size(); ++block) {
    if (reached_[block] != 0) set_.blocks.push_back(static_cast<std::int32_t>(block));
  }
  for (std::size_t colour = 0; colour < set_.scatter.size(); ++colour) {
    set_.scatter[colour].clear();
    for (const std::int32_t occupied : grid.colour(static_cast<int>(colour))) {
      if (distance_[static_cast<std::size_t>(occupied)] != kFar) set_.scatter[colour].push_back(occupied);
    }
  }
}

/// Of the nodes with mass in the rows that the particles of an occupied block touch.
template <class Real>
typename ActiveBlocks<Real>::Stir ActiveBlocks<Real>::stir_of_nodes(OccupiedBlock<Real>& block) const {
  moving_.load(block);
  constexpr std::size_t kRowValues = kArenaSide * kNodeValues;
  double most = 0.0, nodes = 0.0;
  Stir stir;
  for (std::uint64_t rows = *block.rows; rows != 0; rows &= rows - 1) {
    const Real* const row =
        block.scratch.at(moving_.place()) + static_cast<std::size_t>(std::countr_zero(rows)) * kRowValues;
    for (std::size_t node = 0; node < kArenaSide; ++node) {
      const Real* const at = row + node * kNodeValues;
      if (!(at[0] > Real(0))) continue;
      double square = 0.0;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const auto v = static_cast<double>(at[1 + axis]);
        stir.velocity[axis] += v;
        square += v * v;
      }
      if (!(square <= most)) most = square;
      nodes += 1.0;
    }
  }
  stir.speed = std::sqrt(most);
  for (double& v : stir.velocity) v /= std::max(nodes, 1.0);
  return stir;
}

template <class Real>
void ActiveBlocks<Real>::wake_margin(BlockSweep<Real>& sweep) {
  RestField& rest = sweep.state().rest;
  if (drift_ != nullptr) drift_->sums.assign(rest.asleep.size(), {});
  if (set_.margin.empty()) return;
  stirs_.resize(rest.asleep.size());
  sweep.over(set_.margin,
             [this](OccupiedBlock<Real>& block) { stirs_[block.occupied] = stir_of_nodes(block); });
  for (const std::int32_t k : set_.margin) {
    const auto occupied = static_cast<std::size_t>(k);
    if (rest.asleep[occupied] == 0) continue;  // woken by an earlier try of this step
    const double way = go(rest.way[occupied], stirs_[occupied].velocity, static_cast<double>(sweep.dt()));
    // Not a number wakes too: inspection will say whose it is.
    if (stirs_[occupied].speed <= rule_->wake_speed && way <= kPatience * rule_->way) continue;
    rest.wake(occupied);
    set_.moving.push_back(k);
    listed_ = false;
  }
}

template <class Real>
void ActiveBlocks<Real>::end_step(State<Real>& state, double dt, std::span<const Motion<Real>> motion) {
  if (!rule_) return;
  for (const std::int32_t k : set_.moving) {
    const auto occupied = static_cast<std::size_t>(k);
    const Drift::Sum& sum = drift_->sums[occupied];
    Stir stir{std::sqrt(static_cast<double>(motion[occupied].speed_squared)), sum.velocity};
    for (double& v : stir.velocity) v /= std::max(sum.samples, 1.0);
    settle(state, occupied, dt, stir);
  }
}

template <class Real>
void ActiveBlocks<Real>::settle(State<Real>& state, std::size_t occupied, double dt, const Stir& stir) {
  RestField& rest = state.rest;
  const double way = go(rest.way[occupied], stir.velocity, dt);
  rest.calm[occupied] += dt;
  if (stir.speed >= rule_->speed) rest.begin_anew(occupied);
  if (rest.calm[occupied] < rule_->after) return;
  rest.begin_anew(occupied);
  if (way > rule_->way) return;
  rest.asleep[occupied] = 1;
  listed_ = false;
}

template <class Real>
std::size_t ActiveBlocks<Real>::bytes() const {
  return set_.bytes() + distance_.capacity() + reached_.capacity() + stirs_.capacity() * sizeof(Stir) +
         old_blocks_.capacity() * (sizeof(Index3) + sizeof(std::uint32_t) + 33);
}

template class ActiveBlocks<float>;
template class ActiveBlocks<double>;

}  // namespace repose
