// Repose tests: what a surface is made of: the union of balls against the plain formula, cavities, means, and
// distances.
#include "engine/io/level_set.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

#include "engine/io/ball_union.h"

namespace repose {
namespace {

using Place = BlockLattice::Place;
constexpr int kSide = BlockLattice::kSide;

/// Blocks from -n to n - 1 along each axis, those that `wanted` takes.
template <class Wanted>
BlockLattice blocks_about_the_origin(int n, const Wanted& wanted) {
  std::vector<Place> places;
  for (int x = -n; x < n; ++x) {
    for (int y = -n; y < n; ++y) {
      for (int z = -n; z < n; ++z) {
        if (wanted(Place{x, y, z})) places.push_back({x, y, z});
      }
    }
  }
  return BlockLattice(places);
}

/// Calls body(value, position) for every voxel.
template <class Body>
void for_each_voxel(const BlockLattice& lattice, BlockField& field, const Body& body) {
  field.resize(lattice.size() * BlockLattice::kVoxels);
  for (std::size_t block = 0; block < lattice.size(); ++block) {
    for (int k = 0; k < static_cast<int>(BlockLattice::kVoxels); ++k) {
      const Place& place = lattice.place(block);
      body(values_of(field, block)[k],
           std::array<double, 3>{kSide * place[0] + double(k / 64), kSide * place[1] + double(k / 8 % 8),
                                 kSide * place[2] + double(k % 8)});
    }
  }
}

double length(const std::array<double, 3>& x) {
  return std::hypot(x[0], x[1], x[2]);
}

std::vector<Ball> scattered_balls(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-20.0, 30.0);
  std::vector<Ball> balls;
  for (int k = 0; k < count; ++k)
    balls.push_back({{place(random), place(random), place(random)}, k % 3 == 0 ? 3.5f : 2.2f});
  return balls;
}

void expect_the_formula(const Stretch& stretch) {
  constexpr float kMargin = 1.5f;
  const std::vector<Ball> balls = scattered_balls(60);
  Threads threads(2);
  BallUnion made = unite(balls, stretch, kMargin, threads);
  double worst = 0.0;
  std::size_t inside = 0;
  std::set<Place> there;
  for (std::size_t block = 0; block < made.lattice.size(); ++block) there.insert(made.lattice.place(block));
  const auto formula = [&](const std::array<double, 3>& x) {
    double nearest = kMargin;
    for (const Ball& ball : balls) {
      std::array<double, 3> off;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const double half = static_cast<int>(axis) == stretch.axis ? stretch.half : 0.0;
        off[axis] = std::max(0.0, std::abs(x[axis] - ball.center[axis]) - half);
      }
      nearest = std::min(nearest, length(off) - ball.radius);
    }
    return std::max(nearest, -double(kMargin));
  };
  for_each_voxel(made.lattice, made.distance, [&](float value, const std::array<double, 3>& x) {
    worst = std::max(worst, std::abs(value - formula(x)));
    inside += value < 0.0f ? 1 : 0;
  });
  EXPECT_LT(worst, 1e-5);
  EXPECT_GT(inside, 2000u);
  // What is in no block is far away.
  for (int x = -40; x < 50; x += 3) {
    for (int y = -40; y < 50; y += 3) {
      for (int z = -40; z < 50; z += 3) {
        const Place place{x >> 3, y >> 3, z >> 3};
        if (there.count(place) > 0) continue;
        EXPECT_EQ(formula({double(x), double(y), double(z)}), kMargin);
      }
    }
  }
}

TEST(BallUnion, OfScatteredBalls_IsTheNearestOfAll) {
  expect_the_formula({});
}

TEST(BallUnion, InPlaneStrain_BallsAreStretched) {
  expect_the_formula({1, 9.0f});
}

TEST(BallUnion, AnyOrderAndThreads_SameBits) {
  std::vector<Ball> balls = scattered_balls(200);
  Threads one(1), seven(7);
  const BallUnion first = unite(balls, {}, 1.5f, one);
  std::reverse(balls.begin(), balls.end());
  EXPECT_EQ(unite(balls, {}, 1.5f, seven).distance, first.distance);
  balls[0].center[0] += 0.1;
  EXPECT_NE(unite(balls, {}, 1.5f, seven).distance, first.distance) << "control";
}

/// A ball's surface, of values that change sign where they should and are no distances.
struct BentSphere {
  static constexpr double kRadius = 13.3;
  static double distance(const std::array<double, 3>& x) {
    return length({x[0] - 0.37, x[1] + 0.21, x[2] - 0.55}) - kRadius;
  }
  BentSphere() : lattice(blocks_about_the_origin(3, [](const Place&) { return true; })) {
    for_each_voxel(lattice, field, [](float& value, const std::array<double, 3>& x) {
      const double d = distance(x);
      value = static_cast<float>(std::clamp(d * (1.0 + 0.02 * d), -1.5, 1.5));
    });
  }
  BlockLattice lattice;
  BlockField field;
};

TEST(LevelSet, Redistance_OfABentSphereIsItsDistance) {
  BentSphere sphere;
  const auto worst = [&](double inside, double outside) {
    double most = 0.0;
    for_each_voxel(sphere.lattice, sphere.field, [&](float value, const std::array<double, 3>& x) {
      most = std::max(most, std::abs(value - std::clamp(BentSphere::distance(x), -inside, outside)));
    });
    return most;
  };
  EXPECT_GT(worst(5.0, 3.0), 3.0) << "control: as it begins";
  Threads threads(2);
  redistance(sphere.lattice, 5.0f, 3.0f, sphere.field, threads);
  EXPECT_LT(worst(5.0, 3.0), 0.45) << "where the values that it begins from bend";
  // As deep as a surface is drawn back.
  double most = 0.0, squares = 0.0;
  std::size_t count = 0;
  for_each_voxel(sphere.lattice, sphere.field, [&](float value, const std::array<double, 3>& x) {
    const double distance = BentSphere::distance(x);
    if (distance < -3.0 || distance > -1.5) return;
    most = std::max(most, std::abs(value - distance));
    squares += (value - distance) * (value - distance);
    ++count;
  });
  const double rms = std::sqrt(squares / static_cast<double>(count));
  std::printf("two voxels inside a sphere distances are off by %.3f voxels, at most %.3f\n", rms, most);
  EXPECT_LT(most, 0.25);
  EXPECT_LT(rms, 0.06);
}

TEST(LevelSet, AnyThreads_SameBits) {
  BentSphere one, seven;
  Threads alone(1), many(7);
  smooth(one.lattice, 2, 1.5f, one.field, alone);
  redistance(one.lattice, 5.0f, 3.0f, one.field, alone);
  smooth(seven.lattice, 2, 1.5f, seven.field, many);
  redistance(seven.lattice, 5.0f, 3.0f, seven.field, many);
  EXPECT_EQ(one.field, seven.field);
}

TEST(LevelSet, Smooth_LeavesWhatIsLinearAndSpreadsWhatIsNot) {
  BlockLattice lattice = blocks_about_the_origin(2, [](const Place&) { return true; });
  BlockField field;
  const auto linear = [](const std::array<double, 3>& x) { return 0.3 * x[0] - 0.2 * x[1] + 0.1 * x[2]; };
  for_each_voxel(lattice, field,
                 [&](float& value, const std::array<double, 3>& x) { value = static_cast<float>(linear(x)); });
  Threads threads(2);
  smooth(lattice, 2, 0.0f, field, threads);
  double worst = 0.0;
  for_each_voxel(lattice, field, [&](float value, const std::array<double, 3>& x) {
    if (std::max({std::abs(x[0]), std::abs(x[1]), std::abs(x[2])}) < 13.0)
      worst = std::max(worst, std::abs(value - linear(x)));
  });
  EXPECT_LT(worst, 1e-5);
  std::size_t touched = 0;
  for_each_voxel(lattice, field,
                 [](float& value, const std::array<double, 3>& x) { value = length(x) == 0.0; });
  smooth(lattice, 1, 0.0f, field, threads);
  for_each_voxel(lattice, field, [&](float value, const std::array<double, 3>&) {
    if (value == 0.0f) return;
    ++touched;
    EXPECT_NEAR(value, 1.0 / 27.0, 1e-6);
  });
  EXPECT_EQ(touched, 27u) << "across the corner of eight blocks";
}

/// The value in the middle of a shell whose middle has no blocks, with a hole of so many voxels to one side.
float middle_of_a_shell(int hole) {
  const auto near_the_wall = [](const Place& place) {
    return std::max({std::abs(place[0] + 0.5), std::abs(place[1] + 0.5), std::abs(place[2] + 0.5)}) > 1.0;
  };
  BlockLattice lattice = blocks_about_the_origin(4, near_the_wall);
  BlockField field;
  for_each_voxel(lattice, field, [hole](float& value, const std::array<double, 3>& x) {
    value = std::abs(length(x) - 22.0) < 3.0 ? -1.0f : 1.0f;
    if (x[0] > 0.0 && std::abs(x[1]) < 0.5 * hole && std::abs(x[2]) < 0.5 * hole) value = 1.0f;
  });
  fill_cavities(lattice, -1.5f, field);
  float inner = 0.0f;
  for_each_voxel(lattice, field, [&inner](float value, const std::array<double, 3>& x) {
    if (x[0] == -16.0 && x[1] == 0.0 && x[2] == 0.0) inner = value;
    if (length(x) > 26.0) {
      EXPECT_EQ(value, 1.0f);
    }
    if (std::abs(x[0]) < 0.5 && std::abs(length(x) - 22.0) < 3.0) {
      EXPECT_EQ(value, -1.0f);
    }
  });
  return inner;
}

TEST(LevelSet, FillCavities_FillsThoseThatAreClosedAcrossAnyGap) {
  EXPECT_EQ(middle_of_a_shell(0), -1.5f);
  EXPECT_EQ(middle_of_a_shell(2), 1.0f) << "a hole that two blocks share";
}

}  // namespace
}  // namespace repose
