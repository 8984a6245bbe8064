// Repose: what every effect is, once a scene has asked for it: what it does to particles that begin, and the
// passes that it adds to a step. What is off is not made, and costs nothing. An effect is made from its
// description (description.h) and stands in the same pair of files.
#pragma once

#include <functional>

#include "engine/effect/plan_builder.h"
#include "engine/effect/surroundings.h"

namespace repose {

/// Particles that have just been made, [first, last) of a set, with the motion of their body or emitter.
template <class Real>
struct Newcomers {
  ParticleSet<Real>& set;
  std::size_t first, last;
  const SetDescription& description;
  const Surroundings& surroundings;
  std::function<Vec3(std::size_t p)> position;  ///< m, in the scene's frame
  std::function<double(std::size_t p)> birth;   ///< s; of what is emitted, when it crossed the mouth

  template <class Handle>
  Real* channel(Handle) const {
    return set.extra[set.extra_index(Handle::kName)].values.data();
  }
};

/// The hooks that an effect may fill, each with the default of doing nothing.
template <class Real>
class Effect {
 public:
  virtual ~Effect() = default;

  /// Builds shapes, reads files; once, before anything below. Errors: 65, 66, with the key.
  virtual Result<void> prepare(const Surroundings&) { return {}; }

  /// Where its particles begin during the run, m; none where that is nowhere.
  virtual Bounds mouths() const { return {}; }
  /// The most, in m/s, that what it moves itself comes to within a box (m), and so may bring particles to.
  virtual double top_speed(const Bounds&) const { return 0.0; }
  /// Whether it reads kContactLog, which is made where any effect does and there are solids.
  virtual bool reads_contact_log() const { return false; }

  /// Changes velocity, strain and channels of particles that begin.
  virtual void initialize(Newcomers<Real>&) const {}

  /// Adds its passes, each to the slot that says when it runs. Effects add in the order of their list
  /// (effects.h).
  virtual void add_to(PlanBuilder<Real>&) const {}
};

/// Makes an effect ready.
template <class Real, class Made, class From>
EffectResult<Real> make_ready(const From& description, const Surroundings& surroundings) {
  auto effect = std::make_unique<Made>(description);
  if (auto ready = effect->prepare(surroundings); !ready) return ready.error();
  return std::unique_ptr<Effect<Real>>(std::move(effect));
}

}  // namespace repose

/// Defines `make` of a description: Made<Real> is constructed from it.
#define REPOSE_EFFECT(description, Made)                                            \
  template <class Real>                                                             \
  EffectResult<Real> description::make(const Surroundings& surroundings) const {    \
    return make_ready<Real, Made<Real>>(*this, surroundings);                       \
  }                                                                                 \
  template EffectResult<float> description::make<float>(const Surroundings&) const; \
  template EffectResult<double> description::make<double>(const Surroundings&) const;
