/// The voxels on the GPU of scalars beside that of the context, for lenses that show them: each on a grid of
/// its own, whole, and where it does not fit its part of the memory from coarser voxels.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <utility>

#include "common/render/gl/object.h"
#include "common/render/volume/volume_view.h"
#include "common/render/volume/voxels/brick_map.h"
#include "common/render/volume/voxels/value_gradient.h"

namespace palpate {

/// Where matter of one field lies. Depends on its image alone; copies share it.
class FieldBricks {
 public:
  FieldBricks() = default;
  FieldBricks(std::shared_ptr<const VolumeImage> image, BrickRanges ranges)
      : known_(std::make_shared<Known>(Known{std::move(image), std::move(ranges), {}})) {}

  [[nodiscard]] const BrickRanges& ranges() const noexcept { return known_->ranges; }
  /// Made when first asked for.
  [[nodiscard]] const GradientRanges& gradients();

 private:
  struct Known {
    std::shared_ptr<const VolumeImage> image;
    BrickRanges ranges;
    GradientRanges gradients;
  };
  std::shared_ptr<Known> known_ = std::make_shared<Known>();
};

class FieldVoxels {
 public:
  /// Uploads the fields of `view` that some lens shows, as far as they are not there, and frees others.
  /// @param memory for each of them [bytes]; 0: no bound. @param other whose voxels are taken where it draws
  /// these images; null: none. @return whether other voxels are there than before.
  bool update(const VolumeView& view, std::uint64_t memory, const FieldVoxels* other = nullptr);
  /// To the units of shaders/volume/voxels.glsl.
  void bind() const;

  /// What is drawn of Lens::field; null where no lens shows it. @pre 0 < field < kMostFields.
  [[nodiscard]] const std::shared_ptr<const VolumeImage>& image(std::size_t field) const {
    return places_[field - 1].image;
  }
  [[nodiscard]] FieldBricks& bricks(std::size_t field) { return places_[field - 1].bricks; }
  [[nodiscard]] std::uint64_t bytes() const noexcept;

 private:
  struct Place {
    std::shared_ptr<const VolumeImage> asked, image;
    std::uint64_t memory = 0;
    std::shared_ptr<const GlTexture> voxels;
    FieldBricks bricks;
  };
  std::array<Place, kMostFields - 1> places_;
};

}  // namespace palpate
