/// Small pictures of volumes, made one after another in one context of OpenGL.
#pragma once

#include <algorithm>
#include <cmath>
#include <memory>

#include "common/render/gl/context.h"
#include "common/render/volume/volume_picture.h"

namespace palpate {

class PictureStage {
 public:
  static constexpr int kPixels = 48;
  static constexpr double kStep = 1.0 / 255;  ///< of a screen

  /// Makes the context with the first picture. @throws Error (work failed) without OpenGL.
  [[nodiscard]] FloatImage draw(const VolumeView& view, const Camera& camera) {
    if (!context_) context_ = std::make_unique<OffscreenContext>();
    if (!picture_)
      picture_ = std::make_unique<VolumePicture>(kPixels, kPixels, VolumePicture::Context::kCurrent);
    return picture_->draw(view, camera);
  }

 private:
  std::unique_ptr<OffscreenContext> context_;
  std::unique_ptr<VolumePicture> picture_;
};

/// Largest of all numbers; infinite where one of them is none.
[[nodiscard]] inline double brightest(const FloatImage& image) {
  double most = 0.0;
  for (const float number : image.rgba) {
    if (!std::isfinite(number)) return HUGE_VAL;
    most = std::max(most, std::abs(static_cast<double>(number)));
  }
  return most;
}

}  // namespace palpate
