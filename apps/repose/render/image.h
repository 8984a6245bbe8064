// Repose: a finished picture, eight bits a channel, and its way to a PNG file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// RGB, rows from the top, three bytes a pixel without padding: as PNG and ffmpeg's rgb24 want it.
struct Image {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> rgb;

  Image() = default;
  Image(int w, int h)
      : width(w), height(h), rgb(3 * static_cast<std::size_t>(w) * static_cast<std::size_t>(h)) {}

  /// The three bytes of one pixel; (0, 0) is the upper left.
  std::uint8_t* pixel(int x, int y) { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
  const std::uint8_t* pixel(int x, int y) const { return &rgb[3 * (static_cast<std::size_t>(y) * width + x)]; }
};

/// Writes the old picture or the new one, never a torn one. Errors: 73, 74.
Result<void> write_png(const Image& image, const std::string& path);

}  // namespace repose
