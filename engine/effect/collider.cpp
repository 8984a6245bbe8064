#include "engine/effect/collider.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <memory>

namespace repose {
namespace {

constexpr Choice kContacts[] = {
    {"sticky", "moves with the solid"},
    {"slip", "neither enters nor leaves, slides along"},
    {"separating", "does not enter, leaves freely, slides along"},
};

constexpr Choice kAppearances[] = {
    {"auto", "glass where it is hollow, else opaque"},
    {"opaque", "a plain surface"},
    {"glass", "clear, with its outline"},
    {"hidden", "not drawn"},
};

void describe(Fields& fields, Collider& collider) {
  fields.text("name", collider.name, "what messages and overrides call it; no two colliders share a name",
              true);
  bool present = false;
  fields.object("shape", present, true, "the solid", [&](Fields& shape) { describe(shape, collider.shape); });
  fields.flag("hollow", collider.hollow, "the solid is all that lies outside the shape; material lives within");
  fields.choice("contact", collider.contact, kContacts, "what material may do at the surface");
  fields.number("friction", collider.friction,
                {.meaning = "Coulomb's coefficient between material and solid", .low = 0.0});
  fields.choice("appearance", collider.appearance, kAppearances, "how pictures show it");
}

/// A node is constrained as soon as the half cell around it reaches the solid. With the bare sign of its own
/// distance the first constrained node lies up to a cell inside, and a particle drifts farther, to where its
/// stencil has left the free nodes: 1.5 cells deep with the quadratic one, two with the cubic. So the wall is
/// met half a cell early at most, and passed by one (one and a half) at most.
constexpr double kNodeReach = 0.5;  // cells

/// One node's place beside one solid.
template <class Real>
struct NodeContact {
  Real distance;  ///< m, less the node's reach
  Real normal[3];
};

template <class Real>
class ContactTables {
 public:
  explicit ContactTables(std::vector<Solid> solids) : solids_(std::move(solids)) {
    friction_ = std::any_of(solids_.begin(), solids_.end(),
                            [](const Solid& s) { return s.friction > 0.0 && s.contact != Contact::kSticky; });
  }

  void follow_topology(State<Real>& state);
  void collide(NodeBlock<Real>& block) const;

 private:
  struct Near {
    std::size_t solid;
    std::array<NodeContact<Real>, kBlockNodes> nodes;
  };
  using NearSolids = std::vector<Near>;

  NearSolids tabulate(const State<Real>& state, const Index3& block) const;
  void collide_node(const NearSolids& near, std::size_t node, Real dt, Real* v, Real* rubbed) const;

  std::vector<Solid> solids_;
  bool friction_ = false;
  std::map<Index3, NearSolids> seen_;        // every block ever reached; entries stay where they are
  std::vector<const NearSolids*> of_block_;  // per block of the grid; null where no solid is near
};

template <class Real>
typename ContactTables<Real>::NearSolids ContactTables<Real>::tabulate(const State<Real>& state,
                                                                       const Index3& block) const {
  // Half the diagonal of a block's nodes, the cell that a node may be predicted to move along each axis, its
  // own reach.
  const double reach = ((1.5 + 1.0) * std::sqrt(3.0) + kNodeReach) * state.spacing;
  // Material lies in the plane through the origin; the single node across it stands for that plane wherever it
  // is.
  const int flat = state.topology.flat_axis;
  const auto in_plane = [flat](Vec3 x) {
    if (flat >= 0) x[flat] = 0.0;
    return x;
  };
  NearSolids near;
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    if (solids_[k].distance(in_plane(state.world(block, {1.5, 1.5, 1.5}))) > reach) continue;
    Near entry{k, {}};
    for (int node = 0; node < kBlockNodes; ++node) {
      const Vec3 x = in_plane(state.world(block, {double(node / 16), double(node / 4 % 4), double(node % 4)}));
      const Vec3 normal = in_plane(solids_[k].normal(x, 0.25 * state.spacing));
      NodeContact<Real>& contact = entry.nodes[static_cast<std::size_t>(node)];
      contact.distance = static_cast<Real>(solids_[k].distance(x) - kNodeReach * state.spacing);
      for (int axis = 0; axis < 3; ++axis) contact.normal[axis] = static_cast<Real>(normal[axis]);
    }
    near.push_back(entry);
  }
  return near;
}

template <class Real>
void ContactTables<Real>::follow_topology(State<Real>& state) {
  const auto blocks = state.grid.blocks();
  of_block_.assign(blocks.size(), nullptr);
  state.after_friction.slot.assign(friction_ ? blocks.size() : 0, -1);
  std::int32_t slots = 0;
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    auto found = seen_.find(blocks[b]);
    if (found == seen_.end()) found = seen_.emplace(blocks[b], tabulate(state, blocks[b])).first;
    if (found->second.empty()) continue;
    of_block_[b] = &found->second;
    const bool rubs = std::any_of(found->second.begin(), found->second.end(),
                                  [&](const Near& near) { return solids_[near.solid].friction > 0.0; });
    if (friction_ && rubs) state.after_friction.slot[b] = slots++;
  }
  state.after_friction.field.resize(static_cast<std::size_t>(slots));
  state.after_friction.live.assign(static_cast<std::size_t>(slots), 0);
}

template <class Real>
void ContactTables<Real>::collide(NodeBlock<Real>& block) const {
  const NearSolids* near = of_block_[block.block];
  auto& rubbed_field = block.state.after_friction;
  const std::int32_t slot = rubbed_field.slot.empty() ? -1 : rubbed_field.slot[block.block];
  if (near == nullptr) return;
  Real rubbed[kBlockValues];
  bool any_friction = false;
  for (std::size_t node = 0; node < kBlockNodes; ++node) {
    Real* at = block.nodes + node * kNodeValues;
    Real* after = rubbed + node * kNodeValues;
    std::copy_n(at, kNodeValues, after);
    if (!(at[0] > Real(0))) continue;
    collide_node(*near, node, block.dt, at + 1, after + 1);
    any_friction = any_friction || !std::equal(at, at + kNodeValues, after);
  }
  if (slot < 0) return;
  rubbed_field.live[static_cast<std::size_t>(slot)] = any_friction ? 1 : 0;
  if (any_friction) std::copy_n(rubbed, kBlockValues, rubbed_field.block(block.block));
}

template <class Real>
void ContactTables<Real>::collide_node(const NearSolids& near, std::size_t node, Real dt, Real* v,
                                       Real* rubbed) const {
  const auto dot = [](const Real* a, const Real* b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; };
  constexpr std::size_t kMost = 16;
  REPOSE_ASSERT(near.size() <= kMost);
  Real impulse[kMost] = {};  // |v-bar - v*| per solid: the impulse over the mass

  for (std::size_t k = 0; k < near.size(); ++k) {
    const NodeContact<Real>& at = near[k].nodes[node];
    const Real* n = at.normal;
    const Real along = dot(n, v);
    switch (solids_[near[k].solid].contact) {
      case Contact::kSticky:
        if (at.distance < Real(0)) v[0] = v[1] = v[2] = Real(0);
        break;
      case Contact::kSlip:
        if (at.distance < Real(0)) {
          for (int axis = 0; axis < 3; ++axis) v[axis] -= along * n[axis];
          impulse[k] = std::abs(along);
        }
        break;
      case Contact::kSeparating: {
        // phi(x_i + dt v) >= min(phi(x_i), 0), with phi linear over the step: exact for planes, and for curved
        // walls off by the sagitta of a path of one cell at most.
        const Real allowed = std::min(at.distance, Real(0));
        const Real predicted = at.distance + dt * along;
        if (predicted < allowed) {
          impulse[k] = (allowed - predicted) / dt;
          for (int axis = 0; axis < 3; ++axis) v[axis] += impulse[k] * n[axis];
        }
        break;
      }
    }
  }

  std::copy_n(v, 3, rubbed);
  for (std::size_t k = 0; k < near.size(); ++k) {
    const Real bound = static_cast<Real>(solids_[near[k].solid].friction) * impulse[k];
    if (!(bound > Real(0))) continue;
    const Real* n = near[k].nodes[node].normal;
    const Real along = dot(n, rubbed);
    Real tangent[3];
    for (int axis = 0; axis < 3; ++axis) tangent[axis] = rubbed[axis] - along * n[axis];
    const Real speed = std::sqrt(dot(tangent, tangent));
    const Real kept = speed <= bound ? Real(0) : Real(1) - bound / speed;
    for (int axis = 0; axis < 3; ++axis) rubbed[axis] = along * n[axis] + kept * tangent[axis];
  }
}

}  // namespace

void Colliders::declare(Fields& fields) {
  fields.list("colliders", false, "solids that material runs into", [this](Fields& f) {
    Collider collider;
    describe(f, collider);
    const bool taken =
        std::any_of(list.begin(), list.end(), [&](const Collider& c) { return c.name == collider.name; });
    f.check(!taken, "name", "\"" + collider.name + "\" is taken by another collider; choose another");
    list.push_back(collider);
  });
}

template <class Real>
void Colliders::add_to_nodes(Assembly<Real>& assembly) const {
  const auto tables = std::make_shared<ContactTables<Real>>(assembly.solids);
  assembly.plan.order.push_back({{"nodes near solids", "colliders", {"topology"}, {"contacts"}},
                                 [tables](State<Real>& state) { tables->follow_topology(state); }});
  assembly.plan.nodes.push_back(
      {{"collide, friction", "colliders", {"node velocity", "contacts"}, {"node velocity", "v-tilde"}},
       [tables](NodeBlock<Real>& block) { tables->collide(block); }});
}

template void Colliders::add_to_nodes(Assembly<float>&) const;
template void Colliders::add_to_nodes(Assembly<double>&) const;

}  // namespace repose
