// Repose tests: the passes that shape how sand yields, run over lists: the kernels of one instruction set, or
// the reference. Strains go in and come out particle by particle; one number more than asked for lies behind
// every channel and must stay as it is.
#pragma once

#include <optional>

#include "kernels/effect/cohesion.h"
#include "kernels/effect/hardening.h"
#include "kernels/effect/rate_friction.h"
#include "kernels/reference/yield.h"
#include "tests/kernels/material_rig.h"

namespace repose {

template <class Real>
class YieldRig {
 public:
  using Strains = std::vector<Symmetric<Real>>;
  using Numbers = std::vector<Real>;

  /// Without a target, the reference.
  explicit YieldRig(std::optional<Target> target = std::nullopt) : target_(target) {}
  const char* name() const { return target_ ? target_name(*target_) : "reference"; }

  Numbers harden(Numbers q, const HardeningConstants<Real>& law) const {
    Numbers yield_slope(q.size() + 1, kCanary<Real>);
    const auto run = target_ ? hardening_kernels<Real>(*target_).harden : reference::harden<Real>;
    run(q.data(), law, yield_slope.data(), q.size());
    return without_canary(yield_slope);
  }

  Numbers strengthen(const Strains& strains, const Numbers& cohesion, const RateConstants<Real>& law, Real dt,
                     Numbers yield_slope) const {
    Channels channels(strains);
    const Real* strain[6];
    std::copy_n(channels.pointers, 6, strain);
    yield_slope.push_back(kCanary<Real>);
    const auto run = target_ ? rate_friction_kernels<Real>(*target_).strengthen : reference::strengthen<Real>;
    run(strain, cohesion.data(), law, dt, yield_slope.data(), strains.size());
    return without_canary(yield_slope);
  }

  Strains cut_tension(const Strains& strains, const HenckyConstants<Real>& elastic, Real limit,
                      Numbers& trace) const {
    Channels channels(strains);
    trace.push_back(kCanary<Real>);
    const auto run = target_ ? cohesion_kernels<Real>(*target_).cut_tension : reference::cut_tension<Real>;
    run(channels.pointers, elastic, limit, trace.data(), strains.size());
    trace = without_canary(trace);
    return channels.strains();
  }

  /// The yield surface of each particle, and what yielding did.
  struct Surface {
    Numbers yield_slope, cohesion, dilatancy;
    Numbers plastic = {}, sheared = {}, dilated = {};
  };
  Strains return_map(const Strains& strains, Surface& surface) const {
    Channels channels(strains);
    MaterialInput<Real> in{};
    std::copy_n(channels.pointers, 6, in.strain);
    in.count = strains.size();
    Numbers* const results[] = {&surface.plastic, &surface.sheared, &surface.dilated};
    for (Numbers* result : results) result->assign(strains.size() + 1, kCanary<Real>);
    const YieldInput<Real> numbers{surface.yield_slope.data(), surface.cohesion.data(),
                                   surface.dilatancy.data(),   surface.plastic.data(),
                                   surface.sheared.data(),     surface.dilated.data()};
    const auto run =
        target_ ? kernels<Real>(*target_).material[material_index<DruckerPrager>()].return_map_per_particle
                : reference::return_map_per_particle_drucker_prager<Real>;
    run(in, numbers);
    for (Numbers* result : results) *result = without_canary(*result);
    return channels.strains();
  }

 private:
  struct Channels {
    explicit Channels(const Strains& strains) {
      for (std::size_t k = 0; k < 6; ++k) {
        for (const auto& strain : strains) values[k].push_back(strain[k]);
        values[k].push_back(kCanary<Real>);
        pointers[k] = values[k].data();
      }
    }
    Strains strains() const {
      Strains all(values[0].size() - 1);
      for (std::size_t k = 0; k < 6; ++k) {
        EXPECT_EQ(values[k].back(), kCanary<Real>) << "writes beyond the strains";
        for (std::size_t p = 0; p < all.size(); ++p) all[p][k] = values[k][p];
      }
      return all;
    }
    Numbers values[6];
    Real* pointers[6];
  };

  static Numbers without_canary(Numbers numbers) {
    EXPECT_EQ(numbers.back(), kCanary<Real>) << "writes beyond the numbers";
    numbers.pop_back();
    return numbers;
  }

  std::optional<Target> target_;
};

/// Every instruction set of this machine.
template <class Real>
std::vector<YieldRig<Real>> yield_rigs() {
  std::vector<YieldRig<Real>> all;
  for (const Target target : supported_targets()) all.emplace_back(target);
  return all;
}

/// Strains from those of stiff sand to absurd ones, among them none at all, pure pressure, pure tension, and
/// numbers that vanish when squared.
template <class Real>
std::vector<Symmetric<Real>> strains_for_yielding(std::size_t count, std::uint64_t seed) {
  auto strains = strains_of_all_sizes<Real>(count, 1e-9, seed);
  const Real denormal = std::numeric_limits<Real>::denorm_min();
  const Real vanishing = std::sqrt(std::numeric_limits<Real>::min()) / 8;
  for (const Real size : {Real(0), denormal, std::numeric_limits<Real>::min(), vanishing, Real(1e-12),
                          Real(1e-3), Real(1), Real(1e4), Real(1e12)}) {
    for (const Real sign : {Real(-1), Real(1)}) {
      const Real s = sign * size;
      strains.push_back({s, 0, 0, s, 0, s});
      strains.push_back({s, 0, 0, 0, 0, 0});
      strains.push_back({0, s, 0, 0, 0, 0});
      strains.push_back({-s / 2, s, s, -s, s / 4, -s});
    }
  }
  return strains;
}

}  // namespace repose
