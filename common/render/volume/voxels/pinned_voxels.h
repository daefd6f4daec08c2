/// Voxels that a rasteriser on the processor reads where they stand (GL_AMD_pinned_memory): a texture of them would be
/// the same numbers once more, in the same memory. Values between points are those of shaders/volume/voxels.glsl, eight
/// numbers each, as the rasteriser's own are.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/render/gl/object.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

class PinnedVoxels {
 public:
  /// Nothing where the rasteriser is none on the processor, cannot read so many numbers at foreign places, or the image is
  /// sparse.
  [[nodiscard]] static std::shared_ptr<const PinnedVoxels> pin(std::shared_ptr<const VolumeImage> image);
  /// Waits for pictures that still read them.
  ~PinnedVoxels();
  PinnedVoxels(const PinnedVoxels&) = delete;
  PinnedVoxels& operator=(const PinnedVoxels&) = delete;

  void bind(std::uint32_t unit) const;
  /// What the shaders are told.
  [[nodiscard]] std::vector<std::string> defines() const;

 private:
  PinnedVoxels(std::shared_ptr<const VolumeImage> image, GlBuffer buffer);

  std::shared_ptr<const VolumeImage> image_;
  GlBuffer buffer_;
  GlTexture texture_;
};

}  // namespace palpate
