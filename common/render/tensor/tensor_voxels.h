/// An image of diffusion tensors as slices and glyphs show it: the field, and a colour for each voxel.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "common/field/tensor/tensor_field.h"
#include "common/field/transfer/color_transfer.h"
#include "common/math/vec.h"
#include "common/render/color/color_map.h"
#include "common/render/volume/voxels/volume_image.h"

namespace palpate {

/// |x| |y| |z| of a direction as red, green and blue: from left to right, back to front, feet to head.
/// @pre a unit vector.
[[nodiscard]] Rgb direction_color(const Vec3& direction) noexcept;

/// Immutable where shared. Without a field it is a lattice for the slices of another image: `directions` and
/// `anisotropies` are empty then, and no voxel shows. Symbols.  g grid coordinates, whole numbers at the
/// voxels' centres; x = origin + axes g data coordinates. A voxel reaches from g - 1/2 to g + 1/2.
struct TensorVoxels {
  std::shared_ptr<const TensorField> field;  ///< may be null
  Index3 points{0};
  Vec3 origin{0.0};
  Mat3 axes{1.0};  ///< columns: steps along i, j, k [data units]
  /// For each voxel, i fastest: direction_color() of the main eigenvector times FA, 255 standing for one, and
  /// 255 where there is a tensor that is not zero, else all 0.
  std::vector<std::array<std::uint8_t, 4>> directions;
  std::vector<std::uint8_t> anisotropies;  ///< FA, 255 for one

  /// The voxels that show lie between these, both included; all of them where none shows.
  Index3 first_shown{0}, last_shown{0};

  [[nodiscard]] Vec3 position(const Vec3& g) const noexcept { return origin + axes * g; }
  [[nodiscard]] Vec3 grid_coordinates(const Vec3& x) const noexcept;
  /// Whether g lies in a voxel.
  [[nodiscard]] bool contains(const Vec3& g) const noexcept;
  /// Whether a voxel has a tensor that shows. @pre it lies in the image.
  [[nodiscard]] bool shows(const Index3& voxel) const noexcept;
  /// Of a voxel [data units].
  [[nodiscard]] double shortest_edge() const noexcept {
    return std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])});
  }
  /// Boxes around all voxels, and around those from first_shown to last_shown; data coordinates.
  [[nodiscard]] Box bounds() const noexcept;
  [[nodiscard]] Box shown_bounds() const noexcept;
};

/// @param file for messages. @param threads 0: all cores; the image does not depend on it.
/// @throws Error (bad input) where the field was not made from a uniform image.
[[nodiscard]] std::shared_ptr<const TensorVoxels> make_tensor_voxels(std::shared_ptr<const TensorField> field,
                                                                     const std::string& file,
                                                                     int threads = 0);

/// The lattice of `image` alone, for slices through it.
[[nodiscard]] std::shared_ptr<const TensorVoxels> make_slice_lattice(const VolumeImage& image);

/// FA at the centres of the voxels, 0 where there is no tensor; colours are direction_color() of the main
/// eigenvectors, at full strength: how strong a direction is, opacity says. Shares the numbers of `voxels`.
[[nodiscard]] std::shared_ptr<const VolumeImage> make_anisotropy_volume(
    std::shared_ptr<const TensorVoxels> voxels);

/// Of FA for a context: a faint grey veil of what has a direction at all.
[[nodiscard]] ColorTransfer anisotropy_veil();
/// Of FA for a focus: solid where fibres run.
[[nodiscard]] ColorTransfer anisotropy_body();

}  // namespace palpate
