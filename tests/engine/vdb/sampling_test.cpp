// Repose tests: values of VDB files as the engine keeps them have the bits of OpenVDB's own samplers, whatever
// the transform of the grid, in voxels and in tiles.
#include <gtest/gtest.h>
#include <openvdb/io/File.h>
#include <openvdb/math/Maps.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Interpolation.h>

#include "engine/vdb/values.h"
#include "tests/engine/geometry/geometry_rig.h"
#include "tests/temporary_folder.h"

namespace repose {
namespace {

namespace vdb = openvdb;
using vdb::math::MapBase;

/// Transforms of each kind, about the unit of the scene.
std::vector<MapBase::Ptr> maps() {
  namespace math = vdb::math;
  vdb::Mat4d turned = vdb::Mat4d::identity();
  turned.preRotate(math::X_AXIS, 0.3);
  turned.preRotate(math::Z_AXIS, -1.1);
  vdb::Mat4d sheared = turned;
  sheared.preScale(vdb::Vec3d(0.07, 0.11, 0.13));
  sheared.setTranslation(vdb::Vec3d(0.4, -0.2, 7.0));
  return {std::make_shared<math::UniformScaleMap>(0.1),
          std::make_shared<math::ScaleMap>(vdb::Vec3d(0.1, 0.2, 0.07)),
          std::make_shared<math::TranslationMap>(vdb::Vec3d(0.3, 0.1, -0.7)),
          std::make_shared<math::UniformScaleTranslateMap>(0.3, vdb::Vec3d(0.3, 0.1, -0.7)),
          std::make_shared<math::ScaleTranslateMap>(vdb::Vec3d(0.1, 0.2, 0.07), vdb::Vec3d(0.3, 0.1, -0.7)),
          std::make_shared<math::UnitaryMap>(vdb::Vec3d(1, 2, -1).unit(), 0.8),
          std::make_shared<math::AffineMap>(sheared),
          std::make_shared<math::NonlinearFrustumMap>(vdb::BBoxd(vdb::Vec3d(-20), vdb::Vec3d(40)), 0.4, 1.7,
                                                      std::make_shared<math::AffineMap>(sheared))};
}

template <class Grid, class Value>
typename Grid::Ptr random_grid(const MapBase::Ptr& map, const Value& value) {
  auto grid = Grid::create(value());
  grid->setTransform(std::make_shared<vdb::math::Transform>(map));
  grid->setName("g");
  std::mt19937_64 random(5);
  auto voxels = grid->getAccessor();
  for (int k = 0; k < 4000; ++k) {
    const auto along = [&random] { return static_cast<int>(random() % 40) - 15; };
    voxels.setValue({along(), along(), along()}, value());
  }
  for (int k = 0; k < 500; ++k) voxels.setValueOff({k % 9, k % 7, k % 5}, value());  // reads as the background
  grid->tree().addTile(1, {8, 16, 24}, value(), true);
  grid->tree().addTile(1, {-16, 0, 8}, value(), false);
  grid->tree().addTile(2, {128, 0, 0}, value(), true);
  grid->tree().addTile(3, {-4096, 0, 0}, value(), true);
  return grid;
}

template <class Grid>
void set_background(Grid& grid) {
  for (auto value = grid.beginValueOff(); value; ++value) value.setValue(grid.background());
}

/// Places about the voxels, and about faces of blocks and tiles.
std::vector<vdb::Vec3d> places(const vdb::GridBase& grid) {
  std::mt19937_64 random(9);
  std::vector<vdb::Vec3d> all;
  std::uniform_real_distribution<double> near(-20.0, 40.0), far(-5000.0, 5000.0);
  for (int k = 0; k < 6000; ++k) {
    auto& along = k % 6 == 0 ? far : near;
    all.push_back(grid.indexToWorld(vdb::Vec3d(along(random), along(random), along(random))));
  }
  for (int k = -130; k < 140; ++k) all.push_back(grid.indexToWorld(vdb::Vec3d(k, 7.5, k % 16)));
  return all;
}

Vec3 ours(const vdb::Vec3d& x) {
  return {x[0], x[1], x[2]};
}

TEST(VdbSampling, Floats_HaveTheBitsOfOpenVdb) {
  vdb::initialize();
  const TemporaryFolder folder;
  const std::string path = folder.path("g.vdb");
  for (const MapBase::Ptr& map : maps()) {
    std::mt19937_64 random(1);
    std::normal_distribution<float> values;
    const auto grid = random_grid<vdb::FloatGrid>(map, [&] { return values(random); });
    vdb::io::File(path).write({grid});
    const auto read = VdbValues<1>::read({}, path, "g");
    ASSERT_TRUE(read) << map->type() << ": " << read.error().text();
    set_background(*grid);
    std::size_t inside = 0;
    for (const vdb::Vec3d& x : places(*grid)) {
      const auto accessor = grid->getConstAccessor();
      const float theirs = vdb::tools::BoxSampler::sample(accessor, grid->worldToIndex(x));
      ASSERT_EQ(read->at(ours(x))[0], theirs) << map->type() << " at " << x;
      inside += theirs != grid->background() ? 1 : 0;
    }
    EXPECT_GT(inside, 1000u) << map->type();
    EXPECT_EQ(read->at({1e300, 0, 0})[0], grid->background());
  }
}

TEST(VdbSampling, VectorsAndStaggeredOnes_HaveTheBitsOfOpenVdb) {
  vdb::initialize();
  const TemporaryFolder folder;
  const std::string path = folder.path("g.vdb");
  for (const MapBase::Ptr& map : maps()) {
    for (const bool staggered : {false, true}) {
      std::mt19937_64 random(2);
      std::normal_distribution<float> values;
      const auto grid = random_grid<vdb::Vec3SGrid>(
          map, [&] { return vdb::Vec3s(values(random), values(random), values(random)); });
      if (staggered) grid->setGridClass(vdb::GRID_STAGGERED);
      vdb::io::File(path).write({grid});
      const auto read = VdbValues<3>::read({}, path, "g");
      ASSERT_TRUE(read) << map->type() << ": " << read.error().text();
      set_background(*grid);
      for (const vdb::Vec3d& x : places(*grid)) {
        const auto accessor = grid->getConstAccessor();
        const vdb::Vec3d at = grid->worldToIndex(x);
        const vdb::Vec3s theirs = staggered ? vdb::tools::StaggeredBoxSampler::sample(accessor, at)
                                            : vdb::tools::BoxSampler::sample(accessor, at);
        const auto value = read->at(ours(x));
        ASSERT_EQ(vdb::Vec3s(value[0], value[1], value[2]), theirs) << map->type() << " at " << x;
      }
    }
  }
}

}  // namespace
}  // namespace repose
