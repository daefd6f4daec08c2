/// What the shaders of volumes are told of parts, planes that cut and lenses, as they get it
/// (shaders/volume/shape_block.glsl).
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "common/render/camera.h"
#include "common/render/gl/object.h"
#include "common/render/volume/volume_textures.h"
#include "common/render/volume/volume_view.h"

namespace palpate {

/// How much room the arrays of shaders have: for kLensRoom lenses, kFaceRoom faces of all of them together
/// and kCutRoom planes that cut, this many times. Few shapes cost what they cost; many, shaders of their own.
struct ShapeRoom {
  static constexpr std::size_t kLensRoom = 8, kFaceRoom = 256, kCutRoom = 128;

  std::size_t times = 1;  ///< a power of two

  /// The least that holds the shapes of `view`.
  [[nodiscard]] static ShapeRoom of(const VolumeView& view);

  /// Whether shaders find the shapes in a storage buffer: they would be too large for a uniform block of
  /// 16 KB, which is what every driver has.
  [[nodiscard]] bool stored() const noexcept { return times > 2; }
  /// What shaders are told (compile_program()).
  [[nodiscard]] std::string shader_define() const { return "ROOM " + std::to_string(times); }

  bool operator==(const ShapeRoom&) const = default;
};

/// The block's bytes: laid out alike in uniform and in storage buffers.
/// @pre `room` holds the shapes of `view`; at most kMostLenses lenses, kMostCuts planes and kMostTransfers
/// transfer functions.
[[nodiscard]] std::vector<std::byte> make_shape_block(const VolumeView& view, const SceneFrame& frame,
                                                      ShapeRoom room);

/// What shaders are told of light and lines (compile_program()): nothing of what no part of `view` has.
[[nodiscard]] std::vector<std::string> look_defines(const VolumeView& view);

/// For shaders compiled with `room`.
void bind_shape_block(const GlBuffer& block, ShapeRoom room);

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
