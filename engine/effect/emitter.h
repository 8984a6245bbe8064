// Repose: emitters, where particles begin: a mouth that a column of material moves through, or a solid that is
// filled at random. What they make is in stream.h; here are the keys of the scene, and the batches in which it
// comes into the state. Each emitter's particles are a set of their own, empty at the start.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/effect/effect.h"
#include "engine/effect/stream.h"

namespace repose {

/// All emitters of a scene, as one effect. Each is an inlet, in the order of the list.
struct Emitters : Effect {
  static constexpr const char* kName = "emitter";
  static std::vector<Example> examples();

  std::vector<Emitter> list;
  std::vector<std::string> materials;  ///< names that the reader accepts

  void know_materials(const std::vector<std::string>& names) { materials = names; }
  void declare(Fields& fields);
  bool on() const { return !list.empty(); }
  std::string why() const {
    return list.empty() ? "no entry in 'emitters'" : std::to_string(list.size()) + " in 'emitters'";
  }

  std::vector<Inlet> inlets() const;
  double particles_by(double time, double spacing, int flat_axis) const;

  /// Errors: 65, 66, naming the emitter.
  Result<void> prepare(const Surroundings& surroundings);

  /// An event: when the oldest particle that has crossed has gone about a cell, and at the end of a frame.
  template <class Real>
  void add_to_nodes(Assembly<Real>& assembly) const;

 private:
  std::vector<std::shared_ptr<const Shape>> shapes_;  // per emitter; null where it has none
};

}  // namespace repose
