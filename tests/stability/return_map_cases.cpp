// Repose tests: cases 6 to 8 and 10 to 12 of the battery, the return map of sand and the stress. Singular
// values of F are stretches, and their logarithms the values of the Hencky strain that the engine keeps.
// Overshoot is that of the strain, y / (2 mu).
#include "tests/kernels/yield_rig.h"
#include "tests/stability/kernel_cases.h"
#include "tests/stability/worst.h"

namespace repose::battery {
namespace {

template <class Real>
constexpr double kBar = sizeof(Real) == 4 ? 1e-6 : 1e-12;

template <class Real>
std::string named(const std::string& what) {
  return what + ", " + kPrecision<Real>;
}

template <class Real>
double overshoot_of(const Symmetric<Real>& strain, double yield_slope, double cohesion = 0.0) {
  const ExactMatrix m = exact(strain);
  const long double deviator = (m - m.trace() / 3 * ExactMatrix::Identity()).norm();
  return static_cast<double>(deviator + yield_slope * m.trace() - cohesion);
}

template <class Real>
double difference(const Symmetric<Real>& from, const Symmetric<Real>& to) {
  return largest_entry(exact(to) - exact(from));
}

template <class Real>
struct Returned {
  Worst overshoot, change;

  /// By the cone of the material.
  void map(const std::vector<Symmetric<Real>>& strains) {
    const double slope = golden_sand().yield_slope();
    for (const auto& rig : rigs<DruckerPrager, Real>(golden_sand())) {
      const auto once = rig.return_map(strains), twice = rig.return_map(once);
      for (std::size_t k = 0; k < strains.size(); ++k) {
        overshoot.add(overshoot_of(once[k], slope), rig.name());
        change.add(difference(once[k], twice[k]), rig.name());
      }
    }
  }
  /// By numbers per particle, the same cone with some cohesion and dilatancy.
  void map_per_particle(const std::vector<Symmetric<Real>>& strains, std::uint64_t seed) {
    Samples samples(seed);
    typename YieldRig<Real>::Surface surface;
    for (std::size_t k = 0; k < strains.size(); ++k) {
      surface.yield_slope.push_back(static_cast<Real>(golden_sand().yield_slope()));
      surface.cohesion.push_back(static_cast<Real>(samples.uniform(0, 0.1)));
      surface.dilatancy.push_back(static_cast<Real>(samples.uniform(0, 0.3)));
    }
    for (const auto& rig : yield_rigs<Real>()) {
      const auto once = rig.return_map(strains, surface), twice = rig.return_map(once, surface);
      for (std::size_t k = 0; k < strains.size(); ++k) {
        overshoot.add(overshoot_of(once[k], surface.yield_slope[k], surface.cohesion[k]), rig.name());
        change.add(difference(once[k], twice[k]), rig.name());
      }
    }
  }
};

template <class Real>
void decade(Case& asked, std::size_t samples) {
  Returned<Real> plain, per_particle;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    const auto strains = random_strains<Real>(count, 1.0, 6000 + seed);
    plain.map(strains);
    per_particle.map_per_particle(strains, 6500 + seed);
  });
  at_most(asked, named<Real>("overshoot"), plain.overshoot, kBar<Real>);
  at_most(asked, named<Real>("idempotence"), plain.change, kBar<Real>);
  at_most(asked, named<Real>("overshoot with cohesion and dilatancy"), per_particle.overshoot, kBar<Real>);
  at_most(asked, named<Real>("idempotence with cohesion and dilatancy"), per_particle.change, kBar<Real>);
}

template <class Real>
Real ulp(Real size) {
  return std::nextafter(size, std::numeric_limits<Real>::infinity()) - size;
}

/// Strains within an ulp of the tip on either side, with deviators from none to 1.
template <class Real>
std::vector<Symmetric<Real>> strains_at_the_tip(std::size_t count, std::uint64_t seed) {
  Samples samples(seed);
  std::vector<Symmetric<Real>> strains(count);
  for (std::size_t k = 0; k < count; ++k) {
    if (k % 8 == 0) {
      const Real size = static_cast<Real>(samples.power_of_ten(-30, 0));
      const Real t = k % 3 == 0 ? Real(0) : k % 3 == 1 ? ulp(size) : -ulp(size);
      strains[k] = {t, 0, 0, t, 0, t};
      continue;
    }
    const long double scale = samples.power_of_ten(-9, 0), mixed = samples.uniform(-1, 0);
    Symmetric<Real> s = rounded<Real>(scale * turned(ExactVector(1, mixed, -1 - mixed), samples));
    s[5] = -(s[0] + s[3]);  // the trace, as a sum from left to right, is exactly zero
    const Real largest = std::max({std::fabs(s[0]), std::fabs(s[3]), std::fabs(s[5])});
    s[5] += static_cast<Real>(static_cast<int>(samples.index(3)) - 1) * ulp(largest);
    strains[k] = s;
  }
  return strains;
}

/// Stress there, over E; and by how much it jumps between neighbours, one entry of the strain an ulp on.
template <class Real>
void tip(Case& asked, std::size_t samples) {
  const double stiffness = golden_sand().elasticity.youngs_modulus;
  Worst stress, jump;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    const auto strains = strains_at_the_tip<Real>(count, 8000 + seed);
    Samples random(8500 + seed);
    auto neighbours = strains;
    for (auto& neighbour : neighbours) {
      Real& entry = neighbour[random.index(6)];
      entry = std::nextafter(entry, static_cast<Real>(2 * random.sign()));
    }
    for (const auto& rig : rigs<DruckerPrager, Real>(golden_sand())) {
      const auto here = rig.stress(rig.return_map(strains)), there = rig.stress(rig.return_map(neighbours));
      for (std::size_t k = 0; k < count; ++k) {
        stress.add(largest_entry(exact(here[k])) / stiffness, rig.name());
        jump.add(difference(here[k], there[k]) / stiffness, rig.name());
      }
    }
  });
  at_most(asked, named<Real>("stress over E"), stress, 1e-6);
  at_most(asked, named<Real>("jump of stress over E"), jump, 1e-6);
}

template <class Real>
bool finite(const Symmetric<Real>& a) {
  return std::ranges::all_of(a, [](Real entry) { return std::isfinite(entry); });
}

template <class Real>
void extremes(Case& asked, std::size_t samples) {
  std::size_t broken = 0;
  Worst over;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    const auto strains = strains_of_all_sizes<Real>(count, 1e-12, 10000 + seed);
    for (const double angle : {0.0, 30.0, 89.9}) {
      for (const double poisson : {0.0, 0.4999}) {
        DruckerPragerParameters sand = golden_sand();
        sand.friction_angle = angle;
        sand.elasticity.poisson_ratio = poisson;
        const double slope = sand.yield_slope();
        for (const auto& rig : rigs<DruckerPrager, Real>(sand)) {
          const auto once = rig.return_map(strains), stress = rig.stress(once);
          for (std::size_t k = 0; k < count; ++k) {
            broken += finite(once[k]) && finite(stress[k]) ? 0 : 1;
            // Where the cone is steep, a rounding of the pressure is worth as much shear.
            const double size = largest_entry(exact(strains[k])) * (1 + slope);
            over.add(overshoot_of(once[k], slope) / size, rig.name());
          }
        }
      }
    }
  });
  asked.at_most(named<Real>("strains or stresses that are not finite"), static_cast<double>(broken), 0);
  at_most(asked, named<Real>("overshoot over strain and steepness"), over, kBar<Real>);
}

/// map(Q F) = Q map(F): strains turn with the frame, and a rotation Q as the whole of a step turns them too.
template <class Real>
void turns(Case& asked, std::size_t samples) {
  Worst frame, motion;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    const auto wide = random_strains<Real>(count, 1.0, 11000 + seed);
    const auto small = random_strains<Real>(count, 0.04, 11500 + seed);  // of sand: to a tenth
    Samples random(11900 + seed);
    std::vector<ExactMatrix> rotations;
    std::vector<Symmetric<Real>> turned_strains;
    std::vector<Gradient<Real>> gradients(count);
    for (std::size_t k = 0; k < count; ++k) {
      const ExactMatrix q = exact_rotation(random);
      rotations.push_back(q);
      turned_strains.push_back(rounded<Real>(q * exact(wide[k]) * q.transpose()));
      for (int i = 0; i < 9; ++i) {
        gradients[k][i] = static_cast<Real>(q(i / 3, i % 3) - (i % 4 == 0 ? 1 : 0));
      }
    }
    for (const auto& rig : rigs<DruckerPrager, Real>(golden_sand())) {
      const auto plain = rig.return_map(wide), turned_before = rig.return_map(turned_strains);
      const auto still = rig.return_map(small), moved = rig.return_map(rig.trial(small, gradients, Real(1)));
      for (std::size_t k = 0; k < count; ++k) {
        const ExactMatrix& q = rotations[k];
        frame.add(largest_entry(exact(turned_before[k]) - q * exact(plain[k]) * q.transpose()), rig.name());
        motion.add(largest_entry(exact(moved[k]) - q * exact(still[k]) * q.transpose()), rig.name());
      }
    }
  });
  at_most(asked, named<Real>("strain turned, stretches 0.1 to 10"), frame, kBar<Real>);
  at_most(asked, named<Real>("step that turns, strains to a tenth"), motion, kBar<Real>);
}

/// Stress against the slope of the energy that diagnostics sum, over the largest stress. Strains of sand, to a
/// tenth, in float; to nine tenths in double.
template <class Material, class Real>
void slope_of_energy(Worst& error, std::size_t count, std::uint64_t seed) {
  const typename Material::Parameters parameters{};
  const auto energy = [&](const Symmetric<double>& eps) {
    const double strain[6] = {eps[0], eps[1], eps[2], eps[3], eps[4], eps[5]};
    return parameters.energy_density(strain);
  };
  const auto strains = random_strains<Real>(count, sizeof(Real) == 4 ? 0.04 : 0.4, seed);
  std::vector<ExactMatrix> slopes;
  for (const auto& rounded_strain : strains) {
    Symmetric<double> strain, slope;
    std::copy(rounded_strain.begin(), rounded_strain.end(), strain.begin());
    for (std::size_t entry = 0; entry < 6; ++entry) {
      auto more = strain, less = strain;
      more[entry] += 1e-5;
      less[entry] -= 1e-5;
      // An off-diagonal entry stands for two places of the tensor.
      const bool off = entry == 1 || entry == 2 || entry == 4;
      slope[entry] = (energy(more) - energy(less)) / (more[entry] - less[entry]) / (off ? 2 : 1);
    }
    slopes.push_back(exact(slope));
  }
  for (const auto& rig : rigs<Material, Real>(parameters)) {
    const auto stress = rig.stress(strains);
    for (std::size_t k = 0; k < count; ++k) {
      error.add(largest_entry(exact(stress[k]) - slopes[k]) / largest_entry(slopes[k]),
                std::string(Material::Parameters::kName) + ", " + rig.name());
    }
  }
}

/// Half of them as drawn, the others moved to the cone, where little flow must not be less than rounding.
template <class Real>
std::vector<Symmetric<Real>> strains_that_flow(std::size_t count, std::uint64_t seed) {
  auto strains = strains_of_all_sizes<Real>(count, 1e-6, seed);
  Samples samples(seed);
  for (std::size_t k = 0; k < count; k += 2) {
    const ExactMatrix m = exact(strains[k]), mean = m.trace() / 3 * ExactMatrix::Identity();
    const long double on_the_cone = -golden_sand().yield_slope() * m.trace() / (m - mean).norm();
    const long double beyond = 1 + samples.power_of_ten(-8, -2);
    if (on_the_cone > 0) strains[k] = rounded<Real>(mean + on_the_cone * beyond * (m - mean));
  }
  return strains;
}

/// tau(H) : (eps - H), over the largest stress times the largest strain: least of all.
template <class Real>
double least_plastic_work(std::size_t samples) {
  double least = std::numeric_limits<double>::infinity();
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    const auto strains = strains_that_flow<Real>(count, 12500 + seed);
    for (const auto& rig : rigs<DruckerPrager, Real>(golden_sand())) {
      const auto once = rig.return_map(strains), stress = rig.stress(once);
      for (std::size_t k = 0; k < count; ++k) {
        const ExactMatrix tau = exact(stress[k]), flow = exact(strains[k]) - exact(once[k]);
        const double scale = largest_entry(tau) * largest_entry(exact(strains[k]));
        if (scale > 0.0) least = std::min(least, static_cast<double>(tau.cwiseProduct(flow).sum()) / scale);
      }
    }
  });
  return least;
}

template <class Real>
void energies(Case& asked, std::size_t samples) {
  Worst slope;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    [&]<std::size_t... k>(std::index_sequence<k...>) {
      (slope_of_energy<std::tuple_element_t<k, Materials>, Real>(slope, count, 12000 + seed), ...);
    }
    (std::make_index_sequence<std::tuple_size_v<Materials>>());
  });
  at_most(asked, named<Real>("stress against the slope of energy"), slope, 1e-6);
}

}  // namespace

void return_over_a_decade(std::size_t samples) {
  Case asked(6, "return map, stretches of 0.1 to 10");
  decade<float>(asked, samples);
  decade<double>(asked, samples);
}

void return_over_six_decades(std::size_t samples) {
  Case asked(7, "return map, stretches of 1e-6 to 1e6");
  Returned<double> wide;
  Returned<float> single;
  in_batches(samples, [&](std::size_t count, std::uint64_t seed) {
    wide.map(random_strains<double>(count, 6.0, 7000 + seed));
    single.map(random_strains<float>(count, 6.0, 7000 + seed));
  });
  at_most(asked, "overshoot, double", wide.overshoot, 1e-7);
  at_most(asked, "idempotence, double", wide.change, 1e-7);
  const double largest = std::max(single.overshoot.figure(), single.change.figure());
  asked.holds("finite, float", std::isfinite(largest));
}

void cone_tip(std::size_t samples) {
  Case asked(8, "tip of the cone, trace 0 +- 1 ulp");
  tip<float>(asked, samples);
  tip<double>(asked, samples);
}

void extreme_sands(std::size_t samples) {
  Case asked(10, "friction of 0 and 89.9 degrees, Poisson ratio 0 and 0.4999");
  extremes<float>(asked, samples);
  extremes<double>(asked, samples);
}

void turned_states(std::size_t samples) {
  Case asked(11, "map(Q F) = Q map(F)");
  turns<float>(asked, samples);
  turns<double>(asked, samples);
}

void energy_and_work(std::size_t samples) {
  Case asked(12, "stress is the slope of energy, plastic flow dissipates");
  energies<float>(asked, samples);
  energies<double>(asked, samples);
  asked.at_least("plastic work over its scale, float", least_plastic_work<float>(samples), -1e-9, "",
                 {-2e-7, "a strain in float is rounded to 6e-8 of itself, which under pressure is work"});
  asked.at_least("plastic work over its scale, double", least_plastic_work<double>(samples), -1e-9);
}

}  // namespace repose::battery
