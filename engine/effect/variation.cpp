#include "engine/effect/variation.h"

#include <cmath>
#include <map>

#include "engine/base/mix.h"
#include "engine/effect/effect.h"

namespace repose {
namespace {

/// In [-1, 1).
double value_at(std::int64_t i, std::int64_t j, std::int64_t k, std::uint64_t seed) {
  std::uint64_t hash = mix_bits(seed + 0x9e3779b97f4a7c15ull);
  for (const std::int64_t c : {i, j, k})
    hash = mix_bits(hash + static_cast<std::uint64_t>(c) * 0xd1b54a32d192ed03ull);
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

void Variation::declare_in_cone(Fields& fields, const std::string& material) {
  const auto describe = [](Fields& f, VariationParameters& p) {
    f.number("friction", p.friction,
             {.meaning = "the cone's slope varies by this share to either side", .low = 0.0, .high = 1.0});
    f.number("cohesion", p.cohesion,
             {.meaning = "the cohesion varies by this share to either side", .low = 0.0, .high = 1.0});
    f.number("length", p.length, {.unit = "m", .meaning = "size of the patches", .low = 0.0, .low_open = true});
    f.integer("seed", p.seed, {.meaning = "of the noise", .low = 0.0});
    constexpr const char* kFactors =
        "name of a grid of floats in it: factors of 0 or more where particles begin";
    f.feature("friction_grid", p.friction_grid.given, "the cone's slope is multiplied by what a grid holds",
              [&](Fields& grid) { describe_vdb(grid, p.friction_grid, kFactors); });
    f.feature("cohesion_grid", p.cohesion_grid.given, "the cohesion is multiplied by what a grid holds",
              [&](Fields& grid) { describe_vdb(grid, p.cohesion_grid, kFactors); });
  };
  declare_entry(fields, kName, "patches of stronger and weaker sand, from smooth noise or grids", material,
                describe);
}

std::vector<Channel> Variation::channels(const SetDescription& set) const {
  const VariationParameters* p = find(set);
  std::vector<Channel> channels;
  if (p != nullptr && p->varies_friction()) channels.push_back({kFrictionFactor, 1.0});
  if (p != nullptr && p->varies_cohesion()) channels.push_back({kCohesionFactor, 1.0});
  return channels;
}

namespace {

template <class Real>
class PatchesOfSand : public Effect<Real> {
 public:
  explicit PatchesOfSand(const Variation& variation) : variation_(variation) {}

  /// Errors: those of ScalarGrid::read, and 65, a factor below 0; with the key.
  Result<void> prepare(const Surroundings& surroundings) override {
    for (const Variation::Entry& entry : variation_.entries) {
      const std::string key = "materials." + entry.material + "." + Variation::kName;
      Grids grids;
      const VariationParameters& p = entry.parameters;
      if (auto ready = read(surroundings, p.friction_grid, key + ".friction_grid", grids.friction); !ready)
        return ready;
      if (auto ready = read(surroundings, p.cohesion_grid, key + ".cohesion_grid", grids.cohesion); !ready)
        return ready;
      grids_[entry.material] = std::move(grids);
    }
    return {};
  }

  void initialize(Newcomers<Real>& newcomers) const override {
    const VariationParameters* p = variation_.find(newcomers.description);
    if (p == nullptr) return;
    const Grids& grids = grids_.at(newcomers.description.material);
    const auto seed = static_cast<std::uint64_t>(p->seed);
    const auto fill = [&](Real* factor, double share, std::uint64_t of, const ScalarGrid* grid) {
      for (std::size_t i = newcomers.first; i < newcomers.last; ++i) {
        const Vec3 x = newcomers.position(i);
        const double smooth = share > 0.0 ? 1.0 + share * noise(x / p->length, of) : 1.0;
        factor[i] = static_cast<Real>(grid == nullptr ? smooth : smooth * grid->at(x));
      }
    };
    if (p->varies_friction())
      fill(newcomers.channel(Variation::kFrictionFactor), p->friction, 2 * seed, grids.friction.get());
    if (p->varies_cohesion())
      fill(newcomers.channel(Variation::kCohesionFactor), p->cohesion, 2 * seed + 1, grids.cohesion.get());
  }

  void add_to(PlanBuilder<Real>& plan) const override {
    plan.for_each_set_of(variation_, [&](SetSlots<Real>& set, const VariationParameters& p) {
      const auto add = [&](auto factor, auto quantity) {
        set.before_return.add({std::string("variation of ") + decltype(quantity)::kName, variation_.why()},
                              reads(factor, quantity), writes(quantity), [factor, quantity](const auto& at) {
                                const Real* const factors = at.read(factor);
                                Real* const values = at.write(quantity);
                                for (std::size_t i = 0; i < at.count(); ++i) values[i] *= factors[i];
                              });
      };
      if (p.varies_friction()) add(Variation::kFrictionFactor, kYieldSlope);
      if (p.varies_cohesion()) add(Variation::kCohesionFactor, kCohesion);
    });
  }

 private:
  struct Grids {
    std::shared_ptr<const ScalarGrid> friction, cohesion;  // null where there is none
  };

  static Result<void> read(const Surroundings& surroundings, const VdbDescription& grid, const std::string& key,
                           std::shared_ptr<const ScalarGrid>& values) {
    if (!grid.given) return {};
    const auto made = ScalarGrid::read(grid, surroundings.grid_files());
    if (!made) return Error{made.error().kind, made.error().text(), surroundings.where(key)};
    if ((*made)->least() < 0.0) {
      return Error{ErrorKind::kBadScene,
                   "grid \"" + grid.name + "\" of " + grid.file + " goes down to " +
                       std::to_string((*made)->least()) + "; factors must be 0 or more",
                   surroundings.where(key)};
    }
    values = *made;
    return {};
  }

  Variation variation_;
  std::map<std::string, Grids> grids_;  // by material
};

}  // namespace

REPOSE_EFFECT(Variation, PatchesOfSand)

}  // namespace repose
