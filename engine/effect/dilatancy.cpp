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
  const auto slope = static_cast<Real>(assembly.sets[set].sand().cone_slope_at(p->angle));
  const auto per_limit = static_cast<Real>(1.0 / p->limit);
  assembly.gather(set).add({"dilatancy, slope", why()}, reads(kOpened, kDilatancy), writes(kDilatancy),
                           [=](const auto& at) {
                             const Real* const opened = at.read(kOpened);
                             Real* const dilatancy = at.write(kDilatancy);
                             for (std::size_t i = 0; i < at.count(); ++i) {
                               dilatancy[i] = slope * std::max(Real(1) - per_limit * opened[i], Real(0));
                             }
                           });
}

/// What shear has opened is no gap to be closed: volume correction, whose halves enclose this one, must not
/// take it for one.
template <class Real>
void Dilatancy::add_after_return(Assembly<Real>& assembly, std::size_t set) const {
  if (find(assembly.sets[set]) == nullptr) return;
  auto passes = assembly.gather(set);
  const auto trace = when(passes.provides(kTraceOfTrial), kTraceOfTrial);
  passes.add({"dilatancy, opening", why()}, reads(kOpened, kDilated, trace), writes(kOpened, trace),
             [](const auto& at) {
               Real *const opened = at.write(kOpened), *const gap = at.write(kTraceOfTrial);
               const Real* const dilated = at.read(kDilated);
               for (std::size_t i = 0; i < at.count(); ++i) opened[i] += dilated[i];
               if (gap == nullptr) return;
               for (std::size_t i = 0; i < at.count(); ++i) gap[i] -= dilated[i];
             });
}

template void Dilatancy::add_before_return(Assembly<float>&, std::size_t) const;
template void Dilatancy::add_before_return(Assembly<double>&, std::size_t) const;
template void Dilatancy::add_after_return(Assembly<float>&, std::size_t) const;
template void Dilatancy::add_after_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
