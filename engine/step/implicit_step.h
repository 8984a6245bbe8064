// Repose: the implicit step, backward Euler on the velocities of the active nodes (Klar et al. 2016,
// supplement):
//   r_i(v) = m_i (v_i - v_i^free) - dt f_i(v) = 0,   f_i = -sum_p V0 S_p g_ip,   S = tau(Z(b(v))) (I + dt grad
//   v)^-T
// where v^free has all forces but stress. Nothing is assembled: residual and tangent are passes over the same
// blocks, in the same colours, as the transfers; vectors are node fields over the blocks that hold material,
// zero where a node is empty.
#pragma once

#include <optional>

#include "engine/base/profile.h"
#include "engine/step/linear_solve.h"
#include "engine/step/newton.h"
#include "engine/step/tangent_system.h"

namespace repose {

/// What a solve came to.
struct ImplicitReport {
  NewtonReport newton;                           ///< with |r| in kg^1/2 m/s
  std::int64_t unknowns = 0;                     ///< velocity components that were solved for
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
  /// On return nodes hold what the passes that hold nodes are to start from: v, and where a node is held v^free
  /// + dt f / m, so that friction sees the impulse of the contact (Klar et al. 2016, section 8.1).
  ImplicitReport solve(State<Real>& state, Real dt);

  /// After a state was loaded: what was known of its topology may be of another.
  void forget() { orders_ = -1; }
  std::size_t bytes() const;

  // What Newton's method asks for (engine/step/newton.h).
  Vector vector() const { return system_.vector(); }
  std::optional<double> evaluate(const Vector& v);
  bool change_contacts(Vector& v);
  void linearize(const Vector& v);
  struct Solved {
    int iterations = 0;
    bool good = false;
    bool usable() const { return good; }
  };
  Solved solve(double share, Vector& step);
  double scale() const { return scale_; }
  bool has_energy() const;
  double slope(const Vector& step) { return system_.dot(residual_, step); }
  double reach(const Vector& v, const Vector& step);
  void take(const Vector& v, double length, const Vector& step, Vector& to);

 private:
  Solved solve_linear(double share, Vector& step);
  void follow_topology();
  void collect_holds();
  MaterialInput<Real> try_strain(std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) const;
  bool stress(std::size_t set, Chunk<Real>& chunk, ImplicitScratch<Real>& own) const;
  void finish_residual(std::size_t block, const Real* v, Real* r);
  void carry_acceleration();
  void start();
  void publish(const Vector& v);
  double mass_norm_of_forces();

  const StepPlan<Real>& plan_;
  const ImplicitPlan<Real>& implicit_;
  bool returns_;  // whether sand yields within the solve
  Profile& profile_;
  BlockSweep<Real> sweep_;
  ContactSet<Real> contacts_;
  TangentSystem<Real> system_;
  std::optional<LinearSolve<TangentSystem<Real>>> symmetric_;
  std::optional<LinearSolve<TangentSystem<Real>, GeneralizedConjugateResidual<TangentSystem<Real>>>> general_;

  // Unknown is dv = v - v^n: what is small beside v keeps its digits in single precision.
  Vector v_, step_, trial_, residual_, right_;
  bool accelerated_ = false;   // whether the last step is known
  double scale_ = 1.0;         // the larger of outer and inner impulses, the least that was seen in this solve
  std::vector<double> inner_;  // per block: |dt f_int|^2 in the norm of the inverse mass
  std::int64_t orders_ = -1;   // of the topology that vectors are made for
  SolveStatus linear_ = SolveStatus::kConverged;
};

}  // namespace repose
