#include "common/window/controls/lens_control.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/hand/technique/probe_mouse.h"
#include "common/window/keys.h"

namespace palpate {
namespace {

constexpr double kGrowthPerNotch = 0.12;  // logarithm of the size
// Reach of a lens from its middle in diagonals of the scene: beyond them there is nothing to see.
constexpr double kSmallest = 1e-3, kLargest = 2.0;

/// How far the lens reaches from its middle, across the view.
double reach_of(const Lens& lens, const Camera& camera) {
  const LineInterval inside =
      clip_line(lens.shape, center_of(lens.shape, camera.focal_point), camera.axes[0]);
  return inside.last;
}

void grow(Lens& lens, double notches, const Camera& camera, const Box& bounds) {
  if (lens.screen) {
    double& radius = lens.screen->radius;
    radius = std::clamp(radius * std::exp(kGrowthPerNotch * notches), kSmallestCircle, kLargestCircle);
    return;
  }
  const double reach = reach_of(lens, camera), diagonal = bounds.diagonal();
  if (!(reach > 0.0) || !std::isfinite(reach) || !(diagonal > 0.0)) return;  // a half-space has no size
  const double wanted =
      std::clamp(reach * std::exp(kGrowthPerNotch * notches), kSmallest * diagonal, kLargest * diagonal);
  lens.shape = scaled(lens.shape, wanted / reach);
}

}  // namespace

Lens new_lens(const Lens& model, const Vec3& center, const Box& bounds) {
  constexpr double kPartOfSide = 1.0 / 6.0;
  const Vec3 size = bounds.size();
  Lens lens = model;
  lens.shape = make_sphere(center, kPartOfSide * std::max({size.x, size.y, size.z}));
  return lens;
}

Lens new_screen_lens(const Lens& model) {
  Lens lens = model;
  lens.shape = {};
  lens.screen = ScreenCircle{};
  return lens;
}

std::vector<Vec3> outline_of(const Lens& lens, const Camera& camera) {
  if (lens.screen || !lens.shape.quadric || !lens.shape.half_spaces.empty()) return {};
  constexpr int kSides = 64;
  const Vec3 center = center_of(lens.shape, camera.focal_point);
  const double radius = reach_of(lens, camera);
  std::vector<Vec3> circle;
  for (int i = 0; i <= kSides; ++i) {
    const double angle = 2.0 * std::numbers::pi * (i % kSides) / kSides;
    circle.push_back(center + radius * (std::cos(angle) * camera.axes[0] + std::sin(angle) * camera.axes[1]));
  }
  return circle;
}

void LensControl::follow_mouse(const PictureArea& area, const Camera& camera, Lens& lens) const {
  if (lens.screen) {
    lens.screen->x = (x_ - area.left - 0.5 * area.width) / area.height;
    lens.screen->y = (area.top + 0.5 * area.height - y_) / area.height;
    return;
  }
  const Vec3 center = center_of(lens.shape, camera.focal_point);
  const Vec3 wanted = under_mouse(camera, size_of(area), {x_ - area.left, y_ - area.top}, center);
  // A half-space goes along its normal alone: its border passes through the point under the mouse.
  lens.shape = moved(lens.shape, wanted - center_of(lens.shape, wanted));
}

bool LensControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
                         const Box& bounds, VolumeView& view) {
  if (followed_ && *followed_ >= view.lenses.size()) followed_.reset();
  switch (event.kind) {
    case InputKind::kMove:
      x_ = event.x;
      y_ = event.y;
      if (!followed_ || !area.contains(x_, y_)) return false;
      follow_mouse(area, camera, view.lenses[*followed_]);
      return false;  // a camera that is being dragged goes on
    case InputKind::kWheel: {
      if (!followed_ || event.y == 0.0 || !area.contains(x_, y_)) return false;
      Lens& lens = view.lenses[*followed_];
      if (control_ && !lens.screen) {
        const Vec3 center = center_of(lens.shape, camera.focal_point);
        const Vec3 wanted = pushed(camera, center, event.y, std::nullopt);
        lens.shape = moved(lens.shape, wanted - center_of(lens.shape, wanted));
      } else {
        grow(lens, event.y, camera, bounds);
      }
      return true;
    }
    case InputKind::kPress:
      if (!followed_ || event.button != MouseButton::kLeft || !area.contains(x_, y_)) return false;
      let_go();
      return true;
    case InputKind::kKeyDown:
    case InputKind::kKeyUp:
      if (is_control_key(event.key)) control_ = event.kind == InputKind::kKeyDown;
      return false;
    default:
      return false;
  }
}

std::string LensControl::run(Command command, const PictureArea& area, const Camera& camera,
                             const Box& bounds, const Lens& model, VolumeView& view) {
  if (followed_ && *followed_ >= view.lenses.size()) followed_.reset();
  if (command != Command::kLens) {
    if (view.lenses.empty()) return "there is no lens; L begins one";
    const std::size_t chosen = followed_.value_or(view.lenses.size() - 1);
    grow(view.lenses[chosen], command == Command::kLensLarger ? 1.0 : -1.0, camera, bounds);
    return {};
  }
  if (followed_) {
    let_go();
    return "the lens stays there";
  }
  if (view.lenses.empty()) view.lenses.push_back(new_lens(model, camera.focal_point, bounds));
  view.shown = true;
  std::string words = follow(view.lenses.size() - 1);
  if (area.contains(x_, y_)) follow_mouse(area, camera, view.lenses[*followed_]);
  return words;
}

std::string LensControl::follow(std::size_t lens) {
  followed_ = lens;
  return "the lens follows the mouse; wheel: its size, Ctrl and wheel: along the view, click: leave it there";
}

}  // namespace palpate
