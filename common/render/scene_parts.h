/// What of a scene a picture needs, and what of it stays the same in the next one: as plain data.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

/// Bounds for clipping [data units]: lines, outlines, tracts and slices may leave the domain's box a little.
[[nodiscard]] Box reach_of(const SceneView& view);
[[nodiscard]] bool same_box(const Box& a, const Box& b);
/// Whether what stays while the probe moves is the same picture.
[[nodiscard]] bool same_still_part(const SceneView& a, const SceneView& b);
[[nodiscard]] bool shows_volume(const SceneView& view);
/// Whether lines mix with what lies behind them.
[[nodiscard]] bool is_transparent(const SceneView& view);

/// Transparent lines that rays through a volume have to pass, and all that they look like from one place.
struct LayeredLines {
  std::shared_ptr<const std::vector<Line>> lines;
  LineStyle style;
  std::optional<ColorLens> color_lens;
  Background background = Background::kDark;

  [[nodiscard]] static std::optional<LayeredLines> of(const SceneView& view);
  bool operator==(const LayeredLines&) const = default;
};

/// How lines of local seeds are coloured where those of the scene have that style.
[[nodiscard]] LineStyle style_of(const LocalSeeds& seeds, const LineStyle& scene);
/// The range that values of the probe's lines spread over, where no other lines set one: of the followed line,
/// else of those of local seeds.
[[nodiscard]] ValueRange range_alone(const ProbeView& probe, const LineStyle& style);
/// Whether something is coloured by values.
[[nodiscard]] bool has_colored_lines(const SceneView& view);
/// Whether words, axes or a colour bar are drawn over the picture.
[[nodiscard]] bool has_overlay(const SceneView& view);

}  // namespace palpate
