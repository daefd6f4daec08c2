/// What converged rays through a volume look up: its own voxels, and tables of more entries.
#pragma once

#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/volume/shape_block.h"
#include "common/render/volume/volume_textures.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

struct ConvergedVolume {
  VolumeView view;  ///< converged_view() of what is shown
  VolumeTextures textures;
  GlBuffer volume_block, shape_block;
  ShapeRoom room;
  std::vector<std::string> defines;
  GlProgram program;  ///< where its defines are others than those of what is shown

  /// @param shown VolumeTextures::drawn() of `whole`, whose voxels are taken.
  void update(const VolumeView& shown, const SceneFrame& frame, const VolumeTextures& whole);
};

}  // namespace palpate
