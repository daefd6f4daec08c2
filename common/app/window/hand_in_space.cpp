#include "common/app/window/hand_in_space.h"

namespace palpate {

std::optional<std::string> HandInSpace::follow(MenuControl& menu, ProbeSession& touch, SceneView& view,
                                               const PictureArea& area, const Vec3& eye, double time) {
  const bool menu_works = menu_.follow(menu, touch, view.camera, area, time);
  if (!touch.available() || !touch.has_data() || touch.replaying()) return std::nullopt;
  const bool touches = touch.planes() && touch.planes()->state != WidgetState::kFree;
  const bool busy = menu_works || touch.dial() || (touches && !pick_.holding());
  const auto words = pick_.follow(busy ? std::nullopt : picking_hand(touch, eye), view, touch);
  touch.engage(menu_works || pick_.holding());
  return words;
}

}  // namespace palpate
