#include "common/render/volume/volume_variant.h"

#include <span>
#include <utility>

#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"

namespace palpate {

void VolumeVariant::update(const VolumeView& view, const SceneFrame& frame, const VolumeTextures& whole) {
  textures.update(view, {}, &whole);
  room = ShapeRoom::of(view);
  std::vector<std::string> wanted = textures.shader_defines();
  wanted.push_back(room.shader_define());
  if (wanted != defines) {
    program.reset();
    defines = std::move(wanted);
  }
  VolumeBlock told = make_volume_block(view, frame, textures.field_bricks());
  told.asks_tiles = 0.0F;  // rays of all pixels: the tiles are those of another picture
  volume_block = volume_shader::make_block_buffer(told);
  shape_block = make_buffer(make_shape_block(view, frame, room));
}

}  // namespace palpate
