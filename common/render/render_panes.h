/// Pictures of a volume with slices beside it, without a display.
#pragma once

#include <array>
#include <vector>

#include "common/render/render_image.h"
#include "common/render/scene_view.h"
#include "common/render/slice/slice_panes.h"

namespace palpate {

/// What a pane shows.
struct PaneImage {
  Pane pane;
  Image image;  ///< of its size
};
/// A picture put together of its panes.
[[nodiscard]] Image join_panes(const std::vector<PaneImage>& parts, const Background& background, int width,
                               int height);

/// The halves of a picture of this size, with a gap of two pixels between them.
[[nodiscard]] std::array<Pane, 2> halves_of(int width, int height);
/// What the right half shows of `scene`: the other one from the same side and at the same scale, each about its own middle,
/// with the same background, colours and signs. Lengths that differ more than tenfold are of other units: then both are as
/// large, and the title says so. @pre scene.beside.
[[nodiscard]] SceneView beside_view(const SceneView& scene);

/// As render_image(), where the volume of `view` asks for panes of all of them, or another scene stands beside `view` of both: the figures are
/// those of the volume's own pane, or of the left half.
/// @throws Error as that; (usage) for panes for two eyes.
[[nodiscard]] RenderedImage render_panes(const SceneView& view, int width, int height, int repeat = 0,
                                         double budget = 0.0, bool error = false);

}  // namespace palpate
