/// The axes that vectors and tensors of a file may be along.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "common/math/vec.h"

namespace palpate {

enum class VectorFrame : std::uint8_t {
  kImage,    ///< FSL's: those of the image, the first turned around where it is right-handed (fsl_axes())
  kVoxel,    ///< those of the image (image_axes())
  kScanner,  ///< those of the coordinates: RAS of medical images
  kLps       ///< left, posterior, superior: ITK's and DICOM's
};
inline constexpr int kVectorFrameCount = 4;
/// "image", "voxel", "scanner", "lps": as options have it.
[[nodiscard]] std::string_view name_of(VectorFrame frame) noexcept;
/// "FSL's image axes (the first turned around where the image is right-handed)"
[[nodiscard]] std::string_view words_of(VectorFrame frame) noexcept;
/// "frame=scanner": how our images say it in a text of their header, and the frame that such a text names.
[[nodiscard]] std::string frame_mark(VectorFrame frame);
[[nodiscard]] std::optional<VectorFrame> frame_in(std::string_view text) noexcept;
/// From components in the file to the data's axes.
/// @param axes of the image: columns are steps along i, j, k. @pre they span space.
[[nodiscard]] Mat3 matrix_of(VectorFrame frame, const Mat3& axes) noexcept;

}  // namespace palpate
