#include "common/window/controls/region_control.h"

#include <cmath>

#include "common/base/index.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/window/controls/pick_volume.h"

namespace palpate {
namespace {

constexpr double kMouseReach = 9.0;  // of the mouse [pixels]

/// How far along the axis from `from` its line comes closest to the ray; no way where both are parallel.
double along_axis(const ViewRay& ray, const Vec3& from, int axis) {
  constexpr double kParallel = 1e-6;  // sine squared
  const Vec3 between = ray.from - from;
  const double slope = ray.along[axis], sine = 1.0 - slope * slope;
  if (sine < kParallel) return 0.0;
  return (between[axis] - slope * glm::dot(ray.along, between)) / sine;
}

}  // namespace

Box new_region(const Box& bounds) {
  const Vec3 quarter = 0.25 * bounds.size();
  return {bounds.lower + quarter, bounds.upper - quarter};
}

void RegionControl::put(const std::optional<Box>& box) {
  box_ = box;
  corner_.reset();
  held_.reset();
  hand_ = {};
}

std::array<Vec3, RegionControl::kMiddle + 1> RegionControl::handles(const Box& box) {
  std::array<Vec3, kMiddle + 1> places{};
  places.fill(box.center());
  for (int axis = 0; axis < 3; ++axis) {
    const std::size_t first = 2 * as_size(axis);
    places[first][axis] = box.lower[axis];
    places[first + 1][axis] = box.upper[axis];
  }
  return places;
}

void RegionControl::drag(const PictureArea& area, const Camera& camera, const Box& bounds) {
  const PictureSize size{static_cast<int>(area.width), static_cast<int>(area.height)};
  const Vec3 from = handles(held_->from)[held_->handle];
  const bool middle = held_->handle == kMiddle;
  const int axis = static_cast<int>(held_->handle / 2);
  const double dx = x_ - held_->x, dy = y_ - held_->y;
  Vec3 wanted = from;
  if (middle) {
    wanted = dragged(camera, size, from, dx, dy, std::nullopt);
  } else {
    const Vec3 at = project(camera, from, size.width, size.height);
    wanted[axis] += along_axis(view_ray(camera, size, {at.x + dx, at.y + dy}), from, axis);
  }
  Box box = held_->from;
  if (middle) {
    const Vec3 most = glm::max(bounds.upper - box.upper, Vec3(0.0));
    const Vec3 least = glm::min(bounds.lower - box.lower, Vec3(0.0));
    const Vec3 by = glm::clamp(wanted - from, least, most);
    box_ = Box{box.lower + by, box.upper + by};
    return;
  }
  move_face(held_->handle, wanted[axis], bounds, box);
  box_ = box;
}

bool RegionControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera,
                           const Box& bounds) {
  switch (event.kind) {
    case InputKind::kMove:
      x_ = event.x;
      y_ = event.y;
      if (held_) drag(area, camera, bounds);
      return held_.has_value();
    case InputKind::kPress: {
      if (!box_ || event.button != MouseButton::kLeft || !area.contains(x_, y_)) return false;
      double nearest = kMouseReach;
      std::optional<std::size_t> found;
      const auto places = handles(*box_);
      for (std::size_t i = 0; i < places.size(); ++i) {
        // A face that is seen head on goes nowhere on the screen.
        constexpr double kHeadOn = 0.999;
        const bool head_on = i != kMiddle && std::abs(camera.axes[2][static_cast<int>(i / 2)]) > kHeadOn;
        if (head_on && camera.projection == Projection::kOrthographic) continue;
        const Vec3 at =
            project(camera, places[i], static_cast<int>(area.width), static_cast<int>(area.height));
        const double far = std::hypot(at.x + area.left - x_, at.y + area.top - y_);
        if (!(far < nearest)) continue;
        nearest = far;
        found = i;
      }
      if (!found) return false;
      held_ = Hold{.handle = *found, .x = x_, .y = y_, .from = *box_};
      return true;
    }
    case InputKind::kRelease: {
      if (!held_ || event.button != MouseButton::kLeft) return false;
      held_.reset();
      return true;
    }
    default:
      return false;
  }
}

void RegionControl::follow_hand(bool pressed, const Vec3& hand, double reach, const Box& bounds) {
  if (box_) hand_.follow(pressed, hand, reach, bounds, *box_);
}

std::string RegionControl::put_corner(const Vec3& x) {
  if (box_) {
    Box box = *box_;
    for (int axis = 0; axis < 3; ++axis) {
      const bool upper = x[axis] > 0.5 * (box.lower[axis] + box.upper[axis]);
      (upper ? box.upper : box.lower)[axis] = x[axis];
    }
    put(box);
    return "the nearest corner of the box is here";
  }
  if (!corner_) {
    corner_ = x;
    return "a corner of the box; C again puts the one across";
  }
  put(Box{glm::min(*corner_, x), glm::max(*corner_, x)});
  return "a box between both corners";
}

std::vector<Vec3> RegionControl::dots() const {
  if (corner_) return {*corner_};
  if (!box_) return {};
  const auto places = handles(*box_);
  return {places.begin(), places.end()};
}

}  // namespace palpate
