// Repose: the kernels of one material: what it does to strains, and how it answers within an implicit step.
#pragma once

#include <array>
#include <cstddef>

#include "kernels/layout/particle_span.h"
#include "kernels/material/materials.h"

namespace repose {

/// One material's passes over a span, all on the strain channel in place.
template <class Real>
struct MaterialInput {
  const void* constants;  ///< the material's Constants<Real>
  Real* strain[kStrainComponents];
  const Real* gradient[kAffineComponents];       ///< of velocity, 1/s; not the stored C
  Real* stress[kStrainComponents];               ///< out, Pa
  std::array<Real*, kMostLawChannels> channels;  ///< that the law keeps, as many as it has; in place
  Real dt;
  std::size_t count;
  std::ptrdiff_t ahead = 0;  ///< as in ParticleSpan
};

/// The yield surface of each particle of a span, |dev eps| <= cohesion - yield_slope tr(eps), and what yielding
/// did.
template <class Real>
struct YieldInput {
  const Real* yield_slope;  ///< bc = alpha (3 lambda + 2 mu) / (2 mu)
  const Real* cohesion;     ///< k = c_C / (2 mu), c_C the norm of the deviator that holds at no pressure
  const Real* dilatancy;    ///< bD: the flow e/|e| + bD I opens the sand by 3 bD per unit of shear
  Real* plastic;            ///< out: |trial - returned|
  Real* sheared;            ///< out: the same, but 0 where the sand has opened
  Real* dilated;            ///< out: 3 bD dg, the log volume that shear has opened
};

/// How sand answers within an implicit step (kernels/material/drucker_prager_response-inl.h). Materials that do
/// not yield answer alike in all.
enum class TangentMode { kExact, kProjected, kLagged, kUnilateral };
inline constexpr int kTangentModes = 4;

/// What the change of a particle's stress with the velocities takes (kernels/pass/stiffness.cpp): U and Q by
/// rows, the slopes A by rows, theta and beta of the pairs of axes xy xz yz. Particles lie in groups: number k
/// of particle p at (p / kTangentGroup * kTangentValues + k) * kTangentGroup + p % kTangentGroup.
inline constexpr std::size_t kTangentValues = 33;
inline constexpr std::size_t kTangentGroup = 16;

template <class Real>
struct TangentInput {
  MaterialInput<Real> material;  ///< strain is the trial strain; no stress is written
  YieldInput<Real> surface;      ///< by which it yields; yield_slope null: by the numbers of the material
  UnilateralConstants<Real> unilateral;  ///< of the mode of that name
  Real* tangent;                         ///< out, room for whole groups
};

/// What a trial strain weighs against a predicted elastic strain (kernels/pass/stiffness.cpp).
inline constexpr double kTrialWeight = 0.2;

template <class Real>
struct MaterialKernels {
  void (*trial)(const MaterialInput<Real>&);  ///< strain, own <- the trial state after dt of the gradient
  /// strain <- the strain that the yield surface allows; null where the law does not yield.
  void (*return_map)(const MaterialInput<Real>&);
  void (*stress)(const MaterialInput<Real>&);  ///< stress <- tau(strain)
  /// tangent <- how the law answers in each mode.
  void (*linearize[kTangentModes])(const TangentInput<Real>&);

  // Null where the law has no cone.

  /// The return map by numbers per particle.
  void (*return_map_per_particle)(const MaterialInput<Real>&, const YieldInput<Real>&);
  /// strain <- the linearization point: the point of the law between the trial strain and S as a linear model
  /// predicted it; offset <- the change of dt grad v from that point to the trial state.
  void (*linearization_point)(const TangentInput<Real>&, const Real* const predicted[9], Real* const offset[9]);
  /// stress <- that of the unilateral energy, of the trial strain.
  void (*unilateral_stress)(const MaterialInput<Real>&, const UnilateralConstants<Real>&);
};

}  // namespace repose
