#include "engine/io/level_set.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace repose {
namespace {

constexpr int kSide = BlockLattice::kSide;
constexpr std::size_t kVoxels = BlockLattice::kVoxels;
constexpr float kFar = 1e3f;  // farther than any distance that is asked for

/// A voxel: block and place within it.
struct Voxel {
  std::uint32_t block;
  std::array<std::int8_t, 3> at;

  std::size_t index() const {
    return block * kVoxels + static_cast<std::size_t>(at[0] * 64 + at[1] * 8 + at[2]);
  }
};

/// The next voxel along an axis, across blocks that are not there; false where there is none.
bool step(const BlockLattice& lattice, int axis, int up, Voxel& voxel) {
  std::int8_t& at = voxel.at[static_cast<std::size_t>(axis)];
  at = static_cast<std::int8_t>(at + (up != 0 ? 1 : -1));
  if (at >= 0 && at < kSide) return true;
  at = up != 0 ? 0 : kSide - 1;
  voxel.block = lattice.next_in_row(voxel.block, axis, up);
  return voxel.block != BlockLattice::kNone;
}

/// u of (u - x)^2 + (u - y)^2 + (u - z)^2 = 1, of those neighbours that lie below u.
inline float upwind(float x, float y, float z) {
  const float low = std::min(x, y), high = std::max(x, y);
  const float a = std::min(low, z), b = std::max(low, std::min(high, z)), c = std::max(high, z);
  const float one = a + 1.0f;
  const float d = b - a, two = 0.5f * (a + b + std::sqrt(std::max(0.0f, 2.0f - d * d)));
  // From the least, since far values would lose the others' digits.
  const float e = c - a, sum = d + e;
  const float three = a + (sum + std::sqrt(std::max(0.0f, sum * sum - 3.0f * (d * d + e * e - 1.0f)))) / 3.0f;
  const float of_two = one > b ? two : one;
  return of_two > c ? three : of_two;
}

/// Where a value changes sign within a step the distance is that of the plane through the crossings; kFar
/// elsewhere.
void begin_distances(const BlockWithFaces& values, float* distance) {
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const float* const row = values.row(x, y);
      float* const to = distance + x * 64 + y * 8;
      for (int z = 0; z < kSide; ++z) {
        float sum = 0.0f;
        for (const int step : BlockWithFaces::kSteps) {
          float nearest = kFar;
          for (const int next : {-step, step}) {
            const float here = row[z], there = row[z + next];
            if ((here < 0.0f) != (there < 0.0f)) nearest = std::min(nearest, here / (here - there));
          }
          if (nearest < kFar) sum += 1.0f / (nearest * nearest);
        }
        to[z] = sum > 0.0f ? 1.0f / std::sqrt(sum) : kFar;
      }
    }
  }
}

/// One round for a block; whether any value fell.
bool lower_distances(const BlockWithFaces& before, const float* begun, const float* signs, float inside,
                     float outside, float* after) {
  bool fell = false;
  for (int x = 0; x < kSide; ++x) {
    for (int y = 0; y < kSide; ++y) {
      const float* const row = before.row(x, y);
      const int at = x * 64 + y * 8;
      for (int z = 0; z < kSide; ++z) {
        const float found = upwind(std::min(row[z - 100], row[z + 100]), std::min(row[z - 10], row[z + 10]),
                                   std::min(row[z - 1], row[z + 1]));
        const float limit = signs[at + z] < 0.0f ? inside : outside;
        const float better = found < limit ? std::min(found, row[z]) : row[z];
        after[at + z] = begun[at + z] < kFar ? row[z] : better;
      }
      for (int z = 0; z < kSide; ++z) fell |= after[at + z] != row[z];
    }
  }
  return fell;
}

}  // namespace

void fill_cavities(const BlockLattice& lattice, float inside, BlockField& distance) {
  std::vector<bool> open(distance.size(), false);
  std::vector<Voxel> front;
  const auto reach = [&](const Voxel& voxel) {
    if (distance[voxel.index()] < 0.0f || open[voxel.index()]) return;
    open[voxel.index()] = true;
    front.push_back(voxel);
  };
  for (std::uint32_t block = 0; block < lattice.size(); ++block) {
    for (int axis = 0; axis < 3; ++axis) {
      for (int up = 0; up < 2; ++up) {
        if (lattice.next_in_row(block, axis, up) != BlockLattice::kNone) continue;
        for (std::int8_t j = 0; j < kSide; ++j) {
          for (std::int8_t k = 0; k < kSide; ++k) {
            Voxel voxel{block, {}};
            voxel.at[static_cast<std::size_t>(axis)] = up != 0 ? kSide - 1 : 0;
            voxel.at[static_cast<std::size_t>((axis + 1) % 3)] = j;
            voxel.at[static_cast<std::size_t>((axis + 2) % 3)] = k;
            reach(voxel);
          }
        }
      }
    }
  }
  while (!front.empty()) {
    const Voxel voxel = front.back();
    front.pop_back();
    for (int axis = 0; axis < 3; ++axis) {
      for (int up = 0; up < 2; ++up) {
        Voxel next = voxel;
        if (step(lattice, axis, up, next)) reach(next);
      }
    }
  }
  for (std::size_t k = 0; k < distance.size(); ++k) {
    if (distance[k] >= 0.0f && !open[k]) distance[k] = inside;
  }
}

void smooth(const BlockLattice& lattice, int times, float outside, BlockField& distance, Threads& threads) {
  BlockField mean(distance.size());
  for (int pass = 0; pass < 3 * times; ++pass) {
    const int step = BlockWithFaces::kSteps[pass % 3];
    threads.for_each(lattice.size(), [&](std::size_t block) {
      const BlockWithFaces values(lattice, distance, block, outside);
      float* const to = values_of(mean, block);
      for (int x = 0; x < kSide; ++x) {
        for (int y = 0; y < kSide; ++y) {
          const float* const row = values.row(x, y);
          for (int z = 0; z < kSide; ++z)
            to[x * 64 + y * 8 + z] = (row[z - step] + row[z] + row[z + step]) * (1.0f / 3.0f);
        }
      }
    });
    std::swap(mean, distance);
  }
}

void redistance(const BlockLattice& lattice, float inside, float outside, BlockField& distance,
                Threads& threads) {
  BlockField before(distance.size());
  threads.for_each(lattice.size(), [&](std::size_t block) {
    begin_distances(BlockWithFaces(lattice, distance, block, kFar), values_of(before, block));
  });
  const BlockField begun = before;
  BlockField after = before;
  // What is known travels by a voxel in a round. A block of which nothing near has changed stays as it is, in
  // both.
  std::vector<std::uint8_t> fell(lattice.size(), 1), falls(lattice.size());
  for (bool any = true; any;) {
    threads.for_each(lattice.size(), [&](std::size_t block) {
      bool near = fell[block] != 0;
      for (int axis = 0; axis < 3; ++axis) {
        for (int up = 0; up < 2; ++up) {
          const std::uint32_t next = lattice.neighbour(block, axis, up);
          near = near || (next != BlockLattice::kNone && fell[next] != 0);
        }
      }
      falls[block] =
          near && lower_distances(BlockWithFaces(lattice, before, block, kFar), values_of(begun, block),
                                  values_of(distance, block), inside, outside, values_of(after, block));
    });
    std::swap(before, after);
    std::swap(fell, falls);
    any = std::find(fell.begin(), fell.end(), 1) != fell.end();
  }
  threads.for_each(lattice.size(), [&](std::size_t block) {
    float* const values = values_of(distance, block);
    const float* const found = values_of(before, block);
    for (std::size_t k = 0; k < kVoxels; ++k)
      values[k] = values[k] < 0.0f ? -std::min(found[k], inside) : std::min(found[k], outside);
  });
}

}  // namespace repose
