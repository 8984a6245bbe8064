// Repose: probes: figures that a scene asks for, measured while it runs and reported per frame. They read and
// never write what is simulated, so a run with probes has the bits of one without. Running sums are tallies of
// the state, so a frame that was interrupted and resumed reports the same.
#pragma once

#include <string>
#include <vector>

#include "engine/base/vector.h"
#include "engine/effect/description.h"

namespace repose {

struct FlowPlane {
  Vec3 point{0, 0, 0};   ///< m
  Vec3 normal{0, 1, 0};  ///< forth is along it, back against it; of any length but zero
};

struct SurfaceLine {
  Vec3 from{0, 0, 0}, to{1, 0, 0};  ///< m; heights along up do not matter
  double width = 0.0;               ///< m, of the columns across the line; 0: dx
  std::int64_t samples = 0;         ///< columns from end to end; 0: one each dx
};

struct ProbeDescription {
  enum class Type { kForce, kFlow, kSurface, kEnergy };
  std::string name;
  Type type = Type::kEnergy;
  // force
  std::string collider;
  Vec3 about{0, 0, 0};  ///< m, the point that the torque is about
  FlowPlane plane;      // flow
  SurfaceLine line;     // surface
};

struct Probes : EffectDescription {
  static constexpr const char* kName = "probe";
  static std::vector<Example> examples();

  std::vector<ProbeDescription> list;

  void declare(Fields& fields, const SceneOutline& outline);
  bool on() const { return !list.empty(); }
  std::string why() const { return entries_text(list.size(), "probes"); }

  template <class Real>
  EffectResult<Real> make(const Surroundings& surroundings) const;
};

}  // namespace repose
