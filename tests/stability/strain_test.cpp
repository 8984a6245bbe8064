// Repose tests: cases 5, 9 and 13 of the battery: what is no number stays seen, what is crushed stays finite,
// and what opens and closes gains no volume.
#include "kernels/effect/volume_correction.h"
#include "tests/kernels/functions.h"
#include "tests/kernels/material_rig.h"
#include "tests/stability/small_state.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

template <class Real>
bool finite(const Real* values, std::size_t count) {
  return std::all_of(values, values + count, [](Real x) { return std::isfinite(x); });
}
template <class Real>
bool finite(const Symmetric<Real>& a) {
  return finite(a.data(), a.size());
}

template <class Real>
constexpr Real kBad[] = {std::numeric_limits<Real>::quiet_NaN(), std::numeric_limits<Real>::infinity(),
                         -std::numeric_limits<Real>::infinity()};

/// Pressed, sheared, opened, with no strain at all, and beyond the reach of the polynomials.
template <class Real>
std::vector<Symmetric<Real>> sound_strains() {
  std::vector<Symmetric<Real>> strains;
  for (const Real size : {Real(0.01), Real(1.5)}) {
    strains.push_back({-size, 0, 0, -size, 0, -size});
    strains.push_back({-size, size, 0, -size, size / 2, -size});
    strains.push_back({size, size / 4, 0, size, 0, size});
    strains.push_back({0, size, 0, 0, 0, 0});
  }
  strains.push_back({});
  return strains;
}

/// How many results are finite though an entry of what went in was none: of the functions that kernels are made
/// of, and of a whole step of each material.
template <class Real>
std::size_t unseen_in_functions() {
  std::size_t unseen = 0;
  for (const Functions<Real>& functions : all_functions<Real>()) {
    for (const auto& sound : sound_strains<Real>()) {
      for (const Real bad : kBad<Real>) {
        for (std::size_t entry = 0; entry < 6; ++entry) {
          Symmetric<Real> matrix = sound;
          matrix[entry] = bad;
          Real eigen[12], strain[6], b[6];
          functions.eigen_sym3(matrix.data(), eigen, 1);
          functions.half_log1p(matrix.data(), strain, 1);
          functions.expm1_twice(matrix.data(), b, 1);
          unseen += (finite(eigen, 12) ? 1 : 0) + (finite(strain, 6) ? 1 : 0) + (finite(b, 6) ? 1 : 0);
        }
      }
    }
  }
  return unseen;
}

template <class Material, class Real>
std::size_t unseen_in_a_step() {
  std::size_t unseen = 0;
  for (const auto& rig : default_rigs<Material, Real>()) {
    for (const auto& sound : sound_strains<Real>()) {
      for (const Real bad : kBad<Real>) {
        for (std::size_t entry = 0; entry < 15; ++entry) {
          std::vector<Symmetric<Real>> strains{sound};
          std::vector<Gradient<Real>> gradients{{Real(0.1), 0, 0, 0, Real(-0.2), 0, 0, 0, Real(0.1)}};
          (entry < 6 ? strains[0][entry] : gradients[0][entry - 6]) = bad;
          const auto strain = rig.return_map(rig.trial(strains, gradients, Real(1)));
          unseen += finite(strain[0]) ? 1 : 0;
          unseen += finite(rig.stress(strain)[0]) ? 1 : 0;
        }
      }
    }
  }
  return unseen;
}

/// Of the return map by itself.
template <class Real>
std::size_t unseen_in_return_map() {
  std::size_t unseen = 0;
  for (const auto& rig : rigs<DruckerPrager, Real>(golden_sand())) {
    for (const auto& sound : sound_strains<Real>()) {
      for (const Real bad : kBad<Real>) {
        for (std::size_t entry = 0; entry < 6; ++entry) {
          std::vector<Symmetric<Real>> strains{sound};
          strains[0][entry] = bad;
          unseen += finite(rig.return_map(strains)[0]) ? 1 : 0;
        }
      }
    }
  }
  return unseen;
}

template <class Real>
std::size_t unseen_in_steps() {
  return [&]<std::size_t... k>(std::index_sequence<k...>) {
    return (unseen_in_a_step<std::tuple_element_t<k, Materials>, Real>() + ...);
  }
  (std::make_index_sequence<std::tuple_size_v<Materials>>());
}

/// The check before a step: a particle whose velocity or gradient is none must be named.
template <class Real>
std::size_t unseen_by_the_check() {
  std::size_t unseen = 0;
  for (const Target target : supported_targets()) {
    for (const Real bad : kBad<Real>) {
      for (std::size_t entry = 0; entry < 12; ++entry) {
        std::vector<Real> values(12, Real(0));
        values[entry] = bad;
        const Real *velocity[3], *gradient[9];
        for (std::size_t k = 0; k < 12; ++k) (k < 3 ? velocity[k] : gradient[k - 3]) = &values[k];
        unseen +=
            kernels<Real>(target).particle.first_failed(velocity, gradient, 1, Real(1), Real(1)) == 0 ? 0 : 1;
      }
    }
  }
  return unseen;
}

TEST(Battery, Case05_NanOrInfinityInAnEntry_IsNeverFiniteAfterwards) {
  Case asked(5, "not a number, or infinite, in one entry");
  const auto none = [&](const std::string& what, std::size_t unseen) {
    asked.at_most("finite results, " + what, static_cast<double>(unseen), 0);
  };
  none("eigenvalues, log and exp, float", unseen_in_functions<float>());
  none("eigenvalues, log and exp, double", unseen_in_functions<double>());
  none("a step of each material, float", unseen_in_steps<float>());
  none("a step of each material, double", unseen_in_steps<double>());
  none("check before a step, float", unseen_by_the_check<float>());
  none("check before a step, double", unseen_by_the_check<double>());
}

// Sand that has opened comes back as no strain, whatever its other entries are. In a step the trial strain has
// spread what is no number to all of them before.
TEST(Battery, Case05_ReturnMapAlone_KeepsWhatIsNoNumber) {
  Case asked(5, "not a number, or infinite, in the return map alone");
  asked.at_most("finite results, float", static_cast<double>(unseen_in_return_map<float>()), 0);
  asked.at_most("finite results, double", static_cast<double>(unseen_in_return_map<double>()), 0);
}

/// The smallest stretch that a strain keeps, docs/math.md, section 32.
template <class Real>
constexpr double kSmallest = sizeof(Real) == 4 ? 1e-3 : 1e-4;

/// Steps whose I + dt grad v has rank 2, 1 and 0, in any frame, from any strain: how far the least strain is
/// from the floor. What 1 + floor - 1 rounds away of the floor's square is 3 % in float.
template <class Real>
void floor_of_the_strain(Case& asked) {
  Worst off;
  std::size_t broken = 0, unnamed = 0;
  Samples samples(901);
  std::vector<Symmetric<Real>> strains;
  std::vector<Gradient<Real>> gradients;
  for (int k = 0; k < 3000; ++k) {
    const ExactVector stretches(1, k % 3 > 1 ? 0 : 1, 0);
    const ExactMatrix f = (k % 4 == 3 ? 0 : 1) * turned(stretches, samples);
    const ExactMatrix g = f - ExactMatrix::Identity();
    gradients.emplace_back();
    for (int i = 0; i < 9; ++i)
      gradients.back()[static_cast<std::size_t>(i)] = static_cast<Real>(g(i / 3, i % 3));
    strains.push_back(k % 2 == 0 ? Symmetric<Real>{} : random_strains<Real>(1, 0.1, 902 + k)[0]);
  }
  for (const auto& rig : rigs<Hencky, Real>(HenckyParameters{})) {
    const auto crushed = rig.trial(strains, gradients, Real(1));
    const auto stress = rig.stress(crushed);
    for (std::size_t k = 0; k < crushed.size(); ++k) {
      broken += finite(crushed[k]) && finite(stress[k]) ? 0 : 1;
      const double least = static_cast<double>(ExactEigen(exact(crushed[k])).eigenvalues().minCoeff());
      off.add(std::fabs(least - std::log(kSmallest<Real>)), rig.name());
    }
  }
  const Real none[1] = {0};
  for (const Target target : supported_targets()) {
    // Turned, rounding decides whether the determinant is zero; along the axes it is.
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const Real flat[1] = {-1};
      const Real *velocity[3] = {none, none, none}, *gradient[9];
      for (std::size_t k = 0; k < 9; ++k) gradient[k] = k == 4 * axis ? flat : none;
      unnamed +=
          kernels<Real>(target).particle.first_failed(velocity, gradient, 1, Real(1), Real(1)) == 0 ? 0 : 1;
    }
  }
  const std::string precision = std::string(", ") + kPrecision<Real>;
  asked.at_most("strains or stresses that are not finite" + precision, static_cast<double>(broken), 0);
  at_most(asked, "least strain against the floor's" + precision, off, 0.05);
  asked.at_most("steps to nothing that the check passes" + precision, static_cast<double>(unnamed), 0);
}

/// A cube that a step of `dt` s presses to nothing, or through itself, along x.
constexpr const char* kPressed = R"json({"repose": 1, "name": "pressed",
  "grid": {"spacing": 0.0625, "precision": "double"},
  "materials": {"rubber": {"type": "elastic"}},
  "bodies": [{"name": "cube", "material": "rubber",
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.5, 0.5, 0.5]}}],
  "gravity": {"acceleration": [0, 0, 0]}})json";

TEST(Battery, Case09_CrushedToNothing_StaysFiniteAndIsReported) {
  Case asked(9, "stretch of zero");
  floor_of_the_strain<float>(asked);
  floor_of_the_strain<double>(asked);
  SmallState<double> state(scene_of(kPressed));
  constexpr double kStep = 0x1p-12, kRate = -1.25 / kStep;
  state.for_each([&](ParticleSet<double>& set, std::size_t p, const Vec3& x) {
    set.velocity[0][p] = kRate * (x[0] - 0.25);
    set.affine[0][p] = kRate;
  });
  state.limit_steps_only_by(kStep);
  const StepReport report = state.step();
  asked.holds(
      "step through itself is halved and told",
      report.accepted && report.redone > 0 && report.first_refusal.find("inside out") != std::string::npos);
}

/// A cube thrown at 10 times the speed of sound: some of it is pressed to the floor of its strain.
constexpr const char* kThrown = R"json({"repose": 1, "name": "thrown", "grid": {"spacing": 0.01},
  "materials": {"rubber": {"type": "elastic", "density": 1000, "youngs_modulus": 1e4}},
  "bodies": [{"name": "cube", "material": "rubber", "velocity": [0, -40, 0],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.08, 0.08, 0.08]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}}]})json";

TEST(Battery, Case09_FloorReachedInManySteps_IsReported) {
  Case asked(9, "stretch of zero, by and by");
  const auto simulation = simulate(scene_of(kThrown, {"time.frames_per_second=1000"}), 1);
  double least = 0.0;
  for (int k = 0; k < 8 && run_frames(*simulation, 1); ++k) {
    const PointCloud points = simulation->points({.attributes = {OutputAttribute::kElasticStrain}});
    const auto& strain = points.attributes[0].values;  // xx yy zz xy yz xz
    for (std::size_t p = 0; p < points.size(); ++p) {
      const float* s = &strain[6 * p];
      const Symmetric<float> ours{s[0], s[3], s[5], s[1], s[4], s[2]};
      least = std::min(least, static_cast<double>(ExactEigen(exact(ours)).eigenvalues().minCoeff()));
    }
  }
  asked.at_most("least strain, log of 1e-3 is the floor", least, std::log(1e-3) + 0.05);
  bool told = false;
  for (const std::string& warning : simulation->warnings())
    told = told || warning.find("pressed to 1e-03 of their thickness") != std::string::npos;
  asked.holds("told in the warnings", told);
}

/// Opens, projects and closes, or projects alone.
template <class Real>
void open_and_close(Target target, bool correct, Symmetric<Real>& strain, Real& gained) {
  const DruckerPragerConstants<Real> constants(golden_sand());
  const VolumeCorrectionKernels<Real>& volume = volume_correction_kernels<Real>(target);
  MaterialInput<Real> in{&constants, {}, {}, {}, {}, 0, 1};
  for (std::size_t k = 0; k < 6; ++k) in.strain[k] = &strain[k];
  Real trace = 0;
  if (correct) volume.open_volume(in.strain, &gained, &trace, 1);
  kernels<Real>(target).material[material_index<DruckerPrager>()].return_map(in);
  if (correct) volume.close_volume(in.strain, &gained, &trace, 1);
}

/// Log volume that a particle has gained after cycles of opening and pressing, with some shear: what its strain
/// and its channel hold beyond what it was moved by.
template <class Real>
double volume_gained(Target target, bool correct) {
  constexpr int kCycles = 10000;
  Symmetric<Real> strain{Real(-0.001), 0, 0, Real(-0.001), 0, Real(-0.001)};
  Real gained = 0;
  for (int cycle = 0; cycle < kCycles; ++cycle) {
    for (const Real pull : {Real(0.01), Real(-0.01)}) {
      for (const std::size_t diagonal : {0u, 3u, 5u}) strain[diagonal] += pull;
      strain[1] += pull / 4;
      open_and_close(target, correct, strain, gained);
    }
  }
  return std::fabs(static_cast<double>(exact(strain).trace()) + 0.003) + std::fabs(double{gained});
}

template <class Real>
void cycles(Case& asked) {
  Worst gained;
  double without = std::numeric_limits<double>::infinity();
  for (const Target target : supported_targets()) {
    gained.add(volume_gained<Real>(target, true), target_name(target));
    without = std::min(without, volume_gained<Real>(target, false));
  }
  at_most(asked, std::string("volume gained, ") + kPrecision<Real>, gained, 1e-3);
  asked.at_least(std::string("control without the correction, ") + kPrecision<Real>, without, 1e-2);
}

TEST(Battery, Case13_TenThousandOpenings_GainNoVolume) {
  Case asked(13, "opened and pressed shut 1e4 times");
  cycles<float>(asked);
  cycles<double>(asked);
}

/// Sand that slumps.
constexpr const char* kHeap = R"json({"repose": 1, "name": "heap", "grid": {"spacing": 0.01},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "heap", "material": "sand", "velocity": [0.3, -0.5, 0],
              "shape": {"type": "box", "lower": [0, 0, 0], "upper": [0.06, 0.08, 0.06]}}],
  "colliders": [{"name": "floor", "shape": {"type": "plane"}, "friction": 0.5}]})json";

TEST(Battery, Case10_ExtremeSandsInAScene_RunOrAreRefusedWithTheKey) {
  Case asked(10, "scenes of extreme sands");
  for (const std::string precision : {"single", "double"}) {
    bool finite = true;
    for (const std::string angle : {"0", "89.9"}) {
      for (const std::string poisson : {"0", "0.4999"}) {
        const auto simulation =
            simulate(scene_of(kHeap, {"grid.precision=" + precision, "materials.sand.friction_angle=" + angle,
                                      "materials.sand.poisson_ratio=" + poisson}),
                     1);
        const bool ran = run_steps(*simulation, 200);
        const Diagnostics figures = simulation->diagnose();
        finite = finite && ran && std::isfinite(figures.kinetic_energy + figures.elastic_energy);
      }
    }
    asked.holds("200 steps at the four corners are finite, " + precision, finite);
  }
  for (const std::string wrong :
       {"friction_angle=90", "friction_angle=-1", "poisson_ratio=0.5", "poisson_ratio=-1"}) {
    const auto scene = read_scene_text(kHeap, "test scene", ".", {.overrides = {"materials.sand." + wrong}});
    const std::string key = wrong.substr(0, wrong.find('='));
    asked.holds(wrong + " is refused by its key",
                !scene && scene.error().text().find(key) != std::string::npos);
  }
}

}  // namespace
}  // namespace repose::battery
