#include "engine/vdb/values.h"

#include <cmath>
#include <cstring>
#include <type_traits>

#include "engine/base/mix.h"
#include "engine/vdb/question.h"

namespace repose {
namespace {

constexpr std::size_t kVoxels = 512;  // of a block
static_assert(sizeof(VdbTile) == 28 && sizeof(VdbMap) == 248 && sizeof(VdbValuesHead) == 288);

bool all_finite(const double* values, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    if (!std::isfinite(values[k])) return false;
  }
  return true;
}

template <std::size_t kCount>
std::array<float, kCount> between_two(const std::array<float, kCount>& a, const std::array<float, kCount>& b,
                                      double share) {
  std::array<float, kCount> value;
  for (std::size_t k = 0; k < kCount; ++k) value[k] = a[k] + static_cast<float>(double(b[k] - a[k]) * share);
  return value;
}

}  // namespace

bool VdbMap::sound() const {
  return all_finite(shift, 3) && all_finite(scale, 3) && all_finite(matrix, 16) && std::isfinite(gamma) &&
         std::isfinite(width) && all_finite(middle, 2) && std::isfinite(depth_per_voxel) &&
         all_finite(corner, 3);
}

Vec3 VdbMap::to_voxels(const Vec3& x) const {
  if (kind == Kind::kScale) {
    return {(x[0] - shift[0]) * scale[0], (x[1] - shift[1]) * scale[1], (x[2] - shift[2]) * scale[2]};
  }
  const double* const m = matrix;
  Vec3 out(x[0] * m[0] + x[1] * m[4] + x[2] * m[8] + m[12], x[0] * m[1] + x[1] * m[5] + x[2] * m[9] + m[13],
           x[0] * m[2] + x[1] * m[6] + x[2] * m[10] + m[14]);
  if (kind == Kind::kAffine) return out;
  const double spread = width / (gamma * out[2] + 1.0);
  return {out[0] * spread + middle[0] + corner[0], out[1] * spread + middle[1] + corner[1],
          out[2] / depth_per_voxel + corner[2]};
}

void CubeTable::reserve(std::size_t cubes) {
  std::size_t size = 4;
  while (size < 2 * cubes) size *= 2;
  slots_.assign(cubes == 0 ? 0 : size, Slot{{0, 0, 0}, kNone});
}

std::size_t CubeTable::place(std::int32_t x, std::int32_t y, std::int32_t z) const {
  std::uint64_t hash = mix_bits(static_cast<std::uint32_t>(x));
  hash = mix_bits(hash ^ static_cast<std::uint32_t>(y));
  hash = mix_bits(hash ^ static_cast<std::uint32_t>(z));
  std::size_t at = hash & (slots_.size() - 1);
  while (slots_[at].index != kNone &&
         (slots_[at].corner[0] != x || slots_[at].corner[1] != y || slots_[at].corner[2] != z))
    at = (at + 1) & (slots_.size() - 1);
  return at;
}

bool CubeTable::add(const std::int32_t (&corner)[3], std::uint32_t index) {
  Slot& slot = slots_[place(corner[0], corner[1], corner[2])];
  if (slot.index != kNone) return false;
  slot = Slot{{corner[0], corner[1], corner[2]}, index};
  return true;
}

std::uint32_t CubeTable::find(std::int32_t x, std::int32_t y, std::int32_t z) const {
  return slots_.empty() ? kNone : slots_[place(x, y, z)].index;
}

template <int kComponents>
void VdbValues<kComponents>::take(RecordReader& record) {
  const auto head = record.value<VdbValuesHead>();
  if (head.components != kComponents || head.staggered > 1 || !head.map.sound() ||
      head.map.kind > VdbMap::Kind::kFrustum)
    wrong_record("no grid of such values");
  constexpr std::uint64_t kMost = CubeTable::kNone / 2;
  if (head.blocks > kMost || head.tiles > kMost) wrong_record("too many blocks");
  map_ = head.map;
  staggered_ = head.staggered == 1;
  for (std::size_t k = 0; k < kComponents; ++k) background_[k] = head.background[k];
  struct Corner {
    std::int32_t at[3];
  };
  {
    const auto corners = record.array<Corner>(head.blocks);
    blocks_.reserve(corners.size());
    for (std::size_t b = 0; b < corners.size(); ++b) {
      const auto& at = corners[b].at;
      if (((at[0] | at[1] | at[2]) & 7) != 0 || !blocks_.add(at, static_cast<std::uint32_t>(b)))
        wrong_record("blocks that are none");
    }
  }
  values_ = record.array<Value>(head.blocks * kVoxels);
  const auto tiles = record.array<VdbTile>(head.tiles);
  tiles_.reserve(tiles.size());
  for (std::size_t level = 0; level < kVdbTileSides.size(); ++level) {
    const std::uint32_t side = kVdbTileSides[level];
    std::size_t count = 0;
    for (const VdbTile& tile : tiles) count += tile.log2_side == side ? 1 : 0;
    tiles_of_[level].reserve(count);
    for (const VdbTile& tile : tiles) {
      if (tile.log2_side != side) continue;
      const auto& at = tile.corner;
      if (((at[0] | at[1] | at[2]) & ((1 << side) - 1)) != 0 ||
          !tiles_of_[level].add(at, static_cast<std::uint32_t>(tiles_.size())))
        wrong_record("tiles that are none");
      Value& value = tiles_.emplace_back();
      for (std::size_t k = 0; k < kComponents; ++k) value[k] = tile.value[k];
    }
  }
  if (tiles_.size() != tiles.size()) wrong_record("tiles of no size");
  bool finite = true;
  for_each([&finite](const Value& value) {
    for (const float component : value) finite = finite && std::isfinite(component);
  });
  if (!finite) wrong_record("values that are not finite");
}

template <int kComponents>
auto VdbValues<kComponents>::voxel(std::int32_t x, std::int32_t y, std::int32_t z) const -> Value {
  const std::uint32_t block = blocks_.find(x & ~7, y & ~7, z & ~7);
  if (block != CubeTable::kNone)
    return values_[block * kVoxels + static_cast<std::size_t>((x & 7) << 6 | (y & 7) << 3 | (z & 7))];
  for (std::size_t level = 0; level < tiles_of_.size(); ++level) {
    if (tiles_of_[level].empty()) continue;
    const std::int32_t mask = ~((1 << kVdbTileSides[level]) - 1);
    const std::uint32_t tile = tiles_of_[level].find(x & mask, y & mask, z & mask);
    if (tile != CubeTable::kNone) return tiles_[tile];
  }
  return background_;
}

template <int kComponents>
auto VdbValues<kComponents>::between(const Vec3& x) const -> Value {
  constexpr double kMost = 2147483646.0;  // the last voxel that has a neighbour
  std::int32_t first[3];
  double share[3];
  for (int axis = 0; axis < 3; ++axis) {
    const double floor = std::floor(x[axis]);
    if (!(std::abs(floor) <= kMost)) return background_;
    first[axis] = static_cast<std::int32_t>(floor);
    share[axis] = x[axis] - floor;
  }
  Value corner[2][2][2];
  // Mostly all eight lie in one block.
  const std::size_t in[3] = {std::size_t(first[0] & 7), std::size_t(first[1] & 7), std::size_t(first[2] & 7)};
  const std::uint32_t block = in[0] < 7 && in[1] < 7 && in[2] < 7
                                  ? blocks_.find(first[0] & ~7, first[1] & ~7, first[2] & ~7)
                                  : CubeTable::kNone;
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        corner[i][j][k] =
            block != CubeTable::kNone
                ? values_[block * kVoxels + ((in[0] + std::size_t(i)) << 6 | (in[1] + std::size_t(j)) << 3 |
                                             (in[2] + std::size_t(k)))]
                : voxel(first[0] + i, first[1] + j, first[2] + k);
      }
    }
  }
  const auto along_z = [&](int i, int j) { return between_two(corner[i][j][0], corner[i][j][1], share[2]); };
  return between_two(between_two(along_z(0, 0), along_z(0, 1), share[1]),
                     between_two(along_z(1, 0), along_z(1, 1), share[1]), share[0]);
}

template <int kComponents>
auto VdbValues<kComponents>::at(const Vec3& x) const -> Value {
  const Vec3 voxels = map_.to_voxels(x);
  if (!staggered_) return between(voxels);
  Value value;
  for (std::size_t k = 0; k < kComponents; ++k) {
    Vec3 face = voxels;
    face[static_cast<int>(k)] += 0.5;
    value[k] = between(face)[k];
  }
  return value;
}

template <int kComponents>
Result<VdbValues<kComponents>> VdbValues<kComponents>::read(const VdbReader& reader, const std::string& file,
                                                            const std::string& grid) {
  VdbValues made;
  const VdbQuestion question{file, kComponents == 1 ? kVdbFloat : kVdbVector, grid, ErrorKind::kNoInput};
  auto asked = ask_reader(reader, question, [&made](RecordReader& record) { made.take(record); });
  if (!asked) return asked.error();
  return made;
}

template class VdbValues<1>;
template class VdbValues<3>;

}  // namespace repose
