#include "engine/effect/hardening.h"

#include <cmath>

#include "engine/effect/effect.h"
#include "kernels/effect/hardening.h"

namespace repose {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;

/// The largest angle that any q >= 0 gives, degrees: at the end, at the start, or where the slope vanishes.
double largest_angle(const HardeningParameters& p) {
  double most = std::max(p.h0, p.angle(0.0));
  if (p.h1 > 0.0 && p.h2 > 0.0) most = std::max(most, p.angle(1.0 / p.h2 + p.h3 / p.h1));
  return most;
}

}  // namespace

std::vector<Example> Hardening::examples() {
  return {{"hardening", {}, {"materials.sand.hardening={}"}}};
}

void Hardening::declare_in_cone(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, HardeningParameters& p) {
    f.number(
        "h0", p.h0,
        {.unit = "degrees", .meaning = "angle after long shear", .low = 0.0, .high = 90.0, .high_open = true});
    f.number("h1", p.h1, {.unit = "degrees", .meaning = "what a unit of shear adds at first", .low = 0.0});
    f.number("h2", p.h2,
             {.meaning = "rate at which that, and h3, are forgotten", .low = 0.0, .low_open = true});
    f.number("h3", p.h3, {.unit = "degrees", .meaning = "how far below h0 the angle begins", .low = 0.0});
    f.number("initial", p.initial, {.meaning = "plastic shear q at the start", .low = 0.0});
    f.flag("in_flight", p.in_flight, "whether sand that opens hardens too, as in Klar et al. 2016");
    f.check(p.h3 < p.h0 || (p.h3 == 0.0 && p.h0 == 0.0), "h3",
            "must be below h0, so that sand has friction from the start");
    f.check(largest_angle(p) < 90.0, "h1", "lets the angle reach 90 degrees; less h1 or more h2");
  };
  declare_entry(
      fields, kName,
      "friction follows plastic shear q: phi = h0 + (h1 q - h3) exp(-h2 q), Klar et al. 2016, eqs. 29-31; "
      "the angle replaces friction_angle in the cone",
      material, describe);
}

std::vector<Channel> Hardening::channels(const SetDescription& set) const {
  const HardeningParameters* p = find(set);
  return p == nullptr ? std::vector<Channel>{} : std::vector<Channel>{{kShear, p->initial}};
}

namespace {

template <class Real>
class HardeningFriction : public Effect<Real> {
 public:
  explicit HardeningFriction(const Hardening& hardening) : hardening_(hardening) {}

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(hardening_, [&](SetSlots<Real>& set, const HardeningParameters& p) {
      set.before_return.add(
          {"hardening, angle", hardening_.why()}, reads(Hardening::kShear, kYieldSlope), writes(kYieldSlope),
          [kernel = hardening_kernels<Real>(plan.target()).harden, law = law_of(set.description, p)](
              const auto& at) { kernel(at.read(Hardening::kShear), law, at.write(kYieldSlope), at.count()); });
      set.after_return.add({"hardening, shear", hardening_.why()}, reads(Hardening::kShear, kPlastic, kSheared),
                           writes(Hardening::kShear), [in_flight = p.in_flight](const auto& at) {
                             Real* const q = at.write(Hardening::kShear);
                             // A sum of two arrays: what the compiler makes of it is enough.
                             const Real* const gained = in_flight ? at.read(kPlastic) : at.read(kSheared);
                             for (std::size_t i = 0; i < at.count(); ++i) q[i] += gained[i];
                           });
    });
  }

 private:
  static HardeningConstants<Real> law_of(const SetDescription& set, const HardeningParameters& p) {
    const FrictionalCone& cone = *set.cone();
    return {static_cast<Real>(p.h0 * kRadians),
            static_cast<Real>(p.h1 * kRadians),
            static_cast<Real>(p.h2),
            static_cast<Real>(p.h3 * kRadians),
            cone.matching,
            static_cast<Real>(cone.yield_slope_of(set.elasticity(), 1.0))};
  }

  Hardening hardening_;
};

}  // namespace

REPOSE_EFFECT(Hardening, HardeningFriction)

}  // namespace repose
