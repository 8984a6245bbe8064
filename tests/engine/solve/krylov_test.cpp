// Repose tests: the Krylov solvers against dense factorizations and against what they claim to minimise.
#include <type_traits>

#include "tests/engine/solve/krylov_rig.h"

namespace repose {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using System = DenseSystem<double>;

static_assert(ShiftableSystem<DenseSystem<double>> && ShiftableSystem<DenseSystem<float>>);
static_assert(!std::is_copy_constructible_v<System::Vector>, "or a copy in a solver would go unseen");

/// The least |b - A x|_P over x in span{P b, P A P b, ...} of `steps` vectors.
double least_over_krylov_space(const MatrixXd& a, const MatrixXd& p, const VectorXd& b, int steps) {
  const MatrixXd root = p.cwiseSqrt();
  MatrixXd space(b.size(), steps);
  VectorXd next = p * b;
  for (int k = 0; k < steps; ++k) {
    for (int again = 0; again < 2; ++again) next -= space.leftCols(k) * (space.leftCols(k).transpose() * next);
    space.col(k) = next.normalized();
    next = p * (a * space.col(k));
  }
  const MatrixXd image = root * a * space;
  const VectorXd y = image.colPivHouseholderQr().solve(root * b);
  return (root * b - image * y).norm();
}

TEST(Krylov, SymmetricSystem_AgreesWithFactorization) {
  Dice dice(1);
  for (const int n : {1, 2, 3, 8, 21, 60}) {
    for (const int flip : {0, 2, 3}) {
      const MatrixXd a = dice.symmetric(spectrum(n, 30.0, flip));
      const VectorXd b = dice.vector(n);
      // LDL^T that pivots on the diagonal alone is not safe where a is indefinite.
      const VectorXd exact = flip == 0 ? VectorXd(a.ldlt().solve(b)) : VectorXd(a.fullPivLu().solve(b));
      System system(a, dice.weights(n, 3.0));
      with_symmetric_solvers(system, 60, [&](const char* name, auto& solver) {
        const Outcome outcome =
            solve_with(solver, system, b, {.relative = 1e-12, .iterations = 1000}, dice.vector(n));
        EXPECT_TRUE(outcome.report.converged()) << name << " n " << n << " flip " << flip;
        EXPECT_LT((outcome.x - exact).norm() / exact.norm(), 1e-10) << name << " n " << n << " flip " << flip;
      });
    }
  }
}

TEST(Krylov, NonsymmetricSystem_AgreesWithFactorization) {
  Dice dice(2);
  for (const int n : {1, 2, 3, 8, 21, 60}) {
    for (const double skewness : {0.3, 1.0, 3.0}) {
      const MatrixXd a = nonsymmetric(dice, n, skewness);
      const VectorXd b = dice.vector(n);
      const VectorXd exact = a.partialPivLu().solve(b);
      System system(a, dice.weights(n, 1.5));
      for (const int directions : {60, 10}) {
        GeneralizedConjugateResidual<System> solver(system, directions);
        const Outcome outcome =
            solve_with(solver, system, b, {.relative = 1e-12, .iterations = 1000}, dice.vector(n));
        EXPECT_TRUE(outcome.report.converged()) << "n " << n << " skewness " << skewness;
        EXPECT_LT((outcome.x - exact).norm() / exact.norm(), 1e-10) << "n " << n << " skewness " << skewness;
      }
    }
  }
}

TEST(Krylov, AfterKIterations_NormIsLeastOverKrylovSpace) {
  Dice dice(3);
  constexpr int kSize = 20;
  const MatrixXd p = dice.weights(kSize, 3.0);
  const VectorXd b = dice.vector(kSize);
  const auto check = [&](const MatrixXd& a, const char* name, auto& system, auto& solver) {
    for (int k = 1; k <= 12; ++k) {
      const Outcome outcome = solve_with(solver, system, b, {.iterations = k});
      EXPECT_EQ(outcome.report.status, SolveStatus::kCapped);
      EXPECT_EQ(outcome.report.iterations, k);
      EXPECT_NEAR(outcome.report.final_norm / least_over_krylov_space(a, p, b, k), 1.0, 1e-9)
          << name << " " << k;
    }
  };
  for (const int flip : {0, 3}) {
    const MatrixXd a = dice.symmetric(spectrum(kSize, 30.0, flip));
    System system(a, p);
    with_symmetric_solvers(system, 1, [&](const char* name, auto& solver) { check(a, name, system, solver); });
  }
  const MatrixXd a = nonsymmetric(dice, kSize, 1.0);
  System system(a, p);
  GeneralizedConjugateResidual<System> solver(system, 12);
  check(a, "generalized, nonsymmetric", system, solver);

  GeneralizedConjugateResidual<System> forgetful(system, 1);  // not enough for this A: the control
  const Outcome outcome = solve_with(forgetful, system, b, {.iterations = 12});
  EXPECT_GT(outcome.report.final_norm, 1.1 * least_over_krylov_space(a, p, b, 12));
}

TEST(Krylov, Condition1e6_NormNeverRises) {
  Dice dice(4);
  for (const double condition : {1e2, 1e4, 1e6}) {
    for (const int flip : {0, 2, 3}) {
      System system(dice.symmetric(spectrum(60, condition, flip)), dice.weights(60, 3.0));
      const VectorXd b = dice.vector(60);
      with_symmetric_solvers(system, 5, [&](const char* name, auto& solver) {
        // Above the root of the machine epsilon: no restart sheds rounding.
        const Outcome outcome =
            solve_with(solver, system, b, {.relative = 1e-7, .iterations = 400, .history = true});
        const auto& history = outcome.report.history;
        ASSERT_EQ(history.size(), static_cast<std::size_t>(outcome.report.iterations) + 1);
        EXPECT_GT(history.size(), 10u);
        EXPECT_EQ(history.front(), outcome.report.initial_norm);
        EXPECT_EQ(history.back(), outcome.report.final_norm);
        EXPECT_GT(history[history.size() - 2], 1e-7 * history.front()) << "went on after it had converged";
        for (std::size_t k = 1; k + 1 < history.size(); ++k) {
          EXPECT_LE(history[k], history[k - 1] * (1.0 + 1e-12))
              << name << " " << condition << " " << flip << " " << k;
        }
      });
    }
  }
}

TEST(Krylov, SmallSystem_IsExactInNSteps) {
  Dice dice(5);
  for (int n = 1; n <= 8; ++n) {
    for (const int flip : {0, 2}) {
      System system(dice.symmetric(spectrum(n, 10.0, flip)), dice.weights(n, 1.5));
      const VectorXd b = dice.vector(n);
      with_symmetric_solvers(system, 1, [&](const char* name, auto& solver) {
        EXPECT_TRUE(solve_with(solver, system, b, {.relative = 1e-10, .iterations = n}).report.converged())
            << name << n;
      });
    }
    System system(nonsymmetric(dice, n, 1.0), dice.weights(n, 1.5));
    GeneralizedConjugateResidual<System> solver(system, n);
    EXPECT_TRUE(
        solve_with(solver, system, dice.vector(n), {.relative = 1e-10, .iterations = n}).report.converged());
  }
}

TEST(GeneralizedConjugateResidual, SymmetricSystem_HasIteratesOfConjugateResidual) {
  Dice dice(6);
  System system(dice.symmetric(spectrum(40, 20.0)), dice.weights(40, 3.0));
  const VectorXd b = dice.vector(40);
  const VectorXd start = dice.vector(40);
  ConjugateResidual<System> conjugate(system);
  for (const int directions : {1, 4}) {
    GeneralizedConjugateResidual<System> generalized(system, directions);
    for (int k = 1; k <= 15; ++k) {
      const Outcome expected = solve_with(conjugate, system, b, {.iterations = k}, start);
      const Outcome outcome = solve_with(generalized, system, b, {.iterations = k}, start);
      EXPECT_LT((outcome.x - expected.x).norm() / expected.x.norm(), 1e-10) << directions << " " << k;
    }
  }
}

TEST(Krylov, ProjectorInside_KeepsConstrainedComponents) {
  Dice dice(13);
  const VectorXd free = VectorXd::NullaryExpr(20, [](Eigen::Index k) { return k % 4 == 0 ? 0.0 : 1.0; });
  const MatrixXd project = free.asDiagonal();
  const MatrixXd a = dice.symmetric(spectrum(20, 30.0, 4));
  System system(project * a * project, project * dice.weights(20, 3.0) * project);
  const VectorXd b = dice.vector(20);
  const VectorXd start = dice.vector(20);
  with_symmetric_solvers(system, 20, [&](const char* name, auto& solver) {
    const Outcome outcome = solve_with(solver, system, b, {.relative = 1e-12}, start);
    EXPECT_TRUE(outcome.report.converged()) << name;
    for (int k = 0; k < 20; k += 4) EXPECT_EQ(outcome.x[k], start[k]) << name;
    EXPECT_LT((project * (b - a * project * outcome.x)).norm(), 1e-10) << name;
  });
}

TEST(Krylov, WarmSolve_MakesNoVectorsAndNoNeedlessProducts) {
  Dice dice(14);
  System system(dice.symmetric(spectrum(20, 30.0)), dice.weights(20, 3.0));
  const VectorXd b = dice.vector(20);
  with_symmetric_solvers(system, 6, [&](const char* name, auto& solver) {
    system.made = system.products = 0;
    const Outcome outcome = solve_with(solver, system, b, {.relative = 1e-6});
    EXPECT_TRUE(outcome.report.converged()) << name;
    EXPECT_EQ(system.products, outcome.report.iterations + 1) << name;
    EXPECT_EQ(solve_with(solver, system, b, {.relative = 1e-6}).x, outcome.x) << name << " remembers";
    EXPECT_EQ(solve_with(solver, system, b, {.absolute = 1e-3}, outcome.x).report.iterations, 0) << name;
    EXPECT_EQ(solve_with(solver, system, VectorXd::Zero(20), {}).report.iterations, 0) << name;
    EXPECT_EQ(system.made, 0) << name;
  });
}

}  // namespace
}  // namespace repose
