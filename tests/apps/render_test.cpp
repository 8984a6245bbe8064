// Repose: pictures: that light, shadow, depth and glass are where they must be, and films.
#include <gtest/gtest.h>
#include <png.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <numbers>

#include "apps/repose/render/film.h"
#include "apps/repose/render/grains.h"

namespace repose {
namespace {

namespace fs = std::filesystem;

/// Looks along -z at the origin from 2 m, on a black background, the sun above and to the left.
class Pictures : public ::testing::Test {
 protected:
  Pictures() {
    camera_.eye = {0, 0.4, 2};
    camera_.width = 160;
    camera_.height = 90;
    options_.background_top = options_.background_bottom = {0, 0, 0};
  }

  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("repose_render_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::size_t files() const { return std::distance(fs::directory_iterator(folder_), fs::directory_iterator()); }

  Image render() const { return render_grains(grains_, solids_, camera_, light_, options_); }

  /// The pixel that shows a point.
  std::array<int, 2> pixel_of(const Vec3& x) const {
    const View view = make_view(camera_, 1);
    const Eigen::Vector3f v = view.to_view((x - camera_.target).cast<float>());
    return {static_cast<int>(0.5f * static_cast<float>(view.width) + view.focal * v[0] / v[2]),
            static_cast<int>(0.5f * static_cast<float>(view.height) - view.focal * v[1] / v[2])};
  }

  static int brightness(const Image& image, const std::array<int, 2>& at) {
    const std::uint8_t* c = image.pixel(at[0], at[1]);
    return c[0] + c[1] + c[2];
  }

  void add_grain(const Vec3& x, double radius, std::uint32_t id, std::uint8_t material = 0) {
    grains_.push_back({{static_cast<float>(x[0]), static_cast<float>(x[1]), static_cast<float>(x[2])},
                       static_cast<float>(radius),
                       id,
                       material});
  }

  /// A square of side 2 * `half` (m) facing +`axis`, at `offset` along it.
  void add_square(int axis, double offset, double half, bool glass) {
    SolidMesh solid;
    solid.glass = glass;
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    for (const auto& [a, b] : {std::pair{-1, -1}, {1, -1}, {1, 1}, {-1, 1}}) {
      Vec3 x;
      x[axis] = offset;
      x[u] = a * half;
      x[v] = b * half;
      solid.mesh.vertices.push_back(x);
    }
    solid.mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
    solids_.push_back(solid);
  }

  /// A heap that covers many tiles.
  void add_heap(int count) {
    for (int i = 0; i < count; ++i) {
      const double angle = 2.4 * i, distance = 0.3 * std::sqrt(static_cast<double>(i) / count);
      add_grain({distance * std::cos(angle), 0.02 * std::sin(7.0 * i), distance * std::sin(angle)}, 0.01,
                static_cast<std::uint32_t>(i));
    }
  }

  std::vector<Grain> grains_;
  std::vector<SolidMesh> solids_;
  Camera camera_;
  Light light_;
  RenderOptions options_;
  fs::path folder_;
};

TEST_F(Pictures, GrainInTheMiddle_LightsItsPixelsOnly) {
  add_grain({0, 0, 0}, 0.1, 1);
  const Image image = render();
  EXPECT_GT(brightness(image, pixel_of({0, 0, 0})), 150);
  EXPECT_EQ(brightness(image, {5, 5}), 0);
  // The silhouette is the cone that touches the ball: radius over distance to the centre, as a sine.
  const double half_angle = std::asin(0.1 / camera_.eye.norm());
  const double radius = make_view(camera_, 1).focal * std::tan(half_angle);
  const std::array<int, 2> middle = pixel_of({0, 0, 0});
  EXPECT_GT(brightness(image, {middle[0] - static_cast<int>(radius - 1.5), middle[1]}), 0);
  EXPECT_EQ(brightness(image, {middle[0] - static_cast<int>(radius + 2.5), middle[1]}), 0);
}

TEST_F(Pictures, SunFromTheLeft_LeftSideIsBrighter) {
  add_grain({0, 0, 0}, 0.2, 1, 1);
  const Image image = render();
  EXPECT_GT(brightness(image, pixel_of({-0.12, 0.0, 0.1})), 50 + brightness(image, pixel_of({0.12, 0.0, 0.1})));
}

TEST_F(Pictures, ClusterAboveGround_DarkensTheGroundInItsShadow) {
  add_square(1, 0.0, 10.0, false);
  const Image open = render();
  for (int i = 0; i < 27; ++i)
    add_grain({0.03 * (i % 3 - 1), 0.25 + 0.03 * (i / 9), 0.03 * (i / 3 % 3 - 1)}, 0.02, i);
  const Image image = render();
  const Vec3 sun = light_.to_sun.normalized();
  const std::array<int, 2> shadow = pixel_of(Vec3(0, 0.28, 0) - 0.28 / sun[1] * sun);
  const std::array<int, 2> beside = pixel_of(Vec3(0, 0.28, 0.35) - 0.28 / sun[1] * sun);
  EXPECT_LT(brightness(image, shadow), 0.6 * brightness(open, shadow));
  EXPECT_GT(brightness(image, beside), 0.95 * brightness(open, beside));
}

TEST_F(Pictures, GrainsBehindOneAnother_NearerIsSeenInAnyOrder) {
  add_grain({0, 0, 0}, 0.05, 1, 0);
  add_grain(0.2 * camera_.eye, 0.05, 2, 1);
  const Image image = render();
  std::swap(grains_[0], grains_[1]);
  EXPECT_EQ(image.rgb, render().rgb);
  const std::array<int, 2> middle = pixel_of({0, 0, 0});
  const std::uint8_t* c = image.pixel(middle[0], middle[1]);
  EXPECT_GT(c[2], c[0]);  // the blue one
}

TEST_F(Pictures, GrainsThatInterlock_EachIsSeenWhereItIsNearer) {
  camera_.eye = {0, 0, 2};
  add_grain({0, 0, 0}, 0.3, 1, 1);
  add_grain({0.15, 0, 0.17}, 0.1, 2, 2);
  const Image image = render();
  const std::array<int, 2> blue = pixel_of({0.15, 0.08, 0.2472}), red = pixel_of({0.2, 0, 0.25});
  EXPECT_GT(image.pixel(blue[0], blue[1])[2], image.pixel(blue[0], blue[1])[0]);
  EXPECT_GT(image.pixel(red[0], red[1])[0], image.pixel(red[0], red[1])[2]);
}

TEST_F(Pictures, GapInAHeap_IsDarkerThanWithoutOcclusion) {
  options_.background_top = {0.1f, 0.1f, 0.1f};
  light_.sun = {0, 0, 0};
  for (int i = 0; i < 9; ++i)
    add_grain({0.1 * (i % 3 - 1), 0.1 * (i / 3 - 1), i == 4 ? -0.1 : 0.0}, 0.055, i, 1);
  const Image image = render();
  options_.occlusion = 0.0f;
  const Image flat = render();
  const std::array<int, 2> gap = pixel_of({0, 0, -0.05});
  EXPECT_LT(brightness(image, gap), 0.8 * brightness(flat, gap));
}

TEST_F(Pictures, AnyNumberOfThreads_SameBytes) {
  add_heap(3000);
  add_square(1, -0.03, 10.0, false);
  add_square(2, 0.5, 0.4, true);
  const Image image = render();
  for (const std::size_t threads : {1u, 2u, 5u}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    EXPECT_EQ(image.rgb, render().rgb);
  }
}

TEST_F(Pictures, TenKilometresAway_GrainsStayRound) {
  add_grain({0, 0, 0}, 0.1, 1, 1);
  const Image here = render();
  const Vec3 far{8192, 0, -8192};  // a power of two: the float positions of grains are exact there
  grains_.clear();
  add_grain(far, 0.1, 1, 1);
  camera_.eye += far;
  camera_.target += far;
  EXPECT_EQ(here.rgb, render().rgb);
}

TEST_F(Pictures, GlassInFront_LeavesWhatIsBehindVisible) {
  add_grain({0, 0, 0}, 0.15, 1, 1);
  const Image without = render();
  add_square(2, 0.5, 0.5, true);
  const Image with = render();
  const std::array<int, 2> middle = pixel_of({0, 0, 0});
  EXPECT_GT(brightness(with, middle), 0.75 * brightness(without, middle));
  EXPECT_NE(brightness(with, middle), brightness(without, middle));
  const std::uint8_t* c = with.pixel(middle[0], middle[1]);
  EXPECT_GT(c[2], c[0] + 20);  // still the blue grain
}

TEST_F(Pictures, GlassBehindAGrain_DoesNotTouchIt) {
  light_.sun = {0, 0, 0};
  add_grain({0, 0, 0}, 0.15, 1, 1);
  const Image without = render();
  add_square(2, -0.5, 0.5, true);
  const std::array<int, 2> middle = pixel_of({0, 0, 0});
  EXPECT_EQ(brightness(render(), middle), brightness(without, middle));
}

TEST_F(Pictures, GlassTube_OutlineStandsOutFromTheMiddle) {
  options_.background_top = options_.background_bottom = {0.2f, 0.2f, 0.2f};
  const Image empty = render();
  SolidMesh tube;
  tube.glass = true;
  constexpr int kSides = 64;
  for (int i = 0; i < kSides; ++i) {
    const double angle = 2 * std::numbers::pi * i / kSides;
    for (const double y : {-0.5, 0.5})
      tube.mesh.vertices.push_back({0.2 * std::cos(angle), y, 0.2 * std::sin(angle)});
    const int a = 2 * i, b = 2 * ((i + 1) % kSides);
    tube.mesh.triangles.push_back({a, a + 1, b});
    tube.mesh.triangles.push_back({b, a + 1, b + 1});
  }
  solids_.push_back(tube);
  const Image image = render();
  const auto change = [&](const Vec3& x) {
    return std::abs(brightness(image, pixel_of(x)) - brightness(empty, pixel_of(x)));
  };
  EXPECT_GT(change({-0.198, 0, 0}), 2 * change({0.02, 0, 0}) + 10);
}

TEST_F(Pictures, NothingToSee_IsBackground) {
  for (const std::uint8_t byte : render().rgb) ASSERT_EQ(byte, 0);
}

TEST_F(Pictures, GrainsThatCannotBeSeen_AreLeftOutWithoutHarm) {
  add_grain(camera_.eye, 0.5, 1);
  add_grain(camera_.eye + Vec3(0, 0, 1), 0.1, 2);
  add_grain({std::nan(""), 0, 0}, 0.1, 3);
  add_square(0, 0.0, 10.0, true);   // through the eye, edge on
  add_square(1, 0.4, 10.0, false);  // at the height of the eye
  EXPECT_EQ(render().width, camera_.width);
}

TEST_F(Pictures, FrameBounds_HoldsAllCornersAndTouchesTheMargin) {
  const Bounds bounds{{-1, 0, -2}, {3, 1, 2}};
  camera_ = frame_bounds(camera_, bounds, 0.1);
  double widest = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 x{corner & 1 ? 3.0 : -1.0, corner & 2 ? 1.0 : 0.0, corner & 4 ? 2.0 : -2.0};
    const View view = make_view(camera_, 1);
    const Eigen::Vector3f v = view.to_view((x - camera_.target).cast<float>());
    ASSERT_GT(v[2], 0.0f);
    widest = std::max({widest, std::abs(v[0] / v[2]) * view.focal / (0.5 * view.width),
                       std::abs(v[1] / v[2]) * view.focal / (0.5 * view.height)});
  }
  EXPECT_NEAR(widest, 0.8, 1e-3);
}

TEST_F(Pictures, Png_ReadBack_SamePixels) {
  add_heap(500);
  const Image image = render();
  ASSERT_TRUE(write_png(image, path("a.png")));
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  ASSERT_TRUE(png_image_begin_read_from_file(&header, path("a.png").c_str()));
  header.format = PNG_FORMAT_RGB;
  Image back(static_cast<int>(header.width), static_cast<int>(header.height));
  ASSERT_TRUE(png_image_finish_read(&header, nullptr, back.rgb.data(), 0, nullptr));
  EXPECT_EQ(back.width, image.width);
  EXPECT_EQ(back.rgb, image.rgb);
  EXPECT_EQ(write_png(image, path("none/a.png")).error().kind, ErrorKind::kCannotCreate);
}

TEST_F(Pictures, Film_OfTwelvePictures_IsReadByFfprobe) {
  ASSERT_EQ(std::system("command -v ffmpeg ffprobe > /dev/null"), 0) << "install ffmpeg";
  add_heap(500);
  const Image image = render();
  Result<Film> film = Film::start(path("a b'.mp4"), image.width, image.height, 24);
  ASSERT_TRUE(film) << film.error().text();
  for (int i = 0; i < 12; ++i) ASSERT_TRUE(film->add(image));
  EXPECT_FALSE(fs::exists(path("a b'.mp4")));
  const Result<void> done = film->finish();
  ASSERT_TRUE(done) << done.error().text();
  EXPECT_EQ(files(), 1u);
  fs::rename(path("a b'.mp4"), path("a.mp4"));
  const std::string probe =
      "test \"$(ffprobe -v error -count_frames -show_entries stream=nb_read_frames,width,pix_fmt "
      "-of csv=p=0 " +
      path("a.mp4") + ")\" = 160,yuv420p,12";
  EXPECT_EQ(std::system(probe.c_str()), 0);
}

TEST_F(Pictures, Film_WithoutEncoder_SaysWhatToInstallAndLeavesNothing) {
  const Result<Film> film = Film::start(path("a.mp4"), 160, 90, 24, "no-such-encoder");
  ASSERT_FALSE(film);
  EXPECT_EQ(film.error().kind, ErrorKind::kCannotCreate);
  EXPECT_NE(film.error().message.find("apt install ffmpeg"), std::string::npos) << film.error().text();
  EXPECT_EQ(files(), 0u);
}

TEST_F(Pictures, Film_EncoderDies_ErrorAndNothingLeft) {
  {
    Result<Film> film = Film::start(path("a.mp4"), 160, 90, 24, "false");
    ASSERT_TRUE(film);
    Result<void> done;
    const Image image(160, 90);
    for (int i = 0; done && i < 1000; ++i) done = film->add(image);
    if (done) done = film->finish();
    ASSERT_FALSE(done);
    EXPECT_EQ(done.error().kind, ErrorKind::kIo);
    EXPECT_FALSE(film->add(image));
  }
  EXPECT_EQ(files(), 0u);
}

TEST_F(Pictures, Film_ImpossibleSizeOrFolder_Refused) {
  EXPECT_EQ(Film::start(path("a.mp4"), 161, 90, 24).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(Film::start(path("a.mp4"), 160, 90, 0).error().kind, ErrorKind::kUsage);
  EXPECT_EQ(Film::start(path("none/a.mp4"), 160, 90, 24).error().kind, ErrorKind::kCannotCreate);
}

}  // namespace
}  // namespace repose
