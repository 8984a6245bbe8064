// Repose: a raster cut into square tiles, each with the list of what touches it. A tile is drawn by one thread
// in the order of the list, which is what makes a picture independent of the number of threads.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace repose {

/// Samples x0 <= x < x1, y0 <= y < y1.
struct PixelBox {
  int x0 = 0;
  int y0 = 0;
  int x1 = 0;
  int y1 = 0;

  bool empty() const { return x0 >= x1 || y0 >= y1; }
};

PixelBox intersect(const PixelBox& a, const PixelBox& b);

/// The box around [x0, x1] x [y0, y1] in samples, cut to a raster of width x height; safe for any
/// numbers, an empty box where one is NaN.
PixelBox covering_box(float x0, float y0, float x1, float y1, int width, int height);

class TileBins {
 public:
  /// `boxes[i]` holds all samples that primitive i can touch, within the raster; empty where it is not seen.
  TileBins(int width, int height, std::span<const PixelBox> boxes);

  int size() const { return columns_ * rows_; }
  PixelBox box(int tile) const;
  std::span<const std::uint32_t> primitives(int tile) const;

 private:
  template <class Visit>
  void for_each_tile(const PixelBox& box, Visit&& visit) const;

  static constexpr int kSide = 64;
  int width_;
  int height_;
  int columns_;
  int rows_;
  std::vector<std::size_t> first_;  // of each tile in primitives_, and the end
  std::vector<std::uint32_t> primitives_;
};

}  // namespace repose
