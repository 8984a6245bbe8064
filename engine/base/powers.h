// Repose: tables of what follows powers: straight lines between the rows in logarithms, and on beyond the first
// and the last as between the two next to them.
#pragma once

#include <cmath>
#include <cstddef>
#include <span>

namespace repose {

/// At least two rows, ascending in `of`; both numbers above zero.
template <class Row>
double along_powers(std::span<const Row> rows, double Row::*of, double Row::*what, double at) {
  std::size_t k = 1;
  while (k + 1 < rows.size() && rows[k].*of < at) ++k;
  const Row &low = rows[k - 1], &high = rows[k];
  const double slope = std::log(high.*what / low.*what) / std::log(high.*of / low.*of);
  return low.*what * std::pow(at / low.*of, slope);
}

}  // namespace repose
