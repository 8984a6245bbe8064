// Repose: what solids did to the material in a step, for effects that measure it. Nobody keeps one unless a
// scene asks. Each block sums for itself, in double, and blocks are added in their order, so threads change
// nothing; a try of a step that is refused is overwritten by the next one.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/vector.h"
#include "engine/plan/handle.h"

namespace repose {

/// Of one solid on the material, in one step.
struct ContactSums {
  Vec3 impulse{0, 0, 0};  ///< N s
  Vec3 moment{0, 0, 0};   ///< of the impulse about the scene's origin, N m s
  double work = 0.0;      ///< impulse times the velocity of the solid where it acts, J

  void add(const Vec3& x, const Vec3& given, const Vec3& wall) {
    impulse += given;
    moment += x.cross(given);
    work += given.dot(wall);
  }
  void add(const ContactSums& other) {
    impulse += other.impulse;
    moment += other.moment;
    work += other.work;
  }
};

/// Why a record is a type: where nothing is recorded it must not cost.
struct NoContactRecorder {
  void give(std::size_t, const void*, const void*) {}
};

/// Writes what changes the velocity of one node into the sums of its block.
struct ContactRecorder {
  ContactSums* sums;
  double mass;  ///< kg, of the node
  Vec3 x;       ///< m, where it is

  template <class Real>
  static Vec3 vector(const Real* v) {
    return {double(v[0]), double(v[1]), double(v[2])};
  }
  /// `wall` is null where the solid rests; `change` of the node's velocity.
  template <class Real>
  void give(std::size_t solid, const Real* wall, const Real* change) {
    const Vec3 moves = wall == nullptr ? Vec3(0, 0, 0) : vector(wall);
    sums[solid].add(x, mass * vector(change), moves);
  }
};

class ContactLog {
 public:
  /// `all`: else of solids that move alone, which is what does work.
  explicit ContactLog(std::size_t solids, bool all = true) : solids_(solids), all_(all) {}
  bool all() const { return all_; }

  /// Gives rows to the blocks that `near` says, of all blocks of the grid.
  template <class Near>
  void follow_topology(std::size_t blocks, Near near) {
    row_.assign(blocks, -1);
    std::int32_t rows = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      if (near(b)) row_[b] = rows++;
    }
    sums_.assign(static_cast<std::size_t>(rows) * solids_, ContactSums());
  }

  /// Whether anything near a block can be recorded.
  bool has(std::size_t block) const { return row_[block] >= 0; }
  /// The sums of a block that has some, one per solid, at zero.
  ContactSums* begin(std::size_t block) {
    ContactSums* const row = sums_.data() + static_cast<std::size_t>(row_[block]) * solids_;
    std::fill_n(row, solids_, ContactSums());
    return row;
  }
  std::size_t solids() const { return solids_; }
  std::size_t bytes() const {
    return row_.capacity() * sizeof(std::int32_t) + sums_.capacity() * sizeof(ContactSums);
  }

  /// Of all blocks.
  ContactSums total(std::size_t solid) const {
    ContactSums all;
    for (std::size_t k = solid; k < sums_.size(); k += solids_) all.add(sums_[k]);
    return all;
  }

 private:
  std::size_t solids_;
  bool all_;
  std::vector<std::int32_t> row_;  // per block; -1 where no solid is near
  std::vector<ContactSums> sums_;  // rows in the order of blocks
};

template <class>
using ContactLogOf = ContactLog;
inline constexpr TableHandle<"contact log", ContactLogOf> kContactLog;

}  // namespace repose
