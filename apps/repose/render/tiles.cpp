// Repose: sorting primitives into tiles by counting.
#include "apps/repose/render/tiles.h"

#include <algorithm>
#include <cmath>

namespace repose {

PixelBox intersect(const PixelBox& a, const PixelBox& b) {
  return {std::max(a.x0, b.x0), std::max(a.y0, b.y0), std::min(a.x1, b.x1), std::min(a.y1, b.y1)};
}

PixelBox covering_box(float x0, float y0, float x1, float y1, int width, int height) {
  // Written so that a NaN falls to 0: its box is empty.
  const auto cut = [](float value, int most) {
    return value > 0.0f ? static_cast<int>(std::min(value, static_cast<float>(most))) : 0;
  };
  return {cut(std::floor(x0), width), cut(std::floor(y0), height), cut(std::ceil(x1), width),
          cut(std::ceil(y1), height)};
}

TileBins::TileBins(int width, int height, std::span<const PixelBox> boxes)
    : width_(width),
      height_(height),
      columns_((width + kSide - 1) / kSide),
      rows_((height + kSide - 1) / kSide) {
  first_.assign(static_cast<std::size_t>(size()) + 1, 0);
  for (const PixelBox& box : boxes) {
    for_each_tile(box, [&](std::size_t tile) { ++first_[tile + 1]; });
  }
  for (std::size_t tile = 0; tile + 1 < first_.size(); ++tile) first_[tile + 1] += first_[tile];
  primitives_.resize(first_.back());
  std::vector<std::size_t> next = first_;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for_each_tile(boxes[i],
                  [&](std::size_t tile) { primitives_[next[tile]++] = static_cast<std::uint32_t>(i); });
  }
}

template <class Visit>
void TileBins::for_each_tile(const PixelBox& box, Visit&& visit) const {
  if (box.empty()) return;
  for (int row = box.y0 / kSide; row <= (box.y1 - 1) / kSide; ++row) {
    for (int column = box.x0 / kSide; column <= (box.x1 - 1) / kSide; ++column) {
      visit(static_cast<std::size_t>(row * columns_ + column));
    }
  }
}

PixelBox TileBins::box(int tile) const {
  const int x = tile % columns_ * kSide, y = tile / columns_ * kSide;
  return {x, y, std::min(x + kSide, width_), std::min(y + kSide, height_)};
}

std::span<const std::uint32_t> TileBins::primitives(int tile) const {
  const auto i = static_cast<std::size_t>(tile);
  return {primitives_.data() + first_[i], first_[i + 1] - first_[i]};
}

}  // namespace repose
