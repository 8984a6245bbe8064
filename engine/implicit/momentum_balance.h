// Repose: the balance of momentum that an implicit step brings about, backward Euler on the velocities of the
// active nodes (Klar et al. 2016, supplement):
//   r_i(v) = m_i (v_i - v_i^free) - dt f_i(v) = 0,   f_i = -sum_p V0 S_p g_ip,
//   S = tau(Z(b(v))) (I + dt grad v)^-T,
// where v^free has all forces but stress. Nothing is assembled: residual and tangent are passes over the same
// blocks, in the same colours, as the transfers. The unknown is dv = v - v^n: what is small beside v keeps its
// digits in single precision.
#pragma once

#include <limits>
#include <optional>

#include "engine/implicit/particle_response.h"

namespace repose {

template <class Real>
class MomentumBalance {
 public:
  using Vector = NodeField<Real>;

  MomentumBalance(const ImplicitPlan<Real>& plan, ParticleSweep<Real>& sweep, ContactSet<Real>& contacts,
                  TangentSystem<Real>& system);

  /// After each sort event.
  void follow_topology();
  /// A step from the nodes of the sweep's state, which hold mass and v^free, and `before_forces`, with v^n.
  void begin();

  /// |r(dv)| in the norm of the inverse mass, kg^1/2 m/s, less what nodes that stick bear; nothing where a
  /// particle would be turned inside out or something is not finite.
  std::optional<double> evaluate(const Vector& dv);
  /// r of the dv that was evaluated last, less what holds bear, with the friction of Coulomb's regularised law;
  /// after linearize() as the linear model has it there.
  const Vector& residual() const { return residual_; }
  /// The larger of the outer and the inner impulses of the step, in that norm, the least seen in this step. Of
  /// a stiff body inner ones are large far from the solution: what counts is what acts at it.
  double scale() const { return scale_; }
  /// What is evaluated from here on counts alone.
  void forget_scale() { scale_ = std::numeric_limits<double>::infinity(); }

  /// Whether there are models near dv, rather than at it.
  bool models() const { return particles_.models(); }
  /// Whether tangents may be indefinite.
  bool fades() const { return particles_.fades(); }
  /// Makes the system the tangent at the dv that was evaluated last, or of a model near it; returns |r| as the
  /// model has it at that dv.
  double linearize(const Vector& dv, bool near);
  /// The longest length along step at which no particle is turned inside out, when the dv that was evaluated
  /// last lies `length` along it.
  double longest_step(const Vector& step, double length);

  std::size_t particle_bytes() const { return particles_.bytes(); }
  std::size_t block_bytes() const { return residual_.bytes(); }

 private:
  static constexpr double kLeastDeterminant = 0.02;  // for longest_step(): twice what the kernel refuses

  double push_scale(const Chunk<Real>& chunk) const;
  std::array<double, 3> finish_residual(const Vector& dv);
  std::array<double, 3> finish_block(std::size_t block, const Real* dv, Real* r);

  ParticleSweep<Real>& sweep_;
  ContactSet<Real>& contacts_;
  TangentSystem<Real>& system_;
  ParticleResponse<Real> particles_;
  Vector residual_;
  double norm_ = 0.0, scale_ = 0.0;
};

}  // namespace repose
