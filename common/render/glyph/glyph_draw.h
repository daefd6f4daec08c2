/// What glyphs hide and what hides them: the draws that spheres, arrows and tensors have in common.
#pragma once

#include <cstdint>
#include <functional>

namespace palpate {

/// What is drawn of glyphs.
enum class GlyphPart : std::uint8_t {
  kAll,       ///< draw_hidden_then_seen()
  kSeenAgain  ///< what is in sight, once more over what has been drawn before it since: draw_seen_again()
};

/// Calls `draw(opacity)` with the state for what nothing hides, by its opacity and without depth.
/// @pre what is drawn is in the depths already.
void draw_seen_again(float opacity, const std::function<void(float opacity)>& draw);

/// Calls `draw(opacity)` with the state for the part that something nearer hides, where `hidden_opacity`
/// is above zero, and then with that for the part in sight, opaque and with depth.
void draw_hidden_then_seen(float hidden_opacity, const std::function<void(float opacity)>& draw);

/// Either of both.
void draw_glyph_part(GlyphPart part, float opacity, const std::function<void(float opacity)>& draw);

}  // namespace palpate
