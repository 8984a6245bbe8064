// Repose tests: each figure of merit on an input whose figure is known.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "engine/study/heap.h"
#include "engine/study/series.h"
#include "tests/study/study_rig.h"

namespace repose {
namespace {

using std::numbers::pi;
using ::testing::HasSubstr;

Heap plane() {
  Heap heap;
  heap.form = Heap::Form::kPlane;
  return heap;
}

/// A wedge 1.5 m high and 3 m long.
double wedge(double x) {
  return std::max(0.0, 1.5 - 0.5 * x);
}

TEST(RunOut, Wedge_EndsWhereItIsHalfACellHigh) {
  RunOut figure;
  figure.heap = plane();
  const RunRecord record = strips(wedge, 60);
  // 1.5 - x / 2 = 0.05 at 2.9; where the wedge ends, at 3, the mean of three strips is a little more than it.
  EXPECT_NEAR(figure.measure(record).value, 2.91, 1e-5);
  figure.cover = 0.2;
  EXPECT_NEAR(figure.measure(record).value, 2.6, 1e-5);
  figure.start = 1.3;
  EXPECT_NEAR(figure.measure(record).value, 1.0, 1e-5);
  EXPECT_EQ(figure.unit(), "");
}

TEST(RunOut, OriginAndDirection_CountFromThere) {
  RunOut figure;
  figure.heap = plane();
  figure.heap.origin = {4.0, 7.0, 0.0};
  figure.heap.direction = {-2.0, 0.0, 0.0};
  RunRecord record = strips(wedge, 60);
  for (auto& position : record.end.position) position[0] = 4.0 - position[0];
  EXPECT_NEAR(figure.measure(record).value, 2.91, 1e-5);
}

TEST(RunOut, Cone_EndsWhereItIsHalfACellHigh) {
  RunRecord record;
  record.spacing = 0.1;
  for (std::size_t k = 0; k < 40; ++k) {
    const double r = 0.1 * (static_cast<double>(k) + 0.5);
    if (wedge(r) > 0.0) add_particle(record.end, {0.6 * r, 0.0, 0.8 * r}, wedge(r) * ring_area(k, 0.1));
  }
  // Rings farther out weigh more in a mean of three, so that its height is that of a place a little farther
  // out.
  EXPECT_NEAR(RunOut().measure(record).value, 2.9, 0.01);
}

TEST(RunOut, StrayGrain_MovesNothing) {
  RunOut figure;
  figure.heap = plane();
  RunRecord record = strips(wedge, 60);
  const double before = figure.measure(record).value;
  add_particle(record.end, {5.0, 0.0, 0.0}, 1.25e-4);  // an eighth of a cell
  EXPECT_EQ(figure.measure(record).value, before);
  add_particle(record.end, {5.0, 0.0, 0.0}, 2e-3);  // two cells are no grain
  EXPECT_GT(figure.measure(record).value, before + 1.0);
}

TEST(RunOut, PlaneHeapOfUnknownDepth_HasNone) {
  RunOut figure;
  figure.heap = plane();
  RunRecord record = strips(wedge, 60);
  record.flat = -1;
  EXPECT_THAT(figure.measure(record).why, HasSubstr("depth"));
  record.period = {0.0, 0.0, 0.1};
  EXPECT_NEAR(figure.measure(record).value, 2.91, 1e-5);
}

TEST(HeapProfile, Wedge_IsItself) {
  HeapProfile figure;
  figure.heap = plane();
  const FigureValue value = figure.measure(strips(wedge, 60));
  ASSERT_EQ(value.curve.x.size(), 30u);
  for (std::size_t k = 0; k < 30; ++k) EXPECT_NEAR(value.curve.y[k], wedge(value.curve.x[k]), 1e-5);
  EXPECT_NEAR(value.value, wedge(0.05), 1e-5);
}

TEST(Curves, ApartInSharesOfTheOther) {
  const Curve one{{0.0, 1.0, 2.0}, {2.0, 2.0, 2.0}}, higher{{0.0, 1.0, 2.0}, {2.5, 2.5, 2.5}};
  EXPECT_NEAR(apart(higher, one).mean, 0.25, 1e-12);
  EXPECT_NEAR(apart(higher, one).largest, 0.25, 1e-12);
  EXPECT_EQ(apart(one, one).mean, 0.0);
  const Curve shorter{{0.0, 1.0}, {2.0, 2.0}};
  EXPECT_NEAR(apart(shorter, one).largest, 1.0, 1e-12) << "beyond its end there is nothing";
  EXPECT_NEAR(one.at(0.5), 2.0, 1e-12);
  EXPECT_EQ(one.at(2.1), 0.0);
}

TEST(Angle, Wedge_HasItsSlope) {
  Angle figure;
  figure.heap = plane();
  EXPECT_NEAR(figure.measure(strips(wedge, 60)).value, std::atan(0.5) * 180.0 / pi, 1e-3);
  // The foot and the top are left out.
  const auto rounded = [](double x) { return x < 0.6 ? 1.2 : x > 2.6 ? 0.2 : wedge(x); };
  EXPECT_NEAR(figure.measure(strips(rounded, 40)).value, std::atan(0.5) * 180.0 / pi, 1e-3);
}

TEST(CenterOfMass, IsThatOfTheEnd) {
  RunRecord record = series([](double) { return 0.0; }, 1.0, 3);
  for (std::size_t k = 0; k < 3; ++k)
    record.moments[k].center_of_mass = {1.0, 5.0 - static_cast<double>(k), 2.0};
  const FigureValue value = CenterOfMass().measure(record);
  EXPECT_EQ(value.value, 3.0);
  EXPECT_EQ(value.curve.y.front(), 5.0);
}

TEST(EnergyResidual, CountsGainsOrAllChange) {
  RunRecord record = series([](double) { return 0.0; }, 1.0, 4);
  const double potential[] = {10.0, 6.0, 2.0, 2.0}, kinetic[] = {0.0, 3.0, 4.0, 5.0};  // sums 10, 9, 6, 7
  for (std::size_t k = 0; k < 4; ++k) {
    record.moments[k].potential = potential[k];
    record.moments[k].kinetic = kinetic[k];
  }
  EnergyResidual figure;
  EXPECT_NEAR(figure.measure(record).value, 1.0 / 13.0, 1e-12) << "7 after 6, over 5 + 8";
  figure.counts = EnergyResidual::Counts::kChange;
  EXPECT_NEAR(figure.measure(record).value, 4.0 / 13.0, 1e-12);
  // What solids did is taken off.
  for (RunMoment& moment : record.moments) moment.measured = {{"all", "work_of_solids", "J", -1.0}};
  figure.probe = "all";
  EXPECT_NEAR(figure.measure(record).value, 2.0 / 13.0, 1e-12) << "10, 10, 8, 10";
}

TEST(Period, OfADampedSwing_IsItsOwn) {
  const auto swing = [](double t) {
    return 3.0 + 0.5 * std::exp(-0.05 * t) * std::sin(2.0 * pi * t / 1.7 + 0.3);
  };
  Period figure;
  figure.of = "probe.value";
  figure.level = 3.0;
  EXPECT_NEAR(figure.measure(series(swing, 0.02, 800)).value, 1.7, 1e-4);
  figure.level = 9.0;
  EXPECT_THAT(figure.measure(series(swing, 0.02, 800)).why, HasSubstr("level"));
}

TEST(Swings, Heights_LieBetweenSamples) {
  const auto swing = [](double t) { return 3.0 + 0.5 * std::sin(2.0 * pi * t / 1.7 + 0.3); };
  const auto all = swings(series_of(series(swing, 0.17, 100), "probe.value"), 3.0);  // ten to a period
  ASSERT_GT(all.size(), 10u);
  for (const Swing& each : all) EXPECT_NEAR(each.height, 0.5, 0.002) << "the samples alone reach 0.476";
}

TEST(Damping, IsTheShareLostInAPeriod) {
  const double rate = 0.05, period = 1.7;
  const auto swing = [&](double t) {
    return 3.0 + 0.5 * std::exp(-rate * t) * std::sin(2.0 * pi * t / period + 0.3);
  };
  Damping figure;
  figure.of = "probe.value";
  figure.level = 3.0;
  EXPECT_NEAR(figure.measure(series(swing, 0.02, 800)).value, 1.0 - std::exp(-rate * period), 1e-5);
  const auto lasting = [&](double t) { return 3.0 + 0.5 * std::sin(2.0 * pi * t / period); };
  EXPECT_NEAR(figure.measure(series(lasting, 0.02, 800)).value, 0.0, 1e-5);
}

/// Frames that end at 1, 2 and 4 s.
RunRecord three_frames(const std::vector<std::string>& quantities,
                       const std::vector<std::vector<double>>& values) {
  RunRecord record;
  const double times[] = {0.0, 1.0, 2.0, 4.0};
  for (std::size_t k = 0; k < 4; ++k) {
    RunMoment moment;
    moment.time = times[k];
    for (std::size_t q = 0; q < quantities.size(); ++q)
      moment.measured.push_back({"gate", quantities[q], "", values[q][k]});
    record.moments.push_back(moment);
  }
  return record;
}

TEST(SolidForce, IsTheMeanOverTime) {
  SolidForce figure;
  figure.probe = "gate";
  const RunRecord record = three_frames({"force.y"}, {{100.0, 2.0, 4.0, 6.0}});
  EXPECT_NEAR(figure.measure(record).value, (2.0 + 4.0 + 2.0 * 6.0) / 4.0, 1e-12);
  figure.from = 1.0;
  EXPECT_NEAR(figure.measure(record).value, 16.0 / 3.0, 1e-12);
  figure.to = 2.0;
  EXPECT_NEAR(figure.measure(record).value, 4.0, 1e-12);
  figure.from = 3.0;
  figure.to = 3.5;
  EXPECT_FALSE(figure.measure(record).there());
}

TEST(SolidImpulse, IsTheSumOfFrames) {
  SolidImpulse figure;
  figure.probe = "gate";
  figure.axis = 0;
  const FigureValue value = figure.measure(three_frames({"impulse.x"}, {{100.0, 2.0, 4.0, 6.0}}));
  EXPECT_NEAR(value.value, 12.0, 1e-12);
  EXPECT_EQ(value.curve.y, (std::vector<double>{0.0, 2.0, 6.0, 12.0}));
}

TEST(FlowRate, IsForthLessBackOverTime) {
  FlowRate figure;
  figure.probe = "gate";
  const RunRecord record =
      three_frames({"mass_forth", "mass_back"}, {{0.0, 5.0, 5.0, 8.0}, {0.0, 1.0, 0.0, 1.0}});
  EXPECT_NEAR(figure.measure(record).value, (18.0 - 2.0) / 4.0, 1e-12);
  figure.from = 2.0;
  EXPECT_NEAR(figure.measure(record).value, 7.0 / 2.0, 1e-12);
}

/// 8 x 8 x 8 cells of 0.1 m with 8 particles each, whose volume is `share` of what fills the cell.
RunRecord block(const std::function<double(int, int, int)>& share) {
  RunRecord record;
  record.spacing = 0.1;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      for (int k = 0; k < 16; ++k)
        add_particle(record.end, {0.05 * (i + 0.5), 0.05 * (j + 0.5), 0.05 * (k + 0.5)},
                     1.25e-4 * share(i / 4, j / 4, k / 4));
    }
  }
  return record;
}

TEST(DensityError, IsTheMeanDistanceFromSeededDensity) {
  DensityError figure;
  EXPECT_NEAR(figure.measure(block([](int, int, int) { return 1.0; })).value, 0.0, 1e-5);
  EXPECT_NEAR(figure.measure(block([](int, int, int) { return 1.1; })).value, 0.1, 1e-5);
  // Of the 2 x 2 x 2 cells of 0.2 m that lie within, half are off by 0.2.
  const auto half = [](int i, int, int) { return i == 1 ? 1.2 : 1.0; };
  EXPECT_NEAR(figure.measure(block(half)).value, 0.2 * std::sqrt(0.5), 1e-5);
  const auto surface = [](int i, int j, int k) { return i % 3 == 0 || j % 3 == 0 || k % 3 == 0 ? 0.7 : 1.0; };
  EXPECT_NEAR(figure.measure(block(surface)).value, 0.0, 1e-5) << "surfaces do not count";
  const auto spray = [](int i, int j, int k) { return i % 3 == 0 || j % 3 == 0 || k % 3 == 0 ? 0.3 : 1.0; };
  EXPECT_FALSE(figure.measure(block(spray)).there()) << "nor do cells beside what is less than half full";
}

TEST(Marginal, OfAShiftedHeap_IsTheShift) {
  RunRecord record = block([](int, int, int) { return 1.0; });
  record.start = record.end;
  for (auto& position : record.end.position) position[1] += 0.3;
  Marginal figure;
  const FigureValue value = figure.measure(record);
  EXPECT_NEAR(value.value, 0.3, 0.002) << "quantiles go from 1/400 to 399/400";
  figure.along = 0;
  EXPECT_NEAR(figure.measure(record).value, 0.0, 1e-12);
  // Half of the matter moves: so does half of the mass.
  record.end = record.start;
  for (auto& position : record.end.position) position[0] += position[0] > 0.4 ? 0.2 : 0.0;
  EXPECT_NEAR(figure.measure(record).value, 0.1, 0.002);
}

TEST(Marginal, TwoRuns_AreComparedByTheWayOfMass) {
  RunRecord record = block([](int, int, int) { return 1.0; });
  record.start = record.end;
  const auto moved = [&](double way) {
    RunRecord other = record;
    for (auto& position : other.end.position) position[1] += way;
    return Marginal().measure(other);
  };
  EXPECT_NEAR(error_of(Compares::kQuantiles, moved(0.44), moved(0.4)).value, 0.1, 1e-3) << "0.04 of 0.4 m";
}

TEST(ManufacturedError, IsTheDistanceFromTheExactPlace) {
  RunRecord record = block([](int, int, int) { return 1.0; });
  EXPECT_THAT(ManufacturedError().measure(record).why, HasSubstr("manufactured"));
  for (const auto& position : record.end.position) record.expected.push_back(position);
  EXPECT_EQ(ManufacturedError().measure(record).value, 0.0);
  for (auto& position : record.end.position) position = {position[0] + 0.3, position[1], position[2] - 0.4};
  EXPECT_NEAR(ManufacturedError().measure(record).value, 0.5, 1e-12);
  record.period = {0.3, 0.0, 0.0};
  EXPECT_NEAR(ManufacturedError().measure(record).value, 0.4, 1e-12) << "a period in x is no way";
  record.flat = 2;
  EXPECT_NEAR(ManufacturedError().measure(record).value, 0.0, 1e-12) << "nor is what lies across the plane";
}

TEST(Errors, AreSharesOfTheReferenceOrThemselves) {
  const FigureValue run{1.1, "", {}}, reference{1.0, "", {}};
  EXPECT_NEAR(error_of(Compares::kValue, run, reference).value, 0.1, 1e-12);
  EXPECT_NEAR(error_of(Compares::kValue, {-0.9, "", {}}, {-1.0, "", {}}).value, 0.1, 1e-12);
  EXPECT_NEAR(error_of(Compares::kValue, run, {0.0, "", {}}).value, 1.1, 1e-12)
      << "of nothing there is no share";
  EXPECT_NEAR(error_of(Compares::kItself, {-0.02, "", {}}, {}).value, 0.02, 1e-12);
  EXPECT_TRUE(std::isnan(error_of(Compares::kValue, FigureValue::none("gone"), reference).value));
  EXPECT_TRUE(std::isnan(error_of(Compares::kValue, run, FigureValue::none("gone")).value));
}

TEST(Figures, EachHasANameOfItsOwnAndAUnit) {
  std::vector<std::string> names;
  const auto add = [&]<std::size_t... k>(std::index_sequence<k...>) {
    (names.emplace_back(std::variant_alternative_t<k, FigureKind>::kName), ...);
  };
  add(std::make_index_sequence<std::variant_size_v<FigureKind>>());
  for (std::size_t k = 0; k < names.size(); ++k)
    EXPECT_EQ(std::count(names.begin(), names.end(), names[k]), 1) << names[k];
}

/// A run that left nothing must not become a number.
TEST(Figures, OfAnEmptyRun_SayWhyThereIsNone) {
  const auto each = [&]<std::size_t... k>(std::index_sequence<k...>) {
    const auto check = [](const Figure& figure) {
      const FigureValue value = figure.measure(RunRecord());
      EXPECT_FALSE(value.there()) << figure.type() << " is " << value.value;
      EXPECT_FALSE(value.why.empty());
    };
    (check({"", std::variant_alternative_t<k, FigureKind>()}), ...);
  };
  each(std::make_index_sequence<std::variant_size_v<FigureKind>>());
}

}  // namespace
}  // namespace repose
