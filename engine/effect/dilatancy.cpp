#include "engine/effect/dilatancy.h"

#include <algorithm>

namespace repose {

std::vector<Example> Dilatancy::examples() {
  return {{"dilatancy", {}, {"materials.sand.dilatancy={}"}}};
}

void Dilatancy::declare_in_sand(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, DilatancyParameters& p) {
    f.number("angle", p.angle,
             {.unit = "degrees",
              .meaning = "psi; dense sand has 5 to 15",
              .low = 0.0,
              .high = 90.0,
              .high_open = true});
    f.number("limit", p.limit,
             {.meaning = "log volume opened by shear at which it has faded", .low = 0.0, .low_open = true});
  };
  declare_entry(fields, kName, "shear opens the sand", material, describe);
}

std::vector<Channel> Dilatancy::channels(const SetDescription& set) const {
  return find(set) == nullptr ? std::vector<Channel>{} : std::vector<Channel>{{kOpened}};
}

template <class Real>
void Dilatancy::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const DilatancyParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  const std::size_t channel = assembly.state.sets[set].extra_index(kOpened);
  const auto slope = static_cast<Real>(assembly.sets[set].sand().cone_slope_at(p->angle));
  const auto per_limit = static_cast<Real>(1.0 / p->limit);
  assembly.plan.gather[set].push_back(
      {{"dilatancy, slope", why(), {kOpened, "dilatancy"}, {"dilatancy"}}, [=](Chunk<Real>& chunk) {
         const Real* const opened = chunk.set.extra[channel].values.data() + chunk.first;
         Real* const dilatancy = chunk.scratch.yield.dilatancy.data();
         for (std::size_t i = 0; i < chunk.particles.count; ++i) {
           dilatancy[i] = slope * std::max(Real(1) - per_limit * opened[i], Real(0));
         }
       }});
}

/// What shear has opened is no gap to be closed: volume correction, whose halves enclose this one, must not
/// take it for one.
template <class Real>
void Dilatancy::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  if (find(assembly.sets[set]) == nullptr) return;
  const std::size_t channel = assembly.state.sets[set].extra_index(kOpened);
  assembly.plan.gather[set].push_back(
      {{"dilatancy, opening", why(), {kOpened, "dilated"}, {kOpened, "trace of trial"}},
       [channel](Chunk<Real>& chunk) {
         Real* const opened = chunk.set.extra[channel].values.data() + chunk.first;
         Real* const trace = chunk.scratch.value.data();
         const Real* const dilated = chunk.scratch.yield.dilated.data();
         for (std::size_t i = 0; i < chunk.particles.count; ++i) {
           opened[i] += dilated[i];
           trace[i] -= dilated[i];
         }
       }});
}

template void Dilatancy::add_before_return(Assembly<float>&, std::size_t) const;
template void Dilatancy::add_before_return(Assembly<double>&, std::size_t) const;
template void Dilatancy::add_after_return(Assembly<float>&, std::size_t) const;
template void Dilatancy::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
