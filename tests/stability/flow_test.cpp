// Repose tests: motions that are known exactly, and sand that flows as laboratories say.
#include <gtest/gtest.h>

#include "tests/stability/collapse_cases.h"
#include "tests/stability/crowding_cases.h"
#include "tests/stability/order_cases.h"
#include "tests/stability/silo_cases.h"

namespace repose {
namespace {

TEST(Battery, Case21_CrowdedAndSparseParticles_HaveRoom) {
  battery::Case result(21, "crowded and sparse particles");
  battery::expect_room_for_a_crowd(result, 196);
  battery::expect_room_for_few(result, 64);
}

TEST(Battery, Case32_ManufacturedVortex_ConvergesByTheSecondOrder) {
  battery::Case result(32, "manufactured motions");
  battery::expect_order_of_the_vortex(result, {12, 24});
}

TEST(Battery, Case32_ManufacturedBox_ConvergesByTheSecondOrder) {
  battery::Case result(32, "manufactured motions");
  battery::expect_order_of_the_box(result, {16, 32});
}

TEST(Battery, Case33_Column_RunsAsExperimentsSay) {
  battery::Case sand(33, "column collapse"), glue(33, "column collapse, control");
  for (const double aspect : {0.5, 1.0, 2.0}) battery::expect_runout_of_round_column(sand, glue, aspect);
  battery::expect_runout_of_plane_column(sand, glue);
}

TEST(Battery, Case34_SlotOfASilo_FlowsByBeverloo) {
  battery::Case result(34, "silo");
  battery::expect_beverloo_of_a_slot(result, {12, 16, 22});
}

}  // namespace
}  // namespace repose
