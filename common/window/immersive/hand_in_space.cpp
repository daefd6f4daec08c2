#include "common/window/immersive/hand_in_space.h"

namespace palpate {

std::optional<std::string> HandInSpace::follow(MenuControl& menu, ProbeSession& touch, SceneView& view,
                                               const Camera& seeing, const PictureArea& area, double time) {
  const bool menu_works = menu_.follow(menu, touch, seeing, area, time);
  if (!touch.available() || touch.data().empty() || touch.servo().replaying()) return std::nullopt;
  const bool touches = touch.planes() && touch.planes()->state != WidgetState::kFree;
  // On a haptic grid the button takes hold of a region's face, or of the view.
  const bool on_grid = touch.hand().takes_hold() && !touch.planes();
  const bool busy = menu_works || on_grid || touch.hand().dial() || (touches && !pick_.holding());
  auto words = pick_.follow(busy ? std::nullopt : picking_hand(touch, seeing), view, touch);
  touch.hand().engage(menu_works || pick_.holding());
  return words;
}

}  // namespace palpate
