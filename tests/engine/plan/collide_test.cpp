// Repose tests: a node that several solids meet at once: the velocity nearest to its own that none forbids,
// power that comes of nothing but what the solids do, and friction along what none holds.
#include "engine/plan/collide.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

#include "engine/plan/contact_log.h"

namespace repose {
namespace {

constexpr double kStep = 1e-3;

struct Wall {
  Vec3 normal, velocity{0, 0, 0};
  Contact contact = Contact::kSeparating;
  double friction = 0.0, distance = -1e-3;
};

/// As collide() asks for them.
struct Walls {
  const std::vector<Wall>& walls;
  std::vector<NodeContact<double>> places{};

  explicit Walls(const std::vector<Wall>& all) : walls(all) {
    for (const Wall& wall : walls)
      places.push_back({wall.distance, {wall.normal[0], wall.normal[1], wall.normal[2]}});
  }
  std::size_t size() const { return walls.size(); }
  int solid(std::size_t k) const { return static_cast<int>(k); }
  Contact contact(std::size_t k) const { return walls[k].contact; }
  double friction(std::size_t k) const { return walls[k].friction; }
  const NodeContact<double>& at(std::size_t k) const { return places[k]; }
  const double* wall(std::size_t k) const { return walls[k].velocity.data(); }
  void meet(std::size_t, const double*) const {}
};

struct Met {
  Vec3 bar, tilde;
  std::vector<ContactSums> sums;  ///< per unit of mass

  double work() const {
    double sum = 0.0;
    for (const ContactSums& each : sums) sum += each.work;
    return sum;
  }
  Vec3 impulse() const {
    Vec3 sum(0, 0, 0);
    for (const ContactSums& each : sums) sum += each.impulse;
    return sum;
  }
};

Met meet(const std::vector<Wall>& walls, const Vec3& v) {
  Met met{v, v, std::vector<ContactSums>(walls.size())};
  Corner<double> corner;
  collide(Walls(walls), corner, kStep, met.bar.data(), met.tilde.data(),
          ContactRecorder{met.sums.data(), 1.0, Vec3(0, 0, 0)});
  return met;
}

/// By trying every set of walls that may hold.
Vec3 nearest_allowed(const std::vector<Wall>& walls, const Vec3& v) {
  Vec3 best = v;
  double least = std::numeric_limits<double>::infinity();
  for (unsigned chosen = 0; chosen < (1u << walls.size()); ++chosen) {
    Eigen::MatrixXd normals(0, 3);
    Eigen::VectorXd bounds(0);
    for (std::size_t k = 0; k < walls.size(); ++k) {
      if ((chosen >> k & 1u) == 0) continue;
      normals.conservativeResize(normals.rows() + 1, 3);
      bounds.conservativeResize(bounds.size() + 1);
      normals.row(normals.rows() - 1) = walls[k].normal.transpose();
      bounds[bounds.size() - 1] = walls[k].normal.dot(walls[k].velocity);
    }
    Vec3 tried = v;
    if (normals.rows() > 0) {
      const Eigen::MatrixXd gram = normals * normals.transpose();
      tried += normals.transpose() * gram.completeOrthogonalDecomposition().solve(bounds - normals * v);
    }
    bool allowed = true;
    for (const Wall& wall : walls) {
      const double by = wall.normal.dot(tried - wall.velocity);
      const bool equal = wall.contact == Contact::kSlip;
      allowed = allowed && (equal ? std::abs(by) < 1e-9 : by > -1e-9);
    }
    const double far = (tried - v).norm();
    if (!allowed || far >= least) continue;
    least = far;
    best = tried;
  }
  return best;
}

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  double number() { return normal_(engine_); }
  Vec3 vector() { return {number(), number(), number()}; }
  /// Walls no two of which are nearly one, around a way that all of them leave open.
  std::vector<Wall> corner(std::size_t walls, bool moves) {
    const Vec3 open = vector().normalized();
    std::vector<Wall> all;
    while (all.size() < walls) {
      Wall wall;
      wall.normal = (vector().normalized() + 1.1 * open).normalized();
      bool apart = wall.normal.dot(open) > 0.2;
      for (const Wall& other : all) apart = apart && wall.normal.dot(other.normal) < 0.9;
      if (!apart) continue;
      if (moves) wall.velocity = vector();
      all.push_back(wall);
    }
    return all;
  }

 private:
  std::mt19937 engine_;
  std::normal_distribution<double> normal_;
};

double volume(const std::vector<Wall>& walls) {
  return walls[0].normal.cross(walls[1].normal).dot(walls[2].normal);
}

TEST(Corner, VelocityIsTheNearestThatNoWallForbids) {
  Random random(7);
  int several = 0;
  for (int k = 0; k < 4000; ++k) {
    std::vector<Wall> walls = random.corner(k % 2 == 0 ? 2 : 3, k % 3 == 0);
    if (walls.size() == 3 && std::abs(volume(walls)) < 0.3) continue;
    if (k % 5 == 0) walls[0].contact = Contact::kSlip;
    const Vec3 v = 2.0 * random.vector();
    const Met met = meet(walls, v);
    const Vec3 right = nearest_allowed(walls, v);
    ASSERT_LT((met.bar - right).norm(), 1e-5 * (1.0 + v.norm())) << "sample " << k;
    several += (met.bar - v).norm() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(several, 2000);
}

TEST(Corner, SolidsAtRestGiveNoPower) {
  Random random(8);
  int rubs = 0;
  for (int k = 0; k < 4000; ++k) {
    std::vector<Wall> walls = random.corner(2, false);
    for (Wall& wall : walls) {
      wall.friction = std::abs(random.number());
      wall.contact = k % 3 == 0 ? Contact::kSlip : Contact::kSeparating;
    }
    const Vec3 v = 2.0 * random.vector();
    const Met met = meet(walls, v);
    const double power = (met.tilde - v).dot(met.tilde);
    ASSERT_LT(power, 1e-12 * v.squaredNorm()) << "sample " << k;
    ASSERT_EQ(met.work(), 0.0);
    rubs += (met.tilde - met.bar).norm() > 0.0 ? 1 : 0;
  }
  EXPECT_GT(rubs, 1000);
}

TEST(Corner, PowerIsNoMoreThanSolidsTell) {
  Random random(9);
  for (int k = 0; k < 4000; ++k) {
    std::vector<Wall> walls = random.corner(2 + static_cast<std::size_t>(k % 2), true);
    for (Wall& wall : walls) wall.friction = std::abs(random.number());
    const Vec3 v = 2.0 * random.vector();
    const Met met = meet(walls, v);
    ASSERT_LT((met.tilde - v).dot(met.tilde), met.work() + 1e-9 * (1.0 + v.squaredNorm())) << "sample " << k;
    ASSERT_LT((met.impulse() - (met.tilde - v)).norm(), 1e-9 * (1.0 + v.norm())) << "sample " << k;
  }
}

TEST(Corner, FrictionDrivesNothingIntoAWall) {
  Random random(10);
  for (int k = 0; k < 4000; ++k) {
    std::vector<Wall> walls = random.corner(2, false);
    for (Wall& wall : walls) wall.friction = 1.0;
    const Met met = meet(walls, 2.0 * random.vector());
    for (const Wall& wall : walls) ASSERT_GT(wall.normal.dot(met.tilde), -1e-5) << "sample " << k;
  }
}

TEST(Corner, OfTwoWallsThatAreOneTheFirstToMoveIsMet) {
  const Wall rests{Vec3(0, 1, 0)}, rises{Vec3(0, 1, 0), Vec3(0, 2, 0)};
  for (const auto& walls : {std::vector{rests, rises}, std::vector{rises, rests}}) {
    EXPECT_NEAR(meet(walls, Vec3(1, -1, 0)).bar[1], 2.0, 1e-12);
  }
}

TEST(Corner, WhatSticksHoldsWhateverElseActs) {
  Wall sticks{Vec3(0, 1, 0), Vec3(1, 0, 0), Contact::kSticky};
  const Wall pushes{Vec3(1, 0, 0), Vec3(5, 0, 0)};
  for (const auto& walls : {std::vector{sticks, pushes}, std::vector{pushes, sticks}}) {
    EXPECT_LT((meet(walls, Vec3(0, -1, 3)).tilde - sticks.velocity).norm(), 1e-12);
  }
}

// Between plates that close nothing is allowed; what comes out lies between what both ask for.
TEST(Corner, PlatesThatCloseThrowNothing) {
  const Wall left{Vec3(1, 0, 0), Vec3(2, 0, 0)}, right{Vec3(-1, 0, 0), Vec3(-2, 0, 0)};
  for (const double speed : {-50.0, 0.0, 50.0}) {
    const Met met = meet({left, right}, Vec3(speed, 1, 0));
    EXPECT_LE(std::abs(met.bar[0]), 2.0 + 1e-12);
    EXPECT_LT((met.tilde - Vec3(speed, 1, 0)).dot(met.tilde), met.work() + 1e-9);
  }
}

// Of opposite walls one holds nothing; it must not keep a third from being met.
TEST(Corner, BetweenPlatesThatCloseASideWallHolds) {
  const std::vector<Wall> walls{{Vec3(0, 1, 0)}, {Vec3(0, -1, 0), Vec3(0, -2, 0)}, {Vec3(-1, 0, 0)}};
  EXPECT_LE(meet(walls, Vec3(0.5, 0, 0)).bar[0], 1e-12);
}

// A solid that is near and does nothing changes nothing, before and after the one that acts.
TEST(Corner, FrictionOfOneSolidIsItsOwnWhateverElseIsNear) {
  const Wall floor{Vec3(0, 1, 0), Vec3(0, 0, 0), Contact::kSeparating, 0.3};
  const Wall far{Vec3(-1, 0, 0), Vec3(0, 0, 0), Contact::kSeparating, 0.5, 1.0};
  const Vec3 alone = meet({floor}, Vec3(3, -2, 1)).tilde;
  EXPECT_NEAR(alone.norm(), Vec3(3, 0, 1).norm() - 0.6, 1e-12);
  EXPECT_EQ(meet({floor, far}, Vec3(3, -2, 1)).tilde, alone);
  EXPECT_EQ(meet({far, floor}, Vec3(3, -2, 1)).tilde, alone);
}

TEST(Corner, WallsAtRightAnglesActAsOneAfterTheOther) {
  const std::vector<Wall> walls{{Vec3(0, 1, 0), Vec3(0, 0, 0), Contact::kSeparating, 0.3},
                                {Vec3(1, 0, 0), Vec3(0, 0, 0), Contact::kSeparating, 0.3}};
  const Met met = meet(walls, Vec3(-1, -2, 3));
  EXPECT_LT((met.bar - Vec3(0, 0, 3)).norm(), 1e-12);
  EXPECT_NEAR(met.tilde[2], 3.0 - 0.3 * (1.0 + 2.0), 1e-12);
  EXPECT_NEAR(met.sums[0].impulse[1], 2.0, 1e-12);
  EXPECT_NEAR(met.sums[1].impulse[0], 1.0, 1e-12);
  EXPECT_NEAR(met.sums[0].impulse[2], -0.6, 1e-12);
}

}  // namespace
}  // namespace repose
