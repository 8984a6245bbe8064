// Repose: how two states that should have equal bits differ, in plain types.
#pragma once

#include <array>
#include <cstdint>
#include <string>

namespace repose {

/// A hash of one channel over all particles, by their ids.
struct ChannelHash {
  std::string channel;  ///< such as "velocity.x"
  std::uint64_t hash = 0;
};

/// The first number that differs: first by block, in the order of the first state, then by id, then by channel.
struct StateDifference {
  std::string set;
  std::array<std::int32_t, 3> block{};
  std::uint32_t id = 0;
  std::string channel;  ///< or "is not there", "lies in another block"
  double here = 0.0, there = 0.0;
  std::uint64_t particles = 0;  ///< that differ at all
};

}  // namespace repose
