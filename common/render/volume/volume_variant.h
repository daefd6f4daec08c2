/// The volume of a picture with other samples and tables: what rays look up that are cast once more.
#pragma once

#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/volume/shape_block.h"
#include "common/render/volume/volume_textures.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

struct VolumeVariant {
  VolumeTextures textures;
  GlBuffer volume_block, shape_block;
  ShapeRoom room;
  std::vector<std::string> defines;
  GlProgram program;  ///< where its defines are others than those of what is shown

  /// @param view VolumeTextures::drawn() of `whole`, whose voxels are taken, but for samples and tables.
  void update(const VolumeView& view, const SceneFrame& frame, const VolumeTextures& whole);
};

}  // namespace palpate
