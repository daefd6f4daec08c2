#include "common/render/volume/voxels/field_voxels.h"

#include <algorithm>
#include <utility>

#include <epoxy/gl.h>

#include "common/base/check.h"
#include "common/render/volume/volume_bindings.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "common/render/volume/voxels/voxel_texture.h"

namespace palpate {

const GradientRanges& FieldBricks::gradients() {
  if (known_->gradients.ranges.empty())
    known_->gradients = gradient_ranges(*known_->image, known_->ranges.bricks);
  return known_->gradients;
}

bool FieldVoxels::update(const VolumeView& view, std::uint64_t memory, const FieldVoxels* other) {
  PALPATE_CHECK(view.fields.size() < kMostFields);
  bool changed = false;
  for (std::size_t i = 0; i < places_.size(); ++i) {
    Place& place = places_[i];
    const bool shown = i < view.fields.size() && shows_field(view, i + 1);
    if (!shown) {
      changed = changed || place.voxels != nullptr;
      place = {};
      continue;
    }
    const std::shared_ptr<const VolumeImage>& asked = view.fields[i].image;
    PALPATE_CHECK(asked != nullptr);
    if (place.asked == asked && place.memory == memory) continue;
    place = {};
    if (other != nullptr && other->places_[i].image == asked) {
      place = other->places_[i];
    } else {
      place.image = fitting_image(asked, memory);
      place.voxels = std::make_shared<const GlTexture>(upload_whole(*place.image));
      place.bricks = FieldBricks(place.image, brick_ranges(*place.image));
    }
    place.asked = asked;
    place.memory = memory;
    changed = true;
  }
  return changed;
}

void FieldVoxels::bind() const {
  for (std::size_t i = 0; i < places_.size(); ++i) {
    if (places_[i].voxels)
      glBindTextureUnit(volume_shader::kFieldVoxels + static_cast<GLuint>(i), places_[i].voxels->name());
  }
}

std::uint64_t FieldVoxels::bytes() const noexcept {
  std::uint64_t bytes = 0;
  for (const Place& place : places_) bytes += place.image ? place.image->byte_count() : 0;
  return bytes;
}

}  // namespace palpate
