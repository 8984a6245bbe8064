// Repose tests: how Krylov solvers end where they do not converge, and the ladder of a solve.
#include "tests/engine/solve/krylov_rig.h"

namespace repose {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using System = DenseSystem<double>;

TEST(Krylov, SingularSymmetricSystem_StopsAtLeastNormAndSaysSo) {
  Dice dice(7);
  for (const int n : {2, 5, 30, 60}) {
    for (const int flip : {0, 3}) {
      VectorXd eigenvalues = spectrum(n, 100.0, flip);
      eigenvalues[n / 3] = 0.0;
      const MatrixXd a = dice.symmetric(eigenvalues);
      const MatrixXd p = dice.weights(n, 3.0);
      const VectorXd b = dice.vector(n);
      const MatrixXd root = p.cwiseSqrt();
      Eigen::CompleteOrthogonalDecomposition<MatrixXd> factors(root * a);
      factors.setThreshold(1e-12);
      const double least = (root * (b - a * factors.solve(root * b))).norm();
      System system(a, p);
      with_symmetric_solvers(system, n, [&](const char* name, auto& solver) {
        const Outcome outcome = solve_with(solver, system, b, {.relative = 1e-12, .iterations = 2000});
        EXPECT_EQ(outcome.report.status, SolveStatus::kSingular) << name << " n " << n << " flip " << flip;
        EXPECT_NEAR(outcome.report.final_norm / least, 1.0, 1e-9) << name << " n " << n << " flip " << flip;
        EXPECT_LT(outcome.x.norm(), 100.0 * b.norm()) << name << ": lost in the null space";
      });
    }
  }
}

TEST(GeneralizedConjugateResidual, SingularNonsymmetricSystem_EndsAndSaysSo) {
  Dice dice(8);
  for (const int n : {2, 5, 30, 60}) {
    MatrixXd a = nonsymmetric(dice, n, 1.0);
    const VectorXd gone = dice.vector(n).normalized();
    a -= (a * gone) * gone.transpose();  // A gone = 0, but no row of zeros
    System system(a, dice.weights(n, 1.5));
    for (const int directions : {n, 5}) {
      GeneralizedConjugateResidual<System> solver(system, directions);
      const Outcome outcome =
          solve_with(solver, system, dice.vector(n), {.relative = 1e-12, .iterations = 500});
      EXPECT_FALSE(outcome.report.converged());
      EXPECT_LE(outcome.report.iterations, 500);
      EXPECT_GT(outcome.report.final_norm, 1e-6 * outcome.report.initial_norm);
    }
  }
}

TEST(GeneralizedConjugateResidual, WhereNoDirectionOfTheResidualLeadsOn_SolvesAllTheSame) {
  // r^T A r = 0 for every r: each direction made of a residual leads nowhere.
  Dice dice(16);
  for (const int n : {2, 10, 30}) {
    const MatrixXd any = dice.square(n);
    const MatrixXd a = any - any.transpose();
    const VectorXd b = dice.vector(n);
    System system(a);
    GeneralizedConjugateResidual<System> solver(system, n);
    const Outcome outcome = solve_with(solver, system, b, {.relative = 1e-11, .iterations = 500});
    EXPECT_TRUE(outcome.report.converged()) << n << " " << status_name(outcome.report.status);
    EXPECT_LT((outcome.x - a.partialPivLu().solve(b)).norm() / outcome.x.norm(), 1e-9) << n;
  }
}

TEST(LinearSolve, OfGeneralizedConjugateResidual_ShiftsWhatIsSingular) {
  System system(VectorXd{{0, -0.1, 2}}.asDiagonal().toDenseMatrix());
  using General = GeneralizedConjugateResidual<System>;
  LinearSolve<System, General> ladder(system, General(system, 4));
  const Outcome outcome = solve_with(ladder, system, VectorXd{{1, 1, 1}}, {.relative = 1e-12});
  EXPECT_TRUE(outcome.report.converged()) << status_name(outcome.report.status);
  EXPECT_EQ(outcome.report.rung, SolveRung::kShifted);
  EXPECT_LT((outcome.x - VectorXd{{1, 1 / 0.9, 1 / 3.0}}).norm(), 1e-11);
  EXPECT_EQ(system.delta, 0.0);
}

TEST(LinearSolve, BreakdownWithEnoughDone_IsAnEnd) {
  System system(VectorXd{{0, 1, 2}}.asDiagonal().toDenseMatrix());
  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, VectorXd{{0.3, 1, 1}}, {.relative = 1e-12, .enough = 0.5});
  EXPECT_EQ(outcome.report.status, SolveStatus::kSingular);
  EXPECT_EQ(outcome.report.rung, SolveRung::kRestarted);
  EXPECT_LT((outcome.x.tail(2) - VectorXd{{1, 0.5}}).norm(), 1e-9);
}

TEST(Krylov, PreconditionerNotDefinite_BreaksDown) {
  System system(MatrixXd::Identity(3, 3), -MatrixXd::Identity(3, 3));
  with_symmetric_solvers(system, 3, [&](const char* name, auto& solver) {
    System::Vector x(VectorXd::Zero(3));
    EXPECT_EQ(solver.solve(system, System::Vector(VectorXd::Ones(3)), x, {}).status, SolveStatus::kBrokeDown)
        << name;
  });
}

TEST(Krylov, SinglePrecision_ConvergesOrStagnates) {
  using Floats = DenseSystem<float>;
  Dice dice(11);
  for (const int flip : {0, 3}) {
    Floats system(dice.symmetric(spectrum(40, 50.0, flip)), dice.weights(40, 2.0));
    const VectorXd b = dice.vector(40);
    with_symmetric_solvers(system, 40, [&](const char* name, auto& solver) {
      const Outcome coarse = solve_with(solver, system, b, {.relative = 1e-4, .iterations = 1000});
      EXPECT_TRUE(coarse.report.converged()) << name << ' ' << flip;
      for (const double beyond : {1e-9, 0.0}) {
        const Outcome fine = solve_with(solver, system, b, {.relative = beyond, .iterations = 100000});
        EXPECT_EQ(fine.report.status, SolveStatus::kStagnated) << name << ' ' << flip;
        EXPECT_LT(fine.report.final_norm / fine.report.initial_norm, 1e-5) << name << ' ' << flip;
        EXPECT_LT(fine.report.iterations, 5000) << name << ' ' << flip;
      }
    });
  }
}

TEST(Krylov, NotFinite_StopsAtOnce) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  Dice dice(12);
  const VectorXd b = dice.vector(10);
  for (const double bad : {kNan, kInfinity}) {
    VectorXd bad_b = b;
    bad_b[3] = bad;
    System system(dice.symmetric(spectrum(10, 10.0)));
    LinearSolve<System> ladder(system);
    EXPECT_EQ(solve_with(ladder, system, bad_b, {.relative = 1e-12}).report.status, SolveStatus::kNotFinite);
    EXPECT_EQ(solve_with(ladder, system, b, {.relative = 1e-12}, bad_b).report.status, SolveStatus::kNotFinite);
    EXPECT_LE(system.products, 1);
    with_symmetric_solvers(system, 4, [&](const char* name, auto& solver) {
      system.fault = [&](int product, const System::Vector&, System::Vector& y) {
        if (product == 3) y.values[7] = bad;
      };
      system.products = 0;
      const Outcome outcome = solve_with(solver, system, b, {.relative = 1e-12});
      EXPECT_EQ(outcome.report.status, SolveStatus::kNotFinite) << name;
      EXPECT_EQ(system.products, 4) << name;
      EXPECT_TRUE(outcome.x.allFinite()) << name;
      system.fault = nullptr;
      EXPECT_TRUE(solve_with(solver, system, b, {.relative = 1e-12}).report.converged())
          << name << ": not over it";
    });
  }
}

TEST(LinearSolve, WhereConjugateResidualBreaksDown_MinimalResidualSolves) {
  System system(MatrixXd{{0, 1}, {1, 0}});
  const VectorXd b{{1, 0}};
  ConjugateResidual<System> conjugate(system);
  const Outcome alone = solve_with(conjugate, system, b, {.relative = 1e-12});
  EXPECT_EQ(alone.report.status, SolveStatus::kBrokeDown);
  EXPECT_EQ(alone.x, VectorXd::Zero(2));

  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, b, {.relative = 1e-12});
  EXPECT_TRUE(outcome.report.converged());
  EXPECT_EQ(outcome.report.rung, SolveRung::kMinimalResidual);
  EXPECT_LT((outcome.x - VectorXd{{0, 1}}).norm(), 1e-15);
}

TEST(LinearSolve, RegularSystem_StaysOnFirstRung) {
  Dice dice(9);
  System system(dice.symmetric(spectrum(30, 100.0, 3)), dice.weights(30, 3.0));
  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, dice.vector(30), {.relative = 1e-10, .iterations = 500});
  EXPECT_TRUE(outcome.report.converged());
  EXPECT_EQ(outcome.report.rung, SolveRung::kFirst);
  EXPECT_EQ(outcome.report.shift, 0.0);
}

TEST(LinearSolve, BreakdownByPassingFault_IsOverOnceStartedAnew) {
  Dice dice(10);
  System system(dice.symmetric(spectrum(30, 100.0)));
  system.fault = [](int product, const System::Vector& x, System::Vector& y) {
    if (product == 5) y.values -= x.values * (x.values.dot(y.values) / x.values.squaredNorm());
  };
  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, dice.vector(30), {.relative = 1e-10, .iterations = 500});
  EXPECT_TRUE(outcome.report.converged());
  EXPECT_EQ(outcome.report.rung, SolveRung::kRestarted);
}

TEST(LinearSolve, LaterRung_IsContentWithToleranceOfTheFirst) {
  Dice dice(15);
  System system(dice.symmetric(spectrum(30, 100.0)));
  system.fault = [](int product, const System::Vector& x, System::Vector& y) {
    const bool last = product == 8 || product == 10;  // 9 is of the residual computed anew
    if (last) y.values -= x.values * (x.values.dot(y.values) / x.values.squaredNorm());
  };
  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, dice.vector(30), {.relative = 1e-3, .history = true});
  EXPECT_TRUE(outcome.report.converged());
  EXPECT_EQ(outcome.report.rung, SolveRung::kMinimalResidual);
  const auto& history = outcome.report.history;
  ASSERT_EQ(history.size(), static_cast<std::size_t>(outcome.report.iterations) + 2) << "a start for each rung";
  EXPECT_LT(history[8], 0.5 * history[0]);
  EXPECT_GT(history[history.size() - 2], 1e-3 * outcome.report.initial_norm);
}

TEST(LinearSolve, SingularSystem_IsSolvedShifted) {
  // The first shift, 0.1, makes the second eigenvalue zero.
  System system(VectorXd{{0, -0.1, 2}}.asDiagonal().toDenseMatrix());
  LinearSolve<System> ladder(system);
  const Outcome outcome = solve_with(ladder, system, VectorXd{{1, 1, 1}}, {.relative = 1e-12});
  EXPECT_TRUE(outcome.report.converged());
  EXPECT_EQ(outcome.report.rung, SolveRung::kShifted);
  EXPECT_EQ(outcome.report.shift, 1.0);
  EXPECT_LT((outcome.x - VectorXd{{1, 1 / 0.9, 1 / 3.0}}).norm(), 1e-11);
  EXPECT_EQ(system.delta, 0.0) << "the system must be as it was";
}

TEST(LinearSolve, NothingHelps_FailureIsReportedAndXIsAsItWas) {
  System system(VectorXd{{0, -0.1, 2}}.asDiagonal().toDenseMatrix());
  LinearSolve<System> ladder(system, {.first = 0.1, .count = 1});
  const VectorXd start{{3, 4, 5}};
  const Outcome outcome = solve_with(ladder, system, VectorXd{{1, 1, 1}}, {.relative = 1e-12}, start);
  EXPECT_EQ(outcome.report.status, SolveStatus::kBrokeDown);
  EXPECT_EQ(outcome.report.rung, SolveRung::kShifted);
  EXPECT_EQ(outcome.report.final_norm, outcome.report.initial_norm);
  EXPECT_EQ(outcome.x, start);
  EXPECT_EQ(system.delta, 0.0);
}

}  // namespace
}  // namespace repose
