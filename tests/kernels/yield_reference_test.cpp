// Repose tests: the kernels that shape how sand yields, on every instruction set, against the reference. Bounds
// are a number of roundings of the largest number that a sum runs through; what is divided afterwards divides
// them too. Squares of strains vanish below the root of the smallest number, so no norm is sharper than that.
#include "tests/kernels/yield_rig.h"

namespace repose {
namespace {

template <class Real>
class YieldReference : public testing::Test {
 protected:
  using Strains = std::vector<Symmetric<Real>>;
  using Numbers = std::vector<Real>;
  static constexpr double kRounding = std::numeric_limits<Real>::epsilon();
  /// In double the reference rounds, too: the eigenvalues that it goes by are good to some ten roundings.
  static constexpr double kRoundings = (sizeof(Real) == 4 ? 6 : 24) * kRounding;
  static constexpr std::size_t kCount = 20011;

  static double vanishing() { return std::sqrt(double{std::numeric_limits<Real>::min()}); }
  static double size(const Symmetric<Real>& strain) { return largest_entry(exact(strain)); }

  /// A number for every particle; `draw` is given the samples.
  template <class Draw>
  static Numbers numbers(std::size_t count, std::uint64_t seed, Draw draw) {
    Samples samples(seed);
    Numbers all;
    for (std::size_t p = 0; p < count; ++p) all.push_back(static_cast<Real>(draw(samples)));
    return all;
  }
  static Numbers some_cohesion(std::size_t count, std::uint64_t seed) {
    return numbers(count, seed, [](Samples& s) { return s.index(3) == 0 ? 0.0 : s.power_of_ten(-8, 0); });
  }
  static typename YieldRig<Real>::Surface some_surface(std::size_t count) {
    return {numbers(count, 402,
                    [](Samples& s) {
                      const std::size_t kind = s.index(8);
                      return kind == 0 ? 0.0 : kind == 1 ? s.power_of_ten(-6, 4) : s.uniform(0.1, 2);
                    }),
            some_cohesion(count, 403),
            numbers(count, 404, [](Samples& s) { return s.index(2) == 0 ? 0.0 : s.uniform(0, 0.5); })};
  }
};
using Precisions = testing::Types<float, double>;
TYPED_TEST_SUITE(YieldReference, Precisions);

constexpr double kRadians = std::numbers::pi / 180.0;

TYPED_TEST(YieldReference, Harden_EveryMatchingAndShear_Agrees) {
  using Real = TypeParam;
  auto q = this->numbers(this->kCount, 401, [](Samples& s) { return s.power_of_ten(-9, 3); });
  for (const Real extreme : {Real(0), std::numeric_limits<Real>::denorm_min(), Real(1e30)})
    q.push_back(extreme);
  for (const auto& degrees : {std::array{35.0, 9.0, 0.2, 10.0},
                              {35.0, 9.0, 0.3, 10.0},
                              {0.0, 0.0, 1.0, 0.0},
                              {80.0, 0.0, 50.0, 79.0}}) {
    for (int matching = 0; matching < static_cast<int>(std::size(kConeMatchings)); ++matching) {
      const HardeningConstants<Real> law{
          Real(degrees[0] * kRadians), Real(degrees[1] * kRadians),         Real(degrees[2]),
          Real(degrees[3] * kRadians), static_cast<ConeMatching>(matching), Real(3.25)};
      const auto expected = YieldRig<Real>().harden(q, law);
      for (const auto& rig : yield_rigs<Real>()) {
        const auto yield_slope = rig.harden(q, law);
        for (std::size_t p = 0; p < q.size(); ++p) {
          // h2 q itself is rounded, and so is 1 - exp(-h2 q), of which nothing is left beyond 40.
          const double gone = std::min(double{law.h2} * q[p], 40.0);
          const double angle = law.h0 + (law.h1 / law.h2 * gone + law.h3) * (1.0 + gone * std::exp(-gone));
          const double bound =
              8 * this->kRounding * law.per_cone_slope * angle + std::numeric_limits<Real>::min();
          ASSERT_NEAR(yield_slope[p], expected[p], bound) << rig.name() << ", q " << q[p];
        }
      }
    }
  }
}

TYPED_TEST(YieldReference, Quicken_StrainsStepsAndLawsOfAllSizes_Agrees) {
  using Real = TypeParam;
  const auto strains = strains_for_yielding<Real>(this->kCount, 405);
  const auto cohesion = this->some_cohesion(strains.size(), 406);
  const auto before = this->numbers(strains.size(), 407, [](Samples& s) { return s.uniform(0, 2); });
  for (const double dt : {1e-7, 1e-4, 1e-2}) {
    for (const double inertia : {1e-6, 1e-4, 1e-1}) {
      const RateConstants<Real> law{Real(0.7), Real(0.279), Real(inertia)};
      const auto expected = YieldRig<Real>().strengthen(strains, cohesion, law, Real(dt), before);
      for (const auto& rig : yield_rigs<Real>()) {
        const auto yield_slope = rig.strengthen(strains, cohesion, law, Real(dt), before);
        std::size_t higher = 0;
        for (std::size_t p = 0; p < yield_slope.size(); ++p) {
          const double pressed = std::fabs(static_cast<double>(exact(strains[p]).trace()));
          const double sum = 4 * this->size(strains[p]) + cohesion[p] + (before[p] + law.rise) * pressed;
          const double bound =
              8 * this->kRounding * (sum / pressed + before[p]) + 4 * this->vanishing() / pressed;
          if (pressed > 0.0) {
            ASSERT_NEAR(yield_slope[p], expected[p], bound) << rig.name() << ", particle " << p;
          }
          ASSERT_GE(yield_slope[p], before[p]) << rig.name();
          ASSERT_LE(yield_slope[p], (before[p] + law.rise) * (1 + this->kRounding)) << rig.name();
          higher += yield_slope[p] > before[p] ? 1 : 0;
        }
        EXPECT_GT(higher, yield_slope.size() / 20) << "few yield, so little is compared";
        EXPECT_LT(higher, yield_slope.size() / 2);
      }
    }
  }
}

TYPED_TEST(YieldReference, CutTension_StrainsAndLimitsOfAllSizes_Agrees) {
  using Real = TypeParam;
  const auto strains = strains_for_yielding<Real>(this->kCount, 408);
  const auto before = this->numbers(strains.size(), 409, [](Samples& s) { return s.uniform(-0.01, 0.01); });
  for (const double poisson : {0.0, 0.3, 0.4999}) {
    Elasticity elasticity = golden_sand().elasticity;
    elasticity.poisson_ratio = poisson;
    const HenckyConstants<Real> elastic(elasticity);
    for (const double limit : {0.0, 3.0, 3e3, 3e5}) {
      auto expected_trace = before;
      const auto expected = YieldRig<Real>().cut_tension(strains, elastic, Real(limit), expected_trace);
      for (const auto& rig : yield_rigs<Real>()) {
        auto trace = before;
        const auto cut = rig.cut_tension(strains, elastic, Real(limit), trace);
        for (std::size_t p = 0; p < cut.size(); ++p) {
          const double bound = 24 * this->kRounding * this->size(strains[p]) + 2 * this->vanishing();
          ASSERT_LE(largest_entry(exact(cut[p]) - exact(expected[p])), bound)
              << rig.name() << ", particle " << p << ", limit " << limit;
          ASSERT_NEAR(trace[p], expected_trace[p], 3 * bound + 2 * this->kRounding * std::fabs(before[p]))
              << rig.name() << ", particle " << p << ", limit " << limit;
        }
      }
    }
  }
}

TYPED_TEST(YieldReference, ShapedProjection_SurfacesOfAllKinds_Agrees) {
  using Real = TypeParam;
  const auto strains = strains_for_yielding<Real>(this->kCount, 410);
  auto expected = this->some_surface(strains.size());
  const auto expected_strains = YieldRig<Real>().return_map(strains, expected);
  for (const auto& rig : yield_rigs<Real>()) {
    auto surface = this->some_surface(strains.size());
    const auto projected = rig.return_map(strains, surface);
    std::size_t at_the_tip = 0, yielding = 0;
    for (std::size_t p = 0; p < projected.size(); ++p) {
      const double steep = (1.0 + surface.yield_slope[p]) * (1.0 + 3.0 * surface.dilatancy[p]);
      const double bound =
          steep * (this->kRoundings * (this->size(strains[p]) + surface.cohesion[p]) + 2 * this->vanishing());
      const auto where = [&] { return std::string(rig.name()) + ", particle " + std::to_string(p); };
      ASSERT_LE(largest_entry(exact(projected[p]) - exact(expected_strains[p])), bound) << where();
      ASSERT_NEAR(surface.plastic[p], expected.plastic[p], 2 * bound) << where();
      yielding += expected.sheared[p] > 0 ? 1 : 0;
      if ((surface.sheared[p] > 0) != (expected.sheared[p] > 0) && surface.plastic[p] > bound) {
        // Whether it has opened is for rounding to say; then it is at the tip.
        const ExactMatrix h = exact(projected[p]);
        ASSERT_LE(largest_entry(h - h.trace() / 3 * ExactMatrix::Identity()), 2 * bound) << where();
        ++at_the_tip;
        continue;
      }
      ASSERT_NEAR(surface.sheared[p], expected.sheared[p], 2 * bound) << where();
      ASSERT_NEAR(surface.dilated[p], expected.dilated[p], 2 * bound) << where();
    }
    EXPECT_LT(at_the_tip, projected.size() / 100) << rig.name();
    EXPECT_GT(yielding, projected.size() / 10) << rig.name();
  }
}

/// As scalars, too: what the kernels do lane by lane.
TYPED_TEST(YieldReference, ShapedProjection_OfScalars_Agrees) {
  using Real = TypeParam;
  const auto strains = strains_for_yielding<Real>(this->kCount, 411);
  auto surface = this->some_surface(strains.size());
  const auto expected = YieldRig<Real>().return_map(strains, surface);
  for (std::size_t p = 0; p < strains.size(); ++p) {
    const auto& s = strains[p];
    const HWY_NAMESPACE::Sym3<Real> strain{s[0], s[1], s[2], s[3], s[4], s[5]};
    const auto done = DruckerPrager::return_map_per_particle(strain, surface.yield_slope[p],
                                                             surface.cohesion[p], surface.dilatancy[p]);
    const auto& h = done.strain;
    const double steep = (1.0 + surface.yield_slope[p]) * (1.0 + 3.0 * surface.dilatancy[p]);
    const double bound =
        steep * (this->kRoundings * (this->size(s) + surface.cohesion[p]) + 2 * this->vanishing());
    const Symmetric<Real> got{h.xx, h.xy, h.xz, h.yy, h.yz, h.zz};
    ASSERT_LE(largest_entry(exact(got) - exact(expected[p])), bound) << p;
    ASSERT_NEAR(done.plastic, surface.plastic[p], 2 * bound) << p;
  }
}

/// In one lane of many: it stays visible, and no other particle sees it.
TYPED_TEST(YieldReference, NotANumber_StaysWhereItIs) {
  using Real = TypeParam;
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  const auto strains = strains_of_all_sizes<Real>(64, 1e-4, 412);
  const HenckyConstants<Real> elastic(golden_sand().elasticity);
  const RateConstants<Real> rate{Real(0.7), Real(0.279), Real(1e-4)};
  const HardeningConstants<Real> hardening{Real(0.6), Real(0.16), Real(0.2), Real(0.17), {}, Real(3.25)};
  const auto cohesion = this->some_cohesion(64, 413);
  const auto is_nan = [](Real x) { return std::isnan(x); };
  for (const auto& rig : yield_rigs<Real>()) {
    for (std::size_t k = 0; k < 6; ++k) {
      const std::size_t at = 7 * k + 3;
      auto broken = strains;
      broken[at][k] = nan;
      auto surface = this->some_surface(64), surface_of_broken = surface;
      std::vector<Real> trace(64), trace_of_broken(64), yield_slope(64, Real(1));
      const auto expect_lone = [&](const auto& of_broken, const auto& all, const char* what) {
        for (std::size_t p = 0; p < 64; ++p) {
          EXPECT_TRUE(p == at || of_broken[p] == all[p]) << what << ' ' << rig.name() << ' ' << p;
        }
      };
      const auto projected = rig.return_map(broken, surface_of_broken);
      EXPECT_TRUE(std::ranges::any_of(projected[at], is_nan)) << rig.name() << ' ' << k;
      expect_lone(projected, rig.return_map(strains, surface), "projection");
      const auto cut = rig.cut_tension(broken, elastic, Real(100), trace_of_broken);
      EXPECT_TRUE(std::ranges::any_of(cut[at], is_nan)) << rig.name() << ' ' << k;
      expect_lone(cut, rig.cut_tension(strains, elastic, Real(100), trace), "cut");
      expect_lone(rig.strengthen(broken, cohesion, rate, Real(1e-4), yield_slope),
                  rig.strengthen(strains, cohesion, rate, Real(1e-4), yield_slope), "rate");
      yield_slope[at] = nan;
      EXPECT_TRUE(std::isnan(rig.strengthen(strains, cohesion, rate, Real(1e-4), yield_slope)[at]))
          << rig.name();
      std::vector<Real> q(64, Real(0.5)), q_of_broken = q;
      q_of_broken[at] = nan;
      const auto hard = rig.harden(q_of_broken, hardening);
      EXPECT_TRUE(std::isnan(hard[at])) << rig.name();
      expect_lone(hard, rig.harden(q, hardening), "hardening");
    }
  }
}

}  // namespace
}  // namespace repose
