// Repose: how particles answer velocities within an implicit step: their stress, and the linear model of it
// that a linear solve works with. Passes over a chunk for the sweeps of engine/implicit/momentum_balance.h; a
// matrix S is for the push that follows.
//
// The model of sand is not made where its velocities have put it (docs/math.md, 45). Stiff sand whose gradient
// is off by a thousandth is taken for open, or for sheared far beyond the cone, and the tangent there says
// little of what it does next to the solution. The model before predicted a stress as well; made at the point
// of the law that is near both, the next model keeps what the last linear solve found out. The first of a step
// is made where a particle would be if it went on deforming at its own rate.
#pragma once

#include "engine/implicit/tangent_system.h"

namespace repose {

template <class Real>
class ParticleResponse {
 public:
  ParticleResponse(const ImplicitPlan<Real>& plan, ParticleSweep<Real>& sweep, TangentSystem<Real>& system);

  /// After each sort event.
  void follow_topology();
  /// A step begins. After it the next model is the first.
  void begin() { modelled_ = false; }
  /// Whether sand yields within the solve, so that models are made away from the velocities.
  bool models() const { return models_; }
  /// Whether sand has an energy that fades under tension, so that tangents may be indefinite.
  bool fades() const { return fades_; }
  std::size_t bytes() const { return at_begin_.bytes() + at_trial_.bytes() + model_.bytes(); }

  // Passes over a chunk.

  /// Keeps grad v^n, of the velocities in the arena.
  void keep_begin(std::size_t set, const Chunk<Real>& chunk, const ImplicitScratch<Real>& own);
  /// S at the change of velocity in the arena, in own.matrix; false where a particle would be turned inside
  /// out.
  bool stress(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own);
  /// Makes the tangents of the system those at the velocities of the last stress(), or `near` them. If
  /// models(), own.matrix is S at those velocities as the linear model has it.
  void linearize(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own, bool near);
  /// All chunks are linearised.
  void end_linearize() { modelled_ = true; }
  /// grad v of the last stress(), 1/s, by rows.
  std::array<const Real*, kAffineComponents> gradient(std::size_t set, const Chunk<Real>& chunk);

 private:
  using LawChannels = std::array<Real*, kMostLawChannels>;
  /// What is kept of a chunk: the gradient of v (1/s, by rows), and the trial state.
  struct Trial {
    Real* gradient[kAffineComponents];
    Real* strain[kStrainComponents];
    LawChannels law;
  };
  /// S(dt grad v) = stress + D (dt grad v - map), D of the tangents, by rows.
  struct Model {
    Real* stress[kAffineComponents];
    Real* map[kAffineComponents];
  };
  static constexpr std::size_t kTrialValues = kAffineComponents + kStrainComponents + kMostLawChannels;
  static constexpr std::size_t kModelValues = 2 * kAffineComponents;

  template <class Found>
  void find(AlignedArray<Real>& kept, std::size_t values_of_all, std::size_t first, std::size_t set,
            const Chunk<Real>& chunk, Found& found) const;
  static void copy_law_channels(const Chunk<Real>& chunk, const LawChannels& to);
  Trial trial_of(std::size_t set, const Chunk<Real>& chunk);
  Model model_of(std::size_t set, const Chunk<Real>& chunk);
  void try_strain(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own);
  TangentInput<Real> input(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own) const;
  void prepare_return(std::size_t set, Chunk<Real>& chunk, TangentInput<Real>& in) const;
  TangentInput<Real> at_trial(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own);
  TangentInput<Real> at_rate(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own);
  TangentInput<Real> place_model(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own,
                                 bool near, Real* const (&ahead)[kAffineComponents]);
  void move_to_linearization_point(std::size_t set, Chunk<Real>& chunk, const ImplicitScratch<Real>& own,
                                   const TangentInput<Real>& in, Real* const (&ahead)[kAffineComponents]);
  bool stress_of(std::size_t set, const TangentInput<Real>& in, Real* const (&matrix)[kAffineComponents]) const;

  const ImplicitPlan<Real>& plan_;
  /// In the order of YieldInput.
  static constexpr std::array kYieldHandles{kYieldSlope.kInfo, kCohesion.kInfo, kDilatancy.kInfo,
                                            kPlastic.kInfo,    kSheared.kInfo,  kDilated.kInfo};

  bool returns_;  // whether sand yields within the solve
  bool models_ = false, fades_ = false;
  ParticleSweep<Real>& sweep_;
  TangentSystem<Real>& system_;
  bool modelled_ = false;
  std::array<std::size_t, kYieldHandles.size()> yield_;  // in scratch
  AlignedArray<Real> at_begin_, at_trial_, model_;       // per particle: grad v^n, Trial, Model
};

}  // namespace repose
