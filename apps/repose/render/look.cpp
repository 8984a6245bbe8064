// Repose: palettes, soft boxes and the tone curve.
#include "apps/repose/render/look.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

namespace repose {
namespace {

/// A colour as painters know it (sRGB, 0 to 255) and how many of 100 grains have it.
struct Pigment {
  int share;
  std::array<int, 3> srgb;
  float gloss;
};

// Quartz stained by iron oxide, clear quartz, and a few dark minerals.
constexpr std::array<Pigment, 8> kSand{{{27, {200, 163, 114}, 0.10f},
                                        {24, {184, 144, 96}, 0.10f},
                                        {20, {214, 183, 138}, 0.15f},
                                        {13, {166, 124, 80}, 0.08f},
                                        {6, {222, 209, 186}, 0.45f},
                                        {4, {162, 103, 69}, 0.10f},
                                        {4, {118, 94, 72}, 0.15f},
                                        {2, {78, 70, 64}, 0.30f}}};
constexpr std::array<Pigment, 3> kBlue{
    {{50, {86, 134, 190}, 0.06f}, {30, {104, 152, 204}, 0.06f}, {20, {70, 114, 172}, 0.06f}}};
constexpr std::array<Pigment, 3> kRed{
    {{50, {188, 84, 74}, 0.06f}, {30, {204, 104, 88}, 0.06f}, {20, {166, 68, 62}, 0.06f}}};
constexpr std::array<Pigment, 3> kGreen{
    {{50, {98, 158, 110}, 0.06f}, {30, {118, 176, 126}, 0.06f}, {20, {80, 138, 96}, 0.06f}}};

std::span<const Pigment> palette(std::uint8_t material) {
  if (material == 0) return kSand;
  const std::array<std::span<const Pigment>, 3> rubbers{kBlue, kRed, kGreen};
  return rubbers[(material - 1u) % 3];
}

// The finaliser of MurmurHash3: ids that follow one another give unrelated numbers.
std::uint32_t mixed(std::uint32_t h) {
  h = (h ^ h >> 16) * 0x85ebca6bu;
  h = (h ^ h >> 13) * 0xc2b2ae35u;
  return h ^ h >> 16;
}

float to_linear(int srgb) {
  const float s = static_cast<float>(srgb) / 255.0f;
  return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f);
}

}  // namespace

GrainLook look_of(const Grain& grain) {
  const std::uint32_t hash = mixed(grain.id + 0x9e3779b9u);
  const std::span<const Pigment> pigments = palette(grain.material);
  int left = static_cast<int>(hash % 100);
  const Pigment* pigment = &pigments.front();
  for (const Pigment& candidate : pigments) {
    pigment = &candidate;
    left -= candidate.share;
    if (left < 0) break;
  }
  GrainLook look;
  const float shade = 0.86f + 0.28f * static_cast<float>(hash >> 8 & 0xff) / 255.0f;
  look.albedo =
      shade * Color(to_linear(pigment->srgb[0]), to_linear(pigment->srgb[1]), to_linear(pigment->srgb[2]));
  look.gloss = pigment->gloss;
  look.relief = grain.material == 0 ? 0.6f : 0.0f;
  look.seed = mixed(hash);
  return look;
}

Eigen::Vector3f worn_normal(const GrainLook& look, const Eigen::Vector3f& normal) {
  if (look.relief == 0.0f) return normal;
  // Three waves in a frame that is turned for each grain, then a pull towards the nearest of eight faces: lumps
  // alone look like putty, faces alone like cut gems.
  const auto part = [&](int shift) { return static_cast<float>(look.seed >> shift & 0xff) / 127.5f - 1.0f; };
  const Eigen::Quaternionf turn = Eigen::Quaternionf(part(0), part(8), part(16), part(24) + 0.01f).normalized();
  const Eigen::Vector3f inner = turn * normal;
  const Eigen::Vector3f lump(std::sin(3.7f * inner[1] + 9.0f * inner[2]),
                             std::sin(4.3f * inner[2] + 8.0f * inner[0]),
                             std::sin(4.9f * inner[0] + 7.0f * inner[1]));
  const Eigen::Vector3f face = inner.unaryExpr([](float c) { return std::clamp(5.0f * c, -0.577f, 0.577f); });
  return (normal + look.relief * (turn.conjugate() * Eigen::Vector3f(0.35f * lump + face - inner)))
      .normalized();
}

Color background(const RenderOptions& options, float height) {
  const float t = soft_step(-0.02f, 0.45f, height);
  return (1.0f - t) * to_color(options.background_bottom) + t * to_color(options.background_top);
}

Color environment(const Light& light, const Eigen::Vector3f& direction, const Eigen::Vector3f& up) {
  const float height = direction.dot(up);
  const float t = soft_step(-0.25f, 0.35f, height);
  Color color = (1.0f - t) * 0.6f * to_color(light.bounce) + t * (0.75f - 0.25f * height) * to_color(light.sky);

  const Eigen::Vector3f sun = light.to_sun.normalized().cast<float>();
  const Eigen::Vector3f toward = (sun - sun.dot(up) * up).normalized();
  const Eigen::Vector3f side = up.cross(toward);
  const Eigen::Vector3f flat = (direction - height * up).normalized();
  const float box_height = soft_step(0.0f, 0.12f, height) * (1.0f - soft_step(0.62f, 0.8f, height));
  const auto box = [&](float center_side, float width) {
    const float across = std::abs(flat.dot(side) - center_side);
    return box_height * (1.0f - soft_step(0.7f * width, width, across));
  };
  if (flat.dot(toward) > 0.0f) color += 2.6f * box(0.0f, 0.22f) * to_color(light.sun);
  color += 0.8f * box(0.9f, 0.06f) * to_color(light.sky);
  return color;
}

Color film_curve(const Color& light) {
  // Narkowicz's fit (2015) of the ACES film curve, entered lower so that sand keeps its colour in the sun.
  const Color x = 0.62f * light.max(0.0f);
  return ((x * (2.51f * x + 0.03f)) / (x * (2.43f * x + 0.59f) + 0.14f)).min(1.0f);
}

Color to_srgb(const Color& linear) {
  return linear.unaryExpr(
      [](float v) { return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1.0f / 2.4f) - 0.055f; });
}

float soft_step(float from, float to, float x) {
  const float t = std::clamp((x - from) / (to - from), 0.0f, 1.0f);
  return t * t * (3.0f - 2.0f * t);
}

}  // namespace repose
