// Repose: probes: figures that a scene asks for, measured while it runs and reported per frame. They read and
// never write what is simulated, so a run with probes has the bits of one without. Running sums are tallies of
// the state, so a frame that was interrupted and resumed reports the same.
#pragma once

#include <memory>

#include "engine/base/params.h"
#include "engine/effect/effect.h"
#include "engine/effect/flow_probe.h"
#include "engine/effect/surface_probe.h"

namespace repose {

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

struct Probes : Effect {
  static constexpr const char* kName = "probe";
  static std::vector<Example> examples();

  std::vector<ProbeDescription> list;

  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'probes'" : std::to_string(list.size()) + " in 'probes'";
  }
  /// Errors: 65, a force on a solid that is not there.
  Result<void> prepare(const Surroundings& surroundings);

  /// The log of contacts for probes of force and energy; what is summed over steps; what each frame reports.
  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;
  /// For probes of flow: on which side a particle is, before it moves and after.
  template <class Real>
  void add_before_motion(Assembly<Real>& assembly, std::size_t set) const;
  template <class Real>
  void add_after_motion(Assembly<Real>& assembly, std::size_t set) const;

 private:
  bool any(ProbeDescription::Type type) const;
};

}  // namespace repose
