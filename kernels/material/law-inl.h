// Repose: what the law of a material has, so that kernels can run it, and how they call it. N is a number, or a
// register of numbers; branches become `select`. A law that keeps channels of its own gets them as `own`, after
// what it gets otherwise, and may change them where it may change its strain; one that keeps none has functions
// without.
//
//   Sym3<N> stress(c, eps)                      Kirchhoff stress, Pa, of the strain
//   Sym3<N> return_map(c, eps)                  where it yields: the strain that its yield surface allows
//   Sym3<N> trial(c, eps, own, dt_grad_v)       where its state is more than the strain: after a step; else
//   that
//                                               is hencky_trial, and own stays
// Within an implicit step, along the principal axes of the trial strain (response-inl.h); laws are isotropic
// there:
//   Response<N> respond(c, eps)                 elastic
//   Response<N> respond<whole>(c, eps)          yields: of the returned strain, with its whole derivative or
//                                               the symmetric part of it
//   Response<N> elastic_response(c, eps)        yields: as if it did not
// With a cone, respond takes the numbers by which each particle yields, and there are
//   Returned<N> return_map_per_particle(eps, yield_slope, cohesion, dilatancy)
//   Response<N> unilateral_response(c, u, eps), Sym3<N> unilateral_stress(c, u, eps)
//   Sym3<N> elastic_strain(c, tau)              whose stress is tau
// For kernels, once per instruction set: the including file has included Highway before.
#if defined(HWY_NAMESPACE) && (defined(REPOSE_KERNELS_MATERIAL_LAW_INL_H) == defined(HWY_TARGET_TOGGLE))
#ifdef REPOSE_KERNELS_MATERIAL_LAW_INL_H
#undef REPOSE_KERNELS_MATERIAL_LAW_INL_H
#else
#define REPOSE_KERNELS_MATERIAL_LAW_INL_H
#endif

#include <type_traits>
#include <utility>

#include "kernels/base/small_matrix-inl.h"
#include "kernels/material/material.h"
#include "kernels/material/response-inl.h"

HWY_BEFORE_NAMESPACE();
namespace repose {
namespace HWY_NAMESPACE {

template <class L>
inline constexpr std::size_t kOwn = L::Parameters::kChannels.size();

/// The channels that a law keeps of its own.
template <class L, class N>
struct OwnChannels {
  N number[kOwn<L>];
};
template <class L, class N>
requires(kOwn<L> == 0) struct OwnChannels<L, N> {
};

// clang-format off: it knows no concepts yet

// Laws without channels have functions without `own`.
#define REPOSE_HAS(L, without, with) \
  ((kOwn<L> == 0 && requires { without; }) || (kOwn<L> > 0 && requires { with; }))

template <class L>
concept HasStress = requires(const typename L::template Constants<float>& c, const Sym3<float>& eps,
                             OwnChannels<L, float>& own) {
  requires std::is_same_v<typename L::template Constants<float>,
                          typename L::Parameters::template Constants<float>>;
  requires REPOSE_HAS(L, L::stress(c, eps), L::stress(c, eps, own.number));
};
template <class L>
concept HasElasticResponse = requires(const typename L::template Constants<float>& c, const float (&eps)[3],
                                      OwnChannels<L, float>& own) {
  requires REPOSE_HAS(L, L::respond(c, eps), L::respond(c, eps, own.number));
};
template <class L>
concept HasReturnMap = requires(const typename L::template Constants<float>& c, const Sym3<float>& eps,
                                const float (&axes)[3], OwnChannels<L, float>& own) {
  requires REPOSE_HAS(L, L::return_map(c, eps), L::return_map(c, eps, own.number));
  { L::elastic_response(c, axes) } -> std::same_as<Response<float>>;
};
template <class L>
concept HasYieldingResponse = requires(const typename L::template Constants<float>& c, const float (&eps)[3],
                                       OwnChannels<L, float>& own) {
  requires REPOSE_HAS(L, L::template respond<true>(c, eps), L::template respond<true>(c, eps, own.number));
};
template <class L>
concept HasCone = requires(const typename L::template Constants<float>& c, const Sym3<float>& eps,
                           const float (&axes)[3], const UnilateralConstants<float>& u,
                           const YieldSurface<float>& surface) {
  { L::template respond<true>(c, axes, surface) } -> std::same_as<Response<float>>;
  { L::unilateral_response(c, u, axes) } -> std::same_as<Response<float>>;
  { L::unilateral_stress(c, u, eps) } -> std::same_as<Sym3<float>>;
  { L::elastic_strain(c, eps) } -> std::same_as<Sym3<float>>;
  { L::return_map_per_particle(eps, 1.0f, 1.0f, 1.0f).strain } -> std::convertible_to<Sym3<float>>;
  { c.yield_slope } -> std::convertible_to<float>;
};
/// What the law of every material has; which of these is missing, the compiler says.
template <class L>
concept Law = HasStress<L> && (L::Parameters::kYields || HasElasticResponse<L>) &&
              (!L::Parameters::kYields || HasReturnMap<L>) &&
              (!L::Parameters::kYields || L::Parameters::kHasCone || HasYieldingResponse<L>) &&
              (!L::Parameters::kHasCone || HasCone<L>);

/// Whether a law has a trial state of its own.
template <class L>
concept HasOwnTrial = requires(const typename L::template Constants<float>& c, const Sym3<float>& eps,
                               OwnChannels<L, float>& own, const Mat3<float>& step) {
  L::trial(c, eps, own.number, step);
};
#undef REPOSE_HAS
// clang-format on

}  // namespace HWY_NAMESPACE
}  // namespace repose
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
