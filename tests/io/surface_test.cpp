// Repose: surface and fog as OpenVDB reads them back: they enclose the volume and hold the mass of what they
// show.
#include <gtest/gtest.h>
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <optional>
#include <utility>

#include "engine/geometry/seeding.h"
#include "engine/geometry/solids.h"
#include "engine/io/surface.h"
#include "tests/file_bytes.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

constexpr double kSpacing = 0.02;

/// A folder that vanishes with the test.
class VolumeFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("repose_volumes_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }

  fs::path folder_;
};

/// Particles as a simulation would hand them out.
PointCloud cloud_of(const Shape& shape, const SeedOptions& options, double density = 1600.0) {
  const auto seeds = seed_shape(shape, options);
  EXPECT_TRUE(seeds) << seeds.error().text();
  PointCloud points;
  points.spacing = options.spacing;
  const double radius = std::cbrt(3.0 / (4.0 * std::numbers::pi) * 0.5 * seeds->particle_volume);
  for (std::size_t p = 0; p < seeds->cell.size(); ++p) {
    std::array<double, 3> x{};
    for (std::size_t k = 0; k < 3; ++k)
      x[k] = (seeds->cell[p][k] + double(seeds->offset[p][k])) * options.spacing;
    points.position.push_back(x);
    points.velocity.push_back({1.0f, -2.0f, static_cast<float>(x[0])});
    points.id.push_back(static_cast<std::uint32_t>(p));
    points.radius.push_back(static_cast<float>(radius));
    points.mass.push_back(static_cast<float>(density * seeds->particle_volume));
  }
  return points;
}

SurfaceOptions surface_options() {
  return {.voxel = 0.5 * kSpacing, .radius = kSpacing, .smoothing = 2, .flat_axis = {}, .threads = 2};
}

/// A grid of a file, read by OpenVDB itself.
template <class Grid>
typename Grid::Ptr grid_of(const std::string& path, const std::string& name) {
  openvdb::initialize();
  std::ifstream file(path, std::ios::binary);
  openvdb::io::Stream archive(file, false);
  for (const auto& grid : *archive.getGrids()) {
    if (grid->getName() == name) return openvdb::gridPtrCast<Grid>(grid);
  }
  ADD_FAILURE() << "no grid " << name;
  return Grid::create();
}

/// What a level set encloses, m^3: a voxel counts by the share that a plane at its distance cuts off.
double volume_of(const openvdb::FloatGrid& grid) {
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const auto accessor = grid.getConstAccessor();
  const double h = grid.voxelSize()[0];
  double voxels = 0.0;
  for (auto at = box.begin(); at; ++at)
    voxels += std::clamp(0.5 - double(accessor.getValue(*at)) / h, 0.0, 1.0);
  return voxels * h * h * h;
}

double value_at(const openvdb::FloatGrid& grid, const std::array<double, 3>& x) {
  return grid.tree().getValue(
      openvdb::Coord::round(grid.transform().worldToIndex(openvdb::Vec3d(x[0], x[1], x[2]))));
}

double surface_volume(const PointCloud& points, const SurfaceOptions& options, const std::string& path) {
  const Result<void> done = write_surface(points, options, path);
  EXPECT_TRUE(done) << done.error().text();
  return volume_of(*grid_of<openvdb::FloatGrid>(path, "surface"));
}

void expect_usage(const Result<void>& done, const std::string& path) {
  ASSERT_FALSE(done);
  EXPECT_EQ(done.error().kind, ErrorKind::kUsage) << done.error().text();
  EXPECT_EQ(done.error().where, path);
}

/// The middle of each of the 8 parts of a cell.
void put_on_lattice(PointCloud& points) {
  const double half = 0.5 * kSpacing;
  for (auto& x : points.position) {
    for (double& c : x) c = (std::floor(c / half) + 0.5) * half;
  }
}

const BoxShape kBox({0, 0, 0}, {10 * kSpacing, 10 * kSpacing, 10 * kSpacing});

TEST_F(VolumeFiles, SurfaceOfAFilledBox_EnclosesItsVolume) {
  const BoxShape box({0, 0, 0}, {20 * kSpacing, 20 * kSpacing, 20 * kSpacing});
  PointCloud lattice = cloud_of(box, {kSpacing, 8, Sampling::kJittered, 1, {}});
  put_on_lattice(lattice);
  const PointCloud jittered = cloud_of(box, {kSpacing, 8, Sampling::kJittered, 1, {}}),
                   few = cloud_of(box, {kSpacing, 4, Sampling::kJittered, 1, {}}),
                   disks = cloud_of(box, {kSpacing, 8, Sampling::kPoissonDisk, 1, {}});
  for (const auto& [name, points] :
       {std::pair{"lattice", &std::as_const(lattice)}, std::pair{"jittered", &jittered},
        std::pair{"jittered, 4", &few}, std::pair{"disks", &disks}}) {
    const double share = surface_volume(*points, surface_options(), path("a.vdb")) / box.volume();
    std::printf("surface of %s particles: %.4f of the box\n", name, share);
    EXPECT_NEAR(share, 1.0, 0.04) << name;
  }
}

TEST_F(VolumeFiles, SurfaceOfAFilledBox_HasNoHolesAndLiesOnTheFaces) {
  const PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 3, {}});
  ASSERT_TRUE(write_surface(points, surface_options(), path("a.vdb")));
  const auto grid = grid_of<openvdb::FloatGrid>(path("a.vdb"), "surface");
  EXPECT_EQ(grid->getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_FLOAT_EQ(grid->background(), static_cast<float>(1.5 * kSpacing));
  double worst = 0.0;
  for (auto at = openvdb::CoordBBox(openvdb::Coord(-8), openvdb::Coord(28)).begin(); at; ++at) {
    const openvdb::Vec3d x = grid->indexToWorld(*at);
    const double distance = kBox.signed_distance(Vec3(x[0], x[1], x[2]));
    const double here = grid->tree().getValue(*at);
    if (std::abs(distance) > 0.6 * kSpacing) {
      EXPECT_EQ(here < 0.0, distance < 0.0) << distance;
    }
    if (std::abs(here) < kSpacing) worst = std::max(worst, std::abs(here - distance));
  }
  EXPECT_LT(worst, 0.8 * kSpacing) << "edges of the box are rounded";
}

TEST_F(VolumeFiles, SurfaceOfABoxWithAGap_LeavesTheGapOpen) {
  const auto with_gap = [](double width) {
    PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}}), rest;
    rest.spacing = kSpacing;
    for (std::size_t p = 0; p < points.size(); ++p) {
      if (std::abs(points.position[p][0] - 5 * kSpacing) < 0.5 * width) continue;
      rest.position.push_back(points.position[p]);
      rest.velocity.push_back(points.velocity[p]);
      rest.id.push_back(points.id[p]);
      rest.radius.push_back(points.radius[p]);
    }
    return rest;
  };
  const std::array<double, 3> middle{5 * kSpacing, 5 * kSpacing, 5 * kSpacing};
  const auto inside = [&](double width) {
    EXPECT_TRUE(write_surface(with_gap(width), surface_options(), path("a.vdb")));
    return value_at(*grid_of<openvdb::FloatGrid>(path("a.vdb"), "surface"), middle) < 0.0;
  };
  EXPECT_FALSE(inside(4 * kSpacing)) << "twice the diameter of the ball";
  EXPECT_TRUE(inside(1 * kSpacing)) << "half of it";
}

TEST_F(VolumeFiles, SurfaceOfAShell_CountsItsCavityAsInside) {
  PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}}), shell;
  shell.spacing = kSpacing;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const auto& x = points.position[p];
    if (kBox.signed_distance(Vec3(x[0], x[1], x[2])) < -3 * kSpacing) continue;
    shell.position.push_back(x);
    shell.velocity.push_back(points.velocity[p]);
    shell.id.push_back(points.id[p]);
    shell.radius.push_back(points.radius[p]);
  }
  EXPECT_NEAR(surface_volume(shell, surface_options(), path("a.vdb")) / kBox.volume(), 1.0, 0.04);
}

TEST_F(VolumeFiles, SurfaceFarAway_EnclosesTheSame) {
  PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}});
  const double near = surface_volume(points, surface_options(), path("a.vdb"));
  for (auto& x : points.position) x = {x[0] + 1.0e4, x[1] - 1.0e4, x[2]};
  EXPECT_NEAR(surface_volume(points, surface_options(), path("a.vdb")) / near, 1.0, 1e-4);
  EXPECT_LT(value_at(*grid_of<openvdb::FloatGrid>(path("a.vdb"), "surface"), {1.0e4 + 0.1, -1.0e4 + 0.1, 0.1}),
            0);
}

TEST_F(VolumeFiles, SurfaceInPlaneStrain_IsALayerAboutOneSpacingThick) {
  const BoxShape slab({0, 0, -1}, {20 * kSpacing, 20 * kSpacing, 1});
  const PointCloud points = cloud_of(slab, {kSpacing, 4, Sampling::kJittered, 1, 2});
  const double area = 20 * 20 * kSpacing * kSpacing;
  const auto measure = [&](std::optional<int> flat_axis) {
    SurfaceOptions options = surface_options();
    options.flat_axis = flat_axis;
    const double volume = surface_volume(points, options, path("a.vdb"));
    // The voxels of the plane in which the particles lie.
    const auto grid = grid_of<openvdb::FloatGrid>(path("a.vdb"), "surface");
    const double h = options.voxel;
    double section = 0.0;
    for (auto at = openvdb::CoordBBox({-8, -8, 1}, {48, 48, 1}).begin(); at; ++at) {
      section += h * h * std::clamp(0.5 - double(grid->tree().getValue(*at)) / h, 0.0, 1.0);
    }
    return std::pair(section / area, volume / (area * kSpacing));
  };
  const auto [section, layer] = measure(2);
  std::printf("surface in plane strain: %.4f of the section, %.4f of the layer\n", section, layer);
  EXPECT_NEAR(section, 1.0, 0.05);
  EXPECT_NEAR(layer, 1.0, 0.15);
  EXPECT_LT(measure({}).second, 0.7) << "control: balls alone";
}

TEST_F(VolumeFiles, SameCloudTwice_SameBytesWhateverTheOrder) {
  PointCloud points = cloud_of(kBox, {kSpacing, 4, Sampling::kJittered, 1, {}});
  ASSERT_TRUE(write_surface(points, surface_options(), path("a.vdb")));
  ASSERT_TRUE(write_fog(points, {kSpacing, {}}, path("b.vdb")));
  const std::string surface = bytes_of(path("a.vdb")), fog = bytes_of(path("b.vdb"));
  EXPECT_GT(fog.size(), 1000u);
  ASSERT_TRUE(write_surface(points, surface_options(), path("a.vdb")));
  ASSERT_TRUE(write_fog(points, {kSpacing, {}}, path("b.vdb")));
  EXPECT_EQ(bytes_of(path("a.vdb")), surface);
  EXPECT_EQ(bytes_of(path("b.vdb")), fog);
  std::reverse(points.position.begin(), points.position.end());
  ASSERT_TRUE(write_surface(points, surface_options(), path("a.vdb")));
  EXPECT_EQ(bytes_of(path("a.vdb")), surface) << "the nearest ball does not depend on which came first";
  points.position[0][0] += 0.1 * kSpacing;
  ASSERT_TRUE(write_surface(points, surface_options(), path("a.vdb")));
  EXPECT_NE(bytes_of(path("a.vdb")), surface) << "control";
}

TEST_F(VolumeFiles, Fog_HoldsTheMassAndTheMomentum) {
  const PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}});
  double mass = 0.0, momentum = 0.0;
  for (std::size_t p = 0; p < points.size(); ++p) {
    mass += points.mass[p];
    momentum += double(points.mass[p]) * points.velocity[p][2];
  }
  for (const double voxel : {0.5, 1.0, 3.0}) {
    ASSERT_TRUE(write_fog(points, {voxel * kSpacing, {}}, path("a.vdb")));
    const auto density = grid_of<openvdb::FloatGrid>(path("a.vdb"), "density");
    const auto velocity = grid_of<openvdb::Vec3SGrid>(path("a.vdb"), "v");
    const double volume = density->voxelSize().product();
    double held = 0.0, moved = 0.0;
    for (auto value = density->cbeginValueOn(); value; ++value) {
      held += double(*value) * volume;
      moved += double(*value) * volume * velocity->tree().getValue(value.getCoord())[2];
    }
    EXPECT_NEAR(held / mass, 1.0, 1e-5) << voxel;
    EXPECT_NEAR(moved / momentum, 1.0, 1e-5) << voxel;
    EXPECT_EQ(density->activeVoxelCount(), velocity->activeVoxelCount());
  }
}

TEST_F(VolumeFiles, FogInsideABox_HasItsDensityAndVelocity) {
  const PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}}, 1600.0);
  ASSERT_TRUE(write_fog(points, {kSpacing, {}}, path("a.vdb")));
  const auto density = grid_of<openvdb::FloatGrid>(path("a.vdb"), "density");
  const auto velocity = grid_of<openvdb::Vec3SGrid>(path("a.vdb"), "v");
  double least = 1e9, most = 0.0;
  for (auto at = openvdb::CoordBBox(openvdb::Coord(2), openvdb::Coord(8)).begin(); at; ++at) {
    least = std::min(least, double(density->tree().getValue(*at)));
    most = std::max(most, double(density->tree().getValue(*at)));
    const openvdb::Vec3s v = velocity->tree().getValue(*at);
    EXPECT_NEAR(v[2], (*at)[0] * kSpacing, 0.3 * kSpacing);  // the field is v_z = x
    EXPECT_NEAR(v[1], -2.0, 1e-5);
  }
  EXPECT_GT(least, 0.8 * 1600.0);
  EXPECT_LT(most, 1.2 * 1600.0);
}

TEST_F(VolumeFiles, FogInPlaneStrain_IsOneVoxelThick) {
  const BoxShape slab({0, -1, 0}, {20 * kSpacing, 1, 20 * kSpacing});
  const PointCloud points = cloud_of(slab, {kSpacing, 4, Sampling::kJittered, 1, 1}, 1600.0);
  double mass = 0.0;
  for (const float m : points.mass) mass += m;
  ASSERT_TRUE(write_fog(points, {2 * kSpacing, 1}, path("a.vdb")));
  const auto density = grid_of<openvdb::FloatGrid>(path("a.vdb"), "density");
  EXPECT_EQ(density->evalActiveVoxelDim()[1], 1);
  EXPECT_DOUBLE_EQ(density->voxelSize()[1], kSpacing);
  double held = 0.0;
  for (auto value = density->cbeginValueOn(); value; ++value)
    held += double(*value) * density->voxelSize().product();
  EXPECT_NEAR(held / mass, 1.0, 1e-5);
  EXPECT_NEAR(value_at(*density, {5 * kSpacing, 0.5 * kSpacing, 5 * kSpacing}), 1600.0, 160.0);
}

TEST_F(VolumeFiles, EmptyCloud_GridsWithoutVoxels) {
  PointCloud none;
  none.spacing = kSpacing;
  for (const std::optional<int> flat : {std::optional<int>(), std::optional<int>(0)}) {
    ASSERT_TRUE(write_surface(none, {0.01, kSpacing, 2, flat}, path("a.vdb")));
    ASSERT_TRUE(write_fog(none, {0.01, flat}, path("b.vdb")));
    const auto surface = read_grid_figures(path("a.vdb")), fog = read_grid_figures(path("b.vdb"));
    ASSERT_TRUE(surface) << surface.error().text();
    ASSERT_TRUE(fog) << fog.error().text();
    ASSERT_EQ(surface->size(), 1u);
    ASSERT_EQ(fog->size(), 2u);
    EXPECT_EQ((*surface)[0].active, 0u);
    EXPECT_EQ((*fog)[0].active, 0u);
    EXPECT_GT(grid_of<openvdb::FloatGrid>(path("a.vdb"), "surface")->background(), 0.0f) << "all is outside";
  }
}

TEST_F(VolumeFiles, Figures_TellNamesVoxelsAndBounds) {
  const PointCloud points = cloud_of(kBox, {kSpacing, 8, Sampling::kJittered, 1, {}});
  ASSERT_TRUE(write_fog(points, {kSpacing, {}}, path("a.vdb")));
  const auto figures = read_grid_figures(path("a.vdb"));
  ASSERT_TRUE(figures) << figures.error().text();
  ASSERT_EQ(figures->size(), 2u);
  const GridFigures &density = (*figures)[0], &velocity = (*figures)[1];
  EXPECT_EQ(density.name, "density");
  EXPECT_EQ(velocity.name, "v");
  EXPECT_EQ(density.type, "float");
  EXPECT_FALSE(density.points);
  EXPECT_DOUBLE_EQ(density.voxel[2], kSpacing);
  EXPECT_NEAR(density.lower[0], -1.5 * kSpacing, 1e-9);
  EXPECT_NEAR(density.upper[0], 11.5 * kSpacing, 1e-9);
  EXPECT_EQ(density.active, 13u * 13u * 13u);
  EXPECT_GE(density.least, 0.0);
  EXPECT_NEAR(velocity.most, std::hypot(1.0, 2.0, 0.2), 0.01);
  ASSERT_TRUE(write_vdb_points(points, path("p.vdb")));
  EXPECT_TRUE(read_grid_figures(path("p.vdb"))->at(0).points);
  EXPECT_EQ(read_grid_figures(path("none.vdb")).error().kind, ErrorKind::kNoInput);
  std::string bytes = bytes_of(path("a.vdb"));
  bytes[bytes.size() / 2] ^= 1;
  std::ofstream(path("bad.vdb"), std::ios::binary) << bytes;
  EXPECT_EQ(read_grid_figures(path("bad.vdb")).error().kind, ErrorKind::kIo);
}

TEST_F(VolumeFiles, OptionsOutOfRange_Refused) {
  PointCloud points = cloud_of(BoxShape({0, 0, 0}, {0.1, 0.1, 0.1}), {kSpacing, 8, Sampling::kJittered, 1, {}});
  const std::string file = path("a.vdb");
  for (const double voxel : {0.0, -1.0, std::nan(""), kSpacing / 17, 1.1 * kSpacing}) {
    SurfaceOptions options = surface_options();
    options.voxel = voxel;
    expect_usage(write_surface(points, options, file), file);
  }
  for (const double radius : {0.0, 0.4 * kSpacing, 4.1 * kSpacing, std::nan("")}) {
    SurfaceOptions options = surface_options();
    options.radius = radius;
    expect_usage(write_surface(points, options, file), file);
  }
  expect_usage(write_fog(points, {kSpacing / 17, {}}, file), file);
  points.mass.pop_back();
  expect_usage(write_fog(points, {kSpacing, {}}, file), file);
  EXPECT_EQ(write_surface(points, surface_options(), path("no/a.vdb")).error().kind, ErrorKind::kCannotCreate);
  EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace repose
