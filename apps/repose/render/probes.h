// Repose: where soft shadows and occlusion look around a sample.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>

namespace repose {

/// N points spread evenly over the unit disc, from the centre outwards: a Vogel spiral.
template <int N>
const std::array<Eigen::Vector2f, N>& vogel_disc() {
  static const auto points = [] {
    constexpr float kGoldenAngle = 2.39996323f;
    std::array<Eigen::Vector2f, N> disc;
    for (int k = 0; k < N; ++k) {
      const float radius = std::sqrt((static_cast<float>(k) + 0.5f) / N);
      const float angle = kGoldenAngle * static_cast<float>(k);
      disc[static_cast<std::size_t>(k)] = {radius * std::cos(angle), radius * std::sin(angle)};
    }
    return disc;
  }();
  return points;
}

/// Interleaved gradient noise (Jimenez 2014), 0 to 1: differs between neighbours and evens out over a few of
/// them.
inline float dither_at(int x, int y) {
  const float wave = 0.06711056f * static_cast<float>(x) + 0.00583715f * static_cast<float>(y);
  const float noise = 52.9829189f * (wave - std::floor(wave));
  return noise - std::floor(noise);
}

/// A rotation, as cosine and sine.
struct Turn {
  float cosine;
  float sine;
};

/// The rotation by that noise.
inline Turn turn_at(int x, int y) {
  const float angle = 6.2831853f * dither_at(x, y);
  return {std::cos(angle), std::sin(angle)};
}

inline Eigen::Vector2f turned(const Turn& turn, const Eigen::Vector2f& v) {
  return {turn.cosine * v[0] - turn.sine * v[1], turn.sine * v[0] + turn.cosine * v[1]};
}

}  // namespace repose
