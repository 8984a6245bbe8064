// Repose: a scene as plain data: what to simulate, never how. The reader (engine/reading) fills it from a file,
// a host can fill it by hand, the compiler (engine/compiler) turns it into a step plan. SI units, angles in
// degrees.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/base/places.h"
#include "engine/base/result.h"
#include "engine/effect/effects.h"
#include "engine/geometry/seeding.h"
#include "engine/geometry/shape.h"
#include "engine/plan/clock.h"
#include "engine/plan/implicit_settings.h"
#include "engine/plan/transfer_choice.h"
#include "engine/scene/points_wanted.h"
#include "kernels/material/materials.h"

namespace repose {

enum class UpAxis { kY, kZ };
enum class Precision { kSingle, kDouble };

/// A stretch of one axis after which space repeats, a multiple of 8 cells long.
struct PeriodicAxis {
  double lower = 0.0;   // m
  double length = 0.0;  // m; 0: not periodic
};

struct GridDescription {
  double spacing = 0.01;  ///< dx, m
  Precision precision = Precision::kSingle;
  int stencil = 0;                      ///< position in Stencils
  int transfer = 0;                     ///< position in Transfers
  double velocity_loss = 10.0;          ///< 1/s, of velocity that particles have for themselves (flip, aflip)
  std::optional<double> kept_velocity;  ///< share of it that is kept per step, in its place
  double kept_stretching = 0.0;         ///< share of stretching that rpic keeps
  Advection advection = Advection::kAfterFriction;
  std::array<std::int64_t, 3> origin_cells{
      0, 0, 0};                     ///< where the scene's origin lies in the lattice; multiples of 8
  std::optional<int> plane_strain;  ///< the axis (0, 1, 2) across which nothing varies
  std::array<PeriodicAxis, 3> periodic;
};

/// How a step is made.
enum class Integrator {
  kExplicit,  ///< symplectic: short steps, each cheap
  kImplicit,  ///< backward Euler: long steps, each solved for
  kAuto,      ///< whichever should take less time (engine/compiler/integrator.h)
};

/// What happens where energy comes from nowhere.
enum class AlarmChoice { kOff, kWarn, kStop };

struct TimeDescription {
  Integrator integrator = Integrator::kExplicit;
  std::int64_t frames = 48;
  double frames_per_second = 24.0;
  std::vector<std::vector<double>>
      scale;              ///< slow motion: rows (film time in s, scene seconds per film second)
  double max_step = 1.0;  ///< s; an upper bound beside the limits below
  double cfl = 0.6;       ///< cells that matter may cross in a step
  double sound = 0.5;     ///< cells that a compression wave may cross in a step
  double isolated = 0.9;  ///< share of the stability limit of one particle alone
  double strain = 0.5;    ///< largest velocity gradient times step
  AlarmChoice energy_alarm = AlarmChoice::kWarn;
};

inline Clock clock_of(const TimeDescription& time) {
  return {time.frames_per_second, time.scale};
}

struct MaterialDescription {
  std::string name;
  MaterialParameters parameters;
  /// Of what has a cone: d and rho_s of its grains, m and kg/m^3, for the inertial number.
  std::optional<double> grain_diameter{};
  double grain_density = 2500.0;

  /// Position in the list of materials.
  int law() const { return static_cast<int>(parameters.index()); }
  const Elasticity& elasticity() const { return elasticity_of(parameters); }
};

/// A solid filled with particles of one material.
struct BodyDescription {
  std::string name;
  std::string material;
  ShapeDescription shape;
  std::int64_t particles_per_cell = 8;
  Sampling sampling = Sampling::kJittered;
  std::int64_t seed = 1;
  Vec3 velocity{0, 0, 0};          ///< m/s
  Vec3 angular_velocity{0, 0, 0};  ///< rad/s about the centre of the shape's bounds
};

/// The surface of the material as a level set.
struct SurfaceDescription {
  bool given = false;
  double voxel = 0.0;          ///< m; 0: half of grid.spacing
  double radius = 1.0;         ///< spacings; gaps that a ball of this radius does not fit into are closed
  std::int64_t smoothing = 2;  ///< times that the surface is averaged over its neighbours
};

/// Density and velocity of the material on voxels.
struct FogDescription {
  bool given = false;
  double voxel = 0.0;  ///< m; 0: grid.spacing
};

struct OutputDescription {
  bool vdb = true;  ///< NAME.points.####.vdb
  bool ply = false;
  bool vtp = false;
  std::vector<OutputAttribute> attributes;  ///< of points
  SurfaceDescription surface;               ///< NAME.surface.####.vdb
  FogDescription fog;                       ///< NAME.fog.####.vdb
  bool checkpoint = true;                   ///< a resumable state per frame, two kept
  bool steps = false;                       ///< a row of figures per step in run.json
  bool residuals = false;                   ///< and in it the residual of each Newton iteration
};

/// How `movie` looks at the run.
struct CameraDescription {
  bool given = false;  ///< otherwise it frames the material
  Vec3 eye{1, 1, 1};
  Vec3 target{0, 0, 0};
  double field_of_view = 35.0;  ///< degrees, vertical
};

struct Scene {
  std::string name;
  UpAxis up = UpAxis::kY;
  GridDescription grid;
  TimeDescription time;
  std::vector<MaterialDescription> materials;
  std::vector<BodyDescription> bodies;
  Effects effects;
  ImplicitSettings implicit;  ///< where steps are implicit
  OutputDescription output;
  CameraDescription camera;

  template <class E>
  E& effect() {
    return std::get<E>(effects);
  }
  template <class E>
  const E& effect() const {
    return std::get<E>(effects);
  }

  /// A key as errors found after reading name it.
  std::string where(const std::string& key) const { return places.where(key); }

  Places places;
  std::string folder;              ///< where relative paths start
  std::vector<std::string> files;  ///< that it names, as it has them: meshes, grids; a row of "#" for a number
  std::string identity;   ///< what a state of it depends on (engine/reading/identity.h); what is hashed
  std::string canonical;  ///< all of it as compact JSON after overrides and expressions; kept beside a run
};

void describe(Fields& fields, Scene& scene);

/// The sets that effects will fill, and the names of what removes particles, each in the order of the ledger.
std::vector<Inlet> inlets(const Scene& scene);
std::vector<std::string> outlets(const Scene& scene);

}  // namespace repose
