// Repose: what a pass is given: the numbers of the handles that it has declared, and no others. Asking for what
// is not declared does not compile.
#pragma once

#include <array>
#include <cstdint>
#include <memory>

#include "engine/plan/chunk.h"
#include "engine/plan/handle.h"
#include "engine/state/block_extent.h"

namespace repose {

/// Whether what lies at a place is of nodes.
constexpr bool over_nodes(Place place) {
  return place == Place::kNodes || place == Place::kBeforeForces || place == Place::kAfterFriction;
}

/// The nodes of one block.
template <class Real>
struct NodeBlock {
  State<Real>& state;
  std::size_t block;  ///< position in the grid
  Real* nodes;        ///< mass and velocity, kBlockValues numbers
  Real dt;
};

/// Where the plan has put what a handle names: a place in scratch, a channel of a set, or an object.
struct Located {
  std::size_t place = 0;
  void* table = nullptr;
};

/// A block of nodes in space.
template <class Real>
class BlockPlace {
 public:
  BlockPlace(const State<Real>& state, const Index3& block) : state_(state), block_(block) {}

  double spacing() const { return state_.spacing; }
  int flat_axis() const { return state_.topology.flat_axis; }

  /// A point `offset` cells from its first node, m; in the plane, in plane strain.
  Vec3 point(const std::array<double, 3>& offset) const {
    return in_plane(state_.world(block_, offset), flat_axis());
  }
  Vec3 node(std::size_t node) const {
    return point({double(node / 16), double(node / 4 % 4), double(node % 4)});
  }
  Vec3 middle() const { return point(kMiddleOfNodes); }

 private:
  const State<Real>& state_;
  Index3 block_;
};

/// What all passes can ask of their handles.
template <class Real, class Read, class Write>
class DeclaredHandles {
 public:
  using Places = std::array<Located, Read::kSize + Write::kSize>;

  template <class Handle>
  static constexpr bool reads() {
    return Read::template has<Handle>() || Write::template has<Handle>();
  }
  template <class Handle>
  static constexpr bool writes() {
    return Write::template has<Handle>();
  }
  template <class Handle>
  static constexpr std::size_t index() {
    if constexpr (Write::template has<Handle>()) return Read::kSize + Write::template index<Handle>();
    return Read::template index<Handle>();
  }

  explicit DeclaredHandles(const Places& places) : places_(&places) {}

  /// An object that follows the topology.
  template <class Handle>
  requires(Handle::kPlace == Place::kTable && reads<Handle>()) const
      typename Handle::template Of<Real>& read(Handle) const {
    return *static_cast<const typename Handle::template Of<Real>*>(located<Handle>().table);
  }
  template <class Handle>
  requires(Handle::kPlace == Place::kTable && writes<Handle>())
      typename Handle::template Of<Real>& write(Handle) const {
    return *static_cast<typename Handle::template Of<Real>*>(located<Handle>().table);
  }

  /// The place of a handle that is declared by when(), and is not.
  static constexpr std::size_t kAbsent = ~std::size_t{0};

 protected:
  template <class Handle>
  const Located& located() const {
    return (*places_)[index<Handle>()];
  }
  template <class Handle>
  bool absent() const {
    return located<Handle>().place == kAbsent;
  }

 private:
  const Places* places_;
};

/// Of a chunk of particles.
template <class Real, class Read, class Write>
class ChunkAccess : public DeclaredHandles<Real, Read, Write> {
  using Declared = DeclaredHandles<Real, Read, Write>;

 public:
  using Declared::read, Declared::write;

  ChunkAccess(Chunk<Real>& chunk, const typename Declared::Places& places) : Declared(places), chunk_(chunk) {}

  std::size_t count() const { return chunk_.particles.count; }
  /// Distance to the particles that are worked on next, as in ParticleSpan.
  std::ptrdiff_t ahead() const { return chunk_.particles.ahead; }
  Real dt() const { return chunk_.dt; }
  double time() const { return chunk_.time; }        ///< at the start of the step, s
  std::int64_t step() const { return chunk_.step; }  ///< steps completed before this one
  double spacing() const { return chunk_.spacing; }  ///< dx, m
  double mass() const { return chunk_.set.particle_mass; }
  double volume() const { return chunk_.set.particle_volume; }
  std::size_t occupied() const { return chunk_.occupied; }
  bool two_velocities() const { return chunk_.two_velocities; }
  Vec3 world(const Vec3& offset) const { return chunk_.world(offset); }

  /// The numbers of a handle, one array per component: a pointer, or an array of pointers. Null where a handle
  /// that is declared by when() is not.
  template <class Handle>
  requires(Handle::kPlace < Place::kMotion && Declared::template reads<Handle>()) auto read(Handle) const {
    return find<const Real, Handle>();
  }
  template <class Handle>
  requires(Handle::kPlace < Place::kMotion && Declared::template writes<Handle>()) auto write(Handle) const {
    return find<Real, Handle>();
  }
  /// What moves and strains the particles lies there.
  template <class Handle>
  requires((Handle::kPlace == Place::kMoving || Handle::kPlace == Place::kGradient) &&
           Declared::template writes<Handle>()) void put(Handle, Real* const (&at)[Handle::kComponents]) const {
    if constexpr (Handle::kPlace == Place::kMoving)
      std::copy_n(at, Handle::kComponents, chunk_.moving_velocity);
    if constexpr (Handle::kPlace == Place::kGradient)
      std::copy_n(at, Handle::kComponents, chunk_.moving_gradient);
  }
  template <class Handle>
  requires(Handle::kPlace == Place::kMotion && Declared::template writes<Handle>()) Motion<Real>
  &write(Handle) const { return chunk_.motion; }
  template <class Handle>
  requires(Handle::kPlace == Place::kTouched && Declared::template writes<Handle>())
      typename Chunk<Real>::Touched& write(Handle) const {
    return chunk_.touched;
  }
  /// The nodes around the block, kArenaValues numbers; null as above.
  template <class Handle>
  requires(over_nodes(Handle::kPlace) && Declared::template reads<Handle>()) const Real* read(Handle) const {
    return nodes<Handle>();
  }
  template <class Handle>
  requires(over_nodes(Handle::kPlace) && Declared::template writes<Handle>()) Real* write(Handle) const {
    return nodes<Handle>();
  }

  /// The particles as kernels take them: the channels that are declared, the others null. Kernels have one
  /// struct for those that they read and those that they write.
  ParticleSpan<Real> span() const {
    ParticleSpan<Real> span{};
    span.count = chunk_.particles.count;
    span.ahead = chunk_.particles.ahead;
    const auto take = [this]<class Handle>(Handle, Real** to) {
      if constexpr (Declared::template reads<Handle>()) {
        if (this->template absent<Handle>()) return;
        if constexpr (Handle::kPlace == Place::kPosition) std::copy_n(chunk_.particles.position, 3, to);
        if constexpr (Handle::kPlace == Place::kVelocity) std::copy_n(chunk_.particles.velocity, 3, to);
        if constexpr (Handle::kPlace == Place::kAffine)
          std::copy_n(chunk_.particles.affine, kAffineComponents, to);
      }
    };
    take(kPosition, span.position);
    take(kParticleVelocity, span.velocity);
    take(kAffine, span.affine);
    return span;
  }

 private:
  template <class Number, class Handle>
  auto find() const {
    if constexpr (Handle::kPlace == Place::kExtra) {
      if (this->template absent<Handle>()) return static_cast<Number*>(nullptr);
      return static_cast<Number*>(chunk_.set.extra[this->template located<Handle>().place].values.data() +
                                  chunk_.first);
    } else if constexpr (Handle::kPlace == Place::kLaw) {
      std::array<Number*, Handle::kComponents> all{};
      const std::size_t kept = this->template absent<Handle>() ? 0 : chunk_.set.law_channels;
      for (std::size_t k = 0; k < kept; ++k) all[k] = chunk_.set.extra[k].values.data() + chunk_.first;
      return all;
    } else if constexpr (Handle::kPlace == Place::kScratch || Handle::kPlace == Place::kRoom) {
      const std::size_t place = this->template located<Handle>().place;
      const bool absent = this->template absent<Handle>();
      Number* const from = absent ? nullptr : chunk_.scratch.at(place);
      if constexpr (Handle::kComponents == 1) {
        return from;
      } else {
        std::array<Number*, Handle::kComponents> all;
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = absent ? nullptr : from + k * kChunk;
        return all;
      }
    } else if constexpr (Handle::kPlace == Place::kMoving) {
      return pointers<const Real, Handle>(chunk_.moving_velocity);
    } else if constexpr (Handle::kPlace == Place::kGradient) {
      return pointers<const Real, Handle>(chunk_.moving_gradient);
    } else if constexpr (Handle::kPlace == Place::kPosition) {
      return pointers<Number, Handle>(chunk_.particles.position);
    } else if constexpr (Handle::kPlace == Place::kVelocity) {
      return pointers<Number, Handle>(chunk_.particles.velocity);
    } else if constexpr (Handle::kPlace == Place::kAffine) {
      return pointers<Number, Handle>(chunk_.particles.affine);
    } else {
      static_assert(Handle::kPlace == Place::kStrain);
      return pointers<Number, Handle>(chunk_.particles.strain);
    }
  }
  template <class Number, class Handle, class From>
  auto pointers(const From& from) const {
    std::array<Number*, Handle::kComponents> all{};
    if (!this->template absent<Handle>()) std::copy_n(from, Handle::kComponents, all.begin());
    return all;
  }
  template <class Handle>
  Real* nodes() const {
    return this->template absent<Handle>() ? nullptr
                                           : chunk_.scratch.at(this->template located<Handle>().place);
  }

  Chunk<Real>& chunk_;
};

/// Of the nodes of a block.
template <class Real, class Read, class Write>
class NodeAccess : public DeclaredHandles<Real, Read, Write> {
  using Declared = DeclaredHandles<Real, Read, Write>;

 public:
  using Declared::read, Declared::write;

  NodeAccess(const NodeBlock<Real>& block, const typename Declared::Places& places)
      : Declared(places), block_(block) {}

  Real dt() const { return block_.dt; }
  std::int64_t step() const { return block_.state.counters.step; }  ///< steps completed before this one
  double time() const { return block_.state.counters.time; }        ///< at the start of the step, s
  std::size_t block() const { return block_.block; }                ///< position in the grid
  BlockPlace<Real> place() const { return {block_.state, block_.state.grid.blocks()[block_.block]}; }

  /// kBlockValues numbers.
  template <class Handle>
  requires(Handle::kPlace == Place::kNodes &&
           Declared::template reads<Handle>()) const Real* read(Handle) const {
    return block_.nodes;
  }
  template <class Handle>
  requires(Handle::kPlace == Place::kNodes && Declared::template writes<Handle>()) Real* write(Handle) const {
    return block_.nodes;
  }
  template <class Handle>
  requires(Handle::kPlace == Place::kBeforeForces &&
           Declared::template writes<Handle>()) Real* write(Handle) const {
    return block_.state.before_forces.block(block_.block);
  }
  template <class Handle>
  requires(Handle::kPlace == Place::kAfterFriction && Declared::template writes<Handle>()) SparseNodeField<Real>
  &write(Handle) const { return block_.state.after_friction; }
  template <class Handle>
  requires(Handle::kPlace == Place::kActive &&
           Declared::template writes<Handle>()) std::uint64_t& write(Handle) const {
    return block_.state.grid.active(block_.block);
  }

 private:
  const NodeBlock<Real>& block_;
};

/// Of objects alone, for as long as a copy of it lasts.
template <class Real, class Read, class Write>
class TableAccess : public DeclaredHandles<Real, Read, Write> {
  using Declared = DeclaredHandles<Real, Read, Write>;

 public:
  explicit TableAccess(std::shared_ptr<const typename Declared::Places> places)
      : Declared(*places), places_(places) {}

 private:
  std::shared_ptr<const typename Declared::Places> places_;
};

/// Of the state as a whole, between steps.
template <class Real, class Read, class Write>
class StateAccess : public DeclaredHandles<Real, Read, Write> {
  using Declared = DeclaredHandles<Real, Read, Write>;

 public:
  StateAccess(State<Real>& state, const typename Declared::Places& places) : Declared(places), state_(state) {}

  State<Real>& state() const { return state_; }

 private:
  State<Real>& state_;
};

}  // namespace repose
