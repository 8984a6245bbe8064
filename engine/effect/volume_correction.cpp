#include "engine/effect/volume_correction.h"

#include "engine/effect/effect.h"
#include "kernels/effect/volume_correction.h"

namespace repose {

// The law has no number to choose: the presence of its key turns it on.
std::vector<Example> VolumeCorrection::examples() {
  return {{"volume_correction", {}, {"volume_correction={}"}}};
}

void VolumeCorrection::declare(Fields& fields, const SceneOutline&) {
  fields.feature("volume_correction", enabled,
                 "sand that opened in tension closes before it carries load again, Tampubolon et al. 2017",
                 [](Fields&) {});
}

namespace {

template <class Real>
class GapsOfSand : public Effect<Real> {
 public:
  explicit GapsOfSand(const VolumeCorrection& correction) : correction_(correction) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    const char* const why = VolumeCorrection::kName;
    for (SetSlots<Real>& set : plan.sets) {
      if (correction_.channels(set.description).empty()) continue;
      set.before_return.add(
          {"volume correction, before", why}, reads(kTrialStrain, kVolumeGained),
          writes(kTrialStrain, kTraceOfTrial),
          [kernel = volume_correction_kernels<Real>(plan.target()).open_volume](const auto& at) {
            kernel(at.write(kTrialStrain).data(), at.read(kVolumeGained), at.write(kTraceOfTrial), at.count());
          });
      set.after_return.add(
          {"volume correction, after", why}, reads(kHenckyStrain, kTraceOfTrial), writes(kVolumeGained),
          [kernel = volume_correction_kernels<Real>(plan.target()).close_volume](const auto& at) {
            kernel(at.read(kHenckyStrain).data(), at.write(kVolumeGained), at.read(kTraceOfTrial), at.count());
          });
    }
  }

 private:
  VolumeCorrection correction_;
};

}  // namespace

REPOSE_EFFECT(VolumeCorrection, GapsOfSand)

}  // namespace repose
