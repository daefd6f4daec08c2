/// The axes that vectors and tensors of a file may be along.
#pragma once

#include <cstddef>
#include <cstdint>
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
/// "FSL's image axes (the first turned around where the image is right-handed)"
[[nodiscard]] std::string_view words_of(VectorFrame frame) noexcept;
/// From components in the file to the data's axes.
/// @param axes of the image: columns are steps along i, j, k. @pre they span space.
[[nodiscard]] Mat3 matrix_of(VectorFrame frame, const Mat3& axes) noexcept;

/// A difference of coherence (orientation_check.h) that is no chance, and the voxels that it takes.
inline constexpr double kClearCoherence = 0.02;
inline constexpr std::size_t kLeastCoherent = 200;

}  // namespace palpate
