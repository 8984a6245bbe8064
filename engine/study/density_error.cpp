#include "engine/study/density_error.h"

#include <array>
#include <cmath>
#include <map>

namespace repose {
namespace {

using Cell = std::array<std::int64_t, 3>;

/// Whether all cells beside one, across each axis that counts, are at least half full.
bool inside(const std::map<Cell, double>& filled, const Cell& cell, int flat,
            const std::array<std::int64_t, 3>& wraps) {
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == flat) continue;
    for (const int way : {-1, 1}) {
      Cell beside = cell;
      auto& place = beside[static_cast<std::size_t>(axis)];
      place += way;
      if (const std::int64_t round = wraps[static_cast<std::size_t>(axis)]; round > 0)
        place = (place % round + round) % round;
      const auto found = filled.find(beside);
      if (found == filled.end() || found->second < 0.5) return false;
    }
  }
  return true;
}

}  // namespace

void DensityError::describe(Fields& fields) {
  fields.number("width", width,
                {.unit = "m", .meaning = "of the cells that are looked at; 0: two spacings", .low = 0.0});
}

FigureValue DensityError::measure(const RunRecord& record) const {
  const double side = width > 0.0 ? width : 2.0 * record.spacing;
  double volume = side * side * side;
  if (record.flat >= 0) volume = side * side * record.spacing;
  std::array<std::int64_t, 3> wraps{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const double cells = record.period[axis] / side;
    if (cells > 0.0 && std::abs(cells - std::round(cells)) < 1e-6) wraps[axis] = std::llround(cells);
  }
  std::map<Cell, double> filled;
  for (std::size_t p = 0; p < record.end.size(); ++p) {
    Cell cell{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (static_cast<int>(axis) == record.flat) continue;
      cell[axis] = static_cast<std::int64_t>(std::floor(record.end.position[p][axis] / side));
      if (wraps[axis] > 0) cell[axis] = (cell[axis] % wraps[axis] + wraps[axis]) % wraps[axis];
    }
    filled[cell] += particle_volume(record.end, p) / volume;
  }
  double squares = 0.0, count = 0.0;
  for (const auto& [cell, share] : filled) {
    if (!inside(filled, cell, record.flat, wraps)) continue;
    squares += (share - 1.0) * (share - 1.0);
    count += 1.0;
  }
  if (count == 0.0)
    return FigureValue::none("no cell lies away from surfaces; a smaller \"width\" may find some");
  return {std::sqrt(squares / count), "", {}};
}

}  // namespace repose
