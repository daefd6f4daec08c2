#include "common/window/immersive/hand_in_space.h"

namespace palpate {

std::optional<std::string> HandInSpace::follow(MenuControl& menu, ProbeSession& touch, SceneView& view,
                                               const Camera& seeing, const PictureArea& area, double time) {
  const bool menu_works = menu_.follow(menu, touch, seeing, area, time);
  if (!touch.available() || !touch.has_data() || touch.replaying()) return std::nullopt;
  const bool touches = touch.planes() && touch.planes()->state != WidgetState::kFree;
  // On a haptic grid the button takes hold of a region's face, or of the view.
  const bool on_grid = touch.takes_hold() && !touch.planes();
  const bool busy = menu_works || on_grid || touch.dial() || (touches && !pick_.holding());
  auto words = pick_.follow(busy ? std::nullopt : picking_hand(touch, seeing), view, touch);
  touch.engage(menu_works || pick_.holding());
  return words;
}

}  // namespace palpate
