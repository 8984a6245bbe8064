// Repose: where Newton's method begins in an implicit step, from what the last step came to. Two guesses:
//   v^n + dt a, a the acceleration of the last step: right where sand gains speed, and as noisy as v^n;
//   v at the end of the last step: late by dt a, but stresses were balanced in it, and of stiff sand that
//   hardly moves nothing else counts.
// The first stands unless the second is good and leaves less than half of its residual: what a guess is late by
// the tolerance of the solve never quite makes up for, and the next step is late by the same (docs/math.md,
// 46). The second is not tried where velocities gained much in the last step: it would be late by as much.
#pragma once

#include <optional>

#include "engine/implicit/momentum_balance.h"

namespace repose {

template <class Real>
class FirstGuess {
 public:
  using Vector = NodeField<Real>;

  /// `tolerance` is Newton's: a guess that meets it is not bettered.
  FirstGuess(ParticleSweep<Real>& sweep, ContactSet<Real>& contacts, MomentumBalance<Real>& balance,
             double tolerance)
      : sweep_(sweep), contacts_(contacts), balance_(balance), tolerance_(tolerance) {}

  /// Puts the guess into dv, of the step that the balance has begun, with contacts as they are there. Returns
  /// |r|, as evaluated last; nothing where r is defined for no guess.
  std::optional<double> find(Vector& dv);
  /// Keeps what the step came to, in State::last_motion.
  void keep(const Vector& dv);

 private:
  enum class Kind { kAtLastRate, kAtLastVelocity, kAtRest };

  /// Of the impulses: a guess that leaves no more is good, and has the contacts that it should have.
  static constexpr double kGood = 0.3;
  /// Of the residual of the first guess, that the second may leave.
  static constexpr double kBetter = 0.5;

  void follow_blocks();
  std::optional<double> begin_at(Kind kind, Vector& dv);
  std::optional<double> evaluate_at(Kind kind, Vector& dv);
  void place(Kind kind, Vector& dv);
  bool foresee_contacts(Vector& dv);

  ParticleSweep<Real>& sweep_;
  ContactSet<Real>& contacts_;
  MomentumBalance<Real>& balance_;
  double tolerance_;
};

}  // namespace repose
