// Repose: filling a solid with particles. The jittered sampling draws each particle from a counter (seed, cell,
// sub-cell), not from a stream, so a particle is the same whatever the rest of the shape looks like.
#include "engine/geometry/seeding.h"

#include <algorithm>
#include <new>
#include <string>

#include "engine/geometry/poisson_disk.h"
#include "engine/geometry/seed_lattice.h"

namespace repose {
namespace {

constexpr std::int64_t kMostPerCell = 4096;
constexpr double kMostParticles = 4294967295.0;  // ids are uint32

Error refuse(const std::string& message) {
  return {ErrorKind::kBadScene, message, {}};
}

/// Cuts `count` into three factors as even as can be, the greatest first; `dimension` 2 leaves the third at 1.
std::array<std::int64_t, 3> even_factors(std::int64_t count, int dimension) {
  std::array<std::int64_t, 3> best{count, 1, 1};
  for (std::int64_t c = 1; c * c * c <= count && (dimension == 3 || c == 1); ++c) {
    if (count % c != 0) continue;
    for (std::int64_t b = c; b * b <= count / c; ++b) {
      const std::int64_t a = count / c / b;
      if (a * b * c == count && a <= best[0]) best = {a, b, c};
    }
  }
  return best;
}

/// How many sub-cells each axis is cut into.
std::array<std::int64_t, 3> sub_cells(std::int64_t count, const CellBox& box) {
  const auto factors = even_factors(count, box.dimension());
  std::array<std::int64_t, 3> cuts{1, 1, 1};
  for (int k = 0, next = 0; k < 3; ++k) {
    if (k != box.flat_axis) cuts[k] = factors[next++];
  }
  return cuts;
}

std::uint64_t cell_key(std::uint64_t seed, const Index3& cell) {
  std::uint64_t key = mix(seed);
  for (const std::int32_t c : cell) key = mix(key ^ static_cast<std::uint32_t>(c));
  return key;
}

/// A random place in sub-cell `sub` of `cuts`: sixty bits, twenty to an axis, in whole lattice steps.
std::array<double, 3> place_in_cell(const CellBox& box, const std::array<std::int64_t, 3>& cuts,
                                    const std::array<std::int64_t, 3>& sub, std::uint64_t bits) {
  std::array<double, 3> offset;
  for (int k = 0; k < 3; ++k, bits >>= 20) {
    const auto jitter = static_cast<std::int64_t>(bits % kLattice);
    const std::int64_t steps = (sub[k] * kLattice + jitter) / cuts[k];
    offset[k] = k == box.flat_axis ? 0.5 : static_cast<double>(steps) * kLatticeStep;
  }
  return offset;
}

/// `expected` particles, as the volume has it: room for them at once, and for what chance adds at the surface.
Seeds seed_jittered(const Shape& shape, const CellBox& box, const SeedOptions& options, double expected) {
  Seeds seeds;
  const auto room = static_cast<std::size_t>(1.01 * expected) + 1024;
  seeds.cell.reserve(room);
  seeds.offset.reserve(room);
  const auto cuts = sub_cells(options.particles_per_cell, box);
  box.for_each_cell_near(shape, [&](const Index3& cell, double distance) {
    const bool whole = distance < -box.cell_radius();
    const std::uint64_t key = cell_key(options.seed, cell);
    for (std::int64_t s = 0; s < options.particles_per_cell; ++s) {
      const std::array<std::int64_t, 3> sub{s / (cuts[1] * cuts[2]), s / cuts[2] % cuts[1], s % cuts[2]};
      const auto offset = place_in_cell(box, cuts, sub, mix(key + static_cast<std::uint64_t>(s)));
      if (!whole && !(shape.signed_distance(box.position(cell, offset)) < 0)) continue;
      seeds.cell.push_back(cell);
      seeds.offset.push_back(to_float(offset));
    }
  });
  return seeds;
}

Result<void> check(const SeedOptions& options) {
  if (!std::isfinite(options.spacing) || options.spacing <= 0) return refuse("spacing must be greater than 0");
  if (options.particles_per_cell < 1 || options.particles_per_cell > kMostPerCell) {
    return refuse("particles_per_cell must be from 1 to " + std::to_string(kMostPerCell));
  }
  if (options.flat_axis && (*options.flat_axis < 0 || *options.flat_axis > 2)) {
    return refuse("the axis of plane strain must be 0, 1 or 2");
  }
  return {};
}

Result<CellBox> cells_around(const Shape& shape, const SeedOptions& options) {
  const Bounds bounds = shape.bounds();
  CellBox box;
  box.spacing = options.spacing;
  box.flat_axis = options.flat_axis.value_or(-1);
  for (int k = 0; k < 3; ++k) {
    if (k == box.flat_axis) {
      box.upper[k] = 1;
      continue;
    }
    const double lower = std::floor(bounds.lower[k] / box.spacing);
    const double upper = std::floor(bounds.upper[k] / box.spacing) + 1;
    if (!(std::abs(lower) < 2147483646.0 && std::abs(upper) < 2147483646.0)) {
      return refuse("the shape reaches beyond 2^31 cells, or is infinite; a body needs a finite shape");
    }
    box.lower[k] = static_cast<std::int32_t>(lower);
    box.upper[k] = static_cast<std::int32_t>(upper);
  }
  return box;
}

/// Volume that the particles share: in plane strain, that of a slab one cell thick.
Result<double> filled_volume(const Shape& shape, const SeedOptions& options) {
  if (!options.flat_axis) return shape.volume();
  const auto area = shape.section_area(*options.flat_axis);
  if (!area) return area.error();
  return *area * options.spacing;
}

double particles_in(double volume, const SeedOptions& options) {
  const double cell = options.spacing * options.spacing * options.spacing;
  return volume / cell * static_cast<double>(options.particles_per_cell);
}

Result<Seeds> seed_checked(const Shape& shape, const SeedOptions& options) {
  const auto box = cells_around(shape, options);
  if (!box) return box.error();
  const auto volume = filled_volume(shape, options);
  if (!volume) return volume.error();
  const double expected = particles_in(*volume, options);
  if (!(expected < kMostParticles)) {
    return refuse("the shape would hold " + std::to_string(expected) + " particles; at most 2^32 - 1 have ids");
  }
  auto seeds = options.sampling == Sampling::kJittered
                   ? Result<Seeds>(seed_jittered(shape, *box, options, expected))
                   : seed_poisson_disk(shape, *box, options);
  if (!seeds) return seeds;
  if (seeds->cell.empty()) {
    return refuse("the shape holds no particle; use a finer grid or more particles per cell");
  }
  seeds->particle_volume = *volume / static_cast<double>(seeds->cell.size());
  return seeds;
}

}  // namespace

Result<double> expected_particles(const Shape& shape, const SeedOptions& options) {
  if (auto checked = check(options); !checked) return checked.error();
  const auto volume = filled_volume(shape, options);
  if (!volume) return volume.error();
  return particles_in(*volume, options);
}

Result<Seeds> seed_shape(const Shape& shape, const SeedOptions& options) {
  if (auto checked = check(options); !checked) return checked.error();
  try {
    return seed_checked(shape, options);
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for the particles of the shape", {}};
  }
}

}  // namespace repose
