#include "engine/effect/rate_friction.h"

#include <cmath>

#include "engine/effect/effect.h"
#include "kernels/effect/rate_friction.h"

namespace repose {

std::vector<Example> RateFriction::examples() {
  return {{"rate_friction", {}, {"materials.sand.rate_friction={}"}}};
}

void RateFriction::declare_in_cone(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, RateFrictionParameters& p) {
    f.number("rise", p.rise, {.meaning = "mu_2 - mu_s, what fast shear adds to the friction", .low = 0.0});
    f.number(
        "threshold", p.threshold,
        {.meaning = "I0, the inertial number at which half of it is reached", .low = 0.0, .low_open = true});
    f.number("grain_diameter", p.grain_diameter,
             {.unit = "m", .meaning = "d of the inertial number", .low = 0.0, .low_open = true});
    f.number("grain_density", p.grain_density,
             {.unit = "kg/m^3", .meaning = "rho_s, of the grains without pores", .low = 0.0, .low_open = true});
  };
  declare_entry(fields, kName, "friction rises with the rate of shear: mu(I), Jop et al. 2006", material,
                describe);
}

namespace {

template <class Real>
class FrictionByRate : public Effect<Real> {
 public:
  explicit FrictionByRate(const RateFriction& friction) : friction_(friction) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(friction_, [&](SetSlots<Real>& set, const RateFrictionParameters& p) {
      set.before_return.add({"rate friction", friction_.why()}, reads(kTrialStrain, kCohesion, kYieldSlope),
                            writes(kYieldSlope),
                            [kernel = rate_friction_kernels<Real>(plan.target()).strengthen,
                             law = law_of(set.description, p)](const auto& at) {
                              kernel(at.read(kTrialStrain).data(), at.read(kCohesion), law, at.dt(),
                                     at.write(kYieldSlope), at.count());
                            });
    });
  }

 private:
  static RateConstants<Real> law_of(const SetDescription& set, const RateFrictionParameters& p) {
    const Elasticity& e = set.elasticity();
    const double bulk = e.lambda() + 2.0 / 3.0 * e.mu();
    return {static_cast<Real>(set.cone()->yield_slope_of(e, std::sqrt(2.0) / 3.0 * p.rise)),
            static_cast<Real>(p.threshold),
            static_cast<Real>(p.grain_diameter * std::sqrt(2.0 * p.grain_density / bulk))};
  }

  RateFriction friction_;
};

}  // namespace

REPOSE_EFFECT(RateFriction, FrictionByRate)

}  // namespace repose
