// Repose tests: the battery: particles on the faces of cells and blocks, and an ulp beside them.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "engine/compiler/compiler.h"
#include "engine/state/block_sort.h"
#include "engine/state/state_hash.h"
#include "engine/step/stepper.h"
#include "tests/physics/physics_rig.h"
#include "tests/stability/battery.h"

namespace repose {
namespace {

constexpr const char* kScene = R"json({"repose": 1, "name": "faces", "grid": {"spacing": 0.25},
  "materials": {"sand": {"type": "drucker_prager"}}, "gravity": {"acceleration": [0, 0, 0]},
  "bodies": [{"name": "sand", "material": "sand", "shape": {"type": "box", "lower": [0, 0, 0],
    "upper": [1, 1, 1]}}]
  })json";

/// Places along one axis: cell and offset.
template <class Real>
struct Along {
  std::int32_t cell;
  Real offset;
};

/// Faces of cells and of blocks, middles of cells, and an ulp beside each.
template <class Real>
std::vector<Along<Real>> places_along() {
  const Real one = 1, half = Real(0.5), zero = 0;
  std::vector<Along<Real>> places;
  for (const std::int32_t cell : {-4, -1, 0, 3, 4}) {
    for (const Real offset :
         {zero, std::nextafter(zero, one), std::numeric_limits<Real>::epsilon(), std::nextafter(half, zero),
          half, std::nextafter(half, one), std::nextafter(one, zero)}) {
      places.push_back({cell, offset});
    }
  }
  return places;
}

template <class Real>
struct Stepped {
  State<Real> state;
  bool accepted = false;
};

/// A particle at each place of the cross product, at rest, after one step on a target.
template <class Real>
Stepped<Real> step_on(Target target, const std::string& stencil) {
  const Scene scene = scene_of(kScene, {sizeof(Real) == 4 ? "grid.precision=single" : "grid.precision=double",
                                        "grid.stencil=" + stencil});
  auto compiled = compile_scene<Real>(scene, {.target = target});
  EXPECT_TRUE(compiled) << compiled.error().text();
  State<Real>& state = compiled->state;
  ParticleSet<Real>& set = state.sets[0];
  const auto along = places_along<Real>();
  const std::size_t side = along.size();
  set.allocate(side * side * side);
  set.for_each_real([](AlignedArray<Real>& channel) { std::fill_n(channel.data(), channel.size(), Real(0)); });
  std::vector<std::vector<Index3>> cells(1, std::vector<Index3>(set.count));
  for (std::size_t p = 0; p < set.count; ++p) {
    const std::size_t at[3] = {p / side / side, p / side % side, p % side};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      cells[0][p][axis] = along[at[axis]].cell;
      set.position[axis][p] = along[at[axis]].offset;
    }
    set.id[p] = static_cast<std::uint32_t>(p);
  }
  state.ledger.initial = state.ledger.next_id = set.count;
  place_in_blocks(state, std::move(cells), compiled->plan.transfer.ownership());
  Stepper<Real> stepper(std::move(compiled->plan), 2);
  Stepped<Real> result;
  // Sorted, and not yet moved: what the scatter finds.
  EXPECT_TRUE(stepper.sort_if_due(state));
  result.accepted = stepper.step(state, 1e-12).accepted;
  result.state = std::move(state);
  return result;
}

/// Which nodes have mass, by block, 64 bits each; and all of the mass. Products of three weights of an ulp each
/// may underflow on one instruction set and not on another, so the least masses count as none.
template <class Real>
std::map<Index3, std::uint64_t> nodes_with_mass(const State<Real>& state, long double& mass) {
  std::map<Index3, std::uint64_t> found;
  for (std::size_t b = 0; b < state.grid.size(); ++b) {
    std::uint64_t bits = 0;
    for (int n = 0; n < kBlockNodes; ++n) {
      const Real m = state.nodes.block(b)[kNodeValues * n];
      mass += static_cast<long double>(m);
      if (m > Real(sizeof(Real) == 4 ? 1e-36 : 1e-250)) bits |= std::uint64_t{1} << n;
    }
    if (bits != 0) found[state.grid.blocks()[b]] = bits;
  }
  return found;
}

long double spline(int width, long double x) {
  x = std::abs(x);
  if (width == 2) return std::max(0.0L, 1.0L - x);
  if (width == 3) return x < 0.5L ? 0.75L - x * x : x < 1.5L ? 0.5L * (1.5L - x) * (1.5L - x) : 0.0L;
  return x < 1.0L   ? 0.5L * x * x * x - x * x + 2.0L / 3.0L
         : x < 2.0L ? (2.0L - x) * (2.0L - x) * (2.0L - x) / 6.0L
                    : 0.0L;
}

/// Nodes to which the particles, where they lie now, give more than `least` of their mass, by the formula
/// alone.
template <class Real>
std::map<Index3, std::uint64_t> nodes_reached(const State<Real>& state, int width, long double least) {
  std::map<Index3, std::uint64_t> found;
  const ParticleSet<Real>& set = state.sets[0];
  for (std::size_t occupied = 0; occupied < state.grid.occupied_blocks().size(); ++occupied) {
    const Index3 block = state.grid.occupied_coordinates(occupied);
    for (std::size_t p = set.begin[occupied]; p < set.begin[occupied + 1]; ++p) {
      constexpr int kFirst = -3, kWindow = 11;  // all that a particle of a block may reach
      long double weight[3][kWindow];
      for (std::size_t axis = 0; axis < 3; ++axis) {
        for (int n = 0; n < kWindow; ++n)
          weight[axis][n] = spline(width, static_cast<long double>(set.position[axis][p]) - (n + kFirst));
      }
      for (int n = 0; n < kWindow * kWindow * kWindow; ++n) {
        const int at[3] = {n / kWindow / kWindow, n / kWindow % kWindow, n % kWindow};
        if (weight[0][at[0]] == 0.0L || weight[1][at[1]] == 0.0L) continue;
        if (!(weight[0][at[0]] * weight[1][at[1]] * weight[2][at[2]] > least)) continue;
        Index3 home{};
        int bit = 0;
        for (std::size_t axis = 0; axis < 3; ++axis) {
          const int node = at[axis] + kFirst;
          home[axis] = block[axis] + (node >> 2);
          bit = 4 * bit + (node & 3);
        }
        found[home] |= std::uint64_t{1} << bit;
      }
    }
  }
  return found;
}

/// Nodes of `all` that `some` lacks.
double lacking(const std::map<Index3, std::uint64_t>& all, const std::map<Index3, std::uint64_t>& some) {
  double count = 0.0;
  for (const auto& [block, bits] : all) {
    const auto found = some.find(block);
    count += __builtin_popcountll(bits & ~(found == some.end() ? 0 : found->second));
  }
  return count;
}

template <class Real>
void on_faces(battery::Case& c, const std::string& precision) {
  double refused = 0.0, lost = 0.0, unreached = 0.0, beyond = 0.0, other_rows = 0.0, other_nodes = 0.0,
         other_bits = 0.0, nodes = 0.0;
  for (const auto& [stencil, width] : {std::pair{"quadratic", 3}, {"cubic", 4}, {"linear", 2}}) {
    std::vector<Stepped<Real>> all;
    std::vector<Target> targets;
    for (const Target target : {Target::kBaseline, Target::kAvx2, Target::kAvx512}) {
      if (!target_supported(target)) continue;
      all.push_back(step_on<Real>(target, stencil));
      targets.push_back(target);
    }
    std::map<Index3, std::uint64_t> first;
    const auto well_reached = nodes_reached(all[0].state, width, 1e-6L);
    const auto reached = nodes_reached(all[0].state, width, 0.0L);
    for (std::size_t k = 0; k < all.size(); ++k) {
      const State<Real>& state = all[k].state;
      refused += all[k].accepted ? 0.0 : 1.0;
      long double mass = 0.0L;
      const auto found = nodes_with_mass(state, mass);
      const double there = state.sets[0].particle_mass * static_cast<double>(state.sets[0].count);
      lost = std::max(lost, std::abs(static_cast<double>(mass / static_cast<long double>(there)) - 1.0));
      // Weights below the rounding of a node's sum may come out as nothing.
      unreached += lacking(well_reached, found);
      beyond += lacking(found, reached);
      if (k == 0) first = found;
      other_nodes += lacking(first, found) + lacking(found, first);
      other_rows += state.rows_touched == all[0].state.rows_touched ? 0.0 : 1.0;
      const bool fuse = targets[k] != Target::kBaseline && targets[all.size() - 1] != Target::kBaseline;
      if (fuse) other_bits += state_hash(state) == state_hash(all.back().state) ? 0.0 : 1.0;
      for (const auto& [block, bits] : found) nodes += __builtin_popcountll(bits);
    }
  }
  c.at_most("steps refused, " + precision, refused, 0.0);
  c.at_most("mass that is on no node, " + precision, lost, sizeof(Real) == 4 ? 2e-6 : 1e-14);
  c.at_most("nodes that lack mass, " + precision, unreached, 0.0);
  c.at_most("nodes that have mass of nobody, " + precision, beyond, 0.0);
  c.at_most("instruction sets with other rows, " + precision, other_rows, 0.0);
  c.at_most("nodes that only some instruction sets reach, " + precision, other_nodes, 0.0);
  c.at_most("hashes that differ between AVX2 and AVX-512, " + precision, other_bits, 0.0);
  c.at_least("control: nodes looked at, " + precision, nodes, 1000.0);
}

TEST(Battery, Case37_OnFacesTheSameNodesOnEveryInstructionSet) {
  battery::Case c(37, "on cell and block faces, and an ulp beside");
  on_faces<float>(c, "float");
  on_faces<double>(c, "double");
}

}  // namespace
}  // namespace repose
