// Repose tests: must not compile: the pass reads a handle that it has not declared
// (tests/engine/CMakeLists.txt).
#include "engine/plan/step_plan.h"

namespace repose {

void add_sly_pass(StepPlan<float>& plan, const State<float>& state) {
  plan.gather_of(state, 0).add({"sly"}, reads(kYieldSlope), writes(kDilatancy), [](const auto& at) {
    *at.write(kDilatancy) = *at.read(kYieldSlope) * *at.read(kCohesion);
  });
}

}  // namespace repose
