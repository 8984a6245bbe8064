#include "engine/effect/density_correction.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"
#include "kernels/effect/density_correction.h"

namespace repose {

std::vector<Example> DensityCorrection::examples() {
  return {{"density_correction", {}, {"density_correction={}"}},
          {"density_correction: with a gap", {"volume_correction={}"}, {"density_correction={}"}}};
}

void DensityCorrection::declare(Fields& fields, const SceneOutline&) {
  fields.feature("density_correction", enabled,
                 "sand that is sheared for long stays as dense as its particles lie", [this](Fields& f) {
                   f.number(
                       "shear", shear,
                       {.meaning = "shear strain over which a difference goes", .low = 0.0, .low_open = true});
                 });
}

namespace {

template <class Real>
class DensityOfSand : public Effect<Real> {
 public:
  explicit DensityOfSand(const DensityCorrection& correction) : correction_(correction) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    cell_ = std::pow(surroundings.spacing, 3);
    return {};
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    // Nodes do not say whose mass they hold: beside something denser, sand would believe to be crowded.
    double densest = 0.0;
    for (const SetSlots<Real>& set : plan.sets) {
      densest = std::max(densest, set.description.elasticity().density);
    }
    const DensityConstants<Real> law{static_cast<Real>(densest * cell_),
                                     static_cast<Real>(1.0 / correction_.shear)};
    for (SetSlots<Real>& set : plan.sets) {
      if (set.description.cone() == nullptr) continue;
      const auto gained = when(has_gap(set.description), kVolumeGained);
      set.after_motion.add(
          {"density correction", correction_.why()}, reads(kMassAround, kGradient, kHenckyStrain, gained),
          writes(kHenckyStrain, gained),
          [law, kernel = density_correction_kernels<Real>(plan.target()).compact](const auto& at) {
            kernel(at.read(kMassAround), at.read(kGradient).data(), law, at.dt(),
                   at.write(kHenckyStrain).data(), at.write(kVolumeGained), at.count());
          });
    }
  }

 private:
  static bool has_gap(const SetDescription& set) {
    return std::any_of(set.channels.begin(), set.channels.end(),
                       [](const Channel& channel) { return channel.name == kVolumeGained.kName; });
  }

  DensityCorrection correction_;
  double cell_ = 0.0;  // dx^3, m^3
};

}  // namespace

REPOSE_EFFECT(DensityCorrection, DensityOfSand)

}  // namespace repose
