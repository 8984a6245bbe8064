// Repose: scenes that are right: every key arrives at its member, expressions and overrides do what they say.
#include "engine/reading/reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <locale>
#include <numbers>

#include "engine/reading/identity.h"

namespace repose {
namespace {

const char* law_name(const MaterialDescription& material) {
  return std::visit([](const auto& parameters) { return std::decay_t<decltype(parameters)>::kName; },
                    material.parameters);
}

constexpr const char* kWhole = R"({
  // every section, no value at its default
  "repose": 1, "name": "hourglass-1", "up": "z",
  "parameters": {"b": "= 2 * a", "a": 0.25, "turn": "= 90 * deg"},
  "grid": {"spacing": 0.02, "precision": "double", "stencil": "cubic", "transfer": "rpic",
           "velocity_loss": 3, "kept_velocity": 0.5, "kept_stretching": 0.25,
           "origin_cells": [8, -16, 0], "plane_strain": "x",
           "periodic": {"y": {"lower": -0.32, "length": 0.64}}},
  "time": {"frames": 7, "frames_per_second": 30, "max_step": 0.001, "cfl": 0.1, "sound": 0.2,
           "isolated": 0.3, "strain": 0.4},
  "materials": {
    "sand": {"type": "drucker_prager", "density": 1600, "youngs_modulus": 2e5, "poisson_ratio": 0.2,
             "friction_angle": 30, "cone_matching": "plane_strain"},
    "rubber": {"type": "elastic", "density": 900}},
  "bodies": [
    {"name": "heap", "material": "sand",
     "shape": {"type": "sphere", "center": [0, "= b", "= a"], "radius": "= a / 2"},
     "particles_per_cell": 4, "sampling": "poisson_disk", "seed": 5, "velocity": [0, 1, 2],
     "angular_velocity": ["= turn", 0, 0]},
    {"name": "block", "material": "rubber", "shape": {"type": "box", "lower": [0, 0, 0], "upper": [1, 1, 2]}}],
  "colliders": [{"name": "glass", "shape": {"type": "revolution", "profile": [[0, 0], [1, "= b"], [0, 1]]},
                 "hollow": true, "contact": "slip", "friction": 0.3}],
  "gravity": {"ramp": 0.1},
  "volume_correction": {},
  "output": {"vdb": false, "ply": true, "vtp": true, "checkpoint": false,
             "attributes": ["speed", "stress", "channels"], "fog": {"voxel": 0.04},
             "surface": {"voxel": 0.01, "radius": 1.5, "smoothing": 0}},
  "camera": {"eye": [3, 2, 1], "target": [0, 0, 1], "field_of_view": 50}
})";

constexpr const char* kSmall = R"({"repose": 1, "name": "small", "grid": {"spacing": 0.1},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "heap", "material": "sand", "shape": {"type": "sphere", "radius": 1}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}}]})";

Scene read(const std::string& text, std::vector<std::string> overrides = {}) {
  const Result<Scene> scene = read_scene_text(text, "s.json", ".", {.overrides = std::move(overrides)});
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? *scene : Scene{};
}

TEST(SceneReader, WholeScene_SectionsArrive) {
  const Scene scene = read(kWhole);
  EXPECT_EQ(scene.name, "hourglass-1");
  EXPECT_EQ(scene.up, UpAxis::kZ);
  EXPECT_EQ(scene.grid.spacing, 0.02);
  EXPECT_EQ(scene.grid.precision, Precision::kDouble);
  EXPECT_STREQ(kStencilFigures[static_cast<std::size_t>(scene.grid.stencil)].name, "cubic");
  EXPECT_STREQ(kTransferChoices[static_cast<std::size_t>(scene.grid.transfer)].name, "rpic");
  EXPECT_EQ(scene.grid.velocity_loss, 3.0);
  EXPECT_EQ(scene.grid.kept_velocity, std::optional(0.5));
  EXPECT_EQ(scene.grid.kept_stretching, 0.25);
  EXPECT_EQ(scene.grid.origin_cells, (std::array<std::int64_t, 3>{8, -16, 0}));
  EXPECT_EQ(scene.grid.plane_strain, 0);
  EXPECT_EQ(scene.grid.periodic[1].lower, -0.32);
  EXPECT_EQ(scene.grid.periodic[1].length, 0.64);
  EXPECT_EQ(scene.grid.periodic[0].length, 0.0);
  EXPECT_EQ(scene.time.frames, 7);
  EXPECT_EQ(scene.time.frames_per_second, 30.0);
  EXPECT_EQ(scene.time.max_step, 0.001);
  EXPECT_EQ(scene.time.cfl, 0.1);
  EXPECT_EQ(scene.time.sound, 0.2);
  EXPECT_EQ(scene.time.isolated, 0.3);
  EXPECT_EQ(scene.time.strain, 0.4);
  EXPECT_EQ(scene.effect<Gravity>().ramp, 0.1);
  EXPECT_TRUE(scene.effect<VolumeCorrection>().enabled);
  EXPECT_FALSE(scene.output.vdb);
  EXPECT_TRUE(scene.output.ply);
  EXPECT_TRUE(scene.output.vtp);
  EXPECT_FALSE(scene.output.checkpoint);
  using enum OutputAttribute;
  EXPECT_EQ(scene.output.attributes, (std::vector<OutputAttribute>{kSpeed, kStress, kChannels}));
  EXPECT_TRUE(scene.output.surface.given);
  EXPECT_DOUBLE_EQ(scene.output.surface.voxel, 0.01);
  EXPECT_EQ(scene.output.surface.radius, 1.5);
  EXPECT_EQ(scene.output.surface.smoothing, 0);
  EXPECT_TRUE(scene.output.fog.given);
  EXPECT_EQ(scene.output.fog.voxel, 0.04);
  EXPECT_TRUE(scene.camera.given);
  EXPECT_EQ(scene.camera.eye, Vec3(3, 2, 1));
  EXPECT_EQ(scene.camera.target, Vec3(0, 0, 1));
  EXPECT_EQ(scene.camera.field_of_view, 50.0);
}

TEST(SceneReader, EveryStencilAndTransfer_IsReadByItsName) {
  for (std::size_t k = 0; k < kStencilFigures.size(); ++k) {
    EXPECT_EQ(read(kSmall, {std::string("grid.stencil=") + kStencilFigures[k].name}).grid.stencil,
              static_cast<int>(k));
  }
  for (std::size_t k = 0; k < kTransferChoices.size(); ++k) {
    EXPECT_EQ(read(kSmall, {std::string("grid.transfer=") + kTransferChoices[k].name}).grid.transfer,
              static_cast<int>(k));
  }
}

TEST(SceneReader, WholeScene_MaterialsArrive) {
  const Scene scene = read(kWhole);
  ASSERT_EQ(scene.materials.size(), 2u);
  const MaterialDescription& rubber = scene.materials[0];
  const MaterialDescription& sand = scene.materials[1];
  EXPECT_EQ(rubber.name, "rubber");
  EXPECT_STREQ(law_name(rubber), "elastic");
  EXPECT_EQ(rubber.elasticity().density, 900.0);
  EXPECT_EQ(rubber.elasticity().youngs_modulus, HenckyParameters{}.elasticity.youngs_modulus);
  EXPECT_EQ(sand.name, "sand");
  EXPECT_STREQ(law_name(sand), "drucker_prager");
  EXPECT_EQ(sand.elasticity().density, 1600.0);
  EXPECT_EQ(sand.elasticity().youngs_modulus, 2e5);
  EXPECT_EQ(sand.elasticity().poisson_ratio, 0.2);
  EXPECT_EQ(std::get<DruckerPragerParameters>(sand.parameters).friction_angle, 30.0);
  EXPECT_EQ(std::get<DruckerPragerParameters>(sand.parameters).matching, ConeMatching::kPlaneStrain);
}

TEST(SceneReader, WholeScene_SolidsArrive) {
  const Scene scene = read(kWhole);
  ASSERT_EQ(scene.bodies.size(), 2u);
  const BodyDescription& heap = scene.bodies[0];
  EXPECT_EQ(heap.material, "sand");
  EXPECT_EQ(heap.shape.type, ShapeDescription::Type::kSphere);
  EXPECT_EQ(heap.shape.center, Vec3(0, 0.5, 0.25));
  EXPECT_EQ(heap.shape.radius, 0.125);
  EXPECT_EQ(heap.particles_per_cell, 4);
  EXPECT_EQ(heap.sampling, Sampling::kPoissonDisk);
  EXPECT_EQ(heap.seed, 5);
  EXPECT_EQ(heap.velocity, Vec3(0, 1, 2));
  EXPECT_EQ(heap.angular_velocity[1], 0.0);
  EXPECT_DOUBLE_EQ(heap.angular_velocity[0], std::numbers::pi / 2);
  ASSERT_EQ(scene.effect<Colliders>().list.size(), 1u);
  const Collider& glass = scene.effect<Colliders>().list[0];
  EXPECT_EQ(glass.name, "glass");
  EXPECT_TRUE(glass.hollow);
  EXPECT_EQ(glass.contact, Contact::kSlip);
  EXPECT_EQ(glass.friction, 0.3);
  EXPECT_EQ(glass.shape.profile, (std::vector<std::vector<double>>{{0, 0}, {1, 0.5}, {0, 1}}));
}

TEST(SceneReader, KeysLeftOut_DefaultsStay) {
  const Scene scene = read(kSmall);
  EXPECT_EQ(scene.up, UpAxis::kY);
  EXPECT_EQ(scene.effect<Gravity>().acceleration, Vec3(0, -9.81, 0));
  EXPECT_FALSE(scene.grid.plane_strain.has_value());
  EXPECT_STREQ(kStencilFigures[static_cast<std::size_t>(scene.grid.stencil)].name, "quadratic");
  EXPECT_STREQ(kTransferChoices[static_cast<std::size_t>(scene.grid.transfer)].name, "mls_apic");
  EXPECT_EQ(scene.grid.velocity_loss, 10.0);
  EXPECT_EQ(scene.grid.kept_velocity, std::nullopt);
  EXPECT_EQ(scene.grid.kept_stretching, 0.0);
  EXPECT_EQ(scene.time.frames, TimeDescription{}.frames);
  EXPECT_EQ(scene.bodies[0].particles_per_cell, 8);
  EXPECT_EQ(scene.effect<Colliders>().list[0].contact, Contact::kSeparating);
  EXPECT_FALSE(scene.effect<VolumeCorrection>().enabled);
  EXPECT_FALSE(scene.camera.given);
}

TEST(SceneReader, ZIsUp_GravityFollowsUnlessGiven) {
  EXPECT_EQ(read(kSmall, {"up=z"}).effect<Gravity>().acceleration, Vec3(0, 0, -9.81));
  EXPECT_EQ(read(kWhole).effect<Gravity>().acceleration, Vec3(0, 0, -9.81));
  EXPECT_EQ(read(kSmall, {"up=z", "gravity={\"acceleration\": [1, 0, 0]}"}).effect<Gravity>().acceleration,
            Vec3(1, 0, 0));
}

TEST(SceneReader, Expressions_FunctionsAndIntegers) {
  EXPECT_DOUBLE_EQ(read(kSmall, {"grid.spacing==sin(30 * deg) / 5"}).grid.spacing, 0.1);
  EXPECT_EQ(read(kSmall, {"bodies[0].seed== 3 > 2 ? 11 : 12"}).bodies[0].seed, 11);
  EXPECT_EQ(read(kSmall, {"bodies[0].seed=8.0"}).bodies[0].seed, 8);
}

TEST(SceneReader, Overrides_ReachByIndexAndByName) {
  const Scene scene = read(kSmall, {"bodies[0].velocity=[0, 7, 0]", "bodies[0].velocity[1]=3",
                                    "colliders.floor.friction=0.5", "name=run2"});
  EXPECT_EQ(scene.bodies[0].velocity, Vec3(0, 3, 0));
  EXPECT_EQ(scene.effect<Colliders>().list[0].friction, 0.5);
  EXPECT_EQ(scene.name, "run2");
}

TEST(SceneReader, OverrideBelowAKeyThatIsNotThere_MakesIt) {
  EXPECT_TRUE(read(kSmall, {"output.vtp=true"}).output.vtp);
  EXPECT_FALSE(read(kSmall).output.surface.given || read(kSmall).output.fog.given);
  EXPECT_EQ(read(kSmall, {"output.attributes=[\"density\"]"}).output.attributes.size(), 1u);
  EXPECT_EQ(read(kSmall, {"gravity.acceleration=[0, 0, 1]"}).effect<Gravity>().acceleration, Vec3(0, 0, 1));
}

TEST(SceneReader, OverrideWithoutAValue_LeavesTheKeyOut) {
  const Scene with = read(kSmall, {"grid.transfer=flip", "output={\"vtp\": true}"});
  EXPECT_TRUE(with.output.vtp);
  const Scene without =
      read(kSmall, {"grid.transfer=flip", "output={\"vtp\": true}", "output.vtp=", "grid.transfer="});
  EXPECT_FALSE(without.output.vtp);
  EXPECT_EQ(without.grid.transfer, read(kSmall).grid.transfer);
  // What is not there needs no removing, and nothing is made on the way.
  EXPECT_EQ(read(kSmall, {"sleep.after="}).canonical, read(kSmall).canonical);
}

TEST(SceneReader, Overrides_ChangeParameters) {
  const Scene scene = read(kWhole, {"parameters.a=1"});
  EXPECT_EQ(scene.bodies[0].shape.center, Vec3(0, 2, 1));
}

TEST(SceneReader, Canonical_EqualScenesGiveEqualText) {
  const Scene plain = read(kSmall, {"grid.spacing=0.5", "bodies[0].seed=4"});
  const Scene other = read(std::string("/* else */ ") + kSmall, {"bodies[0].seed=4", "grid.spacing==1/2"});
  EXPECT_EQ(plain.canonical, other.canonical);
  EXPECT_NE(plain.canonical, read(kSmall).canonical);
  EXPECT_EQ(plain.canonical.find('\n'), std::string::npos);
  EXPECT_EQ(read(plain.canonical).canonical, plain.canonical);
}

/// A host's locale with decimal commas, and points between thousands, without needing one installed.
struct DecimalComma : std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(SceneReader, HostWithDecimalComma_ReadsTheSame) {
  const Scene expected = read(kWhole);
  const std::locale before = std::locale::global(std::locale(std::locale::classic(), new DecimalComma));
  const Scene scene = read(kWhole);
  std::locale::global(before);
  EXPECT_EQ(scene.grid.spacing, 0.02);
  ASSERT_EQ(scene.bodies.size(), 2u);
  EXPECT_EQ(scene.bodies[0].shape.radius, 0.125);
  EXPECT_EQ(scene.canonical, expected.canonical);
}

TEST(SceneReader, File_FolderIsWhereItLies) {
  const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / "scene_reader_test.json";
  std::ofstream(path) << "\xEF\xBB\xBF" << kSmall;
  const Result<Scene> scene = read_scene(path.string());
  std::filesystem::remove(path);
  ASSERT_TRUE(scene) << scene.error().text();
  EXPECT_EQ(scene->folder, path.parent_path().string());
}

Scene read_at(Quality quality, const std::string& text, std::vector<std::string> overrides = {}) {
  const Result<Scene> scene =
      read_scene_text(text, "s.json", ".", {.overrides = std::move(overrides), .quality = quality});
  EXPECT_TRUE(scene) << scene.error().text();
  return scene ? *scene : Scene{};
}

TEST(SceneReader, DraftQuality_DoublesTheSpacingAndNothingElse) {
  const Scene draft = read_at(Quality::kDraft, kSmall);
  EXPECT_EQ(draft.grid.spacing, 0.2);
  EXPECT_EQ(draft.canonical, read(kSmall, {"grid.spacing=0.2"}).canonical);
}

TEST(SceneReader, ReferenceQuality_HalvesTheSpacingAndNothingElse) {
  const Scene reference = read_at(Quality::kReference, kSmall);
  EXPECT_EQ(reference.grid.spacing, 0.05);
  EXPECT_EQ(reference.canonical, read(kSmall, {"grid.spacing=0.05"}).canonical);
}

TEST(SceneReader, StandardQuality_IsTheSceneAsWritten) {
  EXPECT_EQ(read_at(Quality::kStandard, kWhole).canonical, read(kWhole).canonical);
}

TEST(SceneReader, QualityOfAnExpression_FollowsTheOverridesOfItsParameters) {
  std::string text = kSmall;
  text.replace(text.find("0.1"), 3, R"("= dx + 0.05")");
  text.insert(1, R"("parameters": {"dx": 0.05}, )");
  EXPECT_NEAR(read_at(Quality::kDraft, text).grid.spacing, 0.2, 1e-15);
  EXPECT_NEAR(read_at(Quality::kDraft, text, {"parameters.dx=0.1"}).grid.spacing, 0.3, 1e-15);
  EXPECT_EQ(read_at(Quality::kDraft, text, {"grid.spacing=0.1"}).grid.spacing, 0.1) << "--set wins";
}

TEST(SceneReader, QualityOfAWrongScene_LeavesTheComplaintToTheReader) {
  for (const char* grid : {R"("grid": 3)", R"("grid": {"spacing": "fine"})", R"("grid": {})", R"("up": "y")"}) {
    std::string text = kSmall;
    text.replace(text.find(R"("grid")"), std::string(R"("grid": {"spacing": 0.1})").size(), grid);
    const Result<Scene> draft =
        read_scene_text(text, "s.json", ".", {.overrides = {}, .quality = Quality::kDraft});
    const Result<Scene> standard = read_scene_text(text, "s.json", ".");
    ASSERT_FALSE(draft) << grid;
    EXPECT_EQ(draft.error().text(), standard.error().text());
  }
}

TEST(SceneReader, Identity_IsAllThatAStateDependsOn) {
  const std::string plain = read(kSmall).identity;
  EXPECT_EQ(read(kSmall, {"time.frames=7", "output.vtp=true", "camera.eye=[1,2,3]"}).identity, plain);
  EXPECT_EQ(read(kSmall, {"time={}"}).identity, plain);
  for (const char* other : {"time.cfl=0.3", "bodies.heap.seed=2", "name=other", "gravity.ramp=1"}) {
    EXPECT_NE(read(kSmall, {other}).identity, plain) << other;
  }
}

TEST(SceneReader, FirstDifference_NamesTheKeyAndBothValues) {
  const auto difference = [](const std::string& before, const std::string& now) {
    return first_difference(read(kWhole, {before}).canonical, read(kWhole, {now}).canonical);
  };
  EXPECT_EQ(difference("bodies.heap.seed=5", "bodies.heap.seed=6"), "bodies.heap.seed was 5 and is 6 now");
  EXPECT_EQ(difference("time.cfl=0.1", "time.cfl=0.30000000000000004"),
            "time.cfl was 0.1 and is 0.30000000000000004 now");
  EXPECT_EQ(difference("parameters.a=0.25", "parameters.a=0.5"), "parameters.a was 0.25 and is 0.5 now")
      << "not the radius that follows from it";
  EXPECT_EQ(difference("time.frames=7", "time.frames=8"), "");
  EXPECT_EQ(first_difference("{", kWhole), "");
}

}  // namespace
}  // namespace repose
