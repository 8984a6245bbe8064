// Repose tests: Newton's method on problems of one to three unknowns whose solutions are known: that it
// converges as it should, keeps to where the residual is defined, takes one-sided constraints, and says how it
// ended.
#include "engine/solve/newton.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <functional>

namespace repose {
namespace {

/// r(v) = 0 with a dense derivative. Every evaluation is counted.
struct DenseProblem {
  using Vector = Eigen::VectorXd;
  struct Solved {
    int iterations = 1;
    bool good = true;
    bool usable() const { return good; }
  };

  std::function<std::optional<Vector>(const Vector&)> residual;
  std::function<Eigen::MatrixXd(const Vector&)> derivative;
  std::function<double(const Vector&, const Vector&, double)> longest;
  /// r and its derivative as a model near v has them; none: there is no such place.
  std::function<std::pair<Vector, Eigen::MatrixXd>(const Vector&)> model;
  bool energy = false;
  bool linear_solver_fails = false;
  double left_over = 0.0;                                   // share of the residual that linear solves leave
  double lower = -std::numeric_limits<double>::infinity();  // v[0] >= lower, pushed there by any force
  double against = 1.0;

  bool held = false;
  int evaluations = 0, modelled = 0;
  Vector evaluated, r;
  Vector left;  // r of the linear system
  Eigen::MatrixXd a;

  std::optional<double> evaluate(const Vector& v) {
    ++evaluations;
    evaluated = v;
    const auto found = residual(v);
    if (!found) return std::nullopt;
    r = *found;
    if (held) r[0] = 0.0;
    return r.norm();
  }
  double scale() const { return against; }
  bool has_energy() const { return energy; }
  double slope(const Vector& step) const { return r.dot(step); }
  bool change_contacts(Vector& v, double least) {
    const double wrong = held ? std::max(0.0, -(*residual(v))[0]) : std::max(0.0, lower - v[0]);
    if (wrong <= least) return false;
    const bool hold = held ? (*residual(v))[0] >= 0.0 : v[0] < lower;
    if (hold == held) return false;
    held = hold;
    if (held) v[0] = lower;
    return true;
  }
  bool models() const { return static_cast<bool>(model); }
  bool tightens() const { return true; }
  double linearize(const Vector& v, bool near) {
    left = r;
    a = derivative(evaluated);
    if (near && model) {
      ++modelled;
      std::tie(left, a) = model(v);
    }
    return left.norm();
  }
  Solved solve(double, Vector& step) {
    if (held) {
      a.row(0).setZero();
      a.col(0).setZero();
      a(0, 0) = 1.0;
    }
    step = -(1.0 - left_over) * a.fullPivLu().solve(left);
    return {1, !linear_solver_fails};
  }
  double longest_step(const Vector& step, double length) { return longest(evaluated, step, length); }
  static void take(const Vector& v, double length, const Vector& step, Vector& to) { to = v + length * step; }
};

struct Outcome {
  NewtonReport report;
  Eigen::VectorXd v;
};

Outcome solve_from(DenseProblem& problem, Eigen::VectorXd v, double tolerance, int iterations = 40) {
  Eigen::VectorXd step(v.size()), trial(v.size());
  NewtonStop stop;
  stop.tolerance = tolerance;
  stop.iterations = iterations;
  const std::optional<double> norm = problem.evaluate(v);
  NewtonReport report = Newton<DenseProblem>(problem, v, step, trial, stop).solve(norm);
  return {report, v};
}

Eigen::VectorXd vector1(double x) {
  return Eigen::VectorXd::Constant(1, x);
}
Eigen::MatrixXd matrix1(double x) {
  return Eigen::MatrixXd::Constant(1, 1, x);
}

TEST(Newton, OfSmoothEquations_ConvergesQuadratically) {
  DenseProblem problem;  // a circle and a parabola
  problem.residual = [](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(Eigen::Vector2d(v[0] * v[0] + v[1] * v[1] - 2.0, v[1] - v[0] * v[0]));
  };
  problem.derivative = [](const Eigen::VectorXd& v) {
    return Eigen::MatrixXd{{2.0 * v[0], 2.0 * v[1]}, {-2.0 * v[0], 1.0}};
  };
  const Outcome run = solve_from(problem, Eigen::Vector2d(2.0, 0.5), 1e-12);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_LT((run.v - Eigen::Vector2d(1.0, 1.0)).norm(), 1e-12);
  EXPECT_LE(run.report.iterations, 6);
  const auto& history = run.report.history;
  ASSERT_EQ(history.size(), static_cast<std::size_t>(run.report.iterations) + 1);
  for (std::size_t k = 0; k + 1 < history.size(); ++k) {
    if (history[k] < 0.1) {
      EXPECT_LT(history[k + 1], 2.0 * history[k] * history[k] + 1e-14);
    }
  }
}

TEST(Newton, OfARightFirstGuess_TakesNoIteration) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return v; };
  const Outcome run = solve_from(problem, vector1(0.0), 1e-6);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(run.report.iterations, 0);
  EXPECT_EQ(problem.evaluations, 1);
}

// atan: full steps from beyond 1.39 lead ever farther away.
TEST(Newton, ThatWouldOvershoot_ShortensItsSteps) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return vector1(std::atan(v[0])); };
  problem.derivative = [](const Eigen::VectorXd& v) { return matrix1(1.0 / (1.0 + v[0] * v[0])); };
  const Outcome run = solve_from(problem, vector1(10.0), 1e-10);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_NEAR(run.v[0], 0.0, 1e-10);
  EXPECT_GT(run.report.shortened, 0);
  for (std::size_t k = 0; k + 1 < run.report.history.size(); ++k) {
    EXPECT_LT(run.report.history[k + 1], run.report.history[k]);
  }
}

// log v has no value below zero, where the full step from 10 leads: 10 - 10 log 10 = -13.
TEST(Newton, ThatWouldLeaveWhereTheResidualIsDefined_GoesAsFarAsItReaches) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) {
    return v[0] > 0.0 ? std::optional(vector1(std::log(v[0]))) : std::nullopt;
  };
  problem.derivative = [](const Eigen::VectorXd& v) { return matrix1(1.0 / v[0]); };
  int asked = 0;
  problem.longest = [&asked](const Eigen::VectorXd& v, const Eigen::VectorXd& step, double length) {
    ++asked;
    return length - v[0] / step[0];
  };
  const Outcome run = solve_from(problem, vector1(10.0), 1e-10);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_NEAR(run.v[0], 1.0, 1e-9);
  EXPECT_GT(asked, 0);
}

TEST(Newton, WithoutAValueAtTheStart_SaysSo) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd&) { return std::nullopt; };
  EXPECT_EQ(solve_from(problem, vector1(1.0), 1e-6).report.end, NewtonEnd::kUndefined);
}

// E = (x^2 + 100 y^2) / 2, with a tangent that is not its own: the first step leads from (1, 0) to (0, 1/20),
// where E is a quarter of what it was and |r| five times as much.
TEST(Newton, WithAnEnergy_GoesWhereOnlyTheEnergyFalls) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(Eigen::Vector2d(v[0], 100.0 * v[1]));
  };
  problem.derivative = [](const Eigen::VectorXd&) {
    return Eigen::MatrixXd(Eigen::Matrix2d{{1.0, -0.05}, {-0.05, 0.01}}.inverse());
  };
  problem.energy = true;
  const Outcome with = solve_from(problem, Eigen::Vector2d(1.0, 0.0), 1e-10);
  EXPECT_EQ(with.report.end, NewtonEnd::kConverged);
  EXPECT_LT(with.v.norm(), 1e-9);
  EXPECT_NEAR(with.report.history[1], 5.0, 1e-12);

  problem.energy = false;
  const auto without = solve_from(problem, Eigen::Vector2d(1.0, 0.0), 1e-10).report.history;
  for (std::size_t k = 0; k + 1 < without.size(); ++k) EXPECT_LT(without[k + 1], without[k]);
}

// A body that meets a wall of stiffness 1e6 at 0: seen from -1 there is no wall, and a step from there has to
// be shortened to a millionth. A model that foresees the wall needs one step.
TEST(Newton, WithAModelNearV_StepsAlongIt) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return vector1(v[0] - 1.0 + 1e6 * std::max(v[0], 0.0)); };
  problem.derivative = [](const Eigen::VectorXd& v) { return matrix1(v[0] > 0.0 ? 1e6 + 1.0 : 1.0); };
  const Outcome without = solve_from(problem, vector1(-1.0), 1e-9);
  EXPECT_GT(without.report.shortened, 5);
  problem.model = [](const Eigen::VectorXd& v) {
    return std::pair(vector1(v[0] - 1.0 + 1e6 * v[0]), matrix1(1e6 + 1.0));
  };
  const Outcome run = solve_from(problem, vector1(-1.0), 1e-9);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(run.report.iterations, 1);
  EXPECT_EQ(run.report.shortened, 0);
  EXPECT_NEAR(run.v[0], 1e-6, 1e-11);
}

// A model may be as wrong as it likes: from where |r| would rise along it, steps are those at v.
TEST(Newton, WithAModelThatLeadsAstray_GoesOnAtV) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return v; };
  problem.derivative = [](const Eigen::VectorXd&) { return matrix1(1.0); };
  problem.model = [](const Eigen::VectorXd& v) { return std::pair(v, matrix1(-0.1)); };
  problem.left_over = 0.5;
  const Outcome run = solve_from(problem, vector1(1.0), 0.2);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(problem.modelled, 1);
  EXPECT_EQ(run.report.iterations, 4);  // one astray, then 1/2, 1/4, 1/8
  EXPECT_EQ(run.report.shortened, 3);
  EXPECT_DOUBLE_EQ(run.v[0], 0.125);
  EXPECT_EQ(problem.evaluated[0], run.v[0]);
}

// So it is with a model that no linear solver gets anywhere with.
TEST(Newton, WithAModelThatIsNotSolved_GoesOnAtV) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return v; };
  problem.derivative = [&problem](const Eigen::VectorXd&) {
    problem.linear_solver_fails = problem.modelled == 0;
    return matrix1(1.0);
  };
  problem.model = [](const Eigen::VectorXd& v) { return std::pair(v, matrix1(-1.0)); };
  const Outcome run = solve_from(problem, vector1(1.0), 1e-9);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(run.report.iterations, 2);
}

TEST(Newton, WithAOneSidedConstraint_HoldsWhatWouldPassIt) {
  DenseProblem problem;  // pushed to -1, but not below 0.25; the other goes with it
  problem.residual = [](const Eigen::VectorXd& v) {
    return Eigen::VectorXd(Eigen::Vector2d(v[0] + 1.0, v[1] - 2.0 * v[0]));
  };
  problem.derivative = [](const Eigen::VectorXd&) { return Eigen::MatrixXd{{1.0, 0.0}, {-2.0, 1.0}}; };
  problem.lower = 0.25;
  const Outcome run = solve_from(problem, Eigen::Vector2d(1.0, 1.0), 1e-12);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(run.report.contact_changes, 1);
  EXPECT_DOUBLE_EQ(run.v[0], 0.25);
  EXPECT_NEAR(run.v[1], 0.5, 1e-12);
}

// Held at 0.25 by the guess, where nothing is left of the residual, though it is pulled away to 2.
TEST(Newton, WithAGuessThatIsHeldByAContactThatPulls_LetsItGo) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return vector1(v[0] - 2.0); };
  problem.derivative = [](const Eigen::VectorXd&) { return matrix1(1.0); };
  problem.lower = 0.25;
  problem.held = true;
  const Outcome run = solve_from(problem, vector1(0.25), 1e-12);
  EXPECT_EQ(run.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(run.report.contact_changes, 1);
  EXPECT_NEAR(run.v[0], 2.0, 1e-12);
}

// Pushed to -1; where it would pass its bound in the second half of the iterations, with all else solved.
TEST(Newton, WithAContactThatIsWrongAtTheEnd_GoesOnUnlessItIsWithinTheTolerance) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return vector1(v[0] + 1.0); };
  problem.derivative = [](const Eigen::VectorXd&) { return matrix1(1.0); };
  problem.left_over = 0.1;  // -0.8, then -0.98
  problem.lower = -0.9;
  const Outcome wrong = solve_from(problem, vector1(1.0), 0.03, 3);
  EXPECT_EQ(wrong.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(wrong.report.contact_changes, 1);
  EXPECT_DOUBLE_EQ(wrong.v[0], -0.9);
  problem.held = false;
  problem.lower = -0.96;
  const Outcome little = solve_from(problem, vector1(1.0), 0.03, 3);
  EXPECT_EQ(little.report.end, NewtonEnd::kConverged);
  EXPECT_EQ(little.report.contact_changes, 0);
  EXPECT_NEAR(little.v[0], -0.98, 1e-12);
}

// The cap, a solver that gives up, and a residual that no length lowers are told apart.
TEST(Newton, ThatCannotGoOn_SaysWhy) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) { return v; };
  problem.derivative = [](const Eigen::VectorXd&) { return matrix1(1.0); };
  problem.left_over = 0.5;
  EXPECT_EQ(solve_from(problem, vector1(1.0), 1e-12, 5).report.end, NewtonEnd::kIterations);
  problem.linear_solver_fails = true;
  EXPECT_EQ(solve_from(problem, vector1(1.0), 1e-12).report.end, NewtonEnd::kUnsolved);
  problem.linear_solver_fails = false;
  problem.residual = [](const Eigen::VectorXd& v) { return vector1(1.0 + v[0] * v[0]); };
  EXPECT_EQ(solve_from(problem, vector1(0.0), 1e-12).report.end, NewtonEnd::kNoDescent);
}

// A residual that rounding keeps at three tolerances is as good as it gets. What belongs to the v that is
// handed back must be known, not what belongs to the last length that was refused.
TEST(Newton, ThatRoundingStops_EvaluatesWhatItHandsBackLast) {
  DenseProblem problem;
  problem.residual = [](const Eigen::VectorXd& v) {
    return vector1(std::max(v[0], 3e-6 + 1e-3 * std::abs(v[0])));
  };
  problem.derivative = [](const Eigen::VectorXd&) { return matrix1(1.0); };
  const Outcome run = solve_from(problem, vector1(1.0), 1e-6);
  EXPECT_EQ(run.report.end, NewtonEnd::kStalled);
  EXPECT_GT(run.report.last, run.report.tolerance);
  EXPECT_LE(run.report.last, 10.0 * run.report.tolerance);
  EXPECT_GE(run.report.shortened, 12);
  EXPECT_EQ(problem.evaluated[0], run.v[0]);
}

}  // namespace
}  // namespace repose
