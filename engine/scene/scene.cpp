// Repose: the keys of a scene file, in the order of its reference. Conditions that one value can state are
// ranges; those across several keys are checks at the key that a user would change.
#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>

#include "engine/scene/wording.h"

namespace repose {
namespace {

constexpr Choice kUpAxes[] = {{"y", "y is up"}, {"z", "z is up"}};
constexpr Choice kPrecisions[] = {{"single", "float, the fast one"}, {"double", "double, for reference"}};
constexpr Choice kAdvections[] = {
    {"after_friction", "the velocity that particles keep; what friction holds, rests"},
    {"before_friction", "as Klar et al. 2016; what friction holds creeps a little, by more in longer steps"},
};
constexpr Choice kFlatAxes[] = {
    {"none", "three dimensions"}, {"x", "nothing varies along x"}, {"y", "along y"}, {"z", "along z"}};
constexpr Choice kSamplings[] = {
    {"jittered", "each cell is cut into equal parts with one particle at random in each"},
    {"poisson_disk", "no two particles closer than a radius, Bridson 2007"}};
constexpr Choice kAttributes[] = {
    {"stress", "Cauchy stress, Pa, tension positive; 6 components xx yy zz xy yz xz"},
    {"pressure", "minus the mean of the stress's diagonal, Pa"},
    {"elastic_strain", "Hencky strain of the elastic part; 6 components as of stress"},
    {"density", "kg/m^3, as the elastic strain and the volume that volume_correction remembers leave it"},
    {"speed", "m/s"},
    {"channels", "every number per particle that an effect keeps, by its own name"},
    {"age", "s since a particle began, with the scene or from an emitter; asks for the scene's key \"age\""}};
constexpr const char* kAxisNames[] = {"x", "y", "z"};

constexpr double kBlockCells = 8.0;          // two blocks: what keeps block colours and a periodic seam in step
constexpr double kFinestVoxel = 1.0 / 16.0;  // of files, spacings
constexpr double kMostCells = 2.0e9;         // cell coordinates are 32 bits wide

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

void describe_grid(Fields& fields, GridDescription& grid) {
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
  share_of("kept_velocity", grid.kept_velocity,
           "flip, aflip: share of its own velocity that a particle keeps; 0 is pic, mls_apic");
  share_of("kept_stretching", grid.kept_stretching,
           "rpic: share of the stretching part of its matrix that a particle keeps; 1 is apic");
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

constexpr Choice kIntegrators[] = {
    {"explicit", "short steps, each cheap"},
    {"implicit", "backward Euler: long steps, each solved for (key 'implicit')"},
};

constexpr Choice kTangentModeChoices[] = {
    {"exact",
     "sand yields within the solve, with the whole tangent; not symmetric: generalised conjugate residual"},
    {"projected", "the same, with the symmetric part of the tangent: conjugate residual"},
    {"lagged", "elastic within the solve, sand yields afterwards: cohesion that grows with the step"},
    {"unilateral", "an energy without tension within the solve, sand yields afterwards"},
};

constexpr Choice kPreconditioners[] = {
    {"none", "nothing"},
    {"mass", "one over the mass of each node"},
};

void describe_implicit(Fields& fields, ImplicitSettings& implicit) {
  fields.choice("mode", implicit.mode, kTangentModeChoices, "how sand answers within the solve");
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
                 {.meaning = "that the solver of mode exact keeps; two vectors of nodes each",
                  .low = 1.0,
                  .high = 1000.0});
  bool given = false;
  fields.object("unilateral", given, false, "where the energy of mode unilateral lets tension go",
                [&](Fields& f) {
                  f.number("begin", implicit.unilateral.begin,
                           {.meaning = "strain, tr(eps)/sqrt(3), below which all of the stress acts"});
                  f.number("width", implicit.unilateral.width,
                           {.meaning = "strain over which the stress fades", .low = 0.0, .low_open = true});
                  f.number("bend", implicit.unilateral.bend,
                           {.meaning = "how much sooner it fades under shear", .low = 0.0});
                });
}

void describe_time(Fields& fields, TimeDescription& time) {
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
}

/// One alternative per material of the list; choosing one makes it the material's law. What yields may also
/// have the keys of the effects that act on sand.
template <std::size_t... k>
void describe_law(Fields& fields, Scene& scene, MaterialDescription& material, std::index_sequence<k...>) {
  const auto describe_as = [&]<std::size_t chosen>(std::integral_constant<std::size_t, chosen>, Fields& f) {
    MaterialParameters& law = material.parameters;
    if (law.index() != chosen) law.emplace<chosen>();
    std::get<chosen>(law).describe(f);
    if constexpr (std::variant_alternative_t<chosen, MaterialParameters>::kYields) {
      for_each_effect(scene.effects, [&](auto& effect) { effect.declare_in_sand(f, material.name); });
    }
  };
  const Alternative laws[] = {{std::variant_alternative_t<k, MaterialParameters>::kName,
                               std::variant_alternative_t<k, MaterialParameters>::kMeaning, [&](Fields& f) {
                                 describe_as(std::integral_constant<std::size_t, k>(), f);
                               }}...};
  int chosen = material.law();
  fields.alternatives(chosen, laws, "the law of the material");
}

void describe_material(Fields& fields, Scene& scene, MaterialDescription& material) {
  describe_law(fields, scene, material, std::make_index_sequence<std::variant_size_v<MaterialParameters>>());
}

void describe_body(Fields& fields, BodyDescription& body) {
  fields.text("name", body.name, "what messages and overrides call it; no two bodies share a name", true);
  fields.text("material", body.material, "name of one of the materials", true);
  bool present = false;
  fields.object("shape", present, true, "the solid to fill", [&](Fields& f) { describe(f, body.shape); });
  fields.integer("particles_per_cell", body.particles_per_cell,
                 {.meaning = "particles in a full cell", .low = 1.0, .high = 512.0});
  fields.choice("sampling", body.sampling, kSamplings, "how particles are placed");
  fields.integer("seed", body.seed, {.meaning = "of the random numbers that place particles", .low = 0.0});
  fields.vector("velocity", body.velocity, {.unit = "m/s", .meaning = "at the start"});
  fields.vector("angular_velocity", body.angular_velocity,
                {.unit = "rad/s", .meaning = "at the start, about the centre of the shape's bounds"});
}

/// The size of voxels; a grid of much finer ones would say no more, and take all memory.
void describe_voxel(Fields& fields, double& voxel, double spacing, const char* meaning) {
  fields.number("voxel", voxel, {.unit = "m", .meaning = meaning, .low = 0.0});
  fields.check(voxel == 0.0 || voxel >= kFinestVoxel * spacing, "voxel",
               "must be at least a sixteenth of grid.spacing, " + number_text(kFinestVoxel * spacing) + " m");
}

void describe_surface(Fields& fields, SurfaceDescription& surface, double spacing) {
  describe_voxel(fields, surface.voxel, spacing,
                 "edge of a voxel, at most grid.spacing; 0: half of grid.spacing");
  fields.check(
      surface.voxel <= spacing, "voxel",
      "must be at most grid.spacing, " + number_text(spacing) + " m: particles fall through coarser ones");
  fields.number("radius", surface.radius,
                {.unit = "spacings",
                 .meaning = "gaps that a ball of this radius does not fit into are closed",
                 .low = 0.5,
                 .high = 4.0});
  fields.integer(
      "smoothing", surface.smoothing,
      {.meaning = "times that the surface is averaged over its neighbours", .low = 0.0, .high = 100.0});
}

/// Whether every set keeps a channel: an effect that adds it for all adds it for any.
bool all_keep(const Scene& scene, const std::string& channel) {
  bool kept = false;
  for_each_effect(scene.effects, [&](const auto& effect) {
    for (const Channel& each : effect.channels(SetDescription{})) kept = kept || each.name == channel;
  });
  return kept;
}

void describe_output(Fields& fields, OutputDescription& output, double spacing, bool ages) {
  fields.flag("vdb", output.vdb, "points as NAME.points.####.vdb");
  fields.flag("ply", output.ply, "points as PLY");
  fields.flag("vtp", output.vtp, "points as VTK polygonal data");
  fields.choices("attributes", output.attributes, kAttributes, "what points carry beside P, v, id and pscale");
  const auto& wanted = output.attributes;
  fields.check(ages || std::find(wanted.begin(), wanted.end(), OutputAttribute::kAge) == wanted.end(),
               "attributes",
               "\"age\" needs particles that remember when they began: add \"age\": {} to the scene");
  fields.object("surface", output.surface.given, false,
                "the surface of the material, a level set, as NAME.surface.####.vdb",
                [&](Fields& f) { describe_surface(f, output.surface, spacing); });
  fields.object(
      "fog", output.fog.given, false, "density and velocity of the material on voxels, as NAME.fog.####.vdb",
      [&](Fields& f) { describe_voxel(f, output.fog.voxel, spacing, "edge of a voxel; 0: grid.spacing"); });
  fields.flag("checkpoint", output.checkpoint, "a state to resume from per frame, the last two kept");
}

void describe_camera(Fields& fields, CameraDescription& camera) {
  fields.vector("eye", camera.eye, {.unit = "m", .meaning = "where the camera is"});
  fields.vector("target", camera.target, {.unit = "m", .meaning = "what it looks at"});
  fields.number("field_of_view", camera.field_of_view,
                {.unit = "degrees",
                 .meaning = "vertical angle of view",
                 .low = 0.0,
                 .high = 180.0,
                 .low_open = true,
                 .high_open = true});
  fields.check((camera.eye - camera.target).norm() > 0.0, "target", "must differ from \"eye\"");
}

/// Names become names of files: letters, digits, "_", "-" and ".", the first a letter or digit.
bool is_file_name(const std::string& name) {
  const auto plain = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
  };
  const auto allowed = [&](char c) { return plain(c) || c == '_' || c == '-' || c == '.'; };
  return !name.empty() && plain(name[0]) && std::all_of(name.begin(), name.end(), allowed);
}

template <class Named>
bool is_named(const std::vector<Named>& list, const std::string& name) {
  return std::any_of(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
}

template <class Named>
std::vector<std::string> names_of(const std::vector<Named>& list) {
  std::vector<std::string> names;
  for (const Named& entry : list) names.push_back(entry.name);
  return names;
}

void describe_materials(Fields& fields, Scene& scene) {
  fields.dictionary("materials", true, "the materials, by name", [&](const std::string& name, Fields& f) {
    MaterialDescription material;
    material.name = name;
    describe_material(f, scene, material);
    scene.materials.push_back(material);
  });
}

void describe_bodies(Fields& fields, Scene& scene) {
  fields.list("bodies", false, "solids filled with particles at the start", [&](Fields& f) {
    BodyDescription body;
    describe_body(f, body);
    f.check(!is_named(scene.bodies, body.name), "name",
            "\"" + body.name + "\" is taken by another body; choose another");
    const std::vector<std::string> materials = names_of(scene.materials);
    f.check(materials.empty() || is_named(scene.materials, body.material), "material",
            "no material \"" + body.material + "\"; " + did_you_mean(body.material, materials));
    if (scene.grid.plane_strain) {
      const int flat = *scene.grid.plane_strain;
      Vec3 turns = body.angular_velocity;
      turns[flat] = 0.0;
      f.check(body.velocity[flat] == 0.0, "velocity", "must be zero along the flat axis (plane_strain)");
      f.check(turns.norm() == 0.0, "angular_velocity", "must be about the flat axis (plane_strain)");
    }
    scene.bodies.push_back(body);
  });
}

/// Down follows `up` unless the scene, or a host that filled it, says otherwise.
void turn_gravity(Scene& scene) {
  Vec3& acceleration = scene.effect<Gravity>().acceleration;
  if (scene.up == UpAxis::kZ && acceleration == Gravity{}.acceleration) acceleration = Vec3(0.0, 0.0, -9.81);
}

/// Across plane strain nothing moves, solids neither.
bool stays_in_plane(const MotionDescription& motion, int flat_axis) {
  return std::all_of(motion.keys.begin(), motion.keys.end(), [flat_axis](const MotionKey& key) {
    Vec3 across = key.rotation_axis.normalized();
    across[flat_axis] = 0.0;
    return key.translation[flat_axis] == 0.0 && (key.rotation_angle == 0.0 || across.norm() < 1e-9);
  });
}

}  // namespace

void describe(Fields& fields, Scene& scene) {
  std::int64_t format = 1;
  fields.integer("repose", format,
                 {.meaning = "version of the scene format", .low = 1.0, .high = 1.0, .required = true});
  std::string schema;
  fields.text("$schema", schema,
              "where editors find the JSON Schema of scenes; the reader does not look at it");
  fields.text("name", scene.name, "of the scene and of the files that a run writes", true);
  fields.check(
      is_file_name(scene.name), "name",
      "must do as the name of a file: letters, digits, \"_\", \"-\" and \".\", the first a letter or digit");
  fields.choice("up", scene.up, kUpAxes, "the axis that points up; gravity follows it");
  fields.parameters("parameters",
                    "named numbers for expressions; they may use each other, pi and deg (pi / 180)");

  bool given = false;
  fields.object("grid", given, true, "the lattice", [&](Fields& f) { describe_grid(f, scene.grid); });
  fields.object("time", given, false, "frames and time steps",
                [&](Fields& f) { describe_time(f, scene.time); });
  fields.object("implicit", given, false, "how implicit steps are solved for (time.integrator)",
                [&](Fields& f) { describe_implicit(f, scene.implicit); });
  describe_materials(fields, scene);
  describe_bodies(fields, scene);
  turn_gravity(scene);
  const std::vector<std::string> materials = names_of(scene.materials);
  for_each_effect(scene.effects, [&](auto& effect) {
    effect.know_materials(materials);
    effect.declare(fields);
  });
  for (const Inlet& inlet : inlets(scene)) {
    fields.check(
        !is_named(scene.bodies, inlet.name), inlet.key.c_str(),
        "\"" + inlet.name + "\" is the name of a body; choose another, for both are sets of particles");
  }
  fields.check(!scene.bodies.empty() || !inlets(scene).empty(), "bodies",
               "must hold at least one object, unless there is one in \"emitters\"");
  fields.check(
      !scene.grid.plane_strain || scene.effect<Gravity>().acceleration[*scene.grid.plane_strain] == 0.0,
      "gravity", "acceleration must be zero along the flat axis (plane_strain)");
  for (const Collider& collider : scene.effect<Colliders>().list) {
    fields.check(
        !scene.grid.plane_strain || stays_in_plane(collider.motion, *scene.grid.plane_strain), "colliders",
        "motion of \"" + collider.name + "\" must stay in the plane of plane_strain and turn about its axis");
  }
  fields.object("output", given, false, "what is written per frame", [&](Fields& f) {
    describe_output(f, scene.output, scene.grid.spacing, all_keep(scene, kBirth));
  });
  fields.object("camera", scene.camera.given, false, "how a film looks at the run; without it, at the material",
                [&](Fields& f) { describe_camera(f, scene.camera); });
}

std::vector<Inlet> inlets(const Scene& scene) {
  std::vector<Inlet> all;
  for_each_effect(scene.effects, [&](const auto& effect) {
    for (Inlet& inlet : effect.inlets()) all.push_back(std::move(inlet));
  });
  return all;
}

std::vector<std::string> outlets(const Scene& scene) {
  std::vector<std::string> all;
  for_each_effect(scene.effects, [&](const auto& effect) {
    for (std::string& name : effect.outlets()) all.push_back(std::move(name));
  });
  return all;
}

}  // namespace repose
