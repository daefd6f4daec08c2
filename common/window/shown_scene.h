/// What a scene that has just been read or changed makes of the view, and what the user has made of it.
#pragma once

#include <cstdint>
#include <optional>

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"

namespace palpate {

/// Whether a scene is of an input that has just been opened, or of the same one with a changed document.
enum class ShownAs : std::uint8_t { kNew, kChanged };

/// Puts `scene` into `view`. Where the document changed, what mouse and panels have done since to volume,
/// tensors and tracts stays, which is newer than the scene; else all is as the scene has it. Background
/// and the like are left as they are, and so is the camera.
void show_scene(const SceneState& scene, ShownAs as, SceneView& view);

/// Colours of another time step mean what they mean in the picture that is shown: `style` takes over its range
/// where that is automatic. Of other lines it has none. @param before the document of what is shown.
/// @param shown its automatic range.
void keep_colors(const Document& before, const SceneState& scene, const std::optional<ValueRange>& shown,
                 LineStyle& style);

/// What mouse and panels have done to a view, without the voxels and lines that scenes give to it: light enough
/// to be kept for each edit.
struct ViewEdits {
  LineStyle style;
  std::optional<ColorLens> color_lens;
  std::optional<VolumeView> volume;
  std::optional<TensorView> tensors;
  std::optional<TractView> tracts;
};
[[nodiscard]] ViewEdits edits_of(const SceneView& view);
/// Shows `scene` with these edits, wherever it has what they are of; what they lack is not shown.
void put_edits(const ViewEdits& edits, const SceneState& scene, SceneView& view);

}  // namespace palpate
