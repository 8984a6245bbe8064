#include "engine/effect/plastic_strain.h"

#include "engine/effect/effect.h"
#include "kernels/effect/plastic_strain.h"

namespace repose {

std::vector<Example> PlasticStrain::examples() {
  return {{"plastic_strain", {}, {"plastic_strain={}"}}};
}

void PlasticStrain::declare(Fields& fields, const SceneOutline&) {
  fields.feature("plastic_strain", enabled,
                 "particles add up how much they have flowed, for the attribute \"plastic_strain\" of "
                 "output.attributes",
                 [](Fields&) {});
}

namespace {

/// The trial strain as the return map finds it, for what follows that.
inline constexpr Handle<"trial strain, kept", Place::kScratch, kStrainComponents> kKeptTrial;

template <class Real>
class FlowSoFar : public Effect<Real> {
 public:
  explicit FlowSoFar(const PlasticStrain& measure) : measure_(measure) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    const char* const why = PlasticStrain::kName;
    for (SetSlots<Real>& set : plan.sets) {
      if (measure_.channels(set.description).empty()) continue;
      set.before_return.add({"plastic strain, before", why}, reads(kTrialStrain), writes(kKeptTrial),
                            [](const auto& at) {
                              const auto trial = at.read(kTrialStrain);
                              const auto kept = at.write(kKeptTrial);
                              for (std::size_t k = 0; k < kStrainComponents; ++k)
                                std::copy_n(trial[k], at.count(), kept[k]);
                            });
      set.after_return.add({"plastic strain, after", why},
                           reads(kHenckyStrain, kKeptTrial, kEquivalentPlasticStrain),
                           writes(kEquivalentPlasticStrain),
                           [kernel = plastic_strain_kernels<Real>(plan.target()).accumulate](const auto& at) {
                             kernel(at.read(kKeptTrial).data(), at.read(kHenckyStrain).data(),
                                    at.write(kEquivalentPlasticStrain), at.count());
                           });
    }
  }

 private:
  PlasticStrain measure_;
};

}  // namespace

REPOSE_EFFECT(PlasticStrain, FlowSoFar)

}  // namespace repose
