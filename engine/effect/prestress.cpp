#include "engine/effect/prestress.h"

#include <algorithm>
#include <cmath>

#include "engine/effect/effect.h"

namespace repose {

std::vector<Example> Prestress::examples() {
  return {{"prestress", {}, {R"(prestress=[{"body": "column"}])"}}};
}

void Prestress::declare(Fields& fields, const SceneOutline&) {
  fields.list("prestress", false, "bodies that begin under their weight", [this](Fields& f) {
    Entry entry;
    f.text("body", entry.body, "name of the body", true);
    f.number("surface", entry.surface,
             {.unit = "m", .meaning = "height of the free surface; without it, that of the highest particle"});
    f.number(
        "lateral", entry.lateral,
        {.meaning = "horizontal over vertical stress; without it nu / (1 - nu), that of sand laid down between "
                    "walls, and no less than the cone allows",
         .low = 0.0});
    f.number("load", entry.load, {.unit = "Pa", .meaning = "what presses on the surface", .low = 0.0});
    list.push_back(entry);
  });
}

namespace {

/// The strain of a vertical stress and a horizontal one, tau = 2 mu eps + lambda tr(eps) I: {vertical,
/// horizontal}.
std::array<double, 2> strains(const Elasticity& e, double vertical, double horizontal) {
  const double trace = (vertical + 2.0 * horizontal) / (3.0 * e.lambda() + 2.0 * e.mu());
  return {(vertical - e.lambda() * trace) / (2.0 * e.mu()), (horizontal - e.lambda() * trace) / (2.0 * e.mu())};
}

/// The least horizontal over vertical stress that the cone bears: with r of it, |dev| = sqrt(2/3) (1 - r) and
/// |tr| = 1 + 2 r.
double least_lateral(const SetDescription& set) {
  if (set.cone() == nullptr) return 0.0;
  const double alpha = set.cone()->cone_slope(), root = std::sqrt(2.0 / 3.0);
  return std::max(0.0, (root - alpha) / (root + 2.0 * alpha));
}

template <class Real>
class WeightAtRest : public Effect<Real> {
 public:
  explicit WeightAtRest(const Prestress& prestress) : prestress_(prestress) {}

  Result<void> prepare(const Surroundings& surroundings) override {
    for (const Prestress::Entry& entry : prestress_.list) {
      if (surroundings.body(entry.body) == nullptr) return surroundings.no_body(entry.body, "prestress");
    }
    return {};
  }

  void initialize(Newcomers<Real>& newcomers) const override {
    for (const Prestress::Entry& entry : prestress_.list) {
      if (entry.body == newcomers.description.name) return load(entry, newcomers);
    }
  }

 private:
  static double surface_of(const Prestress::Entry& entry, const Newcomers<Real>& newcomers, int up) {
    if (!std::isnan(entry.surface)) return entry.surface;
    double highest = -std::numeric_limits<double>::infinity();
    for (std::size_t p = newcomers.first; p < newcomers.last; ++p)
      highest = std::max(highest, newcomers.position(p)[up]);
    return highest;
  }

  static void load(const Prestress::Entry& entry, Newcomers<Real>& newcomers) {
    const SetDescription& set = newcomers.description;
    const Surroundings& around = newcomers.surroundings;
    const int up = around.up[1] > 0.0 ? 1 : 2;
    const Elasticity& elasticity = set.elasticity();
    const double surface = surface_of(entry, newcomers, up), nu = elasticity.poisson_ratio;
    const double lateral =
        std::isnan(entry.lateral) ? std::max(nu / (1.0 - nu), least_lateral(set)) : entry.lateral;
    constexpr int kDiagonal[] = {0, 3, 5};
    for (std::size_t p = newcomers.first; p < newcomers.last; ++p) {
      const double depth = std::max(0.0, surface - newcomers.position(p)[up]);
      const double vertical = -(elasticity.density * around.gravity.norm() * depth + entry.load);
      const auto [along, across] = strains(elasticity, vertical, lateral * vertical);
      for (int axis = 0; axis < 3; ++axis) {
        newcomers.set.strain[kDiagonal[axis]][p] = static_cast<Real>(axis == up ? along : across);
      }
    }
  }

  Prestress prestress_;
};

}  // namespace

REPOSE_EFFECT(Prestress, WeightAtRest)

}  // namespace repose
