/// Films: many pictures of a scene, as numbered files or as one file that the program ffmpeg makes of them.
#pragma once

#include <cstddef>

#include "common/cli/picture.h"
#include "common/cli/summaries.h"

namespace palpate {

/// Whether the options ask for a film in place of a picture.
[[nodiscard]] bool asks_for_film(const Document& options) noexcept;

/// Refuses what can be refused before any work is done: outputs that are there, a film of several screens or panes, and
/// where ffmpeg is missing.
/// @throws Error (usage), (work failed).
void check_film(const Document& options, std::size_t pictures, int panes);

/// Draws the frames of `drawn`, the camera turning about the data's upright axis, the hand going along its path; writes
/// them, and says what they are in `summary`.
/// @throws Error (work failed), Cancelled.
void draw_film(const DrawnScene& drawn, const Document& options, const VerbContext& context, int width,
               int height, RenderSummary& summary);

}  // namespace palpate
