#include "common/window/controls/pane_control.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

#include "common/base/text.h"
#include "common/window/controls/plane_image_control.h"

namespace palpate {
namespace {

std::vector<Pane> parts_of(const PictureArea& picture, const VolumeView& volume) {
  return panes_of(volume.panes, static_cast<int>(picture.width), static_cast<int>(picture.height));
}

const Pane* pane_of(const std::vector<Pane>& parts, SlicePlane plane) {
  const auto at =
      std::find_if(parts.begin(), parts.end(), [plane](const Pane& pane) { return pane.plane == plane; });
  return at == parts.end() ? nullptr : &*at;
}

Camera camera_of_pane(const SceneView& scene, const VolumeView& volume, const std::vector<Pane>& parts,
                      const Pane& pane) {
  const bool radiological = scene.anatomical && volume.panes.radiological;
  const Box bounds = volume.image->bounds();
  return pane_camera(volume.panes, *pane.plane, radiological, bounds,
                     pane_view_height(volume.panes, bounds, radiological, parts, pane));
}

Vec3 within(const Box& bounds, const Vec3& x) { return glm::clamp(x, bounds.lower, bounds.upper); }

/// Six digits: all of those of integers that scanners write.
std::string value_text(double value) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%.6g", value);
  return text.data();
}

/// As drag_window(), of what slices show.
void drag_slice_window(VolumeView& volume, double to_right, double to_top) {
  const SliceImage shown = shown_in_slices(volume);
  if (shown.name.empty()) {
    drag_window(volume, to_right, to_top);
    return;
  }
  constexpr double kNarrowest = 1e-4;  // of the range of the values
  const double range = shown.image->highest - shown.image->lowest;
  const ValueWindow window{.width = std::max(shown.window.width + range * to_right, kNarrowest * range),
                           .level = shown.window.level + range * to_top};
  if (window.width > 0.0) volume.panes.window = window;
}

bool is_shift_key(int key) {
  constexpr int kLeft = 340, kRight = 344;  // GLFW's numbers
  return key == kLeft || key == kRight;
}

}  // namespace

const Pane* PaneControl::pane_under_mouse(const PictureArea& picture, const std::vector<Pane>& parts) const {
  for (const Pane& pane : parts) {
    if (pane.plane && pane.contains(x_ - picture.left, y_ - picture.top)) return &pane;
  }
  return nullptr;
}

std::string PaneControl::words_under_mouse(const PictureArea& picture, const std::vector<Pane>& parts,
                                           const SceneView& scene) const {
  const Pane* const pane = pane_under_mouse(picture, parts);
  if (pane == nullptr) return {};
  const SliceImage shown = shown_in_slices(*scene.volume);
  const VolumeImage& image = *shown.image;
  const Vec3 x = place_under(camera_of_pane(scene, *scene.volume, parts, *pane), *pane, x_ - picture.left,
                             y_ - picture.top);
  const Vec3 g = image.grid_point(x);
  const auto place = [](const Vec3& v) {
    return short_number(v.x) + ", " + short_number(v.y) + ", " + short_number(v.z);
  };
  const bool inside =
      glm::all(glm::greaterThanEqual(g, image.lower())) && glm::all(glm::lessThanEqual(g, image.upper()));
  const std::string length = length_unit(scene);
  std::string words = place(x) + (length.empty() ? "" : " " + length);
  if (!inside) return words + ": outside";
  words += ", voxel " + place(glm::round(g)) + ": " + (shown.colored ? "FA " : "");
  const auto said = [&x](const VolumeImage& of) {
    const double value = of.labels ? of.nearest_value(x) : of.value_at(x);
    if (!std::isfinite(value)) return std::string("no value");
    if (!of.labels || value == 0.0) return value_text(value);
    return value_text(value) + " (" + of.labels->at(value).name + ")";
  };
  words += said(image);
  if (scene.volume->panes.blend > 0.0 && !scene.volume->fields.empty())
    words += "; " + scene.volume->fields.front().name + ": " + said(*scene.volume->fields.front().image);
  return words;
}

void PaneControl::follow(const InputEvent& event, const PictureArea& picture, const VolumeView* volume) {
  before_x_ = x_;
  before_y_ = y_;
  switch (event.kind) {
    case InputKind::kKeyDown:
    case InputKind::kKeyUp:
      if (is_control_key(event.key)) control_ = event.kind == InputKind::kKeyDown;
      if (is_shift_key(event.key)) shift_ = event.kind == InputKind::kKeyDown;
      return;
    case InputKind::kMove:
      x_ = event.x;
      y_ = event.y;
      return;
    case InputKind::kPress:
      if (!held_ || *held_ == event.button) {
        const std::vector<Pane> parts = volume != nullptr ? parts_of(picture, *volume) : std::vector<Pane>();
        const Pane* const pane = pane_under_mouse(picture, parts);
        held_ = event.button;
        pressed_in_ = pane != nullptr ? pane->plane : std::nullopt;
      }
      return;
    case InputKind::kRelease:
      if (held_ == event.button) held_.reset();
      if (drag_ && drag_->button == event.button) drag_.reset();
      return;
    default:
      return;
  }
}

std::optional<SlicePlane> PaneControl::plane_in_hand(const std::vector<Pane>& parts,
                                                     const PictureArea& picture) const {
  if (held_) return pressed_in_;
  const Pane* const pane = pane_under_mouse(picture, parts);
  return pane != nullptr ? pane->plane : std::nullopt;
}

std::optional<Sight> PaneControl::sight(const PictureArea& picture, const SceneView& scene) const {
  const std::vector<Pane> parts = parts_of(picture, *scene.volume);
  const auto plane = plane_in_hand(parts, picture);
  const Pane* const pane = plane ? pane_of(parts, *plane) : nullptr;
  if (pane == nullptr) return std::nullopt;
  return Sight{{picture.left + pane->left, picture.top + pane->top, static_cast<double>(pane->width),
                static_cast<double>(pane->height)},
               camera_of_pane(scene, *scene.volume, parts, *pane)};
}

std::optional<Vec3> PaneControl::place(const PictureArea& picture, const SceneView& scene) const {
  const std::vector<Pane> parts = parts_of(picture, *scene.volume);
  const Pane* const pane = pane_under_mouse(picture, parts);
  if (pane == nullptr) return std::nullopt;
  const Vec3 x = place_under(camera_of_pane(scene, *scene.volume, parts, *pane), *pane, x_ - picture.left,
                             y_ - picture.top);
  const Box bounds = scene.volume->image->bounds();
  return glm::clamp(x, bounds.lower, bounds.upper) == x ? std::optional(x) : std::nullopt;
}

bool PaneControl::handle(const InputEvent& event, const PictureArea& picture, const SceneView& scene,
                         VolumeView& volume) {
  SlicePanes& panes = volume.panes;
  if (event.kind == InputKind::kMove) {
    if (drag_) drag(event, picture, scene, volume);
    return drag_.has_value();
  }
  const std::vector<Pane> parts = parts_of(picture, volume);
  const Pane* const pane = pane_under_mouse(picture, parts);
  if (pane == nullptr) return false;
  if (event.kind == InputKind::kPress) {
    drag_ = Drag{.does = event.button == MouseButton::kLeft    ? (shift_ ? Does::kTurn : Does::kCross)
                         : event.button == MouseButton::kRight ? Does::kWindow
                                                               : Does::kMove,
                 .button = event.button,
                 .plane = *pane->plane};
    if (drag_->does == Does::kCross) {
      InputEvent here = event;
      here.x = x_;
      here.y = y_;
      drag(here, picture, scene, volume);
    }
    return true;
  }
  if (event.kind != InputKind::kWheel || event.y == 0.0) return false;
  const Camera camera = camera_of_pane(scene, volume, parts, *pane);
  if (control_) {
    constexpr double kNotch = 1.15, kLeast = 0.1, kMost = 1000.0;
    const double before = panes.zoom;
    panes.zoom = std::clamp(panes.zoom * std::pow(kNotch, event.y), kLeast, kMost);
    // What is under the mouse stays there.
    const Vec3 under = place_under(camera, *pane, x_ - picture.left, y_ - picture.top);
    const Vec3 off = under - camera.focal_point;
    panes.center += (1.0 - before / panes.zoom) * off;
  } else {
    // Away from the viewer for positive notches; touch pads turn by parts of one.
    turned_ += event.y;
    const double voxels = std::trunc(turned_);
    turned_ -= voxels;
    const Vec3& back = camera.axes[2];
    panes.cross = within(volume.image->bounds(),
                         panes.cross + volume.image->way_along(panes.cross, back, -voxels) * back);
  }
  return true;
}

void PaneControl::drag(const InputEvent& to, const PictureArea& picture, const SceneView& scene,
                       VolumeView& volume) const {
  SlicePanes& panes = volume.panes;
  const std::vector<Pane> parts = parts_of(picture, volume);
  const Pane* const pane = pane_of(parts, drag_->plane);
  if (pane == nullptr) return;
  const Camera camera = camera_of_pane(scene, volume, parts, *pane);
  const auto place = [&](double x, double y) {
    return place_under(camera, *pane, x - picture.left, y - picture.top);
  };
  const Vec3 here = place(to.x, to.y), before = place(before_x_, before_y_);
  switch (drag_->does) {
    case Does::kCross:
      panes.cross = within(volume.image->bounds(), here);
      return;
    case Does::kMove:
      panes.center -= here - before;
      return;
    case Does::kTurn: {
      const Vec3 a = before - panes.cross, b = here - panes.cross;
      const Vec3& back = camera.axes[2];
      const double angle = std::atan2(glm::dot(glm::cross(a, b), back), glm::dot(a, b));
      if (std::isfinite(angle)) panes.turn = glm::normalize(glm::angleAxis(angle, back) * panes.turn);
      return;
    }
    case Does::kWindow:
      drag_slice_window(volume, (to.x - before_x_) / picture.width, (before_y_ - to.y) / picture.height);
      return;
  }
}

bool PaneControl::run(Command command, VolumeView& volume) {
  if (volume.panes.layout == 1) return false;
  const auto step = [&](SlicePlane plane, double sign) {
    const Vec3 normal = normal_of(volume.panes, plane);
    volume.panes.cross =
        within(volume.image->bounds(),
               volume.panes.cross + volume.image->way_along(volume.panes.cross, normal, sign) * normal);
    return true;
  };
  switch (command) {
    case Command::kSliceRight:
      return step(SlicePlane::kSagittal, 1.0);
    case Command::kSliceLeft:
      return step(SlicePlane::kSagittal, -1.0);
    case Command::kSliceFront:
      return step(SlicePlane::kCoronal, 1.0);
    case Command::kSliceBack:
      return step(SlicePlane::kCoronal, -1.0);
    case Command::kSliceUp:
      return step(SlicePlane::kAxial, 1.0);
    case Command::kSliceDown:
      return step(SlicePlane::kAxial, -1.0);
    default:
      return false;
  }
}

}  // namespace palpate
