// Repose: how the figures of a state are found (reports.h). Sums
// run per block in double and then over blocks in their order, so they do not depend on threads.
#pragma once

#include <algorithm>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/effect/solid.h"
#include "engine/scene/scene.h"
#include "engine/simulation/reports.h"
#include "engine/state/block_extent.h"
#include "engine/state/state.h"

namespace repose {

/// Whether particles of a block may be within one of the solids, which stand still.
template <class Real>
bool any_near(const std::vector<Solid>& solids, const State<Real>& state, const Index3& block) {
  const Vec3 middle = state.world(block, kMiddleOfParticles);
  return std::any_of(solids.begin(), solids.end(), [&](const Solid& solid) {
    return solid.distance(middle) < radius_of_particles() * state.spacing;
  });
}

template <class Real>
Diagnostics diagnose(const Scene& scene, const std::vector<Solid>& solids, const State<Real>& state,
                     Threads& threads);

template <class Real>
LedgerReport ledger_report(const Scene& scene, const State<Real>& state);

}  // namespace repose
