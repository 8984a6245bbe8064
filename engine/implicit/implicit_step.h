// Repose: the implicit step, from a first guess over Newton's method to the velocities that the nodes keep.
// What it solves is engine/implicit/momentum_balance.h.
#pragma once

#include <optional>

#include "engine/base/profile.h"
#include "engine/implicit/first_guess.h"
#include "engine/implicit/implicit_report.h"
#include "engine/solve/linear_solve.h"
#include "engine/solve/newton.h"

namespace repose {

template <class Real>
class ImplicitStep {
 public:
  using Vector = NodeField<Real>;

  ImplicitStep(BlockSweep<Real>& blocks, Profile& profile);
  ImplicitStep(const ImplicitStep&) = delete;
  ImplicitStep& operator=(const ImplicitStep&) = delete;

  /// Solves the step of the sweep from its state's nodes, which hold mass and v^free, and `before_forces`, with
  /// v^n. If a solution is found, nodes hold v, `after_friction` what friction leaves where that follows the
  /// solve, and the contact log what contacts did. `last`: a step that is refused is not tried by half again.
  ImplicitReport solve(bool last);
  /// The step that was solved last is made: the next begins from what it came to.
  void accept() { guess_.keep(v_); }

  /// After a state was loaded: what was known of its topology may be of another.
  void forget() { sorts_ = -1; }
  /// Makes room for the state that the sweep has begun.
  void reserve();
  std::size_t bytes(const State<Real>& state) const;
  /// Of them, those that grow with the blocks.
  std::size_t block_bytes(const State<Real>& state) const;

  // What Newton's method asks for (engine/solve/newton.h).
  std::optional<double> evaluate(const Vector& v) { return balance_.evaluate(v); }
  double scale() const { return balance_.scale(); }
  bool has_energy() const;
  double slope(const Vector& step) { return dot(system_, balance_.residual(), step); }
  bool change_contacts(Vector& v, double least);
  bool models() const { return balance_.models(); }
  bool tightens() const { return !balance_.fades(); }
  double linearize(const Vector& v, bool near) { return balance_.linearize(v, near); }
  struct Solved {
    int iterations = 0;
    bool good = false;
    bool usable() const { return good; }
  };
  Solved solve(double share, Vector& step);
  double longest_step(const Vector& step, double length) { return balance_.longest_step(step, length); }
  void take(const Vector& v, double length, const Vector& step, Vector& to);

 private:
  void follow_topology();
  void collect_constraints();
  void publish(const Vector& v);
  void publish_block(std::size_t block, const Real* v);

  using General = GeneralizedConjugateResidual<TangentSystem<Real>>;
  /// Vectors of nodes: of the solve, and of the linear solvers, beside two for each direction that is kept.
  static constexpr std::size_t kOwnVectors = 4, kSymmetricVectors = 7, kGeneralVectors = 5;
  std::size_t directions() const { return static_cast<std::size_t>(implicit_.settings.directions); }

  const StepPlan<Real>& plan_;
  const ImplicitPlan<Real>& implicit_;
  Profile& profile_;
  ParticleSweep<Real> sweep_;
  ContactSet<Real> contacts_;
  TangentSystem<Real> system_;
  MomentumBalance<Real> balance_;
  FirstGuess<Real> guess_;
  std::optional<LinearSolve<TangentSystem<Real>>> symmetric_;
  std::optional<LinearSolve<TangentSystem<Real>, General>> general_;

  Vector v_, step_, trial_, right_;  // of dv
  std::int64_t sorts_ = -1;          // of the topology that vectors are made for
  SolveStatus linear_ = SolveStatus::kConverged;
};

}  // namespace repose
