#include "common/render/color/color_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include <epoxy/gl.h>
#include <glm/vec4.hpp>

#include "common/base/index.h"
#include "common/render/gl/gpu_objects.h"

namespace palpate {
namespace {

// IEC 61966-2-1, as shaders/include/color.glsl.
float linear_of(float c) noexcept {
  return c <= 0.04045F ? c / 12.92F : std::pow((c + 0.055F) / 1.055F, 2.4F);
}

// shaders/include/shade.glsl.
glm::vec4 glossy_color(const Rgb& color) {
  const Rgb linear{linear_of(color.r), linear_of(color.g), linear_of(color.b)};
  const float strongest = std::max({linear.r, linear.g, linear.b, 1e-3F});
  return {linear.r, linear.g, linear.b, 0.5F / strongest};
}

GlTexture make_table_texture(ColorMap map, bool linear) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  label_object(GpuObject::Kind::kTexture, name, "colour map");
  const std::array<Rgb, kColorTableSize> table = color_table(map);
  if (linear) {
    std::array<glm::vec4, kColorTableSize> glossy;
    std::transform(table.begin(), table.end(), glossy.begin(), glossy_color);
    glTextureStorage2D(name, 1, GL_RGBA32F, kColorTableSize, 1);
    glTextureSubImage2D(name, 0, 0, 0, kColorTableSize, 1, GL_RGBA, GL_FLOAT, glossy.data());
  } else {
    glTextureStorage2D(name, 1, GL_RGB32F, kColorTableSize, 1);
    glTextureSubImage2D(name, 0, 0, 0, kColorTableSize, 1, GL_RGB, GL_FLOAT, table.data());
  }
  const GLint filter = map == ColorMap::kCategorical ? GL_NEAREST : GL_LINEAR;
  glTextureParameteri(name, GL_TEXTURE_MIN_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_MAG_FILTER, filter);
  glTextureParameteri(name, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(name, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

}  // namespace

void ColorTables::bind(ColorMap map, std::uint32_t unit) {
  GlTexture& table = tables_[as_size(map)];
  if (!table) table = make_table_texture(map, false);
  glBindTextureUnit(unit, table.name());
}

void ColorTables::bind_linear(ColorMap map, std::uint32_t unit) {
  GlTexture& table = linear_tables_[as_size(map)];
  if (!table) table = make_table_texture(map, true);
  glBindTextureUnit(unit, table.name());
}

}  // namespace palpate
