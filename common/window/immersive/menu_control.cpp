#include "common/window/immersive/menu_control.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "common/base/index.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/math/quaternion.h"

namespace palpate {
namespace {

// Ids of sliders and knobs; those of entries are commands.
enum class MenuDial : std::uint16_t { kWidth = 1000, kOpacity, kTime, kTurn };

int id_of(MenuDial dial) { return static_cast<int>(dial); }

SpaceItem entry_for(const std::string& label, Command command) {
  return {.label = label, .id = static_cast<int>(command)};
}

SpaceItem slider_for(const std::string& label, MenuDial id, const DialRange& range, double value) {
  return {.label = label,
          .id = id_of(id),
          .kind = SpaceItem::Kind::kSlider,
          .range = range,
          .value = std::clamp(value, range.lower, range.upper)};
}

std::vector<SpaceItem> items_of(const SceneState& scene, const SceneView& view,
                                const std::vector<std::string>& modes) {
  std::vector<SpaceItem> items;
  if (!modes.empty()) {
    SpaceItem mode{.label = "Touch"};
    for (std::size_t i = 0; i < std::min<std::size_t>(modes.size(), kModeKeys); ++i)
      mode.behind.push_back(
          entry_for(modes[i], static_cast<Command>(static_cast<int>(Command::kMode1) + static_cast<int>(i))));
    if (!scene.lines->empty() || scene.tensors)
      mode.behind.push_back(entry_for("keep the line", Command::kKeepLine));
    items.push_back(std::move(mode));
  }
  items.push_back(
      {.label = "View",
       .behind = {entry_for("at all of it", Command::kResetCamera),
                  entry_for("along x", Command::kLookAlongX), entry_for("along y", Command::kLookAlongY),
                  entry_for("along z", Command::kLookAlongZ)}});
  SpaceItem show{.label = "Show",
                 .behind = {entry_for("axes", Command::kAxes), entry_for("colour bar", Command::kColorBar)}};
  if (view.volume) show.behind.push_back(entry_for("volume", Command::kVolume));
  items.push_back(std::move(show));
  items.push_back(entry_for("Undo", Command::kUndo));
  const std::size_t steps = scene.info->times.size();
  if (steps > 1) {
    items.push_back(slider_for("Time step", MenuDial::kTime, {0.0, static_cast<double>(steps - 1), 1.0},
                               static_cast<double>(time_step_of(scene.document, scene.info->times))));
  }
  if (!scene.lines->empty()) {
    items.push_back(slider_for("Width", MenuDial::kWidth, {1.0, 15.0, 1.0}, view.style.width));
    items.push_back(slider_for("Opacity", MenuDial::kOpacity, {0.1, 1.0, 0.1}, view.style.opacity));
  }
  items.push_back({.label = "Turn",
                   .id = id_of(MenuDial::kTurn),
                   .kind = SpaceItem::Kind::kKnob,
                   .range = {-180.0, 180.0, 15.0}});
  return items;
}

}  // namespace

Ray ray_through(const Camera& camera, const PictureArea& area, double x, double y) {
  const PictureSize size{static_cast<int>(area.width), static_cast<int>(area.height)};
  const Vec3 at = under_mouse(camera, size, {x, y}, camera.focal_point);
  if (camera.projection == Projection::kOrthographic) {
    const Vec3 away = -camera.axes[2];
    return {at - distance(camera) * away, away};
  }
  return {eye(camera), glm::normalize(at - eye(camera))};
}

Ray ray_through(const Camera& camera, const Vec3& place) {
  if (camera.projection == Projection::kOrthographic)
    return {place + distance(camera) * camera.axes[2], -camera.axes[2]};
  return {eye(camera), glm::normalize(place - eye(camera))};
}

void MenuControl::toggle(const SceneState& scene, const SceneView& view,
                         const std::vector<std::string>& modes) {
  events_.clear();
  turned_ = 0.0;
  button_ = by_hand_ = false;
  if (menu_) {
    menu_.reset();
  } else {
    menu_.emplace(items_of(scene, view, modes));
  }
}

void MenuControl::place(const Camera& camera, const PictureArea& area, const std::optional<double>& reach) {
  if (!menu_) return;
  // Parts of the height of the view.
  constexpr double kInwards = 0.05, kForward = 0.08, kDown = 0.1, kEntry = 0.045;
  const double h = camera.view_height, aspect = area.width / area.height;
  double left = (kInwards - 0.5 * aspect) * h, top = (0.5 - kDown) * h, forward = kForward * h;
  double entry = kEntry * h;
  if (reach) {
    // Room for two columns beside each other.
    constexpr double kPart = 0.9, kColumns = 2.1;
    left = std::max(left, -kPart * *reach);
    top = std::min(top, kPart * *reach);
    forward = std::min(forward, 0.5 * *reach);
    entry = std::min(entry, (kPart * *reach - left) / (kColumns * SpaceMenu::kColumn));
  }
  menu_->put(camera.focal_point + left * camera.axes[0] + top * camera.axes[1] + forward * camera.axes[2],
             camera.axes, entry);
}

void MenuControl::take(const SpaceEvent& event) {
  if (event.kind != SpaceEvent::Kind::kNone) events_.push_back(event);
}

bool MenuControl::handle(const InputEvent& event, const PictureArea& area, const Camera& camera) {
  if (!menu_) return false;
  const auto ray = [&] { return ray_through(camera, area, x_ - area.left, y_ - area.top); };
  switch (event.kind) {
    case InputKind::kMove:
      x_ = event.x;
      y_ = event.y;
      if (by_hand_ && held_by_mouse()) return true;
      if (menu_->held() && !button_) return false;  // by another hand
      take(menu_->point(ray(), button_));
      return button_;
    case InputKind::kPress:
      if (event.button != MouseButton::kLeft || !area.contains(x_, y_) || !menu_->meets(ray())) return false;
      button_ = true;
      take(menu_->point(ray(), true));
      return true;
    case InputKind::kRelease:
      if (event.button != MouseButton::kLeft || !std::exchange(button_, false)) return false;
      by_hand_ = false;
      take(menu_->point(ray(), false));
      return true;
    default:
      return false;
  }
}

std::optional<Dial> MenuControl::held_way() const { return menu_ ? menu_->held_way() : std::nullopt; }

std::optional<Vec3> MenuControl::mouse_place(const Camera& camera, const PictureArea& area) const {
  if (!menu_) return std::nullopt;
  const LabelView label = menu_->drawn();
  const Ray ray = ray_through(camera, area, x_ - area.left, y_ - area.top);
  const double slope = glm::dot(ray.direction, label.axes[2]);
  const double along = glm::dot(label.origin - ray.origin, label.axes[2]) / slope;
  if (!(along > 0.0) || !std::isfinite(along)) return std::nullopt;
  return ray.origin + along * ray.direction;
}

void MenuControl::follow_hand(const Camera& camera, const Vec3& place) {
  if (!held_by_mouse()) return;
  by_hand_ = true;
  take(menu_->point(ray_through(camera, place), true));
}

bool MenuControl::point(const Ray& ray, bool button) {
  if (!menu_) return false;
  const bool meets = menu_->meets(ray);
  take(menu_->point(ray, button));
  return meets;
}

std::vector<Command> MenuControl::act(const SceneState& scene, Document& document, SceneView& view) {
  std::vector<Command> commands;
  for (const SpaceEvent& event : std::exchange(events_, {})) {
    if (event.kind == SpaceEvent::Kind::kChosen) {
      commands.push_back(static_cast<Command>(event.id));
    } else if (event.id == id_of(MenuDial::kWidth)) {
      view.style.width = event.value;
    } else if (event.id == id_of(MenuDial::kOpacity)) {
      view.style.opacity = event.value;
    } else if (event.id == id_of(MenuDial::kTime)) {
      set_time_step(document, scene.info->times, floor_size(event.value));
    } else if (event.id == id_of(MenuDial::kTurn)) {
      turn(view.camera, kDegree * (event.value - std::exchange(turned_, event.value)), 0.0);
    }
  }
  return commands;
}

std::optional<LabelView> MenuControl::drawn() const {
  return menu_ ? std::optional(menu_->drawn()) : std::nullopt;
}

}  // namespace palpate
