#include "engine/effect/variation.h"

#include <cmath>

namespace repose {
namespace {

/// Finalizer of splitmix64 (Steele et al. 2014).
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// In [-1, 1).
double value_at(std::int64_t i, std::int64_t j, std::int64_t k, std::uint64_t seed) {
  std::uint64_t hash = mix(seed + 0x9e3779b97f4a7c15ull);
  for (const std::int64_t c : {i, j, k})
    hash = mix(hash + static_cast<std::uint64_t>(c) * 0xd1b54a32d192ed03ull);
  return static_cast<double>(hash >> 11) * 0x1p-52 - 1.0;
}

}  // namespace

double noise(const Vec3& x, std::uint64_t seed) {
  std::int64_t whole[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(x[axis]);
    const double f = x[axis] - floor;
    whole[axis] = static_cast<std::int64_t>(floor);
    share[axis] = f * f * (3.0 - 2.0 * f);
  }
  double sum = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    double weight = 1.0;
    std::int64_t at[3];
    for (int axis = 0; axis < 3; ++axis) {
      const int bit = corner >> axis & 1;
      weight *= bit == 1 ? share[axis] : 1.0 - share[axis];
      at[axis] = whole[axis] + bit;
    }
    sum += weight * value_at(at[0], at[1], at[2], seed);
  }
  return sum;
}

std::vector<Example> Variation::examples() {
  return {{"variation", {}, {R"(materials.sand.variation={"friction": 0.2})"}}};
}

void Variation::declare_in_sand(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, VariationParameters& p) {
    f.number("friction", p.friction,
             {.meaning = "the cone's slope varies by this share to either side", .low = 0.0, .high = 1.0});
    f.number("cohesion", p.cohesion,
             {.meaning = "the cohesion varies by this share to either side", .low = 0.0, .high = 1.0});
    f.number("length", p.length, {.unit = "m", .meaning = "size of the patches", .low = 0.0, .low_open = true});
    f.integer("seed", p.seed, {.meaning = "of the noise", .low = 0.0});
    constexpr const char* kFactors =
        "name of a grid of floats in it: factors of 0 or more where particles begin";
    f.object("friction_grid", p.friction_grid.given, false,
             "the cone's slope is multiplied by what a grid holds",
             [&](Fields& grid) { describe_vdb(grid, p.friction_grid, kFactors); });
    f.object("cohesion_grid", p.cohesion_grid.given, false, "the cohesion is multiplied by what a grid holds",
             [&](Fields& grid) { describe_vdb(grid, p.cohesion_grid, kFactors); });
  };
  declare_entry(fields, kName, "patches of stronger and weaker sand, from smooth noise or grids", material,
                describe);
}

Result<void> Variation::prepare(const Surroundings& surroundings) {
  const auto read = [&](const VdbDescription& grid, const std::string& key,
                        std::shared_ptr<const ScalarGrid>& values) -> Result<void> {
    if (!grid.given) return {};
    const auto made = ScalarGrid::read(grid, surroundings.folder, surroundings.allow_outside_paths);
    if (!made) return Error{made.error().kind, made.error().text(), surroundings.where(key)};
    if ((*made)->least() < 0.0) {
      return Error{ErrorKind::kBadScene,
                   "grid \"" + grid.name + "\" of " + grid.file + " goes down to " +
                       std::to_string((*made)->least()) + "; factors must be 0 or more",
                   surroundings.where(key)};
    }
    values = *made;
    return {};
  };
  for (Entry& entry : entries) {
    const std::string key = "materials." + entry.material + "." + kName;
    VariationParameters& p = entry.parameters;
    if (auto ready = read(p.friction_grid, key + ".friction_grid", p.of_friction); !ready) return ready;
    if (auto ready = read(p.cohesion_grid, key + ".cohesion_grid", p.of_cohesion); !ready) return ready;
  }
  return {};
}

std::vector<Channel> Variation::channels(const SetDescription& set) const {
  const VariationParameters* p = find(set);
  std::vector<Channel> channels;
  if (p != nullptr && p->varies_friction()) channels.push_back({kFrictionFactor, 1.0});
  if (p != nullptr && p->varies_cohesion()) channels.push_back({kCohesionFactor, 1.0});
  return channels;
}

template <class Real>
void Variation::initialize(Newcomers<Real>& newcomers) const {
  const VariationParameters* p = find(newcomers.description);
  if (p == nullptr) return;
  const auto seed = static_cast<std::uint64_t>(p->seed);
  const auto fill = [&](const char* channel, double share, std::uint64_t of, const ScalarGrid* grid) {
    Real* const factor = newcomers.set.extra[newcomers.set.extra_index(channel)].values.data();
    for (std::size_t i = newcomers.first; i < newcomers.last; ++i) {
      const Vec3 x = newcomers.position(i);
      const double smooth = share > 0.0 ? 1.0 + share * noise(x / p->length, of) : 1.0;
      factor[i] = static_cast<Real>(grid == nullptr ? smooth : smooth * grid->at(x));
    }
  };
  if (p->varies_friction()) fill(kFrictionFactor.kName, p->friction, 2 * seed, p->of_friction.get());
  if (p->varies_cohesion()) fill(kCohesionFactor.kName, p->cohesion, 2 * seed + 1, p->of_cohesion.get());
}

template <class Real>
void Variation::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const VariationParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  auto passes = assembly.gather(set);
  const auto add = [&](auto factor, auto quantity) {
    passes.add({std::string("variation of ") + decltype(quantity)::kName, why()}, reads(factor, quantity),
               writes(quantity), [factor, quantity](const auto& at) {
                 const Real* const factors = at.read(factor);
                 Real* const values = at.write(quantity);
                 for (std::size_t i = 0; i < at.count(); ++i) values[i] *= factors[i];
               });
  };
  if (p->varies_friction()) add(kFrictionFactor, kCone);
  if (p->varies_cohesion()) add(kCohesionFactor, kCohesion);
}

template void Variation::initialize(Newcomers<float>&) const;
template void Variation::initialize(Newcomers<double>&) const;
template void Variation::add_before_return(Assembly<float>&, std::size_t) const;
template void Variation::add_before_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
