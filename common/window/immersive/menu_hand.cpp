#include "common/window/immersive/menu_hand.h"

#include <utility>

namespace palpate {

Dial seen_at(const Dial& dial, const Camera& camera, double s, double shift) {
  const auto moved = [&](const Vec3& x) {
    if (camera.projection == Projection::kOrthographic) return x + shift * camera.axes[2];
    return eye(camera) + s * (x - eye(camera));
  };
  Dial out = dial;
  out.start = moved(dial.start);
  out.end = moved(dial.end);
  return out;
}

void MenuHand::lead_by_mouse(MenuControl& menu, ProbeSession& touch, const Camera& camera,
                             const PictureArea& area, double time) {
  const std::optional<Vec3> place = menu.mouse_place(camera, area);
  if (!place) return;
  if (!std::exchange(led_, true)) {
    arrived_ = false;
    back_ = touch.hand().grabbed() ? std::optional(touch.hand().intent().probe) : std::nullopt;
    touch.hold_dial(menu.held_way());
    touch.grab(time, *place);
    return;
  }
  touch.hand().move(*place);
  if (touch.hand().has_arm() && touch.readout().held) {
    // The arm takes a while to come here, and to come along where a knob turns the view.
    arrived_ = (arrived_ && touch.hand().dial() == menu.held_way()) ||
               glm::distance(touch.readout().probe, *place) < menu.entry();
    if (arrived_) menu.follow_hand(camera, touch.readout().probe);
  }
  touch.hold_dial(menu.held_way());
}

bool MenuHand::follow(MenuControl& menu, ProbeSession& touch, const Camera& camera, const PictureArea& area,
                      double time) {
  if (!touch.available()) return false;
  if (const auto& pointing = touch.hand().intent().pointing)
    return menu.shown() && menu.point(*pointing, touch.hand().intent().acts);
  if (touch.hand().by_mouse() && menu.held_by_mouse()) {
    lead_by_mouse(menu, touch, camera, area, time);
    return true;
  }
  if (std::exchange(led_, false)) {
    touch.hold_dial(std::nullopt);
    touch.hand().let_go();
    if (back_) touch.grab(time, *back_);
    back_.reset();
  }
  if (!touch.hand().by_device()) return false;
  const std::optional<Vec3> tip = touch.hand().device_tip(camera);
  const bool works =
      menu.shown() && tip && menu.point(ray_through(camera, *tip), touch.hand().device_presses());
  const std::optional<Dial> way = tip ? menu.held_way() : std::nullopt;
  if (!way) {
    depth_.reset();
    touch.hold_dial(std::nullopt);
    return works;
  }
  const auto depth = [&](const Vec3& x) { return glm::dot(eye(camera) - x, camera.axes[2]); };
  const bool parallel = camera.projection == Projection::kOrthographic;
  if (!depth_) depth_ = parallel ? depth(way->end) - depth(*tip) : depth(*tip) / depth(way->end);
  touch.hold_dial(seen_at(*way, camera, *depth_, *depth_));
  return works;
}

}  // namespace palpate
