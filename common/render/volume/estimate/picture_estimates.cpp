#include "common/render/volume/estimate/picture_estimates.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"

namespace palpate {
namespace {

constexpr int kMostRounds = 8;
constexpr double kKnown = 0.1;  // spread that is good enough, of the error

}  // namespace

ErrorEstimate::ErrorEstimate(std::shared_ptr<const StillPicture> picture) : picture_(std::move(picture)) {
  PALPATE_CHECK(picture_->behind.width == picture_->shown.width &&
                picture_->behind.height == picture_->shown.height);
}

bool ErrorEstimate::add(VolumePass& pass) {
  glFinish();
  const Stopwatch clock;
  const Image& image = picture_->shown;
  const PixelLattice lattice = PixelLattice::of(image.width, image.height, rounds_);
  const std::vector<std::uint8_t> converged =
      cast_sparse_rays(pass, converged_view(pass.drawn_view()), *picture_, lattice);
  const std::vector<std::uint8_t> shown = pixels_of(image, lattice);
  const auto pixel = [](const std::vector<std::uint8_t>& bytes, std::size_t i) {
    return std::array<int, 4>{bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]};
  };
  for (std::size_t i = 0; i < shown.size(); i += 4) sum_.add(pixel(shown, i), pixel(converged, i));
  ++rounds_;
  milliseconds_ += 1e3 * clock.seconds();

  const ImageError now = sum_.error();
  const bool again = PixelLattice::of(image.width, image.height, rounds_).step > lattice.step;
  return lattice.step > 1 && again && rounds_ < kMostRounds && now.spread > kKnown * now.rms;
}

ImageError ErrorEstimate::error() const noexcept {
  ImageError error = sum_.error();
  error.milliseconds = milliseconds_;
  return error;
}

void PictureEstimates::keep(StillPicture picture, const SceneFrame& frame) {
  forget();
  picture_ = std::make_shared<const StillPicture>(std::move(picture));
  frame_ = frame;
  error_.emplace(picture_);
}

void PictureEstimates::forget() { *this = {}; }

bool PictureEstimates::add_to_error(VolumePass& pass) { return error_->add(pass); }

std::optional<ImageError> PictureEstimates::error() const {
  if (!error_ || error_->error().pixels == 0) return std::nullopt;
  return error_->error();
}

bool PictureEstimates::add_saving(VolumePass& pass) {
  if (savings_known_) return false;
  if (!savings_) savings_.emplace(picture_, frame_, error_->error().rms);
  savings_known_ = !savings_->add(pass);
  return !savings_known_;
}

std::optional<QualityErrors> PictureEstimates::quality_errors() const {
  if (!savings_known_) return std::nullopt;
  return savings_->errors();
}

}  // namespace palpate
