#include "engine/effect/volume_correction.h"

namespace repose {

// The law has no number to choose: the presence of its key turns it on.
void describe(Fields&, VolumeCorrection&) {}

template <class Real>
ParticlePass<Real> open_volume_pass(const StepPlan<Real>& plan, std::size_t channel) {
  const auto kernel = plan.kernels->open_volume;
  return {{"volume correction, before", "volume_correction", {"trial strain", kVolumeGained}, {"trial strain", "trace of trial"}},
          [kernel, channel](Chunk<Real>& chunk) {
            const Real* gained = chunk.set.extra[channel].values.data() + chunk.first;
            kernel(chunk.particles.strain, gained, chunk.scratch.value.data(), chunk.particles.count);
          }};
}

template <class Real>
ParticlePass<Real> close_volume_pass(const StepPlan<Real>& plan, std::size_t channel) {
  const auto kernel = plan.kernels->close_volume;
  return {{"volume correction, after", "volume_correction", {"strain", "trace of trial"}, {kVolumeGained}},
          [kernel, channel](Chunk<Real>& chunk) {
            Real* gained = chunk.set.extra[channel].values.data() + chunk.first;
            kernel(chunk.particles.strain, gained, chunk.scratch.value.data(), chunk.particles.count);
          }};
}

template ParticlePass<float> open_volume_pass(const StepPlan<float>&, std::size_t);
template ParticlePass<double> open_volume_pass(const StepPlan<double>&, std::size_t);
template ParticlePass<float> close_volume_pass(const StepPlan<float>&, std::size_t);
template ParticlePass<double> close_volume_pass(const StepPlan<double>&, std::size_t);

}  // namespace repose
