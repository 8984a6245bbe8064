// Repose: handles of what passes hand to one another. A handle is a type of its own, so the compiler knows
// which pass reads what: a pass gets a pointer only through a handle that it has declared, and a handle that
// nobody writes is found when the plan is checked (step_plan.h). An effect makes one by a line:
//   inline constexpr Handle<"saturation", Place::kExtra> kSaturation;
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <type_traits>

#include "kernels/layout/particle_span.h"
#include "kernels/material/materials.h"

namespace repose {

/// Text as a template argument.
template <std::size_t size>
struct Text {
  char letters[size]{};
  consteval Text(const char (&text)[size]) { std::copy_n(text, size, letters); }
};

/// Where numbers lie. Two handles of one place that is a single array, such as momentum and velocity of the
/// nodes, are one memory at two times: writing the one ends the other.
enum class Place {
  kPosition,       ///< channels that every particle has
  kVelocity,       //
  kAffine,         //
  kStrain,         //
  kExtra,          ///< a channel that an effect has asked for
  kLaw,            ///< the channels that the law of the set's material keeps
  kScratch,        ///< one array of the chunk for each name and component
  kRoom,           ///< the same, of no use to other passes
  kMoving,         ///< wherever the gather left the velocity that moves particles
  kGradient,       ///< the same of its gradient
  kMotion,         ///< what moving the chunk did to it
  kTouched,        ///< what of the nodes around its block a chunk has touched
  kNodes,          ///< four values a node; in passes over particles, of the nodes around their block
  kBeforeForces,   ///< the same
  kAfterFriction,  ///< the same, in blocks where there is friction
  kActive,         ///< a bit per node of a block
  kTable,          ///< an object that follows the topology
  kFact,           ///< nothing to point at: that something is known
};

/// A handle as data.
struct HandleInfo {
  std::string_view name;
  Place place;
  int components;

  friend bool operator==(const HandleInfo&, const HandleInfo&) = default;
};

template <Text name, Place place, int components = 1>
struct Handle {
  static constexpr Place kPlace = place;
  static constexpr int kComponents = components;
  static constexpr const char* kName = name.letters;
  static constexpr HandleInfo kInfo{name.letters, place, components};
};

/// A handle of an object: Type<Real>.
template <Text name, template <class> class Type>
struct TableHandle : Handle<name, Place::kTable> {
  template <class Real>
  using Of = Type<Real>;
};

/// A handle that a pass declares in some plans only; where it does not, its pointers are null.
template <class Handle>
struct Maybe {
  bool declared;
};
template <class Handle>
constexpr Maybe<Handle> when(bool declared, Handle) {
  return {declared};
}

/// The handles that a pass reads, or writes.
template <class... Handles>
struct HandleList {
  static constexpr std::size_t kSize = sizeof...(Handles);
  std::array<bool, kSize> declared;

  template <class Handle>
  static constexpr bool has() {
    return (std::is_same_v<Handle, Handles> || ...);
  }
  /// Which of them a handle is.
  template <class Handle>
  static constexpr std::size_t index() {
    std::size_t found = 0, k = 0;
    ((std::is_same_v<Handle, Handles> ? found = k++ : k++), ...);
    return found;
  }
  /// Calls visit(handle, declared) for each.
  template <class Visit>
  void for_each([[maybe_unused]] Visit visit) const {
    [[maybe_unused]] std::size_t k = 0;
    (visit(Handles{}, declared[k++]), ...);
  }
};
template <class... Handles>
struct Reads : HandleList<Handles...> {};
template <class... Handles>
struct Writes : HandleList<Handles...> {};

namespace handles {
template <class Handle>
struct Bare {
  using Type = Handle;
};
template <class Handle>
struct Bare<Maybe<Handle>> {
  using Type = Handle;
};
template <class Handle>
constexpr bool declared(const Handle&) {
  return true;
}
template <class Handle>
constexpr bool declared(const Maybe<Handle>& handle) {
  return handle.declared;
}
}  // namespace handles

template <class... Handles>
constexpr Reads<typename handles::Bare<Handles>::Type...> reads(Handles... list) {
  return {{{handles::declared(list)...}}};
}
template <class... Handles>
constexpr Writes<typename handles::Bare<Handles>::Type...> writes(Handles... list) {
  return {{{handles::declared(list)...}}};
}

// What the core of a step hands on.

inline constexpr Handle<"position", Place::kPosition, 3> kPosition;          ///< cells from the block's origin
inline constexpr Handle<"velocity", Place::kVelocity, 3> kParticleVelocity;  ///< m/s
inline constexpr Handle<"affine", Place::kAffine, kAffineComponents> kAffine;        ///< C, 1/s
inline constexpr Handle<"strain", Place::kStrain, kStrainComponents> kHenckyStrain;  ///< that the law allows
inline constexpr Handle<"trial strain", Place::kStrain, kStrainComponents> kTrialStrain;
inline constexpr Handle<"stress", Place::kScratch, kStrainComponents> kKirchhoffStress;  ///< tau, Pa
inline constexpr Handle<"no stress", Place::kRoom, kStrainComponents> kNoStress;  ///< never written: zeros
/// What particles tell the nodes, where something pushes them: v + dt b, m/s.
inline constexpr Handle<"told velocity", Place::kScratch, 3> kP2gVelocity;
inline constexpr Handle<"moving velocity", Place::kMoving, 3> kMovingVelocity;       ///< m/s
inline constexpr Handle<"gradient", Place::kGradient, kAffineComponents> kGradient;  ///< of it, 1/s
/// Room for both, where they are not what particles keep, and for trials.
inline constexpr Handle<"room for velocity", Place::kRoom, 3> kVelocityRoom;
inline constexpr Handle<"room for gradient", Place::kRoom, kAffineComponents> kGradientRoom;
/// What particles have for themselves beside what nodes tell them: v - sum w v_i, m/s, where the transfer keeps
/// velocity.
inline constexpr Handle<"own_velocity_x", Place::kExtra> kOwnVelocityX;
inline constexpr Handle<"own_velocity_y", Place::kExtra> kOwnVelocityY;
inline constexpr Handle<"own_velocity_z", Place::kExtra> kOwnVelocityZ;
/// Mass of the nodes around a particle, sum w m_i, kg; where an effect asks for it.
inline constexpr Handle<"mass around", Place::kScratch> kMassAround;
/// What the law of a material keeps beside the strain, in its order.
inline constexpr Handle<"law's channels", Place::kLaw, kMostLawChannels> kLawChannels;
inline constexpr Handle<"motion", Place::kMotion> kMotion;
inline constexpr Handle<"touched nodes", Place::kTouched> kTouched;

inline constexpr Handle<"node momentum", Place::kNodes> kNodeMomentum;  ///< mass, and momentum, kg m/s
inline constexpr Handle<"node velocity", Place::kNodes> kNodeVelocity;  ///< mass, and velocity, m/s
inline constexpr Handle<"node momentum before forces", Place::kBeforeForces> kMomentumBeforeForces;
inline constexpr Handle<"node velocity before forces", Place::kBeforeForces> kVelocityBeforeForces;
inline constexpr Handle<"v-tilde", Place::kAfterFriction> kVTilde;  ///< mass, and v after friction
inline constexpr Handle<"active nodes", Place::kActive> kActiveNodes;

/// By which particles yield, where they do so by numbers of their own, and what yielding did (YieldInput).
inline constexpr Handle<"yield slope", Place::kScratch> kYieldSlope;
inline constexpr Handle<"cohesion", Place::kScratch> kCohesion;
inline constexpr Handle<"dilatancy", Place::kScratch> kDilatancy;
inline constexpr Handle<"plastic strain", Place::kScratch> kPlastic;
inline constexpr Handle<"sheared", Place::kScratch> kSheared;
inline constexpr Handle<"dilated", Place::kScratch> kDilated;

inline constexpr Handle<"topology", Place::kFact> kTopology;    ///< which blocks there are
inline constexpr Handle<"particles", Place::kFact> kParticles;  ///< which particles there are
inline constexpr Handle<"report", Place::kFact> kReport;        ///< figures of a frame

}  // namespace repose
