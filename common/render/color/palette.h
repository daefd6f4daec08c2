/// Colours that go with the background, for all that no data colours.
#pragma once

#include "common/render/color/color_map.h"
#include "common/render/scene_view.h"

namespace palpate {

struct Palette {
  Rgb top, bottom;         ///< of the background
  Rgb outline;             ///< edges of the domain
  Rgb plain_line;          ///< lines in one colour
  Rgb ink;                 ///< what has to stand out: probe, vector icon, rim of the followed line
  Rgb tool;                ///< rakes and planes of seeds
  Rgb proxy;               ///< no colour of the maps for data comes near it
  float highlight = 0.0F;  ///< added at most, linear light: a light background swallows bright highlights
  float fading = 0.0F;     ///< share of the background that the farthest lines take on
};

[[nodiscard]] const Palette& palette_of(Background background) noexcept;

}  // namespace palpate
