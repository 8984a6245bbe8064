// Repose tests: what an emitter makes, particle by particle: counts and crossings agree, every layer of a
// column visits each of its sites once, a disc is filled evenly, and newcomers get what effects keep.
#include "engine/effect/emitter.h"
#include "engine/effect/effect.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <set>

namespace repose {
namespace {

Emitter disc(std::int64_t per_cell = 8) {
  Emitter emitter;
  emitter.name = "spout";
  emitter.center = Vec3(0.3, 0.2, -0.1);
  emitter.normal = Vec3(1, -2, 0.5);
  emitter.radius = 0.1;
  emitter.speed = 0.7;
  emitter.particles_per_cell = per_cell;
  return emitter;
}

TEST(Flow, CountAndCrossing_AgreeForEverySerial) {
  Emitter emitter = disc();
  emitter.start = 0.37;
  const Flow flow = flow_of(emitter, 0.013, -1);
  EXPECT_NEAR(flow.rate * flow.particle_volume, std::numbers::pi * 0.01 * 0.7, 1e-15);
  EXPECT_EQ(flow.count(0.0), 0u);
  EXPECT_EQ(flow.count(0.37), 0u);
  for (std::uint64_t serial = 0; serial < 5000; ++serial) {
    const double at = flow.crossing(serial);
    EXPECT_EQ(flow.count(at - 1e-9), serial);
    EXPECT_EQ(flow.count(at + 1e-9), serial + 1);
  }
}

TEST(Flow, Limits_WholeParticles) {
  Emitter emitter = disc();
  const Flow endless = flow_of(emitter, 0.01, -1);
  emitter.most_volume = 3 * endless.particle_volume;
  EXPECT_EQ(flow_of(emitter, 0.01, -1).count(100.0), 3u);
  emitter.most_volume *= 0.999;
  EXPECT_EQ(flow_of(emitter, 0.01, -1).count(100.0), 2u);
  emitter.most_particles = 1;
  EXPECT_EQ(flow_of(emitter, 0.01, -1).count(100.0), 1u);
  emitter = disc();
  emitter.end = 0.25;
  EXPECT_EQ(flow_of(emitter, 0.01, -1).count(100.0), endless.count(0.25));
}

TEST(Stream, Disc_IsFilledEvenlyLayerByLayer) {
  const Stream stream(disc(), nullptr, 0.02, -1);
  const std::uint64_t sites = stream.sites();
  EXPECT_EQ(sites, 18u * 18u);
  const Vec3 normal = disc().normal.normalized();
  double mean = 0.0;
  int quarter[4] = {};
  constexpr std::uint64_t kLayers = 40;
  for (std::uint64_t serial = 0; serial < kLayers * sites; ++serial) {
    const Stream::Birth birth = stream.birth(serial);
    const Vec3 from = birth.position - disc().center;
    EXPECT_NEAR(from.dot(normal), 0.0, 1e-12);
    EXPECT_LT(from.norm(), 0.1 + 1e-12);
    EXPECT_NEAR((birth.velocity - 0.7 * normal).norm(), 0.0, 1e-12);
    mean += from.squaredNorm() / static_cast<double>(kLayers * sites);
    ++quarter[static_cast<int>(4.0 * from.squaredNorm() / 0.01)];  // rings of equal area
  }
  EXPECT_NEAR(mean, 0.5 * 0.01, 0.5 * 0.01 * 0.01);
  for (const int n : quarter) EXPECT_NEAR(n, 0.25 * static_cast<double>(kLayers * sites), 0.03 * n);
}

TEST(Stream, Rectangle_EachLayerVisitsEachSiteOnceInItsOwnOrder) {
  Emitter emitter = disc();
  emitter.type = Emitter::Type::kRectangle;
  emitter.center = Vec3::Zero();
  emitter.normal = Vec3(0, 1, 0);
  emitter.direction = Vec3(1, 0, 0);
  emitter.half_width = 0.05;
  emitter.half_depth = 0.03;
  const Stream stream(emitter, nullptr, 0.02, -1);
  ASSERT_EQ(stream.sites(), 10u * 6u);
  std::vector<int> first;
  for (std::uint64_t layer = 0; layer < 5; ++layer) {
    std::set<int> visited;
    std::vector<int> order;
    for (std::uint64_t k = 0; k < 60; ++k) {
      const Vec3 x = stream.birth(layer * 60 + k).position;
      order.push_back(static_cast<int>(std::floor((x[0] + 0.05) / 0.01)) * 6 +
                      static_cast<int>(std::floor((x[2] + 0.03) / 0.01)));
      visited.insert(order.back());
    }
    EXPECT_EQ(visited.size(), 60u);
    EXPECT_EQ(*visited.begin(), 0);
    EXPECT_EQ(*visited.rbegin(), 59);
    EXPECT_NE(order, first);
    first = order;
  }
}

TEST(Stream, AskedInAnyOrder_TheSameParticles) {
  const Stream forth(disc(), nullptr, 0.02, -1), back(disc(), nullptr, 0.02, -1);
  std::vector<Vec3> places;
  for (std::uint64_t serial = 0; serial < 2000; ++serial) places.push_back(forth.birth(serial).position);
  for (std::uint64_t serial = 2000; serial-- > 0;) EXPECT_EQ(back.birth(serial).position, places[serial]);
  Emitter other = disc();
  other.seed = 2;
  EXPECT_NE(Stream(other, nullptr, 0.02, -1).birth(0).position, places[0]);
}

TEST(Stream, MouthBelowACell_HasASite) {
  Emitter emitter = disc(1);
  emitter.radius = 1e-4;
  const Stream stream(emitter, nullptr, 0.02, -1);
  EXPECT_EQ(stream.sites(), 1u);
  EXPECT_LT((stream.birth(17).position - emitter.center).norm(), 1.001e-4);
}

/// An emitter in a plan of its own, with one channel that somebody fills.
TEST(Emitters, Newcomers_AreMadeReadyAndCounted) {
  Emitters emitters;
  emitters.list = {disc()};
  Surroundings around;
  around.spacing = 0.02;
  const auto made_ready = emitters.make<float>(around);
  ASSERT_TRUE(made_ready);
  State<float> state;
  state.spacing = 0.02;
  state.sets.resize(1);
  state.sets[0].extra.push_back({"age", {}});
  state.sets[0].begin = {0};
  state.ledger.emitted = {0};
  StepPlan<float> plan;
  const std::vector<SetDescription> sets{{"spout", "sand", {}}};
  PlanBuilder<float> builder(plan, state, sets, [](Newcomers<float>& newcomers) {
    for (std::size_t p = newcomers.first; p < newcomers.last; ++p) {
      newcomers.set.extra[0].values[p] = static_cast<float>(newcomers.position(p)[0]);
    }
  });
  (*made_ready)->add_to(builder);
  ASSERT_EQ(plan.events.size(), 1u);
  const auto due = [&](double time, Moment moment) {
    state.counters.time = time;
    return plan.events[0].due(state, moment);
  };
  const double first = flow_of(disc(), 0.02, -1).crossing(0), cell = 0.02 / 0.7;
  EXPECT_FALSE(due(0.99 * first, Moment::kEndOfFrame)) << "nothing has crossed";
  EXPECT_TRUE(due(1.01 * first, Moment::kEndOfFrame));
  EXPECT_FALSE(due(first + 0.99 * cell, Moment::kBeforeStep)) << "the stream has not gone a cell";
  EXPECT_TRUE(due(first + 1.01 * cell, Moment::kBeforeStep));
  Threads threads(1);
  ParticleEdit<float> edit(state, threads);
  plan.events[0].run(state, edit);
  const SetEdit<float>& made = edit.sets[0];
  EXPECT_EQ(made.newcomers.count, flow_of(disc(), 0.02, -1).count(state.counters.time));
  EXPECT_EQ(state.ledger.emitted[0], made.newcomers.count);
  for (std::size_t p = 0; p < made.newcomers.count; ++p) {
    const float x = (static_cast<float>(made.cells[p][0]) + made.newcomers.position[0][p]) * 0.02f;
    EXPECT_NEAR(made.newcomers.extra[0].values[p], x, 1e-6);
  }
  EXPECT_FALSE(due(state.counters.time, Moment::kEndOfFrame)) << "all that has crossed is there";
}

TEST(Emitters, WhatCannotBe_IsRefused) {
  Surroundings around;
  around.spacing = 0.02;
  const auto refusal = [&around](const Emitter& emitter) {
    Emitters emitters;
    emitters.list = {emitter};
    const auto ready = emitters.make<float>(around);
    return ready ? "" : ready.error().text();
  };
  EXPECT_EQ(refusal(disc()), "");
  Emitter emitter = disc();
  emitter.speed = 0.0;
  EXPECT_EQ(refusal(emitter), "emitters.spout: needs a normal and a speed that are not zero");
  emitter = disc();
  emitter.center[0] = 1e9;
  EXPECT_EQ(refusal(emitter), "emitters.spout: reaches beyond 1e9 cells from the origin");
  emitter = disc();
  emitter.type = Emitter::Type::kVolume;
  EXPECT_EQ(refusal(emitter), "emitters.spout: makes no particles; is its size or its rate zero?");
  emitter.rate = 1.0;
  EXPECT_EQ(refusal(emitter), "");
  emitter.shape.type = ShapeDescription::Type::kPlane;
  EXPECT_TRUE(refusal(emitter).starts_with("emitters.spout.shape: is endless")) << refusal(emitter);
  around.flat_axis = 0;
  EXPECT_EQ(refusal(disc()), "emitters.spout: must not move along the flat axis (plane_strain)");
}

}  // namespace
}  // namespace repose
