// Repose tests: contacts of an implicit step by themselves: what they hold, what they bear, and friction, whose
// impulse lies in Coulomb's cone, whose tangent is its derivative, and which the preconditioner inverts.
#include "engine/implicit/contact_set.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "engine/plan/contact_log.h"

namespace repose {
namespace {

constexpr double kMass = 2.0, kFriction = 0.4;
constexpr int kNode = 21;
constexpr std::size_t kAt = kNode * kNodeValues + 1;

/// A node of kMass against a wall that moves along itself.
struct OneNode {
  explicit OneNode(Vec3 normal = Vec3(0.0, 1.0, 0.0), Contact contact = Contact::kSeparating)
      : OneNode(std::vector<Vec3>{normal}, contact) {}
  /// In a corner of several that move alike.
  explicit OneNode(const std::vector<Vec3>& normals, Contact contact = Contact::kSeparating) {
    contacts.clear(1);
    std::vector<Constraint<double>> constraints;
    for (const Vec3& any : normals) {
      const Vec3 normal = any.normalized();
      Constraint<double> hold;
      hold.node = kNode;
      hold.contact = contact;
      hold.solid = 0;
      std::copy_n(normal.data(), 3, hold.normal);
      std::copy_n(wall.data(), 3, hold.velocity);
      hold.bound = normal.dot(wall);
      hold.friction = kFriction;
      constraints.push_back(hold);
    }
    const double none[kBlockValues] = {};
    contacts.set_block(0, constraints, none);
    masses[kNode * kNodeValues] = kMass;
    set_velocity(wall);
  }

  void set_velocity(const Vec3& v) { std::copy_n(v.data(), 3, velocities + kAt); }
  /// What is left of a residual, of a node at a velocity. What of that counts is in `left`.
  Vec3 react(const Vec3& v, const Vec3& residual) {
    set_velocity(v);
    std::copy_n(residual.data(), 3, r + kAt);
    contacts.react(0, masses, velocities, r, left);
    return Eigen::Map<const Vec3>(r + kAt);
  }
  Vec3 counts() const { return Eigen::Map<const Vec3>(left + kAt); }
  Vec3 reaction() const {
    Vec3 found = Vec3::Zero();
    contacts.for_each_reaction(0, [&](int, const Vec3& j) { found = j; });
    return found;
  }

  Vec3 wall{0.5, 0.0, -0.25};
  ContactSet<double> contacts;
  double masses[kBlockValues] = {}, velocities[kBlockValues] = {}, r[kBlockValues] = {},
         left[kBlockValues] = {};
};

/// Any velocity along the wall, from far below the one at which a node begins to slip to far above.
Vec3 along_floor(std::mt19937& engine) {
  std::uniform_real_distribution<double> number(-1.0, 1.0), exponent(-7.0, 1.0);
  return std::pow(10.0, exponent(engine)) * Vec3(number(engine), 0.0, number(engine)).normalized();
}

TEST(ContactSet, Node_IsTakenUpWhereItPassesAndLetGoWhereItIsPulled) {
  OneNode node;
  EXPECT_EQ(node.contacts.directions(), 0);
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  EXPECT_EQ(node.contacts.take_up(0, node.velocities), 1);
  EXPECT_EQ(node.contacts.directions(), 1);
  node.contacts.apply(0, node.velocities);
  EXPECT_DOUBLE_EQ(node.velocities[kAt + 1], 0.0);
  node.react(node.wall, Vec3(0.0, 3.0, 0.0));
  EXPECT_EQ(node.contacts.release(0), 0);
  node.react(node.wall, Vec3(0.0, -3.0, 0.0));
  EXPECT_EQ(node.contacts.release(0), 1);
  EXPECT_EQ(node.contacts.directions(), 0);
}

/// Two walls 60 degrees apart: each pushes against the other's normal.
const Vec3 kLeft(std::sqrt(0.75), 0.5, 0.0), kRight(-std::sqrt(0.75), 0.5, 0.0);

TEST(ContactSet, InASharpCorner_WhatPushesIsKept) {
  for (const auto& push : {std::array{1.0, 1.0}, std::array{1.0, 0.3}, std::array{0.3, 1.0}}) {
    OneNode node(std::vector<Vec3>{kLeft, kRight});
    node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
    EXPECT_EQ(node.contacts.take_up(0, node.velocities), 2);
    node.contacts.apply(0, node.velocities);
    EXPECT_NEAR(node.velocities[kAt], node.wall[0], 1e-12);
    EXPECT_NEAR(node.velocities[kAt + 1], 0.0, 1e-12);
    node.react(node.wall, push[0] * kLeft + push[1] * kRight);
    EXPECT_EQ(node.contacts.release(0), 0) << push[0] << " " << push[1];
  }
  OneNode node(std::vector<Vec3>{kLeft, kRight});
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  node.contacts.take_up(0, node.velocities);
  node.react(node.wall, kLeft - 0.1 * kRight);  // along kRight it is 0.6 against it
  EXPECT_EQ(node.contacts.release(0), 1);
  node.react(node.wall, kLeft);
  EXPECT_NEAR((node.reaction() - kLeft).norm(), 0.0, 1e-12) << "it is the other one that stays";
}

TEST(ContactSet, InASharpCorner_WhatWasJustTakenUpIsKept) {
  OneNode node(std::vector<Vec3>{kLeft, kRight});
  node.set_velocity(node.wall - 0.1 * kLeft);
  EXPECT_EQ(node.contacts.take_up(0, node.velocities), 1);
  node.react(node.wall, kLeft);  // which pulls along kRight
  node.set_velocity(node.wall - 0.1 * kRight);
  EXPECT_EQ(node.contacts.take_up(0, node.velocities), 1);
  EXPECT_EQ(node.contacts.release(0), 0);
  EXPECT_EQ(node.contacts.directions(), 2);
}

TEST(ContactSet, InASharpCorner_BothWallsRubByWhatEachBears) {
  OneNode node(std::vector<Vec3>{kLeft, kRight});
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  node.contacts.take_up(0, node.velocities);
  const Vec3 along(0.0, 0.0, 10.0);
  for (int round = 0; round < 2; ++round) node.react(node.wall + along, 1.0 * kLeft + 0.3 * kRight);
  EXPECT_NEAR(std::abs(node.reaction()[2]), kFriction * 1.3, 1e-9);
}

// Else it is taken up and let go in every iteration, and no contact ever settles.
TEST(ContactSet, OfOppositeWalls_TheOneThatHoldsNothingStays) {
  const Vec3 up(0.0, 1.0, 0.0);
  OneNode node(std::vector<Vec3>{up, -up});
  node.set_velocity(node.wall - 0.1 * up);
  EXPECT_EQ(node.contacts.take_up(0, node.velocities), 1);
  node.set_velocity(node.wall + 0.1 * up);
  EXPECT_EQ(node.contacts.take_up(0, node.velocities), 1);
  EXPECT_EQ(node.contacts.directions(), 1);
  node.react(node.wall, up);  // against the other
  EXPECT_EQ(node.contacts.release(0), 0);
}

TEST(ContactSet, WallsAFewDegreesApart_AreOne) {
  for (const double degrees : {0.0, 2.0, 9.0, 12.0}) {
    const double angle = degrees * std::numbers::pi / 180.0;
    const Vec3 up(0.0, 1.0, 0.0), tilted(std::sin(angle), std::cos(angle), 0.0);
    OneNode node(std::vector<Vec3>{up, tilted});
    node.set_velocity(node.wall - 0.1 * (up + tilted));
    EXPECT_EQ(node.contacts.take_up(0, node.velocities), 2);
    EXPECT_EQ(node.contacts.directions(), degrees > 10.0 ? 2 : 1) << degrees;
    if (degrees > 10.0) continue;
    const Vec3 along(10.0, 0.0, 0.0);
    node.react(node.wall + along, up);
    EXPECT_EQ(node.contacts.release(0), 0) << degrees;
    EXPECT_NEAR(std::abs(node.reaction()[0]), kFriction, 1e-9) << "they rub as one";
  }
}

TEST(ContactSet, Friction_LiesInCoulombsConeAndOpposesSlip) {
  std::mt19937 engine(5);
  OneNode node;
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  node.contacts.take_up(0, node.velocities);
  constexpr double kPush = 3.0, kBound = kFriction * kPush;
  int sticking = 0;
  for (int k = 0; k < 200; ++k) {
    const Vec3 slip = along_floor(engine);
    const Vec3 friction = -node.react(node.wall + slip, Vec3(0.0, kPush, 0.0));  // of a residual without any
    EXPECT_NEAR(friction.normalized().dot(slip.normalized()), -1.0, 1e-9);
    EXPECT_LE(friction.norm(), kBound * (1.0 + 1e-12));
    if (friction.norm() < (1.0 - 1e-9) * kBound) {
      ++sticking;
      EXPECT_LT(slip.norm(), 1e-4 * kBound / kMass);
      EXPECT_EQ((node.reaction() - Vec3(0.0, kPush, 0.0)).norm(), 0.0);  // nothing was asked of it
    } else {
      EXPECT_NEAR((node.reaction() - Vec3(0.0, kPush, 0.0) - friction).norm(), 0.0, 1e-12);
    }
  }
  EXPECT_GT(sticking, 20);
  EXPECT_LT(sticking, 180);
}

/// Keeps what a contact did to a node.
struct Kept {
  std::vector<std::pair<std::size_t, Vec3>>* changes;
  void give(std::size_t solid, const double*, const double* change) {
    changes->emplace_back(solid, Eigen::Map<const Vec3>(change));
  }
};

// After the solve: its impulse is taken back, and the law of explicit steps gives it.
TEST(ContactSet, WhatTheSolveFound_ActsAsInAnExplicitStep) {
  OneNode node;
  const Vec3 falls = node.wall + Vec3(0.02, 0.0, 0.0), push(0.0, 0.3, 0.0);
  node.contacts.take_up(0, node.velocities);
  node.set_velocity(node.wall - Vec3(0.0, 1.0, 0.0));
  node.contacts.take_up(0, node.velocities);
  node.react(falls, push);  // sticks: it bears the push, and friction what is left along the wall
  const Vec3 reaction = node.reaction();
  ASSERT_GT(reaction.y(), 0.0);
  double nodes[kBlockValues] = {};
  nodes[kNode * kNodeValues] = kMass;
  std::copy_n(falls.data(), 3, nodes + kAt);
  std::vector<std::pair<std::size_t, Vec3>> changes;
  node.contacts.act(0, nodes, nodes, nodes, [&](std::size_t, double) { return Kept{&changes}; });
  const Vec3 after = Eigen::Map<const Vec3>(nodes + kAt), free = falls - reaction / kMass;
  EXPECT_NEAR(after.y(), 0.0, 1e-14) << "the wall does not move along its normal";
  EXPECT_NEAR((free - node.wall).y(), -reaction.y() / kMass, 1e-15);
  Vec3 given = Vec3::Zero();
  for (const auto& [solid, change] : changes) given += change;
  EXPECT_LT((given - reaction / kMass).norm(), 1e-12) << "what is recorded is what the solve gave";
  // Coulomb: along the wall it keeps what exceeds the bound, here nothing or its slip less the bound.
  const Vec3 slip = free - node.wall - Vec3(0.0, (free - node.wall).y(), 0.0);
  const double bound = kFriction * reaction.y() / kMass;
  EXPECT_NEAR((after - node.wall).norm(), std::max(0.0, slip.norm() - bound), 1e-12);
}

// Without the friction that holds it the node would run into the second wall; but it is held, and stays where
// the solve had it. A stiff body in a rough room came to 200 times its energy where it did not.
TEST(ContactSet, WhatFrictionHolds_MeetsNoOtherWall) {
  Constraint<double> floor, wall;
  floor.node = wall.node = kNode;
  floor.contact = wall.contact = Contact::kSeparating;
  floor.solid = 0;
  wall.solid = 1;
  floor.normal[1] = 1.0;
  floor.friction = 1.0;
  floor.distance = -1.0;
  wall.normal[0] = -0.8;
  wall.normal[2] = 0.6;
  wall.distance = 0.01;
  wall.bound = -1.0;
  for (const bool runs : {false, true}) {
    ContactSet<double> contacts;
    contacts.clear(1);
    double velocities[kBlockValues] = {}, nodes[kBlockValues] = {}, r[kBlockValues] = {},
           left[kBlockValues] = {};
    contacts.set_block(0, {floor, wall}, velocities);
    velocities[kAt + 1] = -0.1;
    nodes[kNode * kNodeValues] = kMass;
    ASSERT_EQ(contacts.take_up(0, velocities), 1);
    contacts.apply(0, velocities);
    const Vec3 asked(-8.0, 10.0, 1.0);  // 4 m/s along the floor if nothing held
    std::copy_n(asked.data(), 3, r + kAt);
    contacts.react(0, nodes, velocities, r, left);
    // What the solve did not see, a wall that is passed with friction too, still stops the node.
    const Vec3 found = runs ? Vec3(3.0, 0.0, 0.0) : Vec3(0.0, 0.0, 0.0);
    std::copy_n(found.data(), 3, nodes + kAt);
    contacts.act(0, nodes, nodes, nodes, [](std::size_t, double) { return NoContactRecorder{}; });
    const Vec3 after = Eigen::Map<const Vec3>(nodes + kAt);
    EXPECT_GE(after.dot(Vec3(-0.8, 0.0, 0.6)), -1.0 - 1e-12);
    EXPECT_LT(after.norm(), runs ? 3.0 : 1e-14) << after.transpose();
  }
}

// Else the end of the step would give the node another velocity than was solved for.
TEST(ContactSet, OfWhatSlipsAndWhatSticks_TheLatterIsObeyed) {
  Constraint<double> slips, sticks;
  slips.node = sticks.node = kNode;
  slips.contact = Contact::kSlip;
  sticks.contact = Contact::kSticky;
  slips.solid = 0;
  sticks.solid = 1;
  slips.normal[1] = sticks.normal[1] = slips.velocity[1] = slips.bound = 1.0;
  sticks.velocity[1] = sticks.bound = 0.25;
  slips.distance = sticks.distance = -1.0;
  for (const auto& list : {std::vector{slips, sticks}, std::vector{sticks, slips}}) {
    ContactSet<double> contacts;
    contacts.clear(1);
    double velocities[kBlockValues] = {}, nodes[kBlockValues] = {};
    contacts.set_block(0, list, velocities);
    contacts.apply(0, velocities);
    EXPECT_EQ(velocities[kAt + 1], 0.25);
    nodes[kNode * kNodeValues] = kMass;
    std::copy_n(velocities + kAt, 3, nodes + kAt);
    contacts.act(0, nodes, nodes, nodes, [](std::size_t, double) { return NoContactRecorder{}; });
    EXPECT_EQ(nodes[kAt + 1], 0.25);
  }
}

// A node at rest bears what it is asked to, and counts for what is beyond.
TEST(ContactSet, FrictionAtRest_BearsWhatItCan) {
  OneNode node;
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  node.contacts.take_up(0, node.velocities);
  constexpr double kPush = 3.0, kBound = kFriction * kPush;
  for (const double load : {0.0, 0.5, 0.999, 1.001, 2.0}) {
    const Vec3 asked(0.6 * load * kBound, 0.0, -0.8 * load * kBound), normal(0.0, kPush, 0.0);
    node.react(node.wall, normal + asked);
    const double beyond = std::max(load - 1.0, 0.0) * kBound;
    EXPECT_NEAR(node.counts().norm(), beyond, 1e-12) << load;
    EXPECT_NEAR((node.reaction() - normal).norm(), std::min(load, 1.0) * kBound, 1e-12) << load;
  }
}

TEST(ContactSet, FrictionOfWhatIsPulled_IsNone) {
  OneNode node;
  node.set_velocity(node.wall + Vec3(0.0, -0.1, 0.0));
  node.contacts.take_up(0, node.velocities);
  EXPECT_EQ(node.react(node.wall + Vec3(0.3, 0.0, 0.0), Vec3(0.0, -3.0, 0.0)).norm(), 0.0);
}

// At the same impulse, which the tangent leaves as it is.
TEST(ContactSet, TangentOfFriction_IsItsDerivative) {
  std::mt19937 engine(6);
  OneNode node(Vec3(0.3, 1.0, -0.2), Contact::kSlip);
  const Vec3 normal = Vec3(0.3, 1.0, -0.2).normalized(), push = 3.0 * normal;
  for (int k = 0; k < 100; ++k) {
    Vec3 slip = along_floor(engine);
    slip -= normal * normal.dot(slip);
    Vec3 d = along_floor(engine);
    d -= normal * normal.dot(d);
    d *= 1e-4 * slip.norm() / d.norm();
    const Vec3 change = (node.react(node.wall + slip + d, push) - node.react(node.wall + slip - d, push)) / 2.0;
    node.react(node.wall + slip, push);
    node.contacts.linearize(0, node.masses);
    double x[kBlockValues] = {}, y[kBlockValues] = {};
    std::copy_n(d.data(), 3, x + kAt);
    node.contacts.add_friction(0, x, y);
    const Vec3 product = Eigen::Map<const Vec3>(y + kAt);
    EXPECT_NEAR((product - change).norm(), 0.0, 1e-11 + 1e-4 * product.norm()) << slip.norm();

    int rubbing = 0;
    node.contacts.for_each_friction(0, [&](int index, const Mat3& tangent) {
      ++rubbing;
      EXPECT_EQ(index, kNode);
      EXPECT_NEAR((tangent * d - product).norm(), 0.0, 1e-12 * tangent.norm() * d.norm());
      EXPECT_NEAR((tangent * normal).norm(), 0.0, 1e-12 * tangent.norm());
    });
    EXPECT_EQ(rubbing, 1);

    // (m + D)^-1 m (m x + D x) / m = x
    double z[kBlockValues] = {};
    for (std::size_t c = 0; c < 3; ++c) z[kAt + c] = x[kAt + c] + y[kAt + c] / kMass;
    node.contacts.precondition(0, z);
    EXPECT_NEAR((Vec3(Eigen::Map<const Vec3>(z + kAt)) - d).norm(), 0.0, 1e-10 * d.norm());
  }
}

// By itself the node would go on by (m u - r) / m: friction stops it where that is less than the impulse it
// has.
TEST(ContactSet, NodeThatFrictionWouldStop_IsStopped) {
  OneNode node(Vec3(0.0, 1.0, 0.0), Contact::kSlip);
  constexpr double kPush = 3.0, kBound = kFriction * kPush, kSpeed = 0.1;
  const Vec3 slip(kSpeed, 0.0, 0.0);
  for (const double load : {-0.9, 0.0, 0.9, 1.1, 3.0}) {  // of B
    const Vec3 residual = node.react(node.wall + slip, Vec3(kMass * kSpeed - load * kBound, kPush, 0.0));
    ASSERT_GT(residual.norm(), 0.0);
    EXPECT_EQ(node.contacts.stop_held(0, node.masses, node.r, node.velocities), load < 1.0 ? 1 : 0) << load;
    const Vec3 left = Vec3(Eigen::Map<const Vec3>(node.velocities + kAt)) - node.wall;
    EXPECT_NEAR((left - (load < 1.0 ? Vec3(0.0, 0.0, 0.0) : slip)).norm(), 0.0, 1e-15) << load;
  }
}

TEST(ContactSet, NodeThatWouldSlipBack_StopsAtTheWallsVelocity) {
  OneNode node(Vec3(0.0, 1.0, 0.0), Contact::kSlip);
  node.react(node.wall + Vec3(0.1, 0.0, 0.0), Vec3(0.0, 3.0, 0.0));
  node.contacts.linearize(0, node.masses);
  const auto after = [&](const Vec3& to) {
    double from[kBlockValues] = {}, v[kBlockValues] = {};
    const Vec3 begin = node.wall + Vec3(0.1, 0.0, 0.0), end = node.wall + to;
    std::copy_n(begin.data(), 3, from + kAt);
    std::copy_n(end.data(), 3, v + kAt);
    node.contacts.stop_turning(0, from, v);
    return Vec3(Vec3(Eigen::Map<const Vec3>(v + kAt)) - node.wall);
  };
  EXPECT_NEAR(after(Vec3(-0.2, 0.0, 0.1)).norm(), 0.0, 1e-15);
  EXPECT_NEAR((after(Vec3(0.05, 0.0, 0.1)) - Vec3(0.05, 0.0, 0.1)).norm(), 0.0, 1e-15);
}

}  // namespace
}  // namespace repose
