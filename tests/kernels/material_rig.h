// Repose tests: one material run in every way that exists: the scalar templates, and the kernels of each
// instruction set through their table. Strains come in batches, so that full registers and a remainder are both
// met; what lies beyond a batch is checked to stay untouched.
#pragma once

#include "kernels/base/targets.h"

#include "hwy/highway.h"

#include <gtest/gtest.h>

#include <optional>

#include "kernels/material/materials.h"
#include "tests/kernels/exact_matrix.h"

namespace repose {

using HWY_NAMESPACE::DruckerPrager;
using HWY_NAMESPACE::Hencky;
using HWY_NAMESPACE::Materials;
using HWY_NAMESPACE::NeoHookean;

template <class Real>
using Gradient = std::array<Real, 9>;

/// Position of a material in the list, which is that in the kernel tables.
template <class Material, std::size_t k = 0>
constexpr std::size_t material_index() {
  if constexpr (std::is_same_v<Material, std::tuple_element_t<k, Materials>>) {
    return k;
  } else {
    return material_index<Material, k + 1>();
  }
}

template <class Material, class Real>
class MaterialRig {
 public:
  using Constants = typename Material::template Constants<Real>;
  using Strains = std::vector<Symmetric<Real>>;

  /// Without a target, the scalar templates.
  MaterialRig(const Constants& constants, std::optional<Target> target)
      : constants_(constants), target_(target) {}

  const char* name() const { return target_ ? target_name(*target_) : "scalar"; }

  /// What the law keeps of each particle, a vector for each channel.
  using Own = std::array<std::vector<Real>, HWY_NAMESPACE::kOwn<Material>>;
  static Own initial_own(std::size_t count) {
    Own own;
    const auto values = typename Material::Parameters{}.initial_channels();
    for (std::size_t k = 0; k < own.size(); ++k) own[k].assign(count, static_cast<Real>(values[k]));
    return own;
  }

  Strains trial(const Strains& strains, const std::vector<Gradient<Real>>& gradients, Real dt) const {
    Own own = initial_own(strains.size());
    return trial(strains, gradients, dt, own);
  }
  Strains trial(const Strains& strains, const std::vector<Gradient<Real>>& gradients, Real dt, Own& own) const {
    if (target_) return through_kernel(kernel().trial, strains, own, gradients, dt, false);
    Strains out = strains;
    for (std::size_t p = 0; p < out.size(); ++p) {
      HWY_NAMESPACE::Mat3<Real> step;
      for (int k = 0; k < 9; ++k) step.m[k / 3][k % 3] = dt * gradients[p][k];
      if constexpr (HWY_NAMESPACE::HasOwnTrial<Material>) {
        auto numbers = own_of(own, p);
        out[p] = packed(Material::trial(constants_, unpacked(strains[p]), numbers.number, step));
        for (std::size_t k = 0; k < own.size(); ++k) own[k][p] = numbers.number[k];
      } else {
        out[p] = packed(HWY_NAMESPACE::hencky_trial(unpacked(strains[p]), step));
      }
    }
    return out;
  }

  /// Of an elastic material, the strains themselves.
  Strains return_map(const Strains& strains) const {
    Own own = initial_own(strains.size());
    return return_map(strains, own);
  }
  Strains return_map(const Strains& strains, [[maybe_unused]] Own& own) const {
    Strains out = strains;
    if constexpr (Material::Parameters::kYields) {
      if (target_) return through_kernel(kernel().return_map, strains, own, {}, 0, false);
      for (std::size_t p = 0; p < out.size(); ++p) {
        if constexpr (HWY_NAMESPACE::kOwn<Material> == 0) {
          out[p] = packed(Material::return_map(constants_, unpacked(strains[p])));
        } else {
          auto numbers = own_of(own, p);
          out[p] = packed(Material::return_map(constants_, unpacked(strains[p]), numbers.number));
          for (std::size_t k = 0; k < own.size(); ++k) own[k][p] = numbers.number[k];
        }
      }
    }
    return out;
  }

  Strains stress(const Strains& strains) const {
    Own own = initial_own(strains.size());
    if (target_) return through_kernel(kernel().stress, strains, own, {}, 0, true);
    Strains out = strains;
    for (std::size_t p = 0; p < out.size(); ++p) {
      if constexpr (HWY_NAMESPACE::kOwn<Material> == 0) {
        out[p] = packed(Material::stress(constants_, unpacked(strains[p])));
      } else {
        out[p] = packed(Material::stress(constants_, unpacked(strains[p]), own_of(own, p).number));
      }
    }
    return out;
  }

 private:
  using Pass = void (*)(const MaterialInput<Real>&);

  const MaterialKernels<Real>& kernel() const {
    return kernels<Real>(*target_).material[material_index<Material>()];
  }

  static HWY_NAMESPACE::Sym3<Real> unpacked(const Symmetric<Real>& a) {
    return {a[0], a[1], a[2], a[3], a[4], a[5]};
  }
  static Symmetric<Real> packed(const HWY_NAMESPACE::Sym3<Real>& a) {
    return {a.xx, a.xy, a.xz, a.yy, a.yz, a.zz};
  }

  static HWY_NAMESPACE::OwnChannels<Material, Real> own_of(const Own& own, std::size_t p) {
    HWY_NAMESPACE::OwnChannels<Material, Real> numbers;
    for (std::size_t k = 0; k < own.size(); ++k) numbers.number[k] = own[k][p];
    return numbers;
  }

  Strains through_kernel(Pass pass, const Strains& strains, Own& own,
                         const std::vector<Gradient<Real>>& gradients, Real dt, bool want_stress) const {
    const std::size_t count = strains.size();
    std::vector<Real> strain[6], stress[6], gradient[9];
    MaterialInput<Real> in{&constants_, {}, {}, {}, {}, dt, count};
    for (int k = 0; k < 6; ++k) {
      for (const auto& s : strains) strain[k].push_back(s[k]);
      strain[k].push_back(kCanary<Real>);
      stress[k].assign(count + 1, kCanary<Real>);
      in.strain[k] = strain[k].data();
      in.stress[k] = stress[k].data();
    }
    for (int k = 0; k < 9; ++k) {
      for (const auto& g : gradients) gradient[k].push_back(g[k]);
      in.gradient[k] = gradient[k].data();
    }
    for (std::size_t k = 0; k < own.size(); ++k) {
      own[k].push_back(kCanary<Real>);
      in.channels[k] = own[k].data();
    }
    pass(in);
    for (auto& channel : own) {
      EXPECT_EQ(channel.back(), kCanary<Real>) << name() << " writes beyond the law's channels";
      channel.pop_back();
    }
    Strains out(count);
    for (int k = 0; k < 6; ++k) {
      EXPECT_EQ(strain[k][count], kCanary<Real>) << name() << " writes beyond the strains";
      EXPECT_EQ(stress[k][count], kCanary<Real>) << name() << " writes beyond the stresses";
      for (std::size_t p = 0; p < count; ++p) out[p][k] = (want_stress ? stress : strain)[k][p];
    }
    return out;
  }

  Constants constants_;
  std::optional<Target> target_;
};

/// The scalar templates and every instruction set of this machine.
template <class Material, class Real, class Parameters>
std::vector<MaterialRig<Material, Real>> rigs(const Parameters& parameters) {
  const typename Material::template Constants<Real> constants(parameters);
  std::vector<MaterialRig<Material, Real>> all{{constants, std::nullopt}};
  for (const Target target : supported_targets()) all.emplace_back(constants, target);
  return all;
}

template <class Material, class Real>
auto default_rigs() {
  return rigs<Material, Real>(typename Material::Parameters{});
}

/// The sand of the golden values: E = 3.537e5, nu = 0.3, phi = 30 degrees.
inline DruckerPragerParameters golden_sand() {
  DruckerPragerParameters sand;
  sand.friction_angle = 30.0;
  return sand;
}

/// Random strains whose stretches lie in 10^[-decades, decades], turned at random.
template <class Real>
std::vector<Symmetric<Real>> random_strains(std::size_t count, double decades, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Symmetric<Real>> strains(count);
  for (auto& strain : strains) {
    ExactVector values;
    for (int i = 0; i < 3; ++i) values[i] = std::numbers::ln10 * samples.uniform(-decades, decades);
    strain = rounded<Real>(turned(values, samples));
  }
  return strains;
}

/// The same with every size down to `least`, in steps of a decade, so that all cases of a return map are met.
template <class Real>
std::vector<Symmetric<Real>> strains_of_all_sizes(std::size_t count, double least, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Symmetric<Real>> strains(count);
  for (auto& strain : strains) {
    const long double scale = samples.power_of_ten(std::log10(least), 0);
    const ExactVector values(samples.uniform(-1, 1), samples.uniform(-1, 1), samples.uniform(-1, 1));
    strain =
        rounded<Real>(scale * (turned(values, samples) - samples.uniform(-1, 1) * ExactMatrix::Identity()));
  }
  return strains;
}

}  // namespace repose
