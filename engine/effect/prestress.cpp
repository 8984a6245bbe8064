#include "engine/effect/prestress.h"

#include <algorithm>
#include <cmath>

namespace repose {

std::vector<Example> Prestress::examples() {
  return {{"prestress", {}, {R"(prestress=[{"body": "column"}])"}}};
}

void Prestress::declare(Fields& fields) {
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

Result<void> Prestress::prepare(const Surroundings& surroundings) {
  for (const Entry& entry : list) {
    if (surroundings.body(entry.body) == nullptr) return surroundings.no_body(entry.body, "prestress");
  }
  return {};
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
  if (!set.yields()) return 0.0;
  const double alpha = set.sand().cone_slope(), root = std::sqrt(2.0 / 3.0);
  return std::max(0.0, (root - alpha) / (root + 2.0 * alpha));
}

}  // namespace

template <class Real>
void Prestress::initialize(Newcomers<Real>& newcomers) const {
  const SetDescription& set = newcomers.description;
  const auto entry = std::find_if(list.begin(), list.end(), [&](const Entry& e) { return e.body == set.name; });
  if (entry == list.end()) return;
  const Surroundings& around = newcomers.surroundings;
  const int up = around.up[1] > 0.0 ? 1 : 2;
  const Elasticity& elasticity = set.elasticity();
  double surface = entry->surface;
  if (std::isnan(surface)) {
    surface = -std::numeric_limits<double>::infinity();
    for (std::size_t p = newcomers.first; p < newcomers.last; ++p) {
      surface = std::max(surface, newcomers.position(p)[up]);
    }
  }
  const double nu = elasticity.poisson_ratio;
  const double lateral =
      std::isnan(entry->lateral) ? std::max(nu / (1.0 - nu), least_lateral(set)) : entry->lateral;
  constexpr int kDiagonal[] = {0, 3, 5};
  for (std::size_t p = newcomers.first; p < newcomers.last; ++p) {
    const double depth = std::max(0.0, surface - newcomers.position(p)[up]);
    const double vertical = -(elasticity.density * around.gravity.norm() * depth + entry->load);
    const auto [along, across] = strains(elasticity, vertical, lateral * vertical);
    for (int axis = 0; axis < 3; ++axis) {
      newcomers.set.strain[kDiagonal[axis]][p] = static_cast<Real>(axis == up ? along : across);
    }
  }
}

template void Prestress::initialize(Newcomers<float>&) const;
template void Prestress::initialize(Newcomers<double>&) const;

}  // namespace repose
