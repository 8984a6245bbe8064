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
  };
  declare_entry(fields, kName, "patches of stronger and weaker sand, from smooth noise", material, describe);
}

std::vector<Channel> Variation::channels(const SetDescription& set) const {
  const VariationParameters* p = find(set);
  std::vector<Channel> channels;
  if (p != nullptr && p->friction > 0.0) channels.push_back({kFriction, 1.0});
  if (p != nullptr && p->cohesion > 0.0) channels.push_back({kCohesion, 1.0});
  return channels;
}

template <class Real>
void Variation::initialize(Newcomers<Real>& newcomers) const {
  const VariationParameters* p = find(newcomers.description);
  if (p == nullptr) return;
  const auto seed = static_cast<std::uint64_t>(p->seed);
  const auto fill = [&](const char* channel, double share, std::uint64_t of) {
    if (share <= 0.0) return;
    Real* const factor = newcomers.set.extra[newcomers.set.extra_index(channel)].values.data();
    for (std::size_t i = newcomers.first; i < newcomers.last; ++i) {
      factor[i] = static_cast<Real>(1.0 + share * noise(newcomers.position(i) / p->length, of));
    }
  };
  fill(kFriction, p->friction, 2 * seed);
  fill(kCohesion, p->cohesion, 2 * seed + 1);
}

template <class Real>
void Variation::add_before_return(Assembly<Real>& assembly, std::size_t set) const {
  const VariationParameters* p = find(assembly.sets[set]);
  if (p == nullptr) return;
  const auto add = [&](const char* channel, const char* quantity, auto array) {
    const std::size_t index = assembly.state.sets[set].extra_index(channel);
    assembly.plan.gather[set].push_back(
        {{std::string("variation of ") + quantity, why(), {channel, quantity}, {quantity}},
         [index, array](Chunk<Real>& chunk) {
           const Real* const factor = chunk.set.extra[index].values.data() + chunk.first;
           Real* const values = array(chunk.scratch);
           for (std::size_t i = 0; i < chunk.particles.count; ++i) values[i] *= factor[i];
         }});
  };
  if (p->friction > 0.0)
    add(kFriction, "cone", [](Scratch<Real>& scratch) { return scratch.yield.cone.data(); });
  if (p->cohesion > 0.0)
    add(kCohesion, "cohesion", [](Scratch<Real>& scratch) { return scratch.yield.cohesion.data(); });
}

template void Variation::initialize(Newcomers<float>&) const;
template void Variation::initialize(Newcomers<double>&) const;
template void Variation::add_before_return(Assembly<float>&, std::size_t) const;
template void Variation::add_before_return(Assembly<double>&, std::size_t) const;

}  // namespace repose
