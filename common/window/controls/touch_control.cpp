#include "common/window/controls/touch_control.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"
#include "common/field/value_histogram.h"
#include "common/render/tensor/tensor_view.h"
#include "common/window/controls/pick_volume.h"
#include "common/window/controls/plane_control.h"

namespace palpate {
namespace {

constexpr int kLeftShift = 340, kRightShift = 344;
/// A mouse that has not moved for so long rests [s].
constexpr double kRest = 0.25;

/// A layer of a wall, or the face of its cut: solid, where the wall's own surfaces are translucent.
bool shows_values(const SurfaceView& surface) { return surface.values != nullptr; }

}  // namespace

Vec3 start_of_probe(const SceneView& view, const PictureSize& size, const PicturePoint& mouse) {
  constexpr double kReach = 0.25;  // heights of the picture
  constexpr double kOnLine = 3.0;  // [pixels] as near as that, the mouse is on a line: of those the front one
  double nearest = kReach * size.height, depth = HUGE_VAL;
  Vec3 start = under_mouse(view.camera, size, mouse, view.camera.focal_point);
  if (!view.lines) return start;
  const Vec2 at{mouse.x, mouse.y};
  for (const Line& line : *view.lines) {
    Vec3 before{0.0};
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const Vec3 shown = project(view.camera, line.points[i].position, size.width, size.height);
      if (i > 0 && shown.z > 0.0 && before.z > 0.0) {
        const Vec2 a{before}, along = Vec2{shown} - a;
        const double square = glm::dot(along, along);
        const double u = square > 0.0 ? std::clamp(glm::dot(at - a, along) / square, 0.0, 1.0) : 0.0;
        const double away = glm::distance(at, a + u * along);
        const double z = before.z + u * (shown.z - before.z);
        const bool on_both = away <= kOnLine && nearest <= kOnLine;
        if (on_both ? z < depth : away < nearest) {
          nearest = away;
          depth = z;
          start = glm::mix(line.points[i - 1].position, line.points[i].position, u);
        }
      }
      before = shown;
    }
  }
  return start;
}

void TouchControl::grab(const PictureArea& area, const SceneView& view, double time) {
  grab_at(start_of_hand(area, view), time);
}

void TouchControl::grab_at(const Vec3& place, double time) {
  grabbed_ = true;
  waiting_ = false;
  lock(std::nullopt);
  session_.grab(time, place);
  moved_ = time;
}

std::optional<Vec3> TouchControl::next_mark(const PictureArea& area, const SceneView& view) {
  if (!marking_ || !view.volume || !session_.data().scalar() || !area.contains(x_, y_)) return std::nullopt;
  if (marked_ != session_.data().scalar()) {
    marked_ = session_.data().scalar();
    threshold_ = otsu_threshold(*marked_);
  }
  return pick_volume(*view.volume, view.bounds, marked_, threshold_, view.camera, size_of(area),
                     {x_ - area.left, y_ - area.top});
}

/// A click marks the place of the volume that is seen there.
bool TouchControl::mark_place(const PictureArea& area, const SceneView& view) {
  const auto place = next_mark(area, view);
  if (place) session_.notes().add(*place);
  return place.has_value();
}

/// A press with the probe in the hand, wherever that is; else on a cutting plane, where its sphere and ring
/// are in the picture.
bool TouchControl::take_hold(const PictureArea& area, const SceneView& view, double time) {
  if (!session_.hand().takes_hold() || !session_.hand().by_mouse()) return false;
  if (!grabbed_) {
    if (!session_.planes()) return false;
    const auto place = hold_of_planes(session_.planes()->poses, session_.sphere_radius(), view.camera,
                                      size_of(area), {x_ - area.left, y_ - area.top});
    if (!place) return false;
    grab_at(*place, time);
    grabbed_to_hold_ = true;
  }
  session_.hand().press(true);
  holding_ = true;
  return true;
}

/// The end of a drawn tract that is seen under the mouse, however far it lies before or behind the slices: a
/// stroke from there goes on from it.
std::optional<Vec3> TouchControl::end_of_tract(const PictureSize& size, const PicturePoint& mouse,
                                               const Camera& camera) const {
  constexpr double kOnEnd = 8.0;  // [pixels]
  double nearest = kOnEnd;
  std::optional<Vec3> found;
  if (session_.choice().stroke != StrokeUse::kAppend) return found;
  for (const DrawnTract& tract : session_.trail().drawn()) {
    for (const LinePoint* end : {&tract.line.points.front(), &tract.line.points.back()}) {
      const Vec3 shown = project(camera, end->position, size.width, size.height);
      const double away = std::hypot(shown.x - mouse.x, shown.y - mouse.y);
      if (!(shown.z > 0.0 && away < nearest)) continue;
      nearest = away;
      found = end->position;
    }
  }
  return found;
}

/// At the end of a drawn tract, on the slice of tensors under the mouse, on the nearest isosurface there in
/// modes that feel some, else where the lines are. On a heart's wall what lies before the layer that is seen is passed by:
/// it is not shown, or was cut away; behind the face of a cut it is the first layer that is felt.
Vec3 TouchControl::start_of_hand(const PictureArea& area, const SceneView& view) const {
  const PicturePoint mouse{x_ - area.left, y_ - area.top};
  if (const auto end = end_of_tract(size_of(area), mouse, view.camera)) return *end;
  if (view.tensors) {
    const PictureSize size = size_of(area);
    if (const auto pick = pick_slice(*view.tensors, view.camera, size.width, size.height, mouse.x, mouse.y))
      return pick->position;
  }
  if (const HapticLevels levels = session_.data().levels(); levels.field) {
    const Vec3 middle = under_mouse(view.camera, size_of(area), mouse, view.camera.focal_point);
    const Vec3 reach = 2.0 * (view.bounds.diagonal() + distance(view.camera)) * view.camera.axes[2];
    Vec3 viewer = view.camera.projection == Projection::kOrthographic ? middle + reach : eye(view.camera);
    const Vec3 away =
        view.camera.projection == Projection::kOrthographic
            ? middle - reach
            : viewer + (1.0 + view.bounds.diagonal() / distance(view.camera)) * 2.0 * (middle - viewer);
    if (session_.data().has_wall() && std::ranges::any_of(view.surfaces, shows_values)) {
      const ViewRay ray = view_ray(view.camera, size_of(area), mouse);
      const auto seen = pick_surface(ray, view.surfaces, shows_values);
      if (!seen) return start_of_probe(view, size_of(area), mouse);
      constexpr double kBefore = 1e-4;  // diagonals: on the layer to rounding is on either side of it
      viewer = *seen - kBefore * view.bounds.diagonal() * ray.along;
    }
    if (const auto place = first_surface_between(levels, viewer, away)) return *place;
  }
  return start_of_probe(view, size_of(area), mouse);
}

void TouchControl::let_go() noexcept {
  grabbed_ = by_shift_ = by_button_ = waiting_ = holding_ = grabbed_to_hold_ = false;
  lock(std::nullopt);
  session_.hand().let_go();
}

void TouchControl::lock(std::optional<int> axis) noexcept { session_.hand().lead(AxisLock{axis}, {}, {}); }

bool TouchControl::handle(const InputEvent& event, const PictureArea& area, const SceneView& view,
                          double time, bool over_panel) {
  const bool shift = event.key == kLeftShift || event.key == kRightShift;
  switch (event.kind) {
    case InputKind::kMove: {
      const double dx = event.x - x_, dy = event.y - y_;
      x_ = event.x;
      y_ = event.y;
      if (!grabbed_ || (buttons_ > 0 && !by_button_ && !holding_)) return false;
      dragged_ = dragged_ || std::hypot(x_ - pressed_x_, y_ - pressed_y_) > kDragDistance;
      // Over a panel the mouse is on its way to something else: the probe waits where it is.
      if (over_panel || !area.contains(x_, y_)) return true;
      // A mouse that rested means the line that it rested on: on to the panel it may be led over others.
      if (time - moved_ > kRest) session_.trail().note_line();
      moved_ = time;
      session_.hand().lead(MouseDrag{dx, dy}, view.camera, size_of(area));
      return true;
    }
    case InputKind::kWheel:
      if (!grabbed_ || over_panel || !area.contains(x_, y_)) return false;
      session_.hand().lead(WheelTurn{event.y}, view.camera, size_of(area));
      return true;
    case InputKind::kPress:
      ++buttons_;
      if (event.button == MouseButton::kLeft && !waiting_ && !over_panel && area.contains(x_, y_) &&
          (mark_place(area, view) || take_hold(area, view, time)))
        return true;
      if (!waiting_ || event.button != MouseButton::kLeft || over_panel || !area.contains(x_, y_))
        return false;
      grab(area, view, time);
      by_button_ = true;
      dragged_ = false;
      pressed_x_ = x_;
      pressed_y_ = y_;
      return true;
    case InputKind::kRelease: {
      buttons_ = std::max(0, buttons_ - 1);
      if (holding_ && event.button == MouseButton::kLeft) {
        holding_ = false;
        session_.hand().press(false);
        if (grabbed_to_hold_) let_go();
        return true;
      }
      if (!by_button_ || event.button != MouseButton::kLeft) return false;
      // A click leaves the probe in the hand; a drag was a stroke, and the next one may begin.
      by_button_ = false;
      if (dragged_) {
        let_go();
        waiting_ = true;
      }
      return true;
    }
    case InputKind::kKeyDown:
      // Both together begin a command.
      if (by_shift_ && is_control_key(event.key)) let_go();
      if (!shift || (event.modifiers & kModifierControl) != 0 || grabbed_ || !session_.available() ||
          !area.contains(x_, y_))
        return false;
      grab(area, view, time);
      by_shift_ = true;
      return true;
    case InputKind::kKeyUp:
      if (!shift || !by_shift_) return false;
      let_go();
      return true;
    default:
      return false;
  }
}

std::string TouchControl::choose_mode(std::size_t mode) {
  if (mode >= session_.modes().size()) return "there is no mode " + std::to_string(mode + 1);
  TouchChoice choice = session_.choice();
  choice.mode = mode;
  session_.choose(choice);
  return "mode " + session_.modes()[mode].name + ": " + session_.modes()[mode].summary;
}

std::optional<std::string> TouchControl::run(Command command, const PictureArea& area, const SceneView& view,
                                             double time) {
  if (command == Command::kForceOff) {
    session_.servo().force_off();
    return "force off; switch it on again in the panel";
  }
  if (!session_.available()) return "there is nothing to touch here";
  const auto lock_or_free = [this](int axis) -> std::string {
    if (!grabbed_) return "grab the probe first (G)";
    lock(locked_axis() == axis ? std::nullopt : std::optional(axis));
    if (!locked_axis()) return "the probe moves freely";
    return std::string("the probe moves along ") + "xyz"[axis] + " only";
  };
  switch (command) {
    case Command::kGrab:
      if (!session_.hand().by_mouse() && !session_.servo().replaying()) {
        return "the probe is moved by what was given as the device";
      }
      if (grabbed_) {
        let_go();
        return "let go";
      }
      // From the panel's button the mouse has a way to go.
      if (!area.contains(x_, y_)) {
        waiting_ = !waiting_;
        if (!waiting_) return "let go";
        return session_.data().has_tensors() ? "drag along a tract to draw it, or click to take the probe"
               : session_.data().has_flow()
                   ? "click on a line to grab the probe there"
                   : "press on a haptic surface and drag along it, or click to take the probe";
      }
      grab(area, view, time);
      return std::string("grabbed: the mouse moves the probe, the wheel along the view; ") +
             (session_.data().has_flow()      ? "K keeps the line, G lets go"
              : session_.data().has_tensors() ? "K keeps the tract, G lets go"
              : session_.data().has_wall()    ? "K keeps the way along the wall, G lets go"
              : session_.hand().takes_hold()  ? "its button takes hold, G lets go"
                                              : "G lets go");
    case Command::kLockX:
      return lock_or_free(0);
    case Command::kLockY:
      return lock_or_free(1);
    case Command::kLockZ:
      return lock_or_free(2);
    case Command::kKeepLine: {
      // From the panel's button: the line on which the hand rested before it went there.
      const bool here = area.contains(x_, y_);
      const ProbeTrail::Keeping kept =
          here ? session_.trail().keep_line() : session_.trail().keep_noted_line();
      // What the hand draws on its way back from there would be no tract.
      if (!here && grabbed_ && session_.data().has_tensors()) let_go();
      switch (kept) {
        case ProbeTrail::Keeping::kNothing:
          if (session_.data().has_tensors()) return "no tract is drawn: press G, then drag along one";
          if (session_.data().has_wall()) return "there is no way along the wall: press G, then drag on it";
          return grabbed_ ? "no line is followed here: move the probe to where the lines are"
                          : "no line is followed: grab the probe (G) and move it on to one";
        case ProbeTrail::Keeping::kAlready:
          return "that line is kept already";
        case ProbeTrail::Keeping::kKept:
          break;
      }
      return (session_.data().has_tensors() ? "kept tract " : "kept line ") +
             std::to_string(session_.trail().drawn_lines().entries().back().number) +
             "; Ctrl+E saves all that are kept";
    }
    case Command::kLocalLines: {
      if (!session_.data().has_flow()) return "lines about the probe are those of a flow: there is none here";
      TouchChoice choice = session_.choice();
      choice.local = choice.local == SeedShape::kNone   ? SeedShape::kRake
                     : choice.local == SeedShape::kRake ? SeedShape::kPlane
                                                        : SeedShape::kNone;
      session_.choose(choice);
      return std::string("lines about the probe: ") + (choice.local == SeedShape::kNone ? "none"
                                                       : choice.local == SeedShape::kRake
                                                           ? "a rake"
                                                           : "a plane of seeds");
    }
    default: {
      const int mode = static_cast<int>(command) - static_cast<int>(Command::kMode1);
      if (mode < 0 || mode >= kModeKeys) return std::nullopt;
      return choose_mode(as_size(mode));
    }
  }
}

}  // namespace palpate
