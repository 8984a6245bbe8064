#include "engine/simulation/warnings.h"

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <numeric>

#include "engine/base/wording.h"
#include "engine/effect/thin_solid.h"
#include "engine/plan/time_step.h"
#include "engine/simulation/diagnostics.h"
#include "kernels/material/hencky.h"

namespace repose {
namespace {

/// Particles are seeded up to a surface that they touch, and a mesh errs by a tenth of a cell.
constexpr double kToleratedCells = 0.5;

constexpr double kShareWorthAWord = 0.25;

struct Inside {
  std::uint64_t count = 0;
  double depth = 0.0;  // m
  const Solid* solid = nullptr;
};

template <class Real>
Inside inside_block(const std::vector<Solid>& solids, const State<Real>& state, const ParticleSet<Real>& set,
                    std::size_t occupied) {
  Inside inside;
  const Index3 block = state.grid.occupied_coordinates(occupied);
  if (!any_near(solids, state, block)) return inside;
  const double tolerated = kToleratedCells * state.spacing;
  for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
    const Vec3 x = state.world(block, set, p);
    double deepest = tolerated;
    for (const Solid& solid : solids) {
      const double depth = -solid.distance(x);
      deepest = std::max(deepest, depth);
      if (depth <= std::max(tolerated, inside.depth)) continue;
      inside.depth = depth;
      inside.solid = &solid;
    }
    inside.count += deepest > tolerated ? 1 : 0;
  }
  return inside;
}

template <class Real>
std::string inside_text(const ParticleSet<Real>& set, const Inside& inside, double spacing) {
  char figures[128];
  std::snprintf(figures, sizeof figures,
                "%llu of %zu particles start inside solids, the deepest %.3g cells (%.3g m)",
                static_cast<unsigned long long>(inside.count), set.count, inside.depth / spacing, inside.depth);
  return "bodies." + set.name + ": " + figures + " inside colliders." + inside.solid->name +
         "; solids do not push out what starts within them, so move one of the two";
}

template <class Real>
struct Fastest {
  const ParticleSet<Real>* set = nullptr;
  std::size_t occupied = 0, particle = 0;
  double speed = -1.0;  // m/s
};

template <class Real>
Fastest<Real> find_fastest(const State<Real>& state) {
  Fastest<Real> fastest;
  for_each_in_blocks(state, [&](const ParticleSet<Real>& set, std::size_t occupied, std::size_t p) {
    const Vec3 v(double(set.velocity[0][p]), double(set.velocity[1][p]), double(set.velocity[2][p]));
    if (v.norm() > fastest.speed) fastest = {&set, occupied, p, v.norm()};
  });
  return fastest;
}

/// How many particles of a block have come to the least stretch but for some rounding.
template <class Real>
std::uint64_t crushed(const ParticleSet<Real>& set, std::size_t occupied) {
  const double least = std::log(1.05 * static_cast<double>(kSmallestStretch<Real>));
  std::uint64_t count = 0;
  for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
    double eps[kStrainComponents];  // xx xy xz yy yz zz
    for (std::size_t k = 0; k < kStrainComponents; ++k) eps[k] = double(set.strain[k][p]);
    const double off = eps[1] * eps[1] + eps[2] * eps[2] + eps[4] * eps[4];
    const double square = eps[0] * eps[0] + eps[3] * eps[3] + eps[5] * eps[5] + 2.0 * off;
    if (square < least * least) continue;
    Mat3 strain;
    strain << eps[0], eps[1], eps[2], eps[1], eps[3], eps[4], eps[2], eps[4], eps[5];
    const Eigen::SelfAdjointEigenSolver<Mat3> of(strain, Eigen::EigenvaluesOnly);
    count += of.eigenvalues().minCoeff() <= least ? 1 : 0;
  }
  return count;
}

}  // namespace

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  const StencilFigures& nodes = kStencilFigures[static_cast<std::size_t>(scene.grid.stencil)];
  if (!std::isfinite(nodes.feedback)) {
    warnings.push_back(std::string("grid.stencil: no step is stable for particles that stand alone with \"") +
                       nodes.name + "\"; use it only to compare");
  }
  const TransferFigures& transfer = kTransferFigures[static_cast<std::size_t>(scene.grid.transfer)];
  if (scene.grid.kept_velocity && transfer.keeps_velocity) {
    warnings.push_back(scene.where("grid.kept_velocity") +
                       ": acts per step, so smaller steps lose more velocity; a loss per second is "
                       "grid.velocity_loss = -ln(kept_velocity) / step");
  }
  for (const MaterialDescription& material : scene.materials) {
    const FrictionalCone* const cone = cone_of(material.parameters);
    if (cone == nullptr || 3.0 * cone->cone_slope() / std::sqrt(2.0) < 1.0) continue;
    char angle[32];
    std::snprintf(angle, sizeof angle, "%g", cone->friction_angle);
    warnings.push_back("materials." + material.name + ": with friction_angle " + angle +
                       " and this cone_matching the sand can never yield in plane strain; see docs/math.md on "
                       "cone matching");
  }
  return warnings;
}

std::vector<std::string> thin_solid_warnings(const std::vector<Solid>& solids, double spacing) {
  std::vector<std::string> warnings;
  for (const Solid& solid : solids) {
    const std::string thin = "colliders." + solid.name + ": is thinner than two cells";
    if (solid.thickened > 0.0) {
      warnings.push_back(thin + ", and nodes would not see it: it acts as if it were " +
                         number_text(solid.thickened) +
                         " m thicker to either side; make it thicker, or grid.spacing finer");
    } else if (thin_in_places(solid, spacing)) {
      warnings.push_back(thin +
                         " in places, where material may pass through it; make it thicker there, or "
                         "grid.spacing finer");
    }
  }
  return warnings;
}

template <class Real>
std::vector<std::string> seeding_warnings(const std::vector<Solid>& solids, const State<Real>& state,
                                          Threads& threads) {
  std::vector<std::string> warnings;
  if (solids.empty()) return warnings;
  std::vector<Inside> blocks(state.grid.occupied_blocks().size());
  for (const auto& set : state.sets) {
    threads.for_each(blocks.size(), [&](std::size_t occupied) {
      blocks[occupied] = inside_block(solids, state, set, occupied);
    });
    Inside all;
    for (const Inside& block : blocks) {
      all.count += block.count;
      if (block.depth <= all.depth) continue;
      all.depth = block.depth;
      all.solid = block.solid;
    }
    if (all.count > 0) warnings.push_back(inside_text(set, all, state.spacing));
  }
  return warnings;
}

template <class Real>
std::optional<std::string> speed_warning(const StepPlan<Real>& plan, const State<Real>& state) {
  const double whole = std::numeric_limits<double>::infinity();
  const auto next = [&](const Counters& counters) {
    return choose_step(plan.limits, plan.transfer, state.spacing, counters, whole);
  };
  const StepSize cut = next(state.counters);
  if (cut.limit != Limit::kVelocity) return std::nullopt;
  Counters calm = state.counters;
  calm.max_speed = 0.0;
  const double allowed = next(calm).dt;
  if (cut.dt >= kShareWorthAWord * allowed) return std::nullopt;
  const Fastest<Real> fastest = find_fastest(state);
  if (fastest.set == nullptr) return std::nullopt;
  const Vec3 x = state.world(state.grid.occupied_coordinates(fastest.occupied), *fastest.set, fastest.particle);
  char text[320];
  std::snprintf(
      text, sizeof text,
      "' at (%.4g, %.4g, %.4g) m moves at %.3g m/s, which cuts steps to %.3g s where all limits but that of "
      "velocity (time.cfl) would allow %.3g s; is there a floor under it?",
      x[0], x[1], x[2], fastest.speed, cut.dt, allowed);
  return "particle " + std::to_string(fastest.set->id[fastest.particle]) + " of '" + fastest.set->name + text;
}

template <class Real>
std::optional<std::string> crushed_warning(const State<Real>& state, Threads& threads) {
  std::vector<std::uint64_t> blocks(state.grid.occupied_blocks().size());
  for (const auto& set : state.sets) {
    threads.for_each(blocks.size(), [&](std::size_t occupied) { blocks[occupied] = crushed(set, occupied); });
    const std::uint64_t all = std::accumulate(blocks.begin(), blocks.end(), std::uint64_t{0});
    if (all == 0) continue;
    char text[256];
    std::snprintf(text, sizeof text,
                  "%llu of %zu particles of '%s' are pressed to %.0e of their thickness, and no strain is told "
                  "beyond that; stiffer matter, or slower motion, keeps its volume",
                  static_cast<unsigned long long>(all), set.count, set.name.c_str(),
                  static_cast<double>(kSmallestStretch<Real>));
    return text;
  }
  return std::nullopt;
}

template std::vector<std::string> seeding_warnings(const std::vector<Solid>&, const State<float>&, Threads&);
template std::vector<std::string> seeding_warnings(const std::vector<Solid>&, const State<double>&, Threads&);
template std::optional<std::string> speed_warning(const StepPlan<float>&, const State<float>&);
template std::optional<std::string> speed_warning(const StepPlan<double>&, const State<double>&);
template std::optional<std::string> crushed_warning(const State<float>&, Threads&);
template std::optional<std::string> crushed_warning(const State<double>&, Threads&);

}  // namespace repose
