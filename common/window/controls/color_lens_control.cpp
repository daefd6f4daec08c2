#include "common/window/controls/color_lens_control.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "common/compose/text/lens_text.h"
#include "common/window/controls/pick_volume.h"

namespace palpate {
namespace {

/// By a step of the wheel; `notches` > 0: larger.
void resize(double notches, const Box& bounds, ColorLens& lens) {
  constexpr double kGrowth = 0.12, kLeastReach = 1e-3, kMostReach = 2.0;  // logarithm; diagonals
  lens.radius = std::clamp(lens.radius * std::exp(kGrowth * notches), kLeastReach * bounds.diagonal(),
                           kMostReach * bounds.diagonal());
}

}  // namespace

void place_lens(const SceneView& view, ColorLens& lens) {
  constexpr double kPartOfSide = 1.0 / 6.0;
  const Vec3 size = view.bounds.size(), viewer = eye(view.camera);
  lens.radius = kPartOfSide * std::max({size.x, size.y, size.z});
  lens.center = view.bounds.center();
  double nearest = HUGE_VAL;
  // A cut leaves out triangles, not the points that they had.
  for (const SurfaceView& surface : view.surfaces) {
    if (!surface.mesh || !surface.values) continue;
    for (const auto& triangle : surface.mesh->triangles) {
      for (const std::uint32_t corner : triangle) {
        const Vec3& x = surface.mesh->points[corner];
        const double away = glm::distance(x, viewer);
        if (away < nearest) lens.center = x;
        nearest = std::min(nearest, away);
      }
    }
  }
}

void add_color_lens(const SceneView& view, HeartOptions& heart) {
  ColorLens lens;
  place_lens(view, lens);
  heart.lens = sphere_text(lens.center, lens.radius);
}

std::string ColorLensControl::run(Command command, SceneView& view) {
  if (command != Command::kLens) {
    if (view.color_lens) resize(command == Command::kLensLarger ? 1.0 : -1.0, view.bounds, *view.color_lens);
    return {};
  }
  followed_ = !followed_ || !view.color_lens;
  return followed_ ? "the lens follows the mouse over the layer; wheel: its size, click: leave it there"
                   : "the lens stays there";
}

bool ColorLensControl::handle(const InputEvent& event, const PictureArea& area, SceneView& view) {
  if (event.kind == InputKind::kMove) {
    x_ = event.x;
    y_ = event.y;
  }
  if (!view.color_lens || !followed_ || !area.contains(x_, y_)) return false;
  switch (event.kind) {
    case InputKind::kMove: {
      const PictureSize size{static_cast<int>(area.width), static_cast<int>(area.height)};
      const ViewRay ray = view_ray(view.camera, size, {x_ - area.left, y_ - area.top});
      // What a cut has left of the layer is what is seen of it.
      const auto hit = pick_surface(
          ray, view.surfaces, [](const SurfaceView& surface) { return surface.lens_values != nullptr; });
      if (hit) view.color_lens->center = *hit;
      return false;  // a camera that is being dragged goes on
    }
    case InputKind::kWheel:
      resize(event.y, view.bounds, *view.color_lens);
      return true;
    case InputKind::kPress:
      if (event.button != MouseButton::kLeft) return false;
      followed_ = false;
      return true;
    default:
      return false;
  }
}

}  // namespace palpate
