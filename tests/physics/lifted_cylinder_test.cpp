// Repose tests: the angle of repose as laboratories measure it: a cylinder of sand is lifted and leaves a heap,
// whose slope rises with the angle of internal friction.
#include <gtest/gtest.h>

#include "tests/physics/physics_rig.h"

namespace repose {
namespace {

double heap_angle(int phi) {
  const Scene scene = scene_file("friction_angle.json", {"parameters.coarse=3.5", "parameters.ppc=8",
                                                         "parameters.phi=" + std::to_string(phi)});
  const auto simulation = simulate(scene);
  EXPECT_TRUE(run_until(*simulation, 1.0));
  const PointCloud points = simulation->points();
  const double volume = particle_volume(scene, *simulation);
  const double front = front_ring(points, volume, scene.grid.spacing);
  return slope_degrees(points, volume, scene.grid.spacing, 0.25 * front, 0.85 * front);
}

TEST(LiftedCylinder, MoreFriction_SteeperHeap) {
  const double low = heap_angle(20), middle = heap_angle(30), high = heap_angle(40);
  report("heap_of_20", low, "degrees");
  report("heap_of_30", middle, "degrees");
  report("heap_of_40", high, "degrees");
  EXPECT_GT(middle, low + 1.0);
  EXPECT_GT(high, middle + 1.0);
}

}  // namespace
}  // namespace repose
