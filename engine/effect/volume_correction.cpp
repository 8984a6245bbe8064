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
  assembly.gather(set).add(
      {"volume correction, before", kName}, reads(kTrialStrain, kVolumeGained),
      writes(kTrialStrain, kTraceOfTrial), [kernel = assembly.plan.kernels->open_volume](const auto& at) {
        kernel(at.write(kTrialStrain).data(), at.read(kVolumeGained), at.write(kTraceOfTrial), at.count());
      });
}

template <class Real>
void VolumeCorrection::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  assembly.gather(set).add(
      {"volume correction, after", kName}, reads(kHenckyStrain, kTraceOfTrial), writes(kVolumeGained),
      [kernel = assembly.plan.kernels->close_volume](const auto& at) {
        kernel(at.read(kHenckyStrain).data(), at.write(kVolumeGained), at.read(kTraceOfTrial), at.count());
      });
}

template void VolumeCorrection::add_before_return(Assembly<float>&, std::size_t) const;
template void VolumeCorrection::add_before_return(Assembly<double>&, std::size_t) const;
template void VolumeCorrection::add_after_return(Assembly<float>&, std::size_t) const;
template void VolumeCorrection::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
