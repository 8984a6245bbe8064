#include "engine/effect/cohesion.h"

#include <algorithm>

namespace repose {

void Cohesion::declare_in_sand(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, CohesionParameters& p) {
    f.number("strength", p.strength,
             {.unit = "Pa", .meaning = "c of Mohr-Coulomb; damp sand has 500 to 5000", .low = 0.0});
    f.object("tension", p.cut_off, false, "bounds the tension that the sand carries; without it, the cone does",
             [&](Fields& limit) {
               limit.number("limit", p.tension, {.unit = "Pa", .meaning = "largest mean tension", .low = 0.0});
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
  // tr(tau) = (3 lambda + 2 mu) tr(eps), and mean tension is a third of it.
  const double bulk = 3.0 * sand.elasticity.lambda() + 2.0 * sand.elasticity.mu();
  const auto tension =
      p->cut_off ? static_cast<Real>(3.0 * p->tension / bulk) : std::numeric_limits<Real>::max();
  assembly.plan.gather[set].push_back(
      {{"cohesion", why(), {"cohesion", "tension"}, {"cohesion", "tension"}}, [=](Chunk<Real>& chunk) {
         auto& yield = chunk.scratch.yield;
         std::fill_n(yield.cohesion.data(), chunk.particles.count, strength);
         std::fill_n(yield.tension.data(), chunk.particles.count, tension);
       }});
}

template void Cohesion::add_before_return(Assembly<float>&, std::size_t) const;
template void Cohesion::add_before_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
