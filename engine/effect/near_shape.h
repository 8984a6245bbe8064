// Repose: which blocks a shape concerns. No distance exceeds the true one, so most blocks are passed over by
// one look.
#pragma once

#include "engine/geometry/shape.h"
#include "engine/plan/access.h"
#include "engine/state/block_extent.h"

namespace repose {

/// Whether particles of a block may be within a shape, or nodes of it.
template <class Real>
bool may_hold_particles(const Shape& shape, const State<Real>& state, const Index3& block) {
  return shape.signed_distance(BlockPlace<Real>(state, block).middle()) <=
         radius_of_particles_from_nodes() * state.spacing;
}
template <class Real>
bool may_hold_nodes(const Shape& shape, const BlockPlace<Real>& place) {
  return shape.signed_distance(place.middle()) <= radius_of_nodes() * place.spacing();
}

}  // namespace repose
