#include "common/window/controls/pointer.h"

#include <algorithm>

namespace palpate {
namespace {

/// How far the halves lie apart; none where there are no halves.
std::optional<Vec2> from_half_to_half(StereoMode mode, const EyePictureSize& half) {
  if (mode == StereoMode::kSideBySide) return Vec2{half.width, 0.0};
  if (mode == StereoMode::kTopBottom) return Vec2{0.0, half.height};
  return std::nullopt;
}

EyePictureSize half_of(StereoMode mode, const PictureArea& picture) {
  return eye_picture_size(mode, static_cast<int>(picture.width), static_cast<int>(picture.height));
}

}  // namespace

EyeArea eye_area(const StereoView& stereo, const PictureArea& picture, double x, double y) {
  if (stereo.mode != StereoMode::kSideBySide && stereo.mode != StereoMode::kTopBottom)
    return {picture, std::nullopt};
  const EyePictureSize half = half_of(stereo.mode, picture);
  const Vec2 apart = *from_half_to_half(stereo.mode, half);
  const bool second = stereo.mode == StereoMode::kSideBySide ? x - picture.left >= half.width
                                                             : y - picture.top >= half.height;
  EyeArea found{picture, second != stereo.swapped ? 1 : 0};
  found.area.width = half.width;
  found.area.height = half.height;
  if (second) {
    found.area.left += apart.x;
    found.area.top += apart.y;
  }
  return found;
}

std::optional<Vec2> in_other_half(const StereoView& stereo, const PictureArea& picture, double x, double y) {
  if (!picture.contains(x, y)) return std::nullopt;
  const auto apart = from_half_to_half(stereo.mode, half_of(stereo.mode, picture));
  if (!apart) return std::nullopt;
  const PictureArea here = eye_area(stereo, picture, x, y).area;
  const bool second = here.left > picture.left || here.top > picture.top;
  return Vec2{x, y} + (second ? -1.0 : 1.0) * *apart;
}

void Pointer::over(const StereoView& stereo, const PictureArea& picture) {
  stereo_ = stereo;
  picture_ = picture;
  if (buttons_ == 0) at_ = eye_area(stereo_, picture_, x_, y_);
}

void Pointer::follow(const InputEvent& event) {
  if (event.kind == InputKind::kPress) ++buttons_;
  if (event.kind == InputKind::kRelease) buttons_ = std::max(0, buttons_ - 1);
  if (event.kind != InputKind::kMove) return;
  x_ = event.x;
  y_ = event.y;
  if (buttons_ == 0) at_ = eye_area(stereo_, picture_, x_, y_);
}

std::optional<Vec2> Pointer::twin() const { return in_other_half(stereo_, picture_, x_, y_); }

Aim::Aim(Camera& camera, const Camera& seeing)
    : camera_(camera), field_of_view_(camera.field_of_view), eye_offset_(camera.eye_offset) {
  camera.field_of_view = seeing.field_of_view;
  camera.eye_offset = seeing.eye_offset;
}

Aim::~Aim() {
  camera_.field_of_view = field_of_view_;
  camera_.eye_offset = eye_offset_;
}

Camera seeing_camera(const SceneView& view, const std::optional<std::size_t>& eye) {
  if (!eye || !has_two_eyes(view)) return view.camera;
  return stereo_eyes(view.camera, view.stereo, view.bounds).cameras[*eye];
}

}  // namespace palpate
