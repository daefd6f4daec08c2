#include "common/render/volume/converged_volume.h"

#include <span>
#include <utility>

#include "common/render/volume/image_error.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/volume_block.h"

namespace palpate {

void ConvergedVolume::update(const VolumeView& shown, const SceneFrame& frame, const VolumeTextures& whole) {
  view = converged_view(shown);
  textures.update(view, {}, &whole);
  room = ShapeRoom::of(view);
  std::vector<std::string> wanted = textures.shader_defines();
  wanted.push_back(room.shader_define());
  if (wanted != defines) {
    program.reset();
    defines = std::move(wanted);
  }
  volume_block = volume_shader::make_block_buffer(make_volume_block(view, frame, textures.field_bricks()));
  shape_block = make_buffer(make_shape_block(view, frame, room));
}

}  // namespace palpate
