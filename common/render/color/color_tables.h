/// Colour maps as textures.
#pragma once

#include <array>
#include <cstdint>

#include "common/render/color/color_map.h"
#include "common/render/gl/object.h"

namespace palpate {

/// Each is uploaded at its first use. Needs the context current in which it was made.
class ColorTables {
 public:
  /// One row of kColorTableSize colours, sRGB.
  void bind(ColorMap map, std::uint32_t unit);
  /// The same in linear light, each with what its highlights take of its hue (shaders/include/shade.glsl).
  void bind_linear(ColorMap map, std::uint32_t unit);

 private:
  std::array<GlTexture, kColorMapCount> tables_, linear_tables_;
};

}  // namespace palpate
