#include "common/render/volume/estimate/picture_estimates.h"

#include <utility>

namespace palpate {

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
