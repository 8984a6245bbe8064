// Repose: floats in space as a VDB file holds them: in blocks of 8x8x8 voxels and in larger ones of one value,
// where some are given, and a background elsewhere. Trilinear between voxels, with the bits of OpenVDB's
// samplers, without OpenVDB.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"
#include "engine/base/vector.h"
#include "engine/vdb/record.h"
#include "engine/vdb/vdb_reader.h"

namespace repose {

/// From places to voxels; as it is told.
struct VdbMap {
  enum class Kind : std::uint32_t { kScale, kAffine, kFrustum };
  Kind kind = Kind::kScale;
  std::uint32_t reserved = 0;
  double shift[3] = {0, 0, 0}, scale[3] = {1, 1, 1};  ///< (x - shift) * scale
  double matrix[16] = {};                             ///< of affine maps: x y z 1 from the left
  /// Of a camera's frustum, after its affine map.
  double gamma = 0, width = 1, middle[2] = {0, 0}, depth_per_voxel = 1, corner[3] = {0, 0, 0};

  Vec3 to_voxels(const Vec3& x) const;
  bool sound() const;  ///< all numbers are finite
};

/// What goes before the values, as it is told: then follow the corners of all blocks (3 std::int32_t each),
/// their values (512 times the components; z fastest, then y), and the tiles.
struct VdbValuesHead {
  VdbMap map;
  std::uint32_t components = 0;  ///< 1 or 3
  std::uint32_t staggered = 0;   ///< 1: component k of a voxel lies on its face k
  float background[3] = {0, 0, 0};
  std::uint32_t reserved = 0;
  std::uint64_t blocks = 0, tiles = 0;
};

/// A cube of one value, as it is told.
struct VdbTile {
  std::int32_t corner[3] = {0, 0, 0};
  std::uint32_t log2_side = 0;  ///< one of kVdbTileSides
  float value[3] = {0, 0, 0};
};
inline constexpr std::array<std::uint32_t, 3> kVdbTileSides{3, 7, 12};

/// Cubes of one size by their corners.
class CubeTable {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;

  void reserve(std::size_t cubes);
  /// False: it is there already.
  bool add(const std::int32_t (&corner)[3], std::uint32_t index);
  std::uint32_t find(std::int32_t x, std::int32_t y, std::int32_t z) const;
  bool empty() const { return slots_.empty(); }

 private:
  struct Slot {
    std::int32_t corner[3];
    std::uint32_t index;
  };
  std::size_t place(std::int32_t x, std::int32_t y, std::int32_t z) const;

  std::vector<Slot> slots_;  // a power of two, at most half of them taken
};

/// Immutable once read.
template <int kComponents>
class VdbValues {
 public:
  using Value = std::array<float, kComponents>;

  /// Asks the program for a grid. Errors: as ask_reader.
  static Result<VdbValues> read(const VdbReader& reader, const std::string& file, const std::string& grid);

  /// At x (m); of a staggered grid each component where it lies.
  Value at(const Vec3& x) const;
  /// Calls visit(value) for the background and each value that is given.
  template <class Visit>
  void for_each(const Visit& visit) const {
    visit(background_);
    for (const Value& value : values_) visit(value);
    for (const Value& value : tiles_) visit(value);
  }

 private:
  void take(RecordReader& record);
  Value voxel(std::int32_t x, std::int32_t y, std::int32_t z) const;
  Value between(const Vec3& x) const;

  VdbMap map_;
  bool staggered_ = false;
  Value background_{};
  CubeTable blocks_;
  std::array<CubeTable, 3> tiles_of_;
  std::vector<Value> values_, tiles_;
};

}  // namespace repose
