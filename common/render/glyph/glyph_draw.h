/// What glyphs hide and what hides them: the two draws that spheres and arrows have in common.
#pragma once

#include <functional>

namespace palpate {

/// Calls `draw(opacity)` with the state for the part that something nearer hides, where `hidden_opacity`
/// is above zero, and then with that for the part in sight, opaque and with depth.
void draw_hidden_then_seen(float hidden_opacity, const std::function<void(float opacity)>& draw);

}  // namespace palpate
