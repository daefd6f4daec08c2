/// Small pictures with little in them, and what tests ask of pictures.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>

#include "common/render/png.h"
#include "common/render/render_image.h"
#include "common/render/scene_view.h"
#include "tests/support/project_folders.h"

namespace palpate::test {

inline constexpr int kSize = 200;

// An orthographic view along +y of the box [-1, 1]^3 without anything but lines: x to the right, z up.
// The view is 2.44 high (22 % of room at the sides), so a data unit is kSize / 2.44 pixels.
inline SceneView front_view(std::vector<Line> lines) {
  SceneView view;
  view.bounds = {Vec3(-1.0), Vec3(1.0)};
  view.lines = std::make_shared<const std::vector<Line>>(std::move(lines));
  view.camera = make_camera(view.bounds, {.azimuth = 0.0, .elevation = 0.0}, 1.0, Projection::kOrthographic);
  view.show_outline = view.show_axes = view.show_color_bar = false;
  view.style.width = 30.0;  // 6 pixels
  view.style.depth_cue = false;
  return view;
}

struct Pixel {
  int x, y;
};

inline Pixel where(double x, double z) {
  const double unit = kSize / 2.44;
  return {static_cast<int>(0.5 * kSize + unit * x), static_cast<int>(0.5 * kSize - unit * z)};
}

inline std::array<int, 4> at(const Image& image, double x, double z) {
  const Pixel p = where(x, z);
  return image.pixel(p.x, p.y);
}

inline bool is_background(const std::array<int, 4>& c) { return c[0] < 40 && c[1] < 40 && c[2] < 45; }

inline double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) sum += std::abs(a.rgba[i] - b.rgba[i]);
  return sum / static_cast<double>(a.rgba.size());
}

/// The largest difference of any byte.
inline int worst_difference(const Image& a, const Image& b) {
  int worst = a.rgba.size() == b.rgba.size() ? 0 : 256;
  for (std::size_t i = 0; worst < 256 && i < a.rgba.size(); ++i) {
    worst = std::max(worst, std::abs(int{a.rgba[i]} - int{b.rgba[i]}));
  }
  return worst;
}

// Pictures kept beside the tests, looked at by people. Rasterisers of other makes and versions place
// some samples differently: the mean over all bytes and the share of clearly different pixels may reach
// these bounds. PALPATE_UPDATE_BASELINES writes the pictures anew.
inline constexpr double kMeanBound = 0.5, kShareBound = 0.005;
inline constexpr int kClearlyDifferent = 24;

/// The part of `image` from column `left` and row `top` on.
inline Image part_of(const Image& image, int left, int top, int width, int height) {
  Image part{.width = width, .height = height, .rgba = {}};
  for (int y = 0; y < height; ++y) {
    const auto* row = image.rgba.data() + 4 * (static_cast<std::ptrdiff_t>(top + y) * image.width + left);
    part.rgba.insert(part.rgba.end(), row, row + 4 * width);
  }
  return part;
}

/// @pre both have the same size.
inline void expect_alike(const Image& image, const Image& baseline, const std::string& name) {
  EXPECT_LT(mean_difference(image, baseline), kMeanBound) << name;
  int different = 0;
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      const auto a = image.pixel(x, y), b = baseline.pixel(x, y);
      int worst = 0;
      for (std::size_t c = 0; c < 3; ++c) worst = std::max(worst, std::abs(a[c] - b[c]));
      different += worst > kClearlyDifferent ? 1 : 0;
    }
  }
  EXPECT_LT(different, kShareBound * image.width * image.height) << name;
}

/// The baseline of that name, written anew from `image` where that is asked for; of no size where it is not
/// there or of another size.
inline Image baseline_of(const Image& image, const std::string& name) {
  const auto path = source_folder() / "tests/baselines" / (name + ".png");
  if (std::getenv("PALPATE_UPDATE_BASELINES") != nullptr) {
    std::filesystem::create_directories(path.parent_path());
    write_png(path, image, {});
  }
  Image baseline;
  int channels = 0;
  stbi_uc* pixels = stbi_load(path.c_str(), &baseline.width, &baseline.height, &channels, 4);
  EXPECT_NE(pixels, nullptr) << path;
  if (pixels == nullptr) return {};
  baseline.rgba.assign(pixels, pixels + 4 * static_cast<std::ptrdiff_t>(baseline.width) * baseline.height);
  std::free(pixels);
  EXPECT_EQ(baseline.width, image.width) << path;
  EXPECT_EQ(baseline.height, image.height) << path;
  return baseline.width == image.width && baseline.height == image.height ? baseline : Image{};
}

inline void expect_baseline(const SceneView& view, const std::string& name) {
  constexpr int kWidth = 240, kHeight = 180;
  const Image image = render_image(view, kWidth, kHeight).image;
  const Image baseline = baseline_of(image, name);
  if (baseline.width > 0) expect_alike(image, baseline, name);
}

}  // namespace palpate::test
