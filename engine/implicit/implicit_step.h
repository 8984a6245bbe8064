// Repose: the implicit step, from a first guess over Newton's method to the velocities that the nodes keep.
// What it solves is engine/implicit/momentum_balance.h.
#pragma once

#include <optional>

#include "engine/base/profile.h"
#include "engine/implicit/first_guess.h"
#include "engine/solve/linear_solve.h"
#include "engine/solve/newton.h"

namespace repose {

/// What a solve came to.
struct ImplicitReport {
  NewtonReport newton;        ///< with |r| in kg^1/2 m/s
  std::int64_t unknowns = 0;  ///< velocity components that were solved for, with the contacts at the end
  SolveStatus linear = SolveStatus::kConverged;  ///< of the last linear solve that failed, if any did
};

template <class Real>
class ImplicitStep {
 public:
  using Vector = NodeField<Real>;

  ImplicitStep(const StepPlan<Real>& plan, Threads& threads, std::vector<Scratch<Real>>& scratch,
               Profile& profile);
  ImplicitStep(const ImplicitStep&) = delete;
  ImplicitStep& operator=(const ImplicitStep&) = delete;

  /// Solves for a step of dt from the state's nodes, which hold mass and v^free, and `before_forces`, with v^n.
  /// On return nodes hold what the passes that hold nodes are to start from: v less the impulse of their
  /// contacts, which those passes then bring about themselves, and record.
  ImplicitReport solve(State<Real>& state, Real dt);
  /// The step that was solved last is made: the next begins from what it came to.
  void accept() { guess_.keep(v_); }

  /// After a state was loaded: what was known of its topology may be of another.
  void forget() { orders_ = -1; }
  std::size_t bytes() const;

  // What Newton's method asks for (engine/solve/newton.h).
  std::optional<double> evaluate(const Vector& v) { return balance_.evaluate(v); }
  double scale() const { return balance_.scale(); }
  bool has_energy() const;
  double slope(const Vector& step) { return dot(system_, balance_.residual(), step); }
  bool change_contacts(Vector& v);
  bool models() const { return balance_.models(); }
  bool tightens() const { return !balance_.fades(); }
  double linearize(const Vector& v, bool near) { return balance_.linearize(v, near); }
  struct Solved {
    int iterations = 0;
    bool good = false;
    bool usable() const { return good; }
  };
  Solved solve(double share, Vector& step);
  double reach(const Vector& step, double length) { return balance_.reach(step, length); }
  void take(const Vector& v, double length, const Vector& step, Vector& to);

 private:
  void follow_topology();
  void collect_holds();
  void publish(const Vector& v);

  const StepPlan<Real>& plan_;
  const ImplicitPlan<Real>& implicit_;
  Profile& profile_;
  BlockSweep<Real> sweep_;
  ContactSet<Real> contacts_;
  TangentSystem<Real> system_;
  MomentumBalance<Real> balance_;
  FirstGuess<Real> guess_;
  std::optional<LinearSolve<TangentSystem<Real>>> symmetric_;
  std::optional<LinearSolve<TangentSystem<Real>, GeneralizedConjugateResidual<TangentSystem<Real>>>> general_;

  Vector v_, step_, trial_, right_;  // of dv
  std::int64_t orders_ = -1;         // of the topology that vectors are made for
  SolveStatus linear_ = SolveStatus::kConverged;
};

}  // namespace repose
