// Repose: what a scene most likely does not mean, though it is no error. One place, so that every command says
// the same words.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/effect/solid.h"
#include "engine/plan/step_plan.h"
#include "engine/scene/scene.h"
#include "engine/state/state.h"

namespace repose {

/// Materials that cannot do what they are for: sand whose cone is too steep to yield in plane strain.
std::vector<std::string> scene_warnings(const Scene& scene);

/// One for each solid that is thinner than what nodes see: how it is thickened, or that material may pass it
/// where it is thin in places.
std::vector<std::string> thin_solid_warnings(const std::vector<Solid>& solids, double spacing);

/// One for each body that has particles inside solids by more than half a cell: how many, how deep, in which.
template <class Real>
std::vector<std::string> seeding_warnings(const std::vector<Solid>& solids, const State<Real>& state,
                                          Threads& threads);

/// That the fastest particle cuts the next step below a quarter of what the limits other than the velocity's
/// would allow, as sand does that falls past its floor; nothing if it does not. Looks for the particle only if
/// it does.
template <class Real>
std::optional<std::string> speed_warning(const StepPlan<Real>& plan, const State<Real>& state);

/// Particles that are pressed as thin as a strain can say (docs/math.md, section 32), or nothing.
template <class Real>
std::optional<std::string> crushed_warning(const State<Real>& state, Threads& threads);

}  // namespace repose
