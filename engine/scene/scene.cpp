// Repose: the keys of a scene file, in the order of its reference. Conditions that one value can state are
// ranges; those across several keys are checks at the key that a user would change.
#include "engine/scene/scene.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/wording.h"
#include "engine/scene/attributes.h"
#include "engine/scene/numerics.h"

namespace repose {
namespace {

constexpr Choice kUpAxes[] = {{"y", "y is up"}, {"z", "z is up"}};
constexpr Choice kSamplings[] = {
    {"jittered", "each cell is cut into equal parts with one particle at random in each"},
    {"poisson_disk", "no two particles closer than a radius, Bridson 2007"}};
constexpr double kFinestVoxel = 1.0 / 16.0;  // of files, spacings

void describe_grains(Fields& fields, const Scene& scene, MaterialDescription& material) {
  const bool known = grains_of(scene, material).has_value();
  double diameter = std::numeric_limits<double>::quiet_NaN();
  fields.number("grain_diameter", diameter,
                {.unit = "m",
                 .meaning = "d of the attribute \"inertial_number\", without rate_friction, which has its own",
                 .low = 0.0,
                 .low_open = true});
  fields.number("grain_density", material.grain_density,
                {.unit = "kg/m^3",
                 .meaning = "rho_s of the same, of the grains without pores",
                 .low = 0.0,
                 .low_open = true});
  if (!std::isnan(diameter)) material.grain_diameter = diameter;
  fields.check(!known || !material.grain_diameter, "grain_diameter",
               "rate_friction.grain_diameter is that of this material already; leave one of them out");
}

/// One alternative per material of the list; choosing one makes it the material's law. What has a cone may also
/// have the keys of the effects that act on it.
template <std::size_t... k>
void describe_law(Fields& fields, Scene& scene, MaterialDescription& material, std::index_sequence<k...>) {
  const auto describe_as = [&]<std::size_t chosen>(std::integral_constant<std::size_t, chosen>, Fields& f) {
    MaterialParameters& law = material.parameters;
    if (law.index() != chosen) law.emplace<chosen>();
    std::get<chosen>(law).describe(f);
    if constexpr (std::variant_alternative_t<chosen, MaterialParameters>::kHasCone) {
      for_each_effect(scene.effects, [&](auto& effect) { effect.declare_in_cone(f, material.name); });
      describe_grains(f, scene, material);
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

void describe_output(Fields& fields, Scene& scene) {
  OutputDescription& output = scene.output;
  const double spacing = scene.grid.spacing;
  fields.flag("vdb", output.vdb, "points as NAME.points.####.vdb");
  fields.flag("ply", output.ply, "points as PLY");
  fields.flag("vtp", output.vtp, "points as VTK polygonal data");
  fields.choices("attributes", output.attributes, kOutputAttributes,
                 "what points carry beside P, v, id and pscale");
  for (const OutputAttribute attribute : output.attributes) {
    const std::string lacks = lacking(scene, attribute);
    fields.check(lacks.empty(), "attributes", lacks);
  }
  fields.feature("surface", output.surface.given,
                 "the surface of the material, a level set, as NAME.surface.####.vdb",
                 [&](Fields& f) { describe_surface(f, output.surface, spacing); });
  fields.feature(
      "fog", output.fog.given, "density and velocity of the material on voxels, as NAME.fog.####.vdb",
      [&](Fields& f) { describe_voxel(f, output.fog.voxel, spacing, "edge of a voxel; 0: grid.spacing"); });
  fields.flag("checkpoint", output.checkpoint, "a state to resume from per frame, the last two kept");
  fields.flag("steps", output.steps, "figures of each step in run.json, of the first 5000 (docs/output.md)");
  fields.flag("residuals", output.residuals, "with \"steps\": what was left over in each Newton iteration");
  fields.check(output.steps || !output.residuals, "residuals",
               "are part of the figures of each step: add \"steps\": true");
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
  constexpr std::size_t kMost = 200;  // a folder takes 255, and a frame's kind, number and temporary follow it
  return !name.empty() && name.size() <= kMost && plain(name[0]) &&
         std::all_of(name.begin(), name.end(), allowed);
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

/// Two sets of particles may not share a name; and without any there is nothing to simulate.
void check_sets(Fields& fields, const Scene& scene) {
  for (const Inlet& inlet : inlets(scene)) {
    fields.check(
        !is_named(scene.bodies, inlet.name), inlet.key.c_str(),
        "\"" + inlet.name + "\" is the name of a body; choose another, for both are sets of particles");
  }
  fields.check(!scene.bodies.empty() || !inlets(scene).empty(), "bodies",
               "must hold at least one object, unless there is one in \"emitters\"");
}

/// No two numbers of a particle have one name, whoever keeps them.
void check_channels(Fields& fields, const Scene& scene) {
  for (const MaterialDescription& material : scene.materials) {
    std::vector<std::string> names = std::visit(
        [](const auto& law) { return std::vector<std::string>(law.kChannels.begin(), law.kChannels.end()); },
        material.parameters);
    for_each_effect(scene.effects, [&](const auto& effect) {
      for (const Channel& channel : effect.channels({material.name, material.name, material.parameters})) {
        const bool taken = std::find(names.begin(), names.end(), channel.name) != names.end();
        fields.check(
            !taken, "channels",
            "\"" + channel.name + "\" is what an effect or a law calls a number of its own; choose another");
        names.push_back(channel.name);
      }
    });
  }
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
  fields.check(is_file_name(scene.name), "name",
               "must do as the name of a file: at most 200 letters, digits, \"_\", \"-\" and \".\", the first "
               "a letter or "
               "digit");
  fields.choice("up", scene.up, kUpAxes, "the axis that points up; gravity follows it");
  fields.parameters("parameters",
                    "named numbers for expressions; they may use each other, pi and deg (pi / 180)");

  bool given = false;
  fields.object("grid", given, true, "the lattice", [&](Fields& f) { describe(f, scene.grid); });
  fields.object("time", given, false, "frames and time steps", [&](Fields& f) { describe(f, scene.time); });
  fields.object("implicit", given, false, "how implicit steps are solved for (time.integrator)",
                [&](Fields& f) { describe(f, scene.implicit); });
  describe_materials(fields, scene);
  describe_bodies(fields, scene);
  const SceneOutline outline{names_of(scene.materials), scene.grid.plane_strain.value_or(-1),
                             scene.up == UpAxis::kZ};
  for_each_effect(scene.effects, [&](auto& effect) { effect.declare(fields, outline); });
  check_sets(fields, scene);
  check_channels(fields, scene);
  fields.object("output", given, false, "what is written per frame",
                [&](Fields& f) { describe_output(f, scene); });
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
