#include "engine/effect/contact_tables.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <type_traits>

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
ContactTables<Real>::ContactTables(std::vector<Solid> solids, ContactLog* log, bool v_tilde)
    : solids_(std::move(solids)), log_(log) {
  friction_ = v_tilde && std::any_of(solids_.begin(), solids_.end(), has_friction);
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    if (solids_[k].moves()) moving_.emplace_back(solids_[k], k);
  }
}

template <class Real>
bool ContactTables<Real>::holds() const {
  return any_moves() ||
         std::any_of(solids_.begin(), solids_.end(), [](const Solid& s) { return s.thickened > 0.0; });
}

/// How far from its middle a block may feel a solid: its nodes, each with the cell that it may be predicted to
/// move along each axis, and its own reach.
template <class Real>
double ContactTables<Real>::search_distance(double spacing) {
  return (radius_of_nodes(1.0) + kNodeReach) * spacing;
}

template <class Real>
typename ContactTables<Real>::NearSolids ContactTables<Real>::tabulate(const State<Real>& state,
                                                                       const Index3& block) const {
  const BlockPlace<Real> place(state, block);
  NearSolids near;
  for (std::size_t k = 0; k < solids_.size(); ++k) {
    if (solids_[k].moves()) continue;
    if (solids_[k].distance(place.middle()) > search_distance(state.spacing)) continue;
    Near entry{k, {}};
    for (std::size_t node = 0; node < kBlockNodes; ++node) {
      const Vec3 x = place.node(node);
      const WayInPlane way(solids_[k].normal(x, 0.25 * state.spacing), place.flat_axis());
      NodeContact<Real>& contact = entry.nodes[node];
      const double distance = way.distance(solids_[k].distance(x), solids_[k].contact);
      contact.distance = static_cast<Real>(distance - kNodeReach * state.spacing);
      for (int axis = 0; axis < 3; ++axis) contact.normal[axis] = static_cast<Real>(way.normal[axis]);
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
  const auto occupied = state.grid.occupied_blocks();
  block_of_occupied_.assign(occupied.begin(), occupied.end());
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
  const double far = search_distance(state.spacing) + kMarginCells * state.spacing;
  listed_.clear();
  listed_begin_.assign(1, 0);
  for (const Index3& block : state.grid.blocks()) {
    const Vec3 middle = BlockPlace<Real>(state, block).middle();
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
  log_->follow_topology(blocks, [this](std::size_t b) { return log_->all() ? near_any(b) : near_moving(b); });
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

template <class Real>
bool ContactTables<Real>::near_any(std::size_t block) const {
  return of_block_[block] != nullptr || near_moving(block);
}

template <class Real>
bool ContactTables<Real>::near_moving(std::size_t block) const {
  return any_moves() && listed_begin_[block] < listed_begin_[block + 1];
}

/// The solids near a block, in the order of the scene.
template <class Real>
typename ContactTables<Real>::Touches ContactTables<Real>::find_touches(std::size_t block,
                                                                        const BlockPlace<Real>& place) const {
  Touches touches;
  if (const NearSolids* near = of_block_[block]) {
    for (const Near& solid : *near) touches.push_back({solid.solid, solid.nodes.data(), nullptr});
  }
  if (!any_moves()) return touches;
  for (std::size_t i = listed_begin_[block]; i < listed_begin_[block + 1]; ++i) {
    const MovingSolid& moving = moving_[listed_[i]];
    if (moving.distance(place.middle()) > search_distance(place.spacing())) continue;
    touches.push_back({moving.index(), nullptr, &moving});
  }
  std::sort(touches.begin(), touches.end(), [](const Touch& a, const Touch& b) { return a.solid < b.solid; });
  return touches;
}

/// The solids near a node, as collide() asks for them.
template <class Real>
template <typename ContactTables<Real>::Beside kBeside>
struct ContactTables<Real>::AroundNode {
  const ContactTables& tables;
  const Touches& touches;
  AtNode& room;
  std::size_t node;
  Vec3 x;  // where it is; of no account where nothing moves
  double dt;

  std::size_t size() const { return touches.size(); }
  const Solid& its(std::size_t k) const { return tables.solids_[touches[k].solid]; }
  int solid(std::size_t k) const { return static_cast<int>(touches[k].solid); }
  Contact contact(std::size_t k) const { return its(k).contact; }
  Real friction(std::size_t k) const { return static_cast<Real>(its(k).friction); }
  bool moves(std::size_t k) const { return kBeside != Beside::kResting && touches[k].moving != nullptr; }
  const NodeContact<Real>& at(std::size_t k) const { return moves(k) ? room.met[k] : touches[k].nodes[node]; }
  Real* wall(std::size_t k) const { return moves(k) ? room.wall[k].data() : nullptr; }
  void meet(std::size_t k, const Real* v) const {
    if (!moves(k)) return;
    const MovingSolid& solid = *touches[k].moving;
    const double spacing = tables.spacing_;
    if (kBeside == Beside::kDeforming && solid.deforms()) {
      room.met[k] = solid.meet<true>(x, dt, spacing, tables.flat_axis_, v, wall(k));
    } else {
      room.met[k] = solid.meet<false>(x, dt, spacing, tables.flat_axis_, v, wall(k));
    }
  }
};

/// Calls record(mass, place) for a recorder of each node with mass. Returns whether friction changed one.
template <class Real>
template <class Record>
bool ContactTables<Real>::collide_block(const BlockPlace<Real>& place, Real dt, const Touches& touches,
                                        Real* nodes, Real* rubbed, Record record) const {
  constexpr bool kRecords = !std::is_same_v<decltype(record(Real(0), Vec3())), NoContactRecorder>;
  Beside beside = kRecords ? Beside::kRigid : Beside::kResting;
  for (const Touch& touch : touches) {
    if (touch.moving != nullptr)
      beside = std::max(beside, touch.moving->deforms() ? Beside::kDeforming : Beside::kRigid);
  }
  AtNode room(touches.size());
  Corner<Real> corner;
  const auto act = [&]<Beside kBeside>() {
    bool any_friction = false;
    for (std::size_t node = 0; node < kBlockNodes; ++node) {
      Real *const at = nodes + node * kNodeValues, *const after = rubbed + node * kNodeValues;
      std::copy_n(at, kNodeValues, after);
      if (!(at[0] > Real(0))) continue;
      const Vec3 x = kBeside == Beside::kResting ? Vec3(0, 0, 0) : place.node(node);
      const AroundNode<kBeside> solids{*this, touches, room, node, x, static_cast<double>(dt)};
      repose::collide(solids, corner, dt, at + 1, after + 1, record(at[0], x));
      any_friction = any_friction || !std::equal(at, at + kNodeValues, after);
    }
    return any_friction;
  };
  if (beside == Beside::kDeforming) return act.template operator()<Beside::kDeforming>();
  if (beside == Beside::kRigid) return act.template operator()<Beside::kRigid>();
  return act.template operator()<Beside::kResting>();
}

template <class Real>
void ContactTables<Real>::collide(std::size_t block, const BlockPlace<Real>& place, Real dt, Real* nodes,
                                  SparseNodeField<Real>& after_friction, ContactLog* log) const {
  if (!near_any(block)) return;
  const std::int32_t slot = after_friction.slot.empty() ? -1 : after_friction.slot[block];
  const Touches touches = find_touches(block, place);
  Real rubbed[kBlockValues];
  bool any_friction = false;
  if (log != nullptr && log->has(block)) {
    ContactSums* const sums = log->begin(block);
    any_friction = collide_block(place, dt, touches, nodes, rubbed, [sums](Real mass, const Vec3& x) {
      return ContactRecorder{sums, static_cast<double>(mass), x};
    });
  } else if (!touches.empty()) {
    any_friction =
        collide_block(place, dt, touches, nodes, rubbed, [](Real, const Vec3&) { return NoContactRecorder{}; });
  }
  if (slot < 0) return;
  after_friction.live[static_cast<std::size_t>(slot)] = any_friction ? 1 : 0;
  if (any_friction) std::copy_n(rubbed, kBlockValues, after_friction.block(block));
}

template <class Real>
Constraint<Real> ContactTables<Real>::constraint(const Touch& touch, const BlockPlace<Real>& place,
                                                 std::size_t node, Real dt) const {
  // No node goes farther than a cell along each axis in a step: that far a contact may matter.
  const Real fast[3] = {static_cast<Real>(kRootOfThree * spacing_ / static_cast<double>(dt)), Real(0), Real(0)};
  Real velocity[3];
  const auto meet = [&](auto deforms) {
    return touch.moving->template meet<deforms.value>(place.node(node), static_cast<double>(dt), spacing_,
                                                      flat_axis_, fast, velocity);
  };
  const NodeContact<Real> at = touch.moving == nullptr   ? touch.nodes[node]
                               : touch.moving->deforms() ? meet(std::true_type())
                                                         : meet(std::false_type());
  Constraint<Real> made =
      constraint_of(solids_[touch.solid].contact, at, touch.moving == nullptr ? nullptr : velocity, dt);
  made.node = static_cast<int>(node);
  made.solid = static_cast<int>(touch.solid);
  if (made.contact != Contact::kSticky) made.friction = static_cast<Real>(solids_[touch.solid].friction);
  return made;
}

template <class Real>
void ContactTables<Real>::list(std::size_t block, const BlockPlace<Real>& place, Real dt, const Real* nodes,
                               std::vector<Constraint<Real>>& constraints) const {
  if (!near_any(block)) return;
  const Touches touches = find_touches(block, place);
  for (std::size_t node = 0; node < kBlockNodes; ++node) {
    if (!(nodes[node * kNodeValues] > Real(0))) continue;
    for (const Touch& touch : touches) {
      const Constraint<Real> made = constraint(touch, place, node, dt);
      // And that far a solid comes to meet it.
      const Real comes = std::max(Real(0), dt * dot(made.normal, made.velocity));
      const bool separating = made.contact == Contact::kSeparating;
      const Real within = separating ? static_cast<Real>(kRootOfThree * spacing_) + comes : Real(0);
      if (made.distance < within) constraints.push_back(made);
    }
  }
}

template <class Real>
std::size_t ContactTables<Real>::bytes() const {
  constexpr std::size_t kEntry = 96;  // of the map, with what the heap adds
  std::size_t sum = of_block_.capacity() * sizeof(void*) +
                    block_of_occupied_.capacity() * sizeof(std::int32_t) +
                    (listed_begin_.capacity() + listed_.capacity()) * sizeof(std::uint32_t);
  for (const auto& [block, near] : seen_) sum += kEntry + near.capacity() * sizeof(Near);
  return sum;
}

template class ContactTables<float>;
template class ContactTables<double>;

}  // namespace repose
