#include "engine/scene/numerics.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/wording.h"

namespace repose {
namespace {

constexpr Choice kPrecisions[] = {{"single", "float, the fast one"}, {"double", "double, for reference"}};
constexpr Choice kAdvections[] = {
    {"after_friction", "the velocity that particles keep; what friction holds, rests"},
    {"before_friction", "as Klar et al. 2016; what friction holds creeps a little, by more in longer steps"},
};
constexpr Choice kFlatAxes[] = {
    {"none", "three dimensions"}, {"x", "nothing varies along x"}, {"y", "along y"}, {"z", "along z"}};
constexpr const char* kAxisNames[] = {"x", "y", "z"};

constexpr double kBlockCells = 8.0;   // two blocks: what keeps block colours and a periodic seam in step
constexpr double kMostCells = 2.0e9;  // cell coordinates are 32 bits wide

bool is_multiple(double value, double unit) {
  const double count = value / unit;
  return std::abs(count - std::round(count)) <= 1e-6 * std::max(1.0, std::abs(count));
}

void describe_periodic_axis(Fields& fields, PeriodicAxis& axis, double spacing) {
  const double unit = kBlockCells * spacing;
  fields.number("lower", axis.lower, {.unit = "m", .meaning = "where the stretch begins"});
  fields.number("length", axis.length,
                {.unit = "m",
                 .meaning = "length of the stretch; a multiple of 8 spacings",
                 .low = 0.0,
                 .low_open = true,
                 .required = true});
  const auto advice = [&](double value) {
    return number_text(value) + " must be a multiple of 8 spacings, " + number_text(unit) + " m; nearest is " +
           number_text(std::round(value / unit) * unit);
  };
  fields.check(is_multiple(axis.lower, unit), "lower", advice(axis.lower));
  const bool long_enough = axis.length > 0.5 * unit;
  fields.check(long_enough, "length", "must be at least 8 spacings, " + number_text(unit) + " m");
  fields.check(!long_enough || is_multiple(axis.length, unit), "length", advice(axis.length));
  const double reach = std::max(std::abs(axis.lower), std::abs(axis.lower + axis.length));
  fields.check(reach < kMostCells * spacing, "length", "must end less than 2e9 spacings from the origin");
}

void describe_periodic(Fields& fields, GridDescription& grid) {
  for (int axis = 0; axis < 3; ++axis) {
    const char* name = kAxisNames[axis];
    bool given = false;
    fields.object(name, given, false, "space repeats along this axis",
                  [&](Fields& f) { describe_periodic_axis(f, grid.periodic[axis], grid.spacing); });
    fields.check(!given || grid.plane_strain != axis, name,
                 "this axis is flat (plane_strain) and cannot repeat");
  }
}

constexpr Choice kAlarms[] = {{"off", "nobody looks"},
                              {"warn", "the run says so, and goes on"},
                              {"stop", "the run ends, with its state from the last frame"}};
constexpr Choice kIntegrators[] = {
    {"explicit", "short steps, each cheap"},
    {"implicit", "backward Euler: long steps, each solved for (key 'implicit')"},
    {"auto", "whichever of the two should take less time; `repose plan` says which, and why"},
};

constexpr Choice kTangentModeChoices[] = {
    {"exact",
     "sand yields within the solve, with the whole tangent; not symmetric: generalised conjugate residual"},
    {"projected", "the same, with the symmetric part of the tangent: conjugate residual"},
    {"lagged", "elastic within the solve, sand yields afterwards: cohesion that grows with the step"},
    {"unilateral", "an energy without tension within the solve, sand yields afterwards"},
};

constexpr Choice kLinearMethods[] = {
    {"by_mode", "generalized_conjugate_residual for mode exact, conjugate_residual for the others"},
    {"conjugate_residual", "for symmetric tangents"},
    {"generalized_conjugate_residual", "for any; keeps some directions"},
};

constexpr Choice kPreconditioners[] = {
    {"none", "nothing"},
    {"mass", "one over the mass of each node"},
    {"blocks", "the inverse of the 3x3 block of each node"},
};

}  // namespace

void describe(Fields& fields, GridDescription& grid) {
  fields.number(
      "spacing", grid.spacing,
      {.unit = "m", .meaning = "distance between nodes, dx", .low = 0.0, .low_open = true, .required = true});
  fields.choice("precision", grid.precision, kPrecisions, "type of particle and node data");
  std::vector<Choice> stencils;
  for (const StencilFigures& stencil : kStencilFigures) stencils.push_back({stencil.name, stencil.meaning});
  fields.choice("stencil", grid.stencil, stencils, "how a particle spreads over nodes");
  fields.choice("transfer", grid.transfer, kTransferChoices, "how momentum moves between particles and nodes");
  const auto share_of = [&](const char* key, double& value, const char* meaning) {
    fields.number(key, value, {.meaning = meaning, .low = 0.0, .high = 1.0});
  };
  fields.number(
      "velocity_loss", grid.velocity_loss,
      {.unit = "1/s",
       .meaning = "flip, aflip: rate at which a particle loses the velocity that its neighbours do not "
                  "share; 0: never",
       .low = 0.0});
  double kept = grid.kept_velocity.value_or(std::numeric_limits<double>::quiet_NaN());
  share_of("kept_velocity", kept,
           "flip, aflip: share of it that is kept, per step and so more of a loss in smaller steps, instead of "
           "velocity_loss; 0 is pic, mls_apic");
  if (!std::isnan(kept)) grid.kept_velocity = kept;
  share_of("kept_stretching", grid.kept_stretching,
           "rpic: share of the stretching part of its matrix that a particle keeps, per step; 1 is apic");
  fields.choice("advection", grid.advection, kAdvections,
                "which velocity moves particles where there is friction");
  fields.integers("origin_cells", grid.origin_cells,
                  {.unit = "cells",
                   .meaning = "where the scene's origin lies in the lattice; multiples of 8",
                   .low = -kMostCells,
                   .high = kMostCells,
                   .low_open = true,
                   .high_open = true});
  fields.check(
      std::all_of(grid.origin_cells.begin(), grid.origin_cells.end(), [](auto n) { return n % 8 == 0; }),
      "origin_cells", "must be multiples of 8, such as [0, -16, 800]");

  int flat = grid.plane_strain ? *grid.plane_strain + 1 : 0;
  fields.choice("plane_strain", flat, kFlatAxes, "the axis across which nothing varies");
  grid.plane_strain = flat == 0 ? std::nullopt : std::optional<int>(flat - 1);

  bool given = false;
  fields.object("periodic", given, false, "axes along which space repeats",
                [&](Fields& f) { describe_periodic(f, grid); });
}

void describe(Fields& fields, ImplicitSettings& implicit) {
  fields.choice("mode", implicit.mode, kTangentModeChoices, "how sand answers within the solve");
  fields.choice("method", implicit.method, kLinearMethods, "how linear systems are solved");
  fields.check(implicit.mode != TangentMode::kExact || implicit.method != LinearMethod::kConjugateResidual,
               "method",
               "the tangent of mode exact is not symmetric, and conjugate_residual would not solve it; use "
               "generalized_conjugate_residual, or mode projected, which has the symmetric part");
  fields.choice("preconditioner", implicit.preconditioner, kPreconditioners,
                "what stands in for the inverse of the tangent");
  fields.number("tolerance", implicit.tolerance,
                {.meaning = "what may be left of the residual, over the larger of outer and inner impulses",
                 .low = 0.0,
                 .high = 0.1,
                 .low_open = true});
  fields.integer("newton_iterations", implicit.newton_iterations,
                 {.meaning = "at most; a step that needs more is made shorter", .low = 1.0, .high = 1000.0});
  fields.integer("krylov_iterations", implicit.krylov_iterations,
                 {.meaning = "at most, of one linear solve", .low = 1.0, .high = 1.0e6});
  fields.integer("directions", implicit.directions,
                 {.meaning = "that generalized_conjugate_residual keeps; two vectors of nodes each",
                  .low = 1.0,
                  .high = 1000.0});
  bool given = implicit.unilateral.has_value();
  UnilateralConstants<double> unilateral = implicit.unilateral.value_or(UnilateralConstants<double>{});
  fields.object(
      "unilateral", given, false,
      "where the energy of mode unilateral lets tension go; without it, under the pressure of two "
      "cells of the material at 9.81 m/s^2",
      [&](Fields& f) {
        f.number("begin", unilateral.begin,
                 {.meaning = "strain, tr(eps)/sqrt(3), below which all of the stress acts", .required = true});
        f.number(
            "width", unilateral.width,
            {.meaning = "strain over which the stress fades", .low = 0.0, .low_open = true, .required = true});
        f.number("bend", unilateral.bend, {.meaning = "how much sooner it fades under shear", .low = 0.0});
      });
  implicit.unilateral = given ? std::optional(unilateral) : std::nullopt;
}

void describe(Fields& fields, TimeDescription& time) {
  fields.choice("integrator", time.integrator, kIntegrators, "how a step is made");
  fields.integer("frames", time.frames, {.meaning = "frames to simulate", .low = 1.0, .high = 1.0e9});
  fields.number("frames_per_second", time.frames_per_second,
                {.unit = "1/s", .meaning = "frames in a second of the scene", .low = 0.0, .low_open = true});
  fields.rows(
      "scale", time.scale, 2,
      {.meaning = "slow motion: keys (seconds of the film, scene seconds per film second), linear between; "
                  "without it, 1",
       .low = 0.0});
  const auto steps_back = [](const auto& a, const auto& b) { return b[0] <= a[0]; };
  fields.check(std::adjacent_find(time.scale.begin(), time.scale.end(), steps_back) == time.scale.end(),
               "scale", "must ascend in time, for example [[0, 1], [2, 1], [2.5, 0.1]]");
  fields.check(std::all_of(time.scale.begin(), time.scale.end(), [](const auto& key) { return key[1] > 0.0; }),
               "scale", "must be above 0: time does not stand still");
  fields.number("max_step", time.max_step,
                {.unit = "s",
                 .meaning = "upper bound of the time step beside the limits below",
                 .low = 0.0,
                 .low_open = true});
  const auto share = [&](const char* key, double& value, const char* meaning) {
    fields.number(key, value, {.meaning = meaning, .low = 0.0, .high = 1.0, .low_open = true});
  };
  share("cfl", time.cfl, "cells that matter may cross in a step");
  share("sound", time.sound, "cells that a compression wave may cross in a step");
  share("isolated", time.isolated, "share of the stability limit of one particle alone");
  share("strain", time.strain, "largest velocity gradient times step");
  fields.choice("energy_alarm", time.energy_alarm, kAlarms,
                "where there is more energy than gravity, solids and sources can have given");
}

}  // namespace repose
