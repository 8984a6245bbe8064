#include "engine/effect/solid.h"

#include "engine/geometry/mesh_sequence.h"
#include "engine/geometry/periodic_shape.h"

namespace repose {

Solid Solid::at(double time) const {
  Solid still = *this;
  if (motion != nullptr) still.shape = std::make_shared<PlacedShape>(shape, motion->pose(time));
  if (sequence != nullptr) still.shape = sequence->at(time);
  if (moves()) still.shape = in_periods(still.shape, periods);
  still.motion = nullptr;
  still.sequence = nullptr;
  still.led_motion = nullptr;
  still.led_sequence = nullptr;
  return still;
}

}  // namespace repose
