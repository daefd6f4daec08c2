/// Colours that go with the background, for all that no data colours. How well one stands out from the other
/// is their contrast ratio, from 1 to 21 (WCAG 2.2, definition of contrast ratio).
#pragma once

#include "common/render/color/color_map.h"
#include "common/render/scene_view.h"

namespace palpate {

struct Palette {
  Background background;
  Rgb outline;             ///< edges of the domain
  Rgb plain_line;          ///< lines in one colour
  Rgb ink;                 ///< what has to stand out: probe, vector icon, rim of the followed line
  Rgb tool;                ///< rakes and planes of seeds
  Rgb proxy;               ///< no colour of the maps for data comes near it
  float highlight = 0.0F;  ///< added at most, linear light: a light background swallows bright highlights
  float fading = 0.0F;     ///< share of the background that the farthest lines take on
};

[[nodiscard]] Palette palette_of(const Background& background) noexcept;

[[nodiscard]] double contrast_ratio(const Rgb& a, const Rgb& b) noexcept;
/// That between `color` and the nearer end of the gradient.
[[nodiscard]] double contrast_ratio(const Rgb& color, const Background& background) noexcept;

}  // namespace palpate
