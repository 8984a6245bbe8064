// Repose: volume correction for sand (Tampubolon et al. 2017, eqs. 26-27 with the sign that conserves
// volume). Sand that opened in tension forgets by how much; this effect remembers it per particle and takes
// the next compression from it first, so that a bed which was thrown and fell does not keep the bulk of its flight.
#pragma once

#include "engine/base/params.h"
#include "engine/step/step_plan.h"

namespace repose {

struct VolumeCorrection {
  bool enabled = false;  ///< set by the presence of the scene key "volume_correction"
};

void describe(Fields& fields, VolumeCorrection& correction);

/// The channel that remembers, log volume gained per particle.
inline constexpr const char* kVolumeGained = "volume_gained";

/// The halves before and after the return map of a set; `channel` is the set's position among its extra channels.
template <class Real>
ParticlePass<Real> open_volume_pass(const StepPlan<Real>& plan, std::size_t channel);
template <class Real>
ParticlePass<Real> close_volume_pass(const StepPlan<Real>& plan, std::size_t channel);

}  // namespace repose
