// Repose tests: the cases of motion that take minutes.
#include <gtest/gtest.h>

#include "tests/physics/physics_rig.h"
#include "tests/stability/crowding_cases.h"
#include "tests/stability/leak_cases.h"
#include "tests/stability/order_cases.h"
#include "tests/stability/rest_cases.h"
#include "tests/stability/silo_cases.h"

namespace repose {
namespace {

TEST(Battery, Case21_AMillionInACell_HaveRoom) {
  battery::Case result(21, "crowded and sparse particles");
  battery::expect_room_for_a_crowd(result, 1954);
  battery::expect_room_for_few(result, 140);
}

TEST(Battery, Case29_Cone_RestsForTenSeconds) {
  battery::Case result(29, "heap at rest");
  battery::expect_heap_at_rest(result, "cone, 10 s", 10.0, {});
  battery::expect_heap_at_rest(result, "plane strain, implicit, 10 s", 10.0,
                               {"grid.plane_strain=z", "time.integrator=implicit", "time.max_step=5e-3"});
}

TEST(Battery, Case32_ManufacturedMotions_ConvergeByTheSecondOrder) {
  battery::Case result(32, "manufactured motions");
  const battery::Missed missed{
      1.78, "1.98 from 12 to 24 cells; then what places at random leave of the integrals shows"};
  battery::expect_order_of_the_vortex(result, {16, 32, 64}, &missed);
  battery::expect_order_of_the_box(result, {16, 32, 64, 128});
}

TEST(Battery, Case34_Silo_FlowsByBeverloo) {
  battery::Case result(34, "silo");
  battery::expect_beverloo_of_a_slot(result, {10, 13, 16, 20, 24});
  battery::expect_beverloo_of_a_hole(result, {9, 12, 15});
}

TEST(Battery, Case47_NeckOfAnHourglass_LetsNothingIntoTheGlass) {
  battery::Case result(47, "neck of an hourglass");
  battery::expect_no_leak(result, "9 cells wide", scene_file("hourglass.json", {"parameters.coarse=1.5"}), 1.0);
}

TEST(Battery, Case49_RakeOfTheGallery_IsNotEntered) {
  battery::Case result(49, "rake of the gallery");
  battery::expect_no_leak(result, "twice as coarse", scene_file("raking.json", {"parameters.coarse=2"}), 3.1);
}

}  // namespace
}  // namespace repose
