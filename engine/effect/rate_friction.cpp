#include "engine/effect/rate_friction.h"

#include <cmath>

namespace repose {

std::vector<Example> RateFriction::examples() {
  return {{"rate_friction", {}, {"materials.sand.rate_friction={}"}}};
}

void RateFriction::declare_in_sand(Fields& fields, const std::string& material) {
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

template <class Real>
void RateFriction::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const RateFrictionParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  const DruckerPragerParameters& sand = assembly.sets[set].sand();
  const double bulk = sand.elasticity.lambda() + 2.0 / 3.0 * sand.elasticity.mu();
  const RateConstants<Real> law{
      static_cast<Real>(sand.cone_of_slope(std::sqrt(2.0) / 3.0 * p->rise)), static_cast<Real>(p->threshold),
      static_cast<Real>(p->grain_diameter * std::sqrt(2.0 * p->grain_density / bulk))};
  assembly.gather(set).add({"rate friction", why()}, reads(kTrialStrain, kCohesion, kCone), writes(kCone),
                           [kernel = assembly.plan.kernels->quicken, law](const auto& at) {
                             kernel(at.read(kTrialStrain).data(), at.read(kCohesion), law, at.dt(),
                                    at.write(kCone), at.count());
                           });
}

template void RateFriction::add_before_return(Assembly<float>&, std::size_t) const;
template void RateFriction::add_before_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
