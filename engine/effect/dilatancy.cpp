#include "engine/effect/dilatancy.h"

#include <algorithm>

#include "engine/effect/effect.h"

namespace repose {

std::vector<Example> Dilatancy::examples() {
  return {{"dilatancy", {}, {"materials.sand.dilatancy={}"}}};
}

void Dilatancy::declare_in_cone(Fields& fields, const std::string& material) {
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

namespace {

template <class Real>
class OpeningByShear : public Effect<Real> {
 public:
  explicit OpeningByShear(const Dilatancy& dilatancy) : dilatancy_(dilatancy) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(dilatancy_, [&](SetSlots<Real>& set, const DilatancyParameters& p) {
      add_slope(set, p);
      add_opening(set);
    });
  }

 private:
  static constexpr auto kOpened = Dilatancy::kOpened;

  void add_slope(SetSlots<Real>& set, const DilatancyParameters& p) const {
    const auto slope = static_cast<Real>(set.description.cone()->cone_slope_at(p.angle));
    const auto per_limit = static_cast<Real>(1.0 / p.limit);
    set.before_return.add({"dilatancy, slope", dilatancy_.why()}, reads(kOpened, kDilatancy),
                          writes(kDilatancy), [=](const auto& at) {
                            const Real* const opened = at.read(kOpened);
                            Real* const dilatancy = at.write(kDilatancy);
                            for (std::size_t i = 0; i < at.count(); ++i) {
                              dilatancy[i] = slope * std::max(Real(1) - per_limit * opened[i], Real(0));
                            }
                          });
  }

  /// What shear has opened is no gap to be closed: volume correction, whose halves enclose this one, must not
  /// take it for one.
  void add_opening(SetSlots<Real>& set) const {
    const auto trace = when(set.before_return.provides(kTraceOfTrial), kTraceOfTrial);
    set.after_return.add({"dilatancy, opening", dilatancy_.why()}, reads(kOpened, kDilated, trace),
                         writes(kOpened, trace), [](const auto& at) {
                           Real *const opened = at.write(kOpened), *const gap = at.write(kTraceOfTrial);
                           const Real* const dilated = at.read(kDilated);
                           for (std::size_t i = 0; i < at.count(); ++i) opened[i] += dilated[i];
                           if (gap == nullptr) return;
                           for (std::size_t i = 0; i < at.count(); ++i) gap[i] -= dilated[i];
                         });
  }

  Dilatancy dilatancy_;
};

}  // namespace

REPOSE_EFFECT(Dilatancy, OpeningByShear)

}  // namespace repose
