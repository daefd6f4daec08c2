#include "common/window/controls/brush_control.h"

namespace palpate {

bool BrushControl::handle(const InputEvent& event, const std::optional<Vec3>& place) {
  constexpr double kApart = 0.5;  // radii between balls: what lies between two is painted all but a little
  switch (event.kind) {
    case InputKind::kPress:
      if (!on || event.button != MouseButton::kLeft || !place) return false;
      painting_ = true;
      stroke_ = {*place};
      return true;
    case InputKind::kMove:
      if (!painting_) return false;
      if (place && glm::distance(*place, stroke_.back()) >= kApart * radius) stroke_.push_back(*place);
      return true;
    case InputKind::kRelease:
      if (!painting_ || event.button != MouseButton::kLeft) return false;
      painting_ = false;
      return true;
    default:
      return false;
  }
}

}  // namespace palpate
