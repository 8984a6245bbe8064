#include "engine/state/state_difference.h"

#include <algorithm>
#include <bit>
#include <map>
#include <unordered_map>

#include "engine/base/mix.h"

namespace repose {
namespace {

std::uint64_t bits(float value) {
  return std::bit_cast<std::uint32_t>(value);
}
std::uint64_t bits(double value) {
  return std::bit_cast<std::uint64_t>(value);
}

/// In the order of for_each_real.
template <class Real>
std::vector<std::string> channel_names(const ParticleSet<Real>& set) {
  std::vector<std::string> names;
  for (const char* axis : {"x", "y", "z"}) names.push_back(std::string("position.") + axis);
  for (const char* axis : {"x", "y", "z"}) names.push_back(std::string("velocity.") + axis);
  for (int k = 0; k < kAffineComponents && set.keeps_affine; ++k) names.push_back("C." + std::to_string(k));
  for (int k = 0; k < kStrainComponents; ++k) names.push_back("strain." + std::to_string(k));
  for (const auto& channel : set.extra) names.push_back(channel.name);
  return names;
}

struct Place {
  std::size_t particle;
  Index3 block;
};

template <class Real>
std::unordered_map<std::uint32_t, Place> places_by_id(const State<Real>& state, const ParticleSet<Real>& set) {
  std::unordered_map<std::uint32_t, Place> places;
  for (std::size_t occupied = 0; occupied + 1 < set.begin.size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) places[set.id[p]] = {p, block};
  }
  return places;
}

}  // namespace

template <class Real>
std::vector<ChannelHash> channel_hashes(const State<Real>& state) {
  std::map<std::string, std::uint64_t> sums;
  std::vector<std::string> order;
  for (const ParticleSet<Real>& set : state.sets) {
    const std::vector<std::string> names = channel_names(set);
    std::size_t k = 0;
    set.for_each_real([&](const AlignedArray<Real>& channel) {
      if (!sums.contains(names[k])) order.push_back(names[k]);
      std::uint64_t& sum = sums[names[k++]];
      for (std::size_t p = 0; p < set.count; ++p) sum += mix_bits(mix_bits(set.id[p]) ^ bits(channel[p]));
    });
  }
  std::vector<ChannelHash> hashes;
  for (const std::string& name : order) hashes.push_back({name, sums[name]});
  return hashes;
}

template <class Real>
std::optional<StateDifference> first_difference(const State<Real>& here, const State<Real>& there) {
  std::optional<StateDifference> first;
  std::uint64_t particles = 0;
  const auto note = [&](StateDifference found) {
    const auto order = [](const StateDifference& d) { return std::pair(d.block, d.id); };
    if (!first || order(found) < order(*first)) first = std::move(found);
  };
  for (std::size_t s = 0; s < here.sets.size(); ++s) {
    const ParticleSet<Real>&mine = here.sets[s], &other = there.sets[s];
    const auto places = places_by_id(there, other);
    const std::vector<std::string> names = channel_names(mine);
    std::vector<const AlignedArray<Real>*> channels, others;
    mine.for_each_real([&](const AlignedArray<Real>& channel) { channels.push_back(&channel); });
    other.for_each_real([&](const AlignedArray<Real>& channel) { others.push_back(&channel); });
    for (const auto& [id, place] : places_by_id(here, mine)) {
      StateDifference found{mine.name, place.block, id, "", 0.0, 0.0, 0};
      const auto at = places.find(id);
      if (at == places.end()) {
        found.channel = "is not there";
      } else if (at->second.block != place.block) {
        found.channel = "lies in another block";
      } else {
        for (std::size_t k = 0; k < channels.size() && found.channel.empty(); ++k) {
          const Real a = (*channels[k])[place.particle], b = (*others[k])[at->second.particle];
          if (bits(a) == bits(b)) continue;
          found.channel = names[k];
          found.here = static_cast<double>(a);
          found.there = static_cast<double>(b);
        }
      }
      if (found.channel.empty()) continue;
      ++particles;
      note(std::move(found));
    }
  }
  if (first) first->particles = particles;
  return first;
}

#define REPOSE_INSTANTIATE(Real)                                        \
  template std::vector<ChannelHash> channel_hashes(const State<Real>&); \
  template std::optional<StateDifference> first_difference(const State<Real>&, const State<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
