// Repose: motions that are known exactly, for those who verify solvers: bodies begin with the velocity of a
// formula and feel the body force that makes the formula a solution of the balance of momentum. The force is
// that of the place where a particle began, so the particles of such bodies, and of no other, keep it.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "engine/effect/description.h"

namespace repose {

/// The motion of one body. X is the place where a particle began, measured from `origin`, m; t the time, s; e
/// the elasticity of the body's material.
struct ManufacturedSolution {
  enum class Type {
    kBarMode,            ///< the first mode of a bar, fixed at the origin and free at its end; no force
    kGeneralizedVortex,  ///< rings turn against each other and back (Brannon and Kamojjala)
    kAxisAligned,        ///< stretching along the axes, periodic (Wallstedt and Guilkey 2008)
  };
  std::string body;
  Type type = Type::kBarMode;
  Vec3 origin{0, 0, 0};               ///< m, where the formula's coordinates begin
  Vec3 direction{1, 0, 0};            ///< bar: from its fixed end to its free one
  double length = 1.0;                ///< m, of the bar, or of the box that repeats
  double speed = 0.0;                 ///< bar: m/s, of the free end
  Vec3 axis{0, 0, 1};                 ///< vortex
  double inner = 0.75, outer = 1.25;  ///< vortex: m, radii between which matter turns
  double angle = 180.0;               ///< vortex: degrees, of the middle ring at half of `half_period`
  double half_period = 1.0;           ///< vortex: s, after which all is where it began
  Vec3 amplitude{0.05, -0.05, 0.0};   ///< axis aligned: m

  bool pushes() const { return type != Type::kBarMode; }
  /// At t = 0, m/s.
  Vec3 velocity(const Vec3& X, const Elasticity& e) const;
  /// Body force per mass, m/s^2. Zero for the bar.
  Vec3 force(const Vec3& X, double t, const Elasticity& e) const;
};

struct Manufactured : EffectDescription {
  static constexpr const char* kName = "manufactured";
  static std::vector<Example> examples();
  /// Channels: X, m.
  static constexpr Handle<"reference_x", Place::kExtra> kX{};
  static constexpr Handle<"reference_y", Place::kExtra> kY{};
  static constexpr Handle<"reference_z", Place::kExtra> kZ{};

  std::vector<ManufacturedSolution> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const;
  std::vector<Channel> channels(const SetDescription& set) const;

  /// That of a body; null where it has none.
  const ManufacturedSolution* find(const std::string& body) const;
  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
