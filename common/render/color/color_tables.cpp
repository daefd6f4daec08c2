#include "common/render/color/color_tables.h"

#include <cstddef>

#include <epoxy/gl.h>

#include "common/base/index.h"
#include "common/render/gl/gpu_objects.h"

namespace palpate {
namespace {

GlTexture make_table_texture(ColorMap map) {
  GLuint name = 0;
  glCreateTextures(GL_TEXTURE_2D, 1, &name);
  GlTexture texture(name);
  label_object(GpuObject::Kind::kTexture, name, "colour map");
  const auto& table = color_table(map);
  glTextureStorage2D(name, 1, GL_RGB32F, kColorTableSize, 1);
  glTextureSubImage2D(name, 0, 0, 0, kColorTableSize, 1, GL_RGB, GL_FLOAT, table.data());
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
  if (!table) table = make_table_texture(map);
  glBindTextureUnit(unit, table.name());
}

}  // namespace palpate
