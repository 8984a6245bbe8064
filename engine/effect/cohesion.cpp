#include "engine/effect/cohesion.h"

#include <algorithm>

namespace repose {

std::vector<Example> Cohesion::examples() {
  return {{"cohesion", {}, {"materials.sand.cohesion={}"}},
          {"cohesion: tension", {}, {R"(materials.sand.cohesion={"tension": {"limit": 100}})"}}};
}

void Cohesion::declare_in_sand(Fields& fields, const std::string& material) {
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

template <class Real>
void Cohesion::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const CohesionParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  const DruckerPragerParameters& sand = assembly.sets[set].sand();
  const auto strength = static_cast<Real>(sand.cohesion_strain(p->strength));
  assembly.gather(set).add(
      {"cohesion", why()}, reads(kCohesion), writes(kCohesion),
      [strength](const auto& at) { std::fill_n(at.write(kCohesion), at.count(), strength); });
}

template <class Real>
void Cohesion::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  const CohesionParameters* p = find(assembly.sets[set]);
  if (p == nullptr || !p->cut_off) return;
  const HenckyConstants<Real> elastic(assembly.sets[set].elasticity());
  auto passes = assembly.gather(set);
  const auto trace = when(passes.provides(kTraceOfTrial), kTraceOfTrial);
  passes.add({"tension cut-off", why() + ".tension"}, reads(kHenckyStrain, trace), writes(kHenckyStrain, trace),
             [kernel = assembly.plan.kernels->cut_tension, elastic,
              limit = static_cast<Real>(p->tension)](const auto& at) {
               kernel(at.write(kHenckyStrain).data(), elastic, limit, at.write(kTraceOfTrial), at.count());
             });
}

template void Cohesion::add_before_return(Assembly<float>&, std::size_t) const;
template void Cohesion::add_before_return(Assembly<double>&, std::size_t) const;

template void Cohesion::add_after_return(Assembly<float>&, std::size_t) const;
template void Cohesion::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
