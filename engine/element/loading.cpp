#include "engine/element/loading.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/wording.h"

namespace repose {
namespace {

constexpr int kX = 0, kZ = 2;
constexpr double kLargestStretch = 1.0, kFirstReach = 0.05;  // log, of one step

double normal_stress(const Element& element, int axis) {
  constexpr std::array<std::size_t, 3> kDiagonal{0, 3, 5};
  return element.state().stress[kDiagonal[static_cast<std::size_t>(axis)]];
}

/// Finds the stretch by which a step brings a normal stress to a target, and makes that step.
class ServoStep {
 public:
  ServoStep(Element& element, const PathStep& step, const Servo& servo, double target)
      : element_(element), step_(step), servo_(servo), target_(target), before_(element.save()) {
    const double stiffness = element.material().elasticity().youngs_modulus;
    tolerance_ = std::max(1e-10 * std::abs(target), 1e-14 * stiffness);
    width_ =
        std::min(std::max({1e-2 * step.gradient.norm(), std::abs(target) / stiffness, 1e-12}), kFirstReach);
  }

  /// `stretch`: a guess, then what was found. False where there is none.
  bool make(double& stretch) {
    double a = stretch, fa = miss(a);
    if (std::abs(fa) <= tolerance_) return true;
    double b = a, fb = fa;
    for (double reach = width_; (fa > 0.0) == (fb > 0.0); reach *= 2.0) {
      a = b;
      fa = fb;
      b = a - std::copysign(reach, fa);  // stress grows with the stretch
      if (!(std::abs(b) <= kLargestStretch)) return false;
      fb = miss(b);
      if (!std::isfinite(fb)) return false;
      if (std::abs(fb) <= tolerance_) {  // sand that has come apart bears nothing, however far it is stretched
        stretch = b;
        return true;
      }
    }
    return narrow(a, fa, b, fb, stretch);
  }

 private:
  /// By the secant's Illinois form, and halving where that is slow.
  bool narrow(double a, double fa, double b, double fb, double& stretch) {
    double ga = fa, gb = fb;  // of which the Illinois form halves one
    double best = std::abs(fa) < std::abs(fb) ? a : b, least = std::min(std::abs(fa), std::abs(fb));
    for (int k = 0; k < 200 && least > tolerance_; ++k) {
      const double middle = k % 4 == 3 ? 0.5 * (a + b) : (a * gb - b * ga) / (gb - ga);
      const double f = miss(middle);
      if (std::abs(f) < least) {
        least = std::abs(f);
        best = middle;
      }
      if ((f > 0.0) == (fb > 0.0)) {
        b = middle;
        fb = gb = f;
        ga *= 0.5;
      } else {
        a = b;
        ga = fa = fb;
        b = middle;
        fb = gb = f;
      }
      if (a == b) break;
    }
    stretch = best;
    return std::abs(miss(best)) <= 1e3 * tolerance_;
  }

  /// Makes the step with a stretch; by how much the stress is above the target, Pa.
  double miss(double stretch) {
    element_.restore(before_);
    Mat3 gradient = step_.gradient;
    for (int axis = 0; axis < 3; ++axis) {
      if (servo_.stretched[static_cast<std::size_t>(axis)]) gradient(axis, axis) = std::expm1(stretch);
    }
    element_.step(gradient / step_.dt, step_.dt);
    return normal_stress(element_, servo_.axis) - target_;
  }

  Element& element_;
  const PathStep& step_;
  const Servo& servo_;
  double target_;
  Element::Snapshot before_;
  double tolerance_, width_;
};

Error unreachable_stress(const std::string& where, int axis, double target) {
  char text[160];
  std::snprintf(text, sizeof text,
                "no strain holds sigma_%c%c at %.6g Pa: the material cannot bear this path so far", 'x' + axis,
                'x' + axis, target);
  return {ErrorKind::kPhysics, text, where};
}

Path straight_path(double pressure, const PathLength& length, const Mat3& step) {
  Path path;
  path.pressure = pressure;
  PathStep one{step, length.strain / length.steps / length.rate};
  for (int k = 1; k <= length.steps; ++k) {
    one.where = "step " + std::to_string(k);
    path.steps.push_back(one);
  }
  return path;
}

Mat3 along_axis(double log_strain) {
  Mat3 step = Mat3::Zero();
  step(kZ, kZ) = std::expm1(log_strain);
  return step;
}

Result<void> confine(Element& element, double pressure) {
  if (pressure == 0.0) return {};
  const PathStep press{Mat3::Zero(), 1.0};
  const Servo all_around{{true, true, true}, kZ};
  double stretch = 0.0;
  if (ServoStep(element, press, all_around, -pressure).make(stretch)) return {};
  return unreachable_stress("the pressure before the path", kZ, -pressure);
}

}  // namespace

Path triaxial_path(double pressure, const PathLength& length, bool extension) {
  const double step = length.strain / length.steps;
  Path path = straight_path(pressure, length, along_axis(extension ? step : -step));
  path.servo = Servo{{true, true, false}, kX};
  return path;
}

Path oedometric_path(double pressure, const PathLength& length) {
  return straight_path(pressure, length, along_axis(-length.strain / length.steps));
}

Path simple_shear_path(double pressure, const PathLength& length, bool constant_volume) {
  Mat3 step = Mat3::Zero();
  step(kX, kZ) = length.strain / length.steps;
  Path path = straight_path(pressure, length, step);
  if (!constant_volume) path.servo = Servo{{false, false, true}, kZ};
  return path;
}

Result<std::vector<ElementState>> drive(Element& element, const Path& path) {
  if (auto confined = confine(element, path.pressure); !confined) return confined.error();
  element.begin_path();
  std::vector<ElementState> states{element.state()};
  const double target = path.servo ? normal_stress(element, path.servo->axis) : 0.0;
  double stretch = 0.0;
  for (const PathStep& step : path.steps) {
    const double determinant = (Mat3::Identity() + step.gradient).determinant();
    if (!(determinant > 0.0))
      return Error{
          ErrorKind::kBadScene,
          "turns the element inside out, det(I + dt L) = " + number_text(determinant) + "; take smaller steps",
          step.where};
    if (path.servo) {
      if (!ServoStep(element, step, *path.servo, target).make(stretch))
        return unreachable_stress(step.where, path.servo->axis, target);
    } else {
      element.step(step.gradient / step.dt, step.dt);
    }
    if (!std::isfinite(element.state().p()) || !std::isfinite(element.state().q()))
      return Error{ErrorKind::kPhysics, "the stress is no finite number any more; take smaller steps",
                   step.where};
    states.push_back(element.state());
  }
  return states;
}

}  // namespace repose
