// Repose: one pass over the sets for what every cloud has, and one for each attribute that is wanted.
#include "engine/simulation/points.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <utility>

#include "engine/scene/attributes.h"

namespace repose {
namespace {

/// Where xx yy zz xy yz xz of a file lie in a strain of ours.
constexpr std::array<std::size_t, 6> kFileOrder{0, 3, 5, 1, 4, 2};

/// A set on its way into a cloud.
template <class Real>
struct Source {
  const ParticleSet<Real>& set;
  const MaterialDescription& material;
  const MaterialKernels<Real>& kernels;
  const std::uint32_t* row;      ///< of each particle of the set, in the cloud
  double time;                   ///< of the state, s
  std::optional<Grains> grains;  ///< of the material
};

/// The row of each particle, set after set: its place among all ids.
template <class Real>
std::vector<std::uint32_t> rows_by_id(const State<Real>& state) {
  std::vector<std::uint32_t> ids;
  ids.reserve(state.particles());
  for (const auto& set : state.sets) ids.insert(ids.end(), set.id.data(), set.id.data() + set.count);
  // Ids are unique: as many as the largest asks for are all there, and each is its own row.
  if (ids.empty() || *std::max_element(ids.begin(), ids.end()) == ids.size() - 1) return ids;
  std::vector<std::uint32_t> order(ids.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return ids[a] < ids[b]; });
  for (std::uint32_t row = 0; row < order.size(); ++row) ids[order[row]] = row;
  return ids;
}

template <class Real>
double trace_of(const ParticleSet<Real>& set, std::size_t p) {
  return double(set.strain[0][p]) + double(set.strain[3][p]) + double(set.strain[5][p]);
}

/// Calls visit(p, tau) for all particles; tau in the order of strains, by the kernel that steps use.
template <class Real, class Visit>
void for_each_stress(const Source<Real>& source, Visit visit) {
  AlignedArray<Real> strain(kStrainComponents * kChunk), stress(kStrainComponents * kChunk);
  std::visit(
      [&](const auto& parameters) {
        const typename std::decay_t<decltype(parameters)>::template Constants<Real> constants(parameters);
        MaterialInput<Real> in{};
        in.constants = &constants;
        for (std::size_t k = 0; k < kStrainComponents; ++k) {
          in.strain[k] = strain.data() + k * kChunk;
          in.stress[k] = stress.data() + k * kChunk;
        }
        for (std::size_t first = 0; first < source.set.count; first += kChunk) {
          in.count = std::min(kChunk, source.set.count - first);
          for (std::size_t k = 0; k < kStrainComponents; ++k) {
            std::copy_n(source.set.strain[k].data() + first, in.count, in.strain[k]);
          }
          for (std::size_t k = 0; k < source.set.law_channels; ++k)  // read, as kernels of stress do
            in.channels[k] = const_cast<Real*>(source.set.extra[k].values.data() + first);
          source.kernels.stress(in);
          for (std::size_t i = 0; i < in.count; ++i) {
            std::array<double, 6> tau;
            for (std::size_t k = 0; k < 6; ++k) tau[k] = in.stress[k][i];
            visit(first + i, tau);
          }
        }
      },
      source.material.parameters);
}

template <class Real>
void put_stress(const Source<Real>& source, std::vector<float>& values) {
  for_each_stress(source, [&](std::size_t p, const std::array<double, 6>& tau) {
    const double j = std::exp(trace_of(source.set, p));
    float* to = &values[6 * std::size_t{source.row[p]}];
    for (std::size_t k = 0; k < 6; ++k) to[k] = static_cast<float>(tau[kFileOrder[k]] / j);
  });
}

template <class Real>
void put_pressure(const Source<Real>& source, std::vector<float>& values) {
  for_each_stress(source, [&](std::size_t p, const std::array<double, 6>& tau) {
    const double j = std::exp(trace_of(source.set, p));
    values[source.row[p]] = static_cast<float>((0.0 - tau[0] - tau[3] - tau[5]) / (3.0 * j));
  });
}

template <class Real>
void put_elastic_strain(const Source<Real>& source, std::vector<float>& values) {
  for (std::size_t p = 0; p < source.set.count; ++p) {
    float* to = &values[6 * std::size_t{source.row[p]}];
    for (std::size_t k = 0; k < 6; ++k) to[k] = static_cast<float>(source.set.strain[kFileOrder[k]][p]);
  }
}

template <class Real>
void put_density(const Source<Real>& source, std::vector<float>& values) {
  const double rest = source.material.elasticity().density;
  const std::size_t channel = source.set.extra_index(kVolumeGained.kName);
  const Real* gained = channel < source.set.extra.size() ? source.set.extra[channel].values.data() : nullptr;
  for (std::size_t p = 0; p < source.set.count; ++p) {
    const double growth = trace_of(source.set, p) + (gained != nullptr ? double(gained[p]) : 0.0);
    values[source.row[p]] = static_cast<float>(rest * std::exp(-growth));
  }
}

template <class Real>
void put_speed(const Source<Real>& source, std::vector<float>& values) {
  for (std::size_t p = 0; p < source.set.count; ++p) {
    double square = 0.0;
    for (const auto& v : source.set.velocity) square += double(v[p]) * double(v[p]);
    values[source.row[p]] = static_cast<float>(std::sqrt(square));
  }
}

template <class Real>
void put_age(const Source<Real>& source, std::vector<float>& values) {
  const std::size_t channel = source.set.extra_index(kBirth.kName);
  const bool known = channel < source.set.extra.size();
  for (std::size_t p = 0; p < source.set.count; ++p) {
    const double birth = known ? double(source.set.extra[channel].values[p]) : std::nan("");
    values[source.row[p]] = static_cast<float>(source.time - birth);
  }
}

template <class Real>
void put_velocity_gradient(const Source<Real>& source, std::vector<float>& values) {
  for (std::size_t p = 0; p < source.set.count; ++p) {
    float* to = &values[9 * std::size_t{source.row[p]}];
    for (std::size_t k = 0; k < 9; ++k)
      to[k] = source.set.keeps_affine ? static_cast<float>(source.set.affine[k][p]) : std::nanf("");
  }
}

/// sqrt(2 D' : D') of the gradient that a particle keeps, 1/s.
template <class Real>
double shear_rate(const ParticleSet<Real>& set, std::size_t p) {
  if (!set.keeps_affine) return std::nan("");
  const auto at = [&](std::size_t row, std::size_t column) { return double(set.affine[3 * row + column][p]); };
  const double mean = (at(0, 0) + at(1, 1) + at(2, 2)) / 3.0;
  double square = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      const double rate = 0.5 * (at(i, j) + at(j, i)) - (i == j ? mean : 0.0);
      square += 2.0 * rate * rate;
    }
  }
  return std::sqrt(square);
}

template <class Real>
void put_shear_rate(const Source<Real>& source, std::vector<float>& values) {
  for (std::size_t p = 0; p < source.set.count; ++p)
    values[source.row[p]] = static_cast<float>(shear_rate(source.set, p));
}

template <class Real>
void put_inertial_number(const Source<Real>& source, std::vector<float>& values) {
  if (!source.grains) {
    for (std::size_t p = 0; p < source.set.count; ++p) values[source.row[p]] = std::nanf("");
    return;
  }
  for_each_stress(source, [&](std::size_t p, const std::array<double, 6>& tau) {
    const double pressure = -(tau[0] + tau[3] + tau[5]) / (3.0 * std::exp(trace_of(source.set, p)));
    const double rate = shear_rate(source.set, p);
    // d sqrt(rho_s / p) is the time that grains take to be pressed together; without pressure they never are.
    const double heaviness =
        pressure <= 0.0 ? std::numeric_limits<double>::infinity() : source.grains->density / pressure;
    const double number = rate == 0.0 ? 0.0 : rate * source.grains->diameter * std::sqrt(heaviness);
    values[source.row[p]] = static_cast<float>(number);
  });
}

template <class Real>
void put_plastic_strain(const Source<Real>& source, std::vector<float>& values) {
  const std::size_t channel = source.set.extra_index(kEquivalentPlasticStrain.kName);
  const bool known = channel < source.set.extra.size();
  const bool yields = std::visit([](const auto& law) { return std::decay_t<decltype(law)>::kYields; },
                                 source.material.parameters);
  for (std::size_t p = 0; p < source.set.count; ++p) {
    values[source.row[p]] = known    ? static_cast<float>(source.set.extra[channel].values[p])
                            : yields ? std::nanf("")
                                     : 0.0f;
  }
}

/// How an attribute of one name is computed. An attribute of the scene is a line of the list, in its order.
template <class Real>
struct Recipe {
  OutputAttribute attribute;
  const char* name;
  int components;
  void (*put)(const Source<Real>&, std::vector<float>&);
};

template <class Real>
constexpr std::array<Recipe<Real>, 10> kRecipes{
    {{OutputAttribute::kStress, "stress", 6, put_stress<Real>},
     {OutputAttribute::kPressure, "pressure", 1, put_pressure<Real>},
     {OutputAttribute::kElasticStrain, "elastic_strain", 6, put_elastic_strain<Real>},
     {OutputAttribute::kDensity, "density", 1, put_density<Real>},
     {OutputAttribute::kSpeed, "speed", 1, put_speed<Real>},
     {OutputAttribute::kAge, "age", 1, put_age<Real>},
     {OutputAttribute::kShearRate, "shear_rate", 1, put_shear_rate<Real>},
     {OutputAttribute::kInertialNumber, "inertial_number", 1, put_inertial_number<Real>},
     {OutputAttribute::kPlasticStrain, "plastic_strain", 1, put_plastic_strain<Real>},
     {OutputAttribute::kVelocityGradient, "velocity_gradient", 9, put_velocity_gradient<Real>}}};

/// Channels of one set that are one attribute: "Cd.x", "Cd.y" and "Cd.z" are "Cd", others are one each.
struct Lanes {
  std::string name;
  std::size_t first, count;
};

template <class Real>
std::vector<Lanes> lanes_of(const ParticleSet<Real>& set) {
  std::vector<Lanes> list;
  for (std::size_t k = 0; k < set.extra.size(); ++k) {
    const std::string stem = set.extra[k].name.substr(0, set.extra[k].name.find('.'));
    if (!list.empty() && list.back().name == stem) {
      ++list.back().count;
    } else {
      list.push_back({stem, k, 1});
    }
  }
  return list;
}

/// Channels of every set, all or those that are named; zero where a set lacks one.
template <class Real>
void add_channels(const std::vector<Source<Real>>& sources, const std::vector<std::string>* named,
                  PointCloud& cloud) {
  const std::size_t first = cloud.attributes.size();
  for (const Source<Real>& source : sources) {
    for (const Lanes& lanes : lanes_of(source.set)) {
      if (named != nullptr && std::find(named->begin(), named->end(), lanes.name) == named->end()) continue;
      const std::size_t n = lanes.count;
      std::size_t at = first;
      while (at < cloud.attributes.size() && cloud.attributes[at].name != lanes.name) ++at;
      if (at == cloud.attributes.size()) {
        cloud.attributes.push_back({lanes.name, static_cast<int>(n), std::vector<float>(n * cloud.size())});
      }
      std::vector<float>& values = cloud.attributes[at].values;
      for (std::size_t k = 0; k < n; ++k) {
        const Real* const from = source.set.extra[lanes.first + k].values.data();
        for (std::size_t p = 0; p < source.set.count; ++p)
          values[n * source.row[p] + k] = static_cast<float>(from[p]);
      }
    }
  }
}

template <class Real>
void add_attribute(OutputAttribute wanted, const std::vector<Source<Real>>& sources, PointCloud& cloud) {
  if (wanted == OutputAttribute::kChannels) return add_channels(sources, nullptr, cloud);
  for (const Recipe<Real>& recipe : kRecipes<Real>) {
    if (recipe.attribute != wanted) continue;
    const std::size_t n = static_cast<std::size_t>(recipe.components);
    PointAttribute attribute{recipe.name, recipe.components, std::vector<float>(n * cloud.size())};
    for (const Source<Real>& source : sources) recipe.put(source, attribute.values);
    cloud.attributes.push_back(std::move(attribute));
  }
}

template <class Real>
void put_positions(const State<Real>& state, const Source<Real>& source, PointCloud& cloud) {
  const ParticleSet<Real>& set = source.set;
  const auto occupied_blocks = state.grid.occupied_blocks();
  for (std::size_t occupied = 0; set.count > 0 && occupied < occupied_blocks.size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
      const Vec3 x = state.within_periods(state.world(block, set, p));
      cloud.position[source.row[p]] = {x[0], x[1], x[2]};
    }
  }
}

template <class Real>
void put_particles(const Source<Real>& source, PointCloud& cloud) {
  const ParticleSet<Real>& set = source.set;
  // A sphere of half the particle's volume: grains that touch without hiding one another.
  const double radius = std::cbrt(3.0 / (4.0 * std::numbers::pi) * 0.5 * set.particle_volume);
  for (std::size_t p = 0; p < set.count; ++p) {
    const std::size_t row = source.row[p];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cloud.velocity[row][axis] = static_cast<float>(set.velocity[axis][p]);
    }
    cloud.id[row] = set.id[p];
    cloud.radius[row] = static_cast<float>(radius);
  }
}

/// Fills one value per set into the rows of its particles.
template <class Real, class Get>
std::vector<float> by_set(const std::vector<Source<Real>>& sources, std::size_t count, Get get) {
  std::vector<float> values(count);
  for (const Source<Real>& source : sources) {
    const auto value = static_cast<float>(get(source));
    for (std::size_t p = 0; p < source.set.count; ++p) values[source.row[p]] = value;
  }
  return values;
}

}  // namespace

int components_of(OutputAttribute attribute) {
  for (const Recipe<float>& recipe : kRecipes<float>) {
    if (recipe.attribute == attribute) return recipe.components;
  }
  return 0;
}

template <class Real>
PointCloud make_points(const Scene& scene, const State<Real>& state, const Kernels<Real>& kernels,
                       const PointsWanted& wanted) {
  const std::vector<std::uint32_t> rows = rows_by_id(state);
  std::vector<Source<Real>> sources;
  const std::uint32_t* row = rows.data();
  for (const auto& set : state.sets) {
    const MaterialDescription& material = scene.materials[static_cast<std::size_t>(set.material)];
    sources.push_back({set, material, kernels.material[material.law()], row, state.counters.time,
                       grains_of(scene, material)});
    row += set.count;
  }
  PointCloud cloud;
  cloud.spacing = state.spacing;
  cloud.position.resize(rows.size());
  cloud.velocity.resize(rows.size());
  cloud.id.resize(rows.size());
  cloud.radius.resize(rows.size());
  for (const Source<Real>& source : sources) {
    put_positions(state, source, cloud);
    put_particles(source, cloud);
  }
  if (scene.materials.size() > 1) {
    const auto law = [](const Source<Real>& source) { return source.material.law(); };
    cloud.attributes.push_back({"material", 1, by_set(sources, rows.size(), law)});
  }
  for (const OutputAttribute attribute : wanted.attributes) add_attribute(attribute, sources, cloud);
  if (!wanted.channels.empty()) add_channels(sources, &wanted.channels, cloud);
  if (wanted.mass) {
    cloud.mass =
        by_set(sources, rows.size(), [](const Source<Real>& source) { return source.set.particle_mass; });
  }
  return cloud;
}

template PointCloud make_points(const Scene&, const State<float>&, const Kernels<float>&, const PointsWanted&);
template PointCloud make_points(const Scene&, const State<double>&, const Kernels<double>&,
                                const PointsWanted&);

}  // namespace repose
