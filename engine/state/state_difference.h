// Repose: where two states that should have equal bits part.
#pragma once

#include <optional>
#include <vector>

#include "engine/state/difference.h"
#include "engine/state/state.h"

namespace repose {

/// In the order of channels.
template <class Real>
std::vector<ChannelHash> channel_hashes(const State<Real>& state);
/// Nothing where all particles are equal to the bit.
template <class Real>
std::optional<StateDifference> first_difference(const State<Real>& here, const State<Real>& there);

}  // namespace repose
