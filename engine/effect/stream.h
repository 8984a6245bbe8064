// Repose: what an emitter makes, as functions of time and serial number alone. Particle j crosses at its own
// exact time and lies at its own exact place, drawn from (seed, j); how many there are by a time is whole
// numbers and no sum. So what comes out depends neither on steps nor on the batches in which it is put into the
// state.
#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/params.h"
#include "engine/geometry/shape.h"

namespace repose {

/// What a scene says of an emitter.
struct Emitter {
  enum class Type { kDisc, kRectangle, kVolume, kHost };

  std::string name;
  std::string material;
  Type type = Type::kDisc;
  std::int64_t particles_per_cell = 8;
  std::int64_t seed = 1;
  double start = 0.0;                                    ///< s
  double end = std::numeric_limits<double>::infinity();  ///< s
  double spread = 0.0;              ///< share of its speed that a particle has in a direction of its own
  std::int64_t most_particles = 0;  ///< 0: no limit
  double most_volume = 0.0;         ///< m^3; 0: no limit

  // disc and rectangle: the mouth that a column of material moves through
  Vec3 center{0, 0, 0};                       ///< m
  Vec3 normal{0, -1, 0};                      ///< where it moves to
  double speed = 1.0;                         ///< m/s
  double radius = 0.1;                        ///< m; disc
  Vec3 direction{1, 0, 0};                    ///< rectangle: of its first side
  double half_width = 0.1, half_depth = 0.1;  ///< m; rectangle: along `direction`, and across it

  // volume: random places in a solid
  ShapeDescription shape;
  Vec3 velocity{0, 0, 0};  ///< m/s
  double rate = 0.0;       ///< m^3/s
};

/// How an emitter's particles follow one another.
struct Flow {
  double start = 0.0, end = 0.0;  ///< s
  double rate = 0.0;              ///< particles/s
  double particle_volume = 0.0;   ///< m^3
  std::uint64_t most = 0;         ///< particles

  /// Serial j crosses in the middle of its share of the flow.
  double crossing(std::uint64_t serial) const { return start + (static_cast<double>(serial) + 0.5) / rate; }
  /// How many have crossed by a time: those of [0, count).
  std::uint64_t count(double time) const;
};

/// In plane strain (flat_axis >= 0) the column is one cell deep along that axis.
Flow flow_of(const Emitter& emitter, double spacing, int flat_axis);

/// The particles of an emitter.
class Stream {
 public:
  struct Birth {
    Vec3 position;  ///< m, at the crossing
    Vec3 velocity;  ///< m/s
  };

  /// `shape`: of a volume, built; else null.
  Stream(const Emitter& emitter, std::shared_ptr<const Shape> shape, double spacing, int flat_axis);

  const Flow& flow() const { return flow_; }
  Birth birth(std::uint64_t serial) const;
  /// The sites of the mouth: each has one particle per `sites()` serials.
  std::uint64_t sites() const { return std::uint64_t{across_[0]} * across_[1]; }

 private:
  Vec3 site(std::uint64_t serial) const;
  Vec3 place_in_shape(std::uint64_t serial) const;

  Emitter emitter_;
  std::shared_ptr<const Shape> shape_;
  int flat_axis_;
  Flow flow_;
  Vec3 side_[2];                      // m: from the middle of the mouth to its edges
  std::uint32_t across_[2] = {1, 1};  // sites along each side
  /// Which site each serial of a layer has. Kept from one particle to the next; it says nothing new.
  mutable std::vector<std::uint32_t> order_;
  mutable std::optional<std::uint64_t> layer_;
};

}  // namespace repose
