#include "engine/effect/contact_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace repose {
namespace {

/// How far a moving solid may go before its list is made anew: a block, so that lists last for several steps
/// and hold few blocks too many.
constexpr double kMarginCells = 4.0;

bool has_friction(const Solid& solid) {
  return solid.friction > 0.0 && solid.contact != Contact::kSticky;
}

}  // namespace

template <class Real>
struct ContactTables<Real>::NoRecord {
  void before(const Real*) {}
  void after(std::size_t, const Real*, const Real*) {}
};

template <class Real>
struct ContactTables<Real>::Recorder {
  ContactSums* sums;
  double mass;
  Vec3 x;
  Vec3 start = Vec3::Zero();

  static Vec3 vector(const Real* v) { return {double(v[0]), double(v[1]), double(v[2])}; }
  void before(const Real* v) { start = vector(v); }
  void after(std::size_t solid, const Real* wall, const Real* v) {
    const Vec3 moves = wall == nullptr ? Vec3(0, 0, 0) : vector(wall);
    sums[solid].add(x, mass * (vector(v) - start), moves);
  }
};

template <class Real>
ContactTables<Real>::ContactTables(std::vector<Solid> solids, std::shared_ptr<ContactLog> log)
    : solids_(std::move(solids)), log_(std::move(log)) {
  friction_ = std::any_of(solids_.begin(), solids_.end(), has_friction);
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    if (solids_[k].moves()) moving_.emplace_back(solids_[k], k);
  }
}

/// How far from its middle a block may feel a solid: half the diagonal of its nodes, the cell that a node may
/// be predicted to move along each axis, its own reach.
template <class Real>
double ContactTables<Real>::reach(const State<Real>& state) const {
  return ((1.5 + 1.0) * std::sqrt(3.0) + kNodeReach) * state.spacing;
}

template <class Real>
typename ContactTables<Real>::NearSolids ContactTables<Real>::tabulate(const State<Real>& state,
                                                                       const Index3& block) const {
  const int flat = state.topology.flat_axis;
  NearSolids near;
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    if (solids_[k].moves()) continue;
    if (solids_[k].distance(in_plane(state.world(block, {1.5, 1.5, 1.5}), flat)) > reach(state)) continue;
    Near entry{k, {}};
    for (int node = 0; node < kBlockNodes; ++node) {
      const Vec3 x =
          in_plane(state.world(block, {double(node / 16), double(node / 4 % 4), double(node % 4)}), flat);
      const Vec3 normal = in_plane(solids_[k].normal(x, 0.25 * state.spacing), flat);
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
  spacing_ = state.spacing;
  flat_axis_ = state.topology.flat_axis;
  const auto blocks = state.grid.blocks();
  of_block_.assign(blocks.size(), nullptr);
  for (std::size_t b = 0; b < blocks.size(); ++b) {
    auto found = seen_.find(blocks[b]);
    if (found == seen_.end()) found = seen_.emplace(blocks[b], tabulate(state, blocks[b])).first;
    if (!found->second.empty()) of_block_[b] = &found->second;
  }
  if (any_moves()) {
    find_bounds(state);
    for (MovingSolid& moving : moving_) moving.list_at(state.counters.time, kMarginCells * spacing_);
    list_moving(state);
  }
  share_out(state);
}

template <class Real>
void ContactTables<Real>::find_bounds(const State<Real>& state) {
  bounds_ = Bounds();
  for (const Index3& block : state.grid.blocks()) {
    bounds_.lower = bounds_.lower.cwiseMin(in_plane(state.world(block, {0, 0, 0}), flat_axis_));
    bounds_.upper = bounds_.upper.cwiseMax(in_plane(state.world(block, {3, 3, 3}), flat_axis_));
  }
}

template <class Real>
void ContactTables<Real>::list_moving(const State<Real>& state) {
  const double far = reach(state) + kMarginCells * state.spacing;
  listed_.clear();
  listed_begin_.assign(1, 0);
  for (const Index3& block : state.grid.blocks()) {
    const Vec3 middle = in_plane(state.world(block, {1.5, 1.5, 1.5}), flat_axis_);
    for (std::uint32_t k = 0; k < moving_.size(); ++k) {
      if (moving_[k].listed_distance(middle) <= far) listed_.push_back(k);
    }
    listed_begin_.push_back(static_cast<std::uint32_t>(listed_.size()));
  }
}

template <class Real>
bool ContactTables<Real>::rubs(std::size_t block) const {
  if (of_block_[block] != nullptr) {
    for (const Near& near : *of_block_[block]) {
      if (has_friction(solids_[near.solid])) return true;
    }
  }
  if (!any_moves()) return false;
  for (std::size_t i = listed_begin_[block]; i < listed_begin_[block + 1]; ++i) {
    if (has_friction(solids_[moving_[listed_[i]].index()])) return true;
  }
  return false;
}

/// Room for v-tilde where there is friction, and for what is recorded.
template <class Real>
void ContactTables<Real>::share_out(State<Real>& state) {
  const std::size_t blocks = state.grid.size();
  state.after_friction.slot.assign(friction_ ? blocks : 0, -1);
  std::int32_t slots = 0;
  for (std::size_t b = 0; friction_ && b < blocks; ++b) {
    if (rubs(b)) state.after_friction.slot[b] = slots++;
  }
  state.after_friction.field.resize(static_cast<std::size_t>(slots));
  state.after_friction.live.assign(static_cast<std::size_t>(slots), 0);
  if (log_ == nullptr) return;
  log_->follow_topology(blocks, [this](std::size_t b) {
    return of_block_[b] != nullptr || (any_moves() && listed_begin_[b] < listed_begin_[b + 1]);
  });
}

template <class Real>
void ContactTables<Real>::prepare(State<Real>& state, Real dt) {
  const double time = state.counters.time;
  bool used_up = false;
  for (MovingSolid& moving : moving_) {
    const bool gone = moving.prepare(time, static_cast<double>(dt), bounds_, kMarginCells * state.spacing);
    used_up = used_up || gone;
  }
  if (!used_up) return;
  for (MovingSolid& moving : moving_) moving.list_at_end();
  list_moving(state);
  share_out(state);
}

template <class Real>
double ContactTables<Real>::fastest(double from, double to) const {
  double most = 0.0;
  for (const MovingSolid& moving : moving_) most = std::max(most, moving.fastest(from, to, bounds_));
  return most;
}

/// The solids near a block, in the order of the scene.
template <class Real>
std::size_t ContactTables<Real>::find_touches(const NodeBlock<Real>& block, Touch* touches) const {
  std::size_t count = 0;
  const auto add = [&](const Touch& touch) {
    REPOSE_ASSERT(count < kMost);
    touches[count++] = touch;
  };
  if (const NearSolids* near = of_block_[block.block]) {
    for (const Near& solid : *near) add({solid.solid, solid.nodes.data(), nullptr});
  }
  if (!any_moves()) return count;
  const State<Real>& state = block.state;
  for (std::size_t i = listed_begin_[block.block]; i < listed_begin_[block.block + 1]; ++i) {
    const MovingSolid& moving = moving_[listed_[i]];
    const Vec3 middle = in_plane(state.world(state.grid.blocks()[block.block], {1.5, 1.5, 1.5}), flat_axis_);
    if (moving.distance(middle) > reach(state)) continue;
    add({moving.index(), nullptr, &moving});
  }
  std::sort(touches, touches + count, [](const Touch& a, const Touch& b) { return a.solid < b.solid; });
  return count;
}

template <class Real>
template <typename ContactTables<Real>::Beside kBeside, class Record>
void ContactTables<Real>::collide_node(const Touch* touches, std::size_t count, std::size_t node, const Vec3& x,
                                       Real dt, Real* v, Real* rubbed, Record record) const {
  constexpr bool kAnyMoves = kBeside != Beside::kResting;
  Real impulse[kMost] = {};  // |v-bar - v*| per solid: the impulse over the mass
  NodeContact<Real> met[kAnyMoves ? kMost : 1];
  Real walls[kAnyMoves ? kMost : 1][3];
  const auto moves = [&](std::size_t k) { return kAnyMoves && touches[k].moving != nullptr; };
  const auto contact = [&](std::size_t k) -> const NodeContact<Real>& {
    return moves(k) ? met[k] : touches[k].nodes[node];
  };
  const auto wall = [&](std::size_t k) -> const Real* { return moves(k) ? walls[k] : nullptr; };
  for (std::size_t k = 0; k < count; ++k) {
    if (moves(k)) {
      const MovingSolid& solid = *touches[k].moving;
      const auto step = static_cast<double>(dt);
      if (kBeside == Beside::kDeforming && solid.deforms()) {
        met[k] = solid.meet<true>(x, step, spacing_, flat_axis_, v, walls[k]);
      } else {
        met[k] = solid.meet<false>(x, step, spacing_, flat_axis_, v, walls[k]);
      }
    }
    record.before(v);
    impulse[k] = constrain(solids_[touches[k].solid].contact, contact(k), wall(k), dt, v);
    record.after(touches[k].solid, wall(k), v);
  }
  std::copy_n(v, 3, rubbed);
  for (std::size_t k = 0; k < count; ++k) {
    const Real bound = static_cast<Real>(solids_[touches[k].solid].friction) * impulse[k];
    if (!(bound > Real(0))) continue;
    record.before(rubbed);
    rub(contact(k).normal, wall(k), bound, rubbed);
    record.after(touches[k].solid, wall(k), rubbed);
  }
}

/// Calls visit(node, mass and v, mass and v-tilde) for each node with mass; returns whether friction changed
/// one.
template <class Real>
template <class Visit>
bool ContactTables<Real>::for_each_node(NodeBlock<Real>& block, Real* rubbed, Visit visit) const {
  bool any_friction = false;
  for (std::size_t node = 0; node < kBlockNodes; ++node) {
    Real* at = block.nodes + node * kNodeValues;
    Real* after = rubbed + node * kNodeValues;
    std::copy_n(at, kNodeValues, after);
    if (!(at[0] > Real(0))) continue;
    visit(node, at, after);
    any_friction = any_friction || !std::equal(at, at + kNodeValues, after);
  }
  return any_friction;
}

template <class Real>
Vec3 ContactTables<Real>::place_of(const NodeBlock<Real>& block, std::size_t node) const {
  const std::array<double, 3> offset{double(node / 16), double(node / 4 % 4), double(node % 4)};
  return in_plane(block.state.world(block.state.grid.blocks()[block.block], offset), flat_axis_);
}

/// Returns whether friction changed a node.
template <class Real>
bool ContactTables<Real>::collide_block(NodeBlock<Real>& block, const Touch* touches, std::size_t count,
                                        Real* rubbed) const {
  Beside beside = Beside::kResting;
  for (const Touch* touch = touches; touch != touches + count; ++touch) {
    if (touch->moving != nullptr)
      beside = std::max(beside, touch->moving->deforms() ? Beside::kDeforming : Beside::kRigid);
  }
  const auto act = [&]<Beside kBeside>(auto record) {
    return for_each_node(block, rubbed, [&](std::size_t node, Real* at, Real* after) {
      const Vec3 x = kBeside == Beside::kResting ? Vec3() : place_of(block, node);
      collide_node<kBeside>(touches, count, node, x, block.dt, at + 1, after + 1, record(at, x));
    });
  };
  if (log_ != nullptr) {
    ContactSums* const row = log_->row(block.block);
    std::fill_n(row, log_->solids(), ContactSums());
    const auto record = [row](const Real* at, const Vec3& x) {
      return Recorder{row, static_cast<double>(at[0]), x};
    };
    return beside == Beside::kDeforming ? act.template operator()<Beside::kDeforming>(record)
                                        : act.template operator()<Beside::kRigid>(record);
  }
  if (count == 0) return false;
  const auto record = [](const Real*, const Vec3&) { return NoRecord{}; };
  if (beside == Beside::kDeforming) return act.template operator()<Beside::kDeforming>(record);
  if (beside == Beside::kRigid) return act.template operator()<Beside::kRigid>(record);
  return act.template operator()<Beside::kResting>(record);
}

template <class Real>
void ContactTables<Real>::collide(NodeBlock<Real>& block) const {
  const bool listed = any_moves() && listed_begin_[block.block] < listed_begin_[block.block + 1];
  if (of_block_[block.block] == nullptr && !listed) return;
  auto& rubbed_field = block.state.after_friction;
  const std::int32_t slot = rubbed_field.slot.empty() ? -1 : rubbed_field.slot[block.block];
  Touch touches[kMost];
  const std::size_t count = find_touches(block, touches);
  Real rubbed[kBlockValues];
  const bool any_friction = collide_block(block, touches, count, rubbed);
  if (slot < 0) return;
  rubbed_field.live[static_cast<std::size_t>(slot)] = any_friction ? 1 : 0;
  if (any_friction) std::copy_n(rubbed, kBlockValues, rubbed_field.block(block.block));
}

template <class Real>
void ContactTables<Real>::list(const NodeBlock<Real>& block, std::vector<Hold<Real>>& holds) const {
  const bool listed = any_moves() && listed_begin_[block.block] < listed_begin_[block.block + 1];
  if (of_block_[block.block] == nullptr && !listed) return;
  Touch touches[kMost];
  const std::size_t count = find_touches(block, touches);
  // No node goes farther than a cell in a step: that far a contact may matter.
  const Real fast[3] = {static_cast<Real>(spacing_ / static_cast<double>(block.dt)), Real(0), Real(0)};
  for (std::size_t node = 0; node < kBlockNodes; ++node) {
    if (!(block.nodes[node * kNodeValues] > Real(0))) continue;
    for (std::size_t k = 0; k < count; ++k) {
      Real wall[3] = {};
      const Touch& touch = touches[k];
      const auto meet = [&](auto deforms) {
        return touch.moving->template meet<deforms.value>(place_of(block, node), static_cast<double>(block.dt),
                                                          spacing_, flat_axis_, fast, wall);
      };
      const NodeContact<Real> at = touch.moving == nullptr   ? touch.nodes[node]
                                   : touch.moving->deforms() ? meet(std::true_type())
                                                             : meet(std::false_type());
      const Contact contact = solids_[touch.solid].contact;
      const bool against = contact == Contact::kSeparating;
      if (!(at.distance < (against ? static_cast<Real>(spacing_) : Real(0)))) continue;
      Hold<Real> hold;
      hold.node = static_cast<int>(node);
      hold.kind = contact == Contact::kSticky ? Hold<Real>::Kind::kAll
                  : against                   ? Hold<Real>::Kind::kAgainst
                                              : Hold<Real>::Kind::kAlong;
      std::copy_n(at.normal, 3, hold.normal);
      std::copy_n(wall, 3, hold.velocity);
      hold.bound = dot(at.normal, wall);
      if (contact != Contact::kSticky) hold.friction = static_cast<Real>(solids_[touch.solid].friction);
      if (against) hold.bound += (std::min(at.distance, Real(0)) - at.distance) / block.dt;
      holds.push_back(hold);
    }
  }
}

template class ContactTables<float>;
template class ContactTables<double>;

}  // namespace repose
