// Repose: where a host puts particles, and takes them away: emitters of type "host". Nothing begins there by
// itself; between two steps the host says what begins and what ends, and it is done at once.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "engine/effect/effect.h"
#include "engine/plan/step_plan.h"

namespace repose {

/// Puts particle p of newcomers at x (m), on the lattice of seeds so that nothing below 1 rounds up to it.
template <class Real>
void put_at(const Vec3& x, const Surroundings& around, std::size_t p, SetEdit<Real>& added);

template <class Real>
class HostInlets {
 public:
  struct Inlet {
    std::string name;
    InletPlace place;
    SetDescription description;
  };

  /// `outlet`: where in Ledger::removed stands what a host removes.
  HostInlets(std::vector<Inlet> inlets, std::size_t outlet, const Surroundings& surroundings,
             std::function<void(Newcomers<Real>&)> initialize)
      : inlets_(std::move(inlets)),
        outlet_(outlet),
        surroundings_(surroundings),
        initialize_(std::move(initialize)) {}

  /// The inlet of a name, or null.
  const Inlet* find(const std::string& name) const;
  std::vector<std::string> names() const;

  /// `count` particles begin; positions (m) and velocities (m/s) are x y z of each, `velocities` may be null.
  /// `then` has the last word on what they keep.
  void add(const Inlet& inlet, std::size_t count, const double* positions, const float* velocities,
           State<Real>& state, ParticleEdit<Real>& edit,
           const std::function<void(ParticleSet<Real>& newcomers)>& then) const;
  /// The particles of ids that there are end. Returns how many.
  std::size_t remove(std::vector<std::uint32_t> ids, State<Real>& state, ParticleEdit<Real>& edit) const;

  std::size_t bytes() const { return 0; }

 private:
  std::vector<Inlet> inlets_;
  std::size_t outlet_;
  Surroundings surroundings_;
  std::function<void(Newcomers<Real>&)> initialize_;
};

inline constexpr TableHandle<"host inlets", HostInlets> kHostInlets;

}  // namespace repose
