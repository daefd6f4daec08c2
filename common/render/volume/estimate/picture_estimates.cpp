#include "common/render/volume/estimate/picture_estimates.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/base/clock.h"
#include "common/base/index.h"

namespace palpate {
namespace {

constexpr int kMostRounds = 8;
constexpr double kKnown = 0.1;  // spread that is good enough, of the error

}  // namespace

ErrorEstimate::ErrorEstimate(std::shared_ptr<const StillPicture> picture) : picture_(std::move(picture)) {
  PALPATE_CHECK(picture_->behind.width == picture_->shown.width &&
                picture_->behind.height == picture_->shown.height);
}

void ErrorEstimate::add_pixels(const std::vector<std::uint8_t>& converged, const PixelLattice& lattice,
                               const LatticeBox& box) {
  const std::vector<std::uint8_t> shown = pixels_of(picture_->shown, lattice);
  const auto pixel = [](const std::vector<std::uint8_t>& bytes, std::size_t i) {
    return std::array<int, 4>{bytes[i], bytes[i + 1], bytes[i + 2], bytes[i + 3]};
  };
  for (int row = box.bottom; row < box.top; ++row) {
    for (int column = box.left; column < box.right; ++column) {
      const std::size_t i = 4 * (as_size(row) * as_size(lattice.columns) + as_size(column));
      sum_.add(pixel(shown, i), pixel(converged, i));
    }
  }
}

// One box of voxels that were asked for; where not even one pixel's fit, of those that are drawn.
void ErrorEstimate::add_box(VolumePass& pass, FinestRays& finest, const SceneFrame& frame,
                            const PixelLattice& lattice) {
  const LatticeBox box = boxes_.back();
  boxes_.pop_back();
  if (const auto converged = finest.cast(pass, *picture_, frame, lattice, box))
    return add_pixels(*converged, lattice, box);
  LatticeBox first = box, second = box;
  if (box.right - box.left > 1) {
    first.right = second.left = box.left + (box.right - box.left) / 2;
  } else if (box.top - box.bottom > 1) {
    first.top = second.bottom = box.bottom + (box.top - box.bottom) / 2;
  } else {
    boxes_.clear();  // no other pixel's will, or the error would be of some part of the picture
    sum_ = {};
    sum_.add_coarser();
    return add_pixels(cast_sparse_rays(pass, converged_view(pass.drawn_view()), *picture_, lattice), lattice,
                      {.right = lattice.columns, .top = lattice.rows});
  }
  boxes_.push_back(second);
  boxes_.push_back(first);
}

bool ErrorEstimate::add(VolumePass& pass, FinestRays& finest, const SceneFrame& frame) {
  glFinish();
  const Stopwatch clock;
  const Image& image = picture_->shown;
  const PixelLattice lattice = PixelLattice::of(image.width, image.height, rounds_);
  if (pass.has_asked_voxels() || !sum_.error().of_asked_voxels) {
    add_pixels(cast_sparse_rays(pass, converged_view(pass.drawn_view()), *picture_, lattice), lattice,
               {.right = lattice.columns, .top = lattice.rows});
  } else {
    if (boxes_.empty()) boxes_ = FinestRays::boxes(pass.asked_view(), lattice);
    add_box(pass, finest, frame, lattice);
  }
  milliseconds_ += 1e3 * clock.seconds();
  if (!boxes_.empty()) return true;
  ++rounds_;

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

void PictureEstimates::forget() {
  picture_.reset();
  error_.reset();
  savings_.reset();
  savings_known_ = false;
}

bool PictureEstimates::add_to_error(VolumePass& pass) {
  if (!finest_) finest_ = std::make_unique<FinestRays>();
  return error_->add(pass, *finest_, frame_);
}

std::optional<ImageError> PictureEstimates::error() const {
  if (!error_ || error_->error().pixels == 0) return std::nullopt;
  return error_->error();
}

bool PictureEstimates::add_saving(VolumePass& pass, const OpaquePart& opaque_part) {
  if (savings_known_) return false;
  if (!savings_) savings_.emplace(picture_, frame_, error_->error().rms);
  savings_known_ = !savings_->add(pass, opaque_part);
  return !savings_known_;
}

std::optional<QualityErrors> PictureEstimates::quality_errors() const {
  if (!savings_known_) return std::nullopt;
  return savings_->errors();
}

}  // namespace palpate
