/// A scalar image under slices, in its own geometry, as plain data.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "common/field/value_histogram.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// How the colours of tensors lie over the image below them.
enum class UnderlayBlend : std::uint8_t {
  kAnisotropy,  ///< as opaque as FA says: grey c of the image becomes FA colour + (1 - FA) c
  kSolid,       ///< they hide the image; it shows where there is no tensor
  kNone         ///< the image alone
};
inline constexpr int kUnderlayBlendCount = 3;
[[nodiscard]] std::string_view name_of(UnderlayBlend blend) noexcept;  ///< "anisotropy"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] UnderlayBlend underlay_blend_from_name(std::string_view name);

/// The slices are those of a TensorView; what they show of this image is sampled at their positions in data
/// coordinates, whatever its resolution and orientation.
struct UnderlayView {
  std::shared_ptr<const VolumeImage> image;  ///< not null
  ValueWindow window;                        ///< from black to white
  UnderlayBlend blend = UnderlayBlend::kAnisotropy;

  bool operator==(const UnderlayView&) const = default;  ///< images are the same where the objects are
};

/// The value of the voxel of `image` that x lies in; nothing outside, or where the value is not finite.
[[nodiscard]] std::optional<double> voxel_value(const VolumeImage& image, const Vec3& x) noexcept;

}  // namespace palpate
