// Repose: whether energy comes from nowhere, as it does where steps are too long for what they meet. Looks now
// and then: kinetic, affine, elastic and potential energy, against what there was when it began to watch and
// what has come since. It changes nothing, and is no part of the state: after a load it begins anew.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/plan/contact_log.h"
#include "engine/plan/step_plan.h"
#include "engine/state/state.h"
#include "engine/step/step_report.h"

namespace repose {

template <class Real>
class EnergyWatch {
 public:
  explicit EnergyWatch(const StepPlan<Real>& plan);

  /// Before a step: where it has not begun to watch, it does.
  void begin(const State<Real>& state, Threads& threads);
  /// After an accepted step. Where it looks it notes in the report what it saw, and an alarm when there is more
  /// energy than there can be, once.
  void after_step(const State<Real>& state, Threads& threads, bool ends_frame, StepReport& report);
  void forget() { watching_ = false; }

  std::size_t bytes() const { return blocks_.capacity() * sizeof(Sums); }

 private:
  /// Over particles.
  struct Sums {
    MatterInMotion matter;
    Vec3 momentum{0, 0, 0};
    double affine = 0.0, elastic = 0.0, potential = 0.0;  ///< J
    double begun = 0.0, newcomers = 0.0;  ///< mass and energy of those that began since the last look, kg, J
    double lowest = 0.0, highest = 0.0;   ///< potential per mass, m^2/s^2
    bool any = false;

    double energy() const { return matter.kinetic + affine + elastic + potential; }
    void add(const Sums& other);
  };

  bool due(bool ends_frame) const;
  Sums look(const State<Real>& state, Threads& threads);
  void sum_block(const State<Real>& state, std::size_t occupied, Sums& sums) const;
  double given_since(const State<Real>& state, const Sums& now) const;
  EnergyAlert alert(const State<Real>& state, const Sums& now) const;

  const EnergyAlarm* alarm_;  // null: none
  const ContactLog* solids_;  // null: none moves
  std::vector<Sums> blocks_;  // per occupied block
  bool watching_ = false, told_ = false;
  int steps_ = 0;              // since the last look
  std::int64_t watched_ = 0;   // steps since it began to watch
  double work_ = 0.0;          // of solids since then, J
  Sums last_;                  // at the last look
  double time_ = 0.0;          // then, s
  double most_speed_ = 0.0;    // since then, m/s
  std::uint64_t next_id_ = 0;  // of particles then
  double begun_with_ = 0.0;    // energy, J
  double given_ = 0.0;         // since then, J
  double scale_ = 0.0;         // J
};

}  // namespace repose
