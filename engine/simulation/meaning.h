// Repose: numbers and places of a scene that are right by themselves and most likely not meant: units of
// another system, matter too soft for its height, bodies that lie in one another, sand that nothing catches.
#pragma once

#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/effect/solid.h"
#include "engine/scene/scene.h"
#include "engine/state/state.h"

namespace repose {

/// Densities of g/cm^3, angles in radians, coefficients of friction that are angles; implicit steps as long as
/// frames.
std::vector<std::string> unit_warnings(const Scene& scene);

/// Bodies that their own weight presses by more than a quarter: rho g H over E.
template <class Real>
std::vector<std::string> softness_warnings(const Scene& scene, const State<Real>& state);

/// Bodies that share cells, which then hold matter twice.
template <class Real>
std::vector<std::string> overlap_warnings(const State<Real>& state);

/// Bodies and emitters under which nothing lies, where nothing else could end or stop their fall. `solids` are
/// those at the start.
template <class Real>
std::vector<std::string> floor_warnings(const Scene& scene, const std::vector<Solid>& solids,
                                        const State<Real>& state);

/// Emitters whose mouth, or the cell before it, lies in a solid.
std::vector<std::string> mouth_warnings(const Scene& scene, const std::vector<Solid>& solids);

}  // namespace repose
