#include "engine/effect/cohesion.h"

#include <algorithm>

#include "engine/effect/effect.h"
#include "kernels/effect/cohesion.h"

namespace repose {

std::vector<Example> Cohesion::examples() {
  return {{"cohesion", {}, {"materials.sand.cohesion={}"}},
          {"cohesion: tension", {}, {R"(materials.sand.cohesion={"tension": {"limit": 100}})"}}};
}

void Cohesion::declare_in_cone(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, CohesionParameters& p) {
    f.number("strength", p.strength,
             {.unit = "Pa", .meaning = "c of Mohr-Coulomb; damp sand has 500 to 5000", .low = 0.0});
    f.object(
        "tension", p.cut_off, false,
        "bounds the tension that the sand carries (Rankine); without it, the cone does", [&](Fields& limit) {
          limit.number("limit", p.tension, {.unit = "Pa", .meaning = "largest principal stress", .low = 0.0});
        });
  };
  declare_entry(fields, kName, "strength without pressure", material, describe);
}

namespace {

template <class Real>
class CohesionOfSand : public Effect<Real> {
 public:
  explicit CohesionOfSand(const Cohesion& cohesion) : cohesion_(cohesion) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(cohesion_, [&](SetSlots<Real>& set, const CohesionParameters& p) {
      const SetDescription& of = set.description;
      const auto strength = static_cast<Real>(of.cone()->cohesion_strain(of.elasticity(), p.strength));
      set.before_return.add(
          {"cohesion", cohesion_.why()}, reads(kCohesion), writes(kCohesion),
          [strength](const auto& at) { std::fill_n(at.write(kCohesion), at.count(), strength); });
      if (p.cut_off) cut_tension(plan, set, p);
    });
  }

 private:
  void cut_tension(PlanBuilder<Real>& plan, SetSlots<Real>& set, const CohesionParameters& p) const {
    const auto trace = when(set.before_return.provides(kTraceOfTrial), kTraceOfTrial);
    set.after_return.add({"tension cut-off", cohesion_.why() + ".tension"}, reads(kHenckyStrain, trace),
                         writes(kHenckyStrain, trace),
                         [kernel = cohesion_kernels<Real>(plan.target()).cut_tension,
                          elastic = HenckyConstants<Real>(set.description.elasticity()),
                          limit = static_cast<Real>(p.tension)](const auto& at) {
                           kernel(at.write(kHenckyStrain).data(), elastic, limit, at.write(kTraceOfTrial),
                                  at.count());
                         });
  }

  Cohesion cohesion_;
};

}  // namespace

REPOSE_EFFECT(Cohesion, CohesionOfSand)

}  // namespace repose
