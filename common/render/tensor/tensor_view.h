/// What a picture shows of an image of diffusion tensors, as plain data.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>

#include "common/field/value_histogram.h"
#include "common/render/camera.h"
#include "common/render/tensor/tensor_voxels.h"
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

enum class TensorColor : std::uint8_t {
  kDirection,  ///< direction_color() of the main eigenvector; on slices times FA
  kFa          ///< fractional anisotropy from black to white
};
inline constexpr int kTensorColorCount = 2;
[[nodiscard]] std::string_view name_of(TensorColor color) noexcept;  ///< "direction"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] TensorColor tensor_color_from_name(std::string_view name);

/// What stands for a tensor.
enum class GlyphShape : std::uint8_t {
  kNone,
  kEllipsoid,
  kSuperquadric  ///< Kindlmann 2004: edges show how linear and planar it is, whatever the direction of view
};
inline constexpr int kGlyphShapeCount = 3;
[[nodiscard]] std::string_view name_of(GlyphShape shape) noexcept;  ///< "superquadric"
/// @throws Error (usage) that lists the known ones.
[[nodiscard]] GlyphShape glyph_shape_from_name(std::string_view name);

/// Slices lie in the image's own planes, through one point.
struct TensorView {
  std::shared_ptr<const TensorVoxels> image;
  Vec3 position{0.0};                            ///< data coordinates
  std::array<bool, 3> slices{true, true, true};  ///< those across the image's axes i, j, k
  TensorColor color = TensorColor::kDirection;
  bool smooth = false;    ///< colours are interpolated between voxels, else each voxel has its own
  bool crosshair = true;  ///< lines through `position` on the slices
  GlyphShape glyphs = GlyphShape::kNone;  ///< on the slices that are shown
  double glyph_least_fa = 0.15;           ///< tensors below have no glyph
  /// Glyphs stand no closer than this [thousandths of the picture's height at the focal point].
  double glyph_spacing = 24.0;
  std::optional<UnderlayView> underlay;  ///< on the slices, below the colours of tensors
};

/// Whether both give the same picture; images count as the same where they are the same objects.
[[nodiscard]] bool same_picture(const TensorView& a, const TensorView& b);

/// The image's axis that is most nearly parallel to axis 0, 1 or 2 of the data: across which sagittal,
/// coronal and axial slices lie. Each axis of the image is given for one of the data.
[[nodiscard]] std::array<int, 3> slice_axes(const Mat3& axes) noexcept;

/// `position` moved by `steps` voxels along the image's axis `axis`, from voxel to voxel; it stays in the
/// image.
[[nodiscard]] Vec3 moved_position(const TensorVoxels& image, const Vec3& position, int axis, int steps);

struct TensorPick {
  Vec3 position{0.0};  ///< on a slice, data coordinates
  Index3 voxel{0};
  int axis = 0;                    ///< of the image, across which the slice lies
  std::optional<Mat3> tensor;      ///< of the voxel, where it shows
  std::optional<double> underlay;  ///< the value there of the image below
};

/// The nearest slice under the pixel (x, y) from the top left corner that shows something there; none where
/// the ray of the pixel meets none.
[[nodiscard]] std::optional<TensorPick> pick_slice(const TensorView& view, const Camera& camera, int width,
                                                   int height, double x, double y);

}  // namespace palpate
