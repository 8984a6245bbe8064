#include "engine/effect/volume_correction.h"

namespace repose {

// The law has no number to choose: the presence of its key turns it on.
std::vector<Example> VolumeCorrection::examples() {
  return {{"volume_correction", {}, {"volume_correction={}"}}};
}

void VolumeCorrection::declare(Fields& fields) {
  fields.object("volume_correction", enabled, false,
                "sand that opened in tension closes before it carries load again, Tampubolon et al. 2017",
                [](Fields&) {});
}

template <class Real>
void VolumeCorrection::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const std::size_t channel = assembly.state.sets[set].extra_index(kGained);
  const auto open = [kernel = assembly.plan.kernels->open_volume, channel](Chunk<Real>& chunk) {
    const Real* gained = chunk.set.extra[channel].values.data() + chunk.first;
    kernel(chunk.particles.strain, gained, chunk.scratch.value.data(), chunk.particles.count);
  };
  assembly.plan.gather[set].push_back(
      {{"volume correction, before", kName, {"trial strain", kGained}, {"trial strain", "trace of trial"}},
       open});
}

template <class Real>
void VolumeCorrection::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  const std::size_t channel = assembly.state.sets[set].extra_index(kGained);
  const auto close = [kernel = assembly.plan.kernels->close_volume, channel](Chunk<Real>& chunk) {
    Real* gained = chunk.set.extra[channel].values.data() + chunk.first;
    kernel(chunk.particles.strain, gained, chunk.scratch.value.data(), chunk.particles.count);
  };
  assembly.plan.gather[set].push_back(
      {{"volume correction, after", kName, {"strain", "trace of trial"}, {kGained}}, close});
}

template void VolumeCorrection::add_before_return(Assembly<float>&, std::size_t) const;
template void VolumeCorrection::add_before_return(Assembly<double>&, std::size_t) const;
template void VolumeCorrection::add_after_return(Assembly<float>&, std::size_t) const;
template void VolumeCorrection::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
