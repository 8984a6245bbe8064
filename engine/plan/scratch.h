// Repose: the memory that passes of a chunk share, one per thread: as much as the handles of a plan ask for.
#pragma once

#include <map>
#include <string_view>

#include "engine/base/aligned_array.h"
#include "engine/base/result.h"
#include "engine/plan/handle.h"
#include "kernels/layout/node_block.h"

namespace repose {

/// Where in the scratch of a thread each handle has its numbers, and how many there are.
class ScratchLayout {
 public:
  /// The first number of a handle; it gets room when it is asked for the first time. Component k of a chunk's
  /// numbers begins kChunk numbers after the one before it.
  std::size_t place(const HandleInfo& handle) {
    return place(handle.name, static_cast<std::size_t>(handle.components) * kChunk);
  }
  /// The same of the nodes around a block.
  std::size_t place_arena(std::string_view name) { return place(name, kArenaValues); }

  /// Gives two of them one arena.
  void share_arena(std::string_view name, std::string_view with) {
    places_[name] = {place_arena(with), kArenaValues};
  }

  /// Numbers in all.
  std::size_t size() const { return size_; }

 private:
  std::size_t place(std::string_view name, std::size_t values) {
    const auto [found, is_new] = places_.try_emplace(name, Room{size_, values});
    REPOSE_ASSERT(found->second.values == values);  // two handles have one name
    if (is_new) size_ += (values + kLine - 1) / kLine * kLine;
    return found->second.first;
  }

  static constexpr std::size_t kLine = 16;  // numbers; so that each begins with a line of the cache
  struct Room {
    std::size_t first, values;
  };
  std::map<std::string_view, Room> places_;
  std::size_t size_ = 0;
};

/// The nodes around a block: sums of what its particles tell, later the velocity that moves them; v-tilde,
/// where it is not what moves; velocity before forces.
inline constexpr std::string_view kArena = "nodes around", kArenaAfterFriction = "v-tilde around",
                                  kArenaBeforeForces = "velocity before forces around";

template <class Real>
class Scratch {
 public:
  explicit Scratch(const ScratchLayout& layout) : numbers_(layout.size()) {}
  Real* at(std::size_t place) { return numbers_.data() + place; }

 private:
  AlignedArray<Real> numbers_;
};

}  // namespace repose
