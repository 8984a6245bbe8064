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
  assembly.plan.gather[set].push_back(
      {{"cohesion", why(), {"cohesion"}, {"cohesion"}}, [strength](Chunk<Real>& chunk) {
         std::fill_n(chunk.scratch.yield.cohesion.data(), chunk.particles.count, strength);
       }});
}

template <class Real>
void Cohesion::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  const CohesionParameters* p = find(assembly.sets[set]);
  if (p == nullptr || !p->cut_off) return;
  const HenckyConstants<Real> elastic(assembly.sets[set].elasticity());
  assembly.plan.gather[set].push_back(
      {{"tension cut-off", why() + ".tension", {"strain"}, {"strain", "trace of trial"}},
       [kernel = assembly.plan.kernels->cut_tension, elastic,
        limit = static_cast<Real>(p->tension)](Chunk<Real>& chunk) {
         kernel(chunk.particles.strain, elastic, limit, chunk.scratch.value.data(), chunk.particles.count);
       }});
}

template void Cohesion::add_before_return(Assembly<float>&, std::size_t) const;
template void Cohesion::add_before_return(Assembly<double>&, std::size_t) const;

template void Cohesion::add_after_return(Assembly<float>&, std::size_t) const;
template void Cohesion::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
