// Repose: a picture from start to end: what is seen, then its light sample by sample, then glass over it, then
// the samples of a pixel together.
#include "apps/repose/render/grains.h"

#include <tbb/parallel_for.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "apps/repose/render/glass.h"
#include "apps/repose/render/local_scene.h"
#include "apps/repose/render/look.h"
#include "apps/repose/render/occlusion.h"
#include "apps/repose/render/probes.h"
#include "apps/repose/render/shadow.h"
#include "apps/repose/render/visibility.h"

namespace repose {
namespace {

/// A visible point before light falls on it.
struct Surface {
  Eigen::Vector3f position;  // world, relative to the target
  Eigen::Vector3f normal;    // of the shape
  Eigen::Vector3f shading;   // with its relief
  Color albedo;
  float gloss = 0;
  bool solid = false;
};

class Painter {
 public:
  Painter(std::span<const Grain> grains, std::span<const SolidMesh> solids, const Camera& camera,
          const Light& light, const RenderOptions& options)
      : solids_(solids),
        light_(light),
        options_(options),
        scene_(make_local_scene(grains, solids, camera.target)),
        view_(make_view(camera, options.supersampling)),
        up_(camera.up.normalized().cast<float>()),
        sun_(light.to_sun.normalized().cast<float>()),
        ranges_{3.0f * scene_.grain_radius, std::max(0.06f * scene_.size, 8.0f * scene_.grain_radius)},
        visible_(find_visible(scene_, view_)),
        shadow_(scene_, light),
        glass_(scene_, solids, view_, light_, up_) {
    looks_.resize(grains.size());
    tbb::parallel_for(std::size_t{0}, grains.size(), [&](std::size_t i) { looks_[i] = look_of(grains[i]); });
  }

  int tiles() const { return glass_.tiles().size(); }

  /// Lights one tile and writes its pixels.
  void paint(int tile, Image& image) const {
    const PixelBox box = glass_.tiles().box(tile);
    const int width = box.x1 - box.x0;
    const std::vector<GlassSample> glass = glass_.draw(tile, visible_);
    std::vector<Color> samples(static_cast<std::size_t>(width) * static_cast<std::size_t>(box.y1 - box.y0));
    for (int y = box.y0; y < box.y1; ++y) {
      for (int x = box.x0; x < box.x1; ++x) {
        const std::size_t at = static_cast<std::size_t>(y - box.y0) * width + (x - box.x0);
        Color color = behind_glass(x, y);
        if (!glass.empty()) color = glass[at].through * color + glass[at].mirrored;
        // Before the samples are joined: a highlight of one sample must not outshine its pixel.
        samples[at] = film_curve(options_.exposure * color);
      }
    }
    join(samples, box, image);
  }

 private:
  Color behind_glass(int x, int y) const {
    const Color back =
        background(options_, (view_.rotation.transpose() * view_.ray(x, y)).normalized().dot(up_));
    const std::uint32_t primitive = visible_.primitive[visible_.at(x, y)];
    if (primitive == Visibility::kNothing) return back;
    const Surface surface = surface_at(x, y, primitive);
    float fade = 0.0f;
    if (surface.solid) {
      const float far = surface.position.norm() / view_.eye.norm();
      fade = soft_step(options_.fade_from, options_.fade_to, far);
      if (fade == 1.0f) return back;
    }
    return (1.0f - fade) * light_on(surface, x, y) + fade * back;
  }

  Surface surface_at(int x, int y, std::uint32_t primitive) const {
    Surface s;
    const Eigen::Vector3f ray = view_.ray(x, y);
    s.position = view_.to_world(visible_.depth[visible_.at(x, y)] * ray);
    if (primitive < scene_.balls.size()) {
      const GrainLook& look = looks_[primitive];
      s.normal = (s.position - scene_.balls[primitive].center).normalized();
      s.shading = worn_normal(look, s.normal);
      s.albedo = look.albedo;
      s.gloss = look.gloss;
      return s;
    }
    const std::size_t triangle = primitive - scene_.balls.size();
    const Triangle& t = scene_.matte[triangle];
    Eigen::Vector3f weights;
    visible_.triangles[triangle].hit(ray, weights);
    s.normal = (weights[0] * t.normal[0] + weights[1] * t.normal[1] + weights[2] * t.normal[2]).normalized();
    // By the face, not by the smooth normal, which may look away at an outline that is seen from outside.
    const Eigen::Vector3f face = (t.corner[1] - t.corner[0]).cross(t.corner[2] - t.corner[0]);
    if (face.dot(view_.eye - s.position) < 0.0f) s.normal = -s.normal;
    s.shading = s.normal;
    s.albedo = color_of(solids_[t.solid]);
    s.solid = true;
    return s;
  }

  Color light_on(const Surface& s, int x, int y) const {
    const Turn turn = turn_at(x, y);
    const float open = 1.0f - options_.occlusion * (1.0f - open_sky(visible_, view_, ranges_, x, y,
                                                                    view_.rotation * s.normal, turn));
    // Light that is caught in a hollow bounces and takes the colour of its walls (Jimenez et al. 2016,
    // simplified).
    const Color sky_share = open / (1.0f - 0.7f * s.albedo * (1.0f - open));
    const float up = 0.5f + 0.5f * s.shading.dot(up_);
    Color light = sky_share * (up * to_color(light_.sky) + (1.0f - up) * to_color(light_.bounce));

    const float facing = s.shading.dot(sun_);
    if (facing <= 0.0f || s.normal.dot(sun_) <= 0.0f) return s.albedo * light;
    float lit = shadow_.lit(s.position, s.normal, turn);
    if (s.solid) lit *= shadow_.through_glass(s.position, turn);
    light += facing * lit * to_color(light_.sun);
    const Eigen::Vector3f halfway = (sun_ + (view_.eye - s.position).normalized()).normalized();
    const float highlight = s.gloss * std::pow(std::max(0.0f, s.shading.dot(halfway)), 40.0f);
    return s.albedo * light + highlight * lit * to_color(light_.sun);
  }

  // The mean of each pixel's samples. A tile holds whole pixels, since its side is a multiple of the
  // supersampling.
  void join(const std::vector<Color>& samples, const PixelBox& box, Image& image) const {
    const int n = options_.supersampling, width = box.x1 - box.x0;
    for (int py = box.y0 / n; py < box.y1 / n; ++py) {
      for (int px = box.x0 / n; px < box.x1 / n; ++px) {
        Color sum(0, 0, 0);
        for (int y = py * n; y < (py + 1) * n; ++y) {
          for (int x = px * n; x < (px + 1) * n; ++x) {
            sum += samples[static_cast<std::size_t>(y - box.y0) * width + (x - box.x0)];
          }
        }
        put_pixel(sum / static_cast<float>(n * n), px, py, image);
      }
    }
  }

  static void put_pixel(const Color& color, int x, int y, Image& image) {
    // Rounding by a pattern, not to the nearest: smooth backgrounds would show bands.
    const float pattern = dither_at(x, y);
    const Color display = to_srgb(color);
    for (int k = 0; k < 3; ++k) {
      image.pixel(x, y)[k] = static_cast<std::uint8_t>(std::clamp(255.0f * display[k] + pattern, 0.0f, 255.0f));
    }
  }

  std::span<const SolidMesh> solids_;
  const Light& light_;
  const RenderOptions& options_;
  LocalScene scene_;
  View view_;
  Eigen::Vector3f up_;
  Eigen::Vector3f sun_;
  OcclusionRanges ranges_;
  Visibility visible_;
  ShadowMap shadow_;
  Glass glass_;
  std::vector<GrainLook> looks_;
};

}  // namespace

Image render_grains(std::span<const Grain> grains, std::span<const SolidMesh> solids, const Camera& camera,
                    const Light& light, const RenderOptions& options) {
  REPOSE_ASSERT(options.supersampling == 1 || options.supersampling == 2 || options.supersampling == 4);
  const Painter painter(grains, solids, camera, light, options);
  Image image(camera.width, camera.height);
  tbb::parallel_for(0, painter.tiles(), [&](int tile) { painter.paint(tile, image); });
  return image;
}

}  // namespace repose
