/// Writers of images, chosen by the file's ending: .nii, .nii.gz (NIfTI-1), .nrrd, .vti
/// (VTK XML ImageData, coordinates as they are). Written under a temporary
/// name and renamed, so an output is never half a file.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>

#include "common/field/data_set.h"

namespace palpate {

/// What the numbers of a voxel are, in the axes of the coordinates.
enum class ImageContent : std::uint8_t {
  kScalar,  ///< one number
  kVector,  ///< three: a direction
  kTensor,  ///< six: xx xy xz yy yz zz
  kColor    ///< three in [0, 1]: red, green, blue; stored in a byte each
};
/// Numbers of a voxel.
[[nodiscard]] int component_count(ImageContent content) noexcept;

/// Along which axes, and in which order, NIfTI files hold directions and tensors: fields of its header cannot say,
/// so that its description does (frame_mark()).
enum class ImageConvention : std::uint8_t {
  kMrtrix,  ///< the axes of the coordinates; xx yy zz xy xz yz
  kFsl      ///< fsl_axes(); xx xy xz yy yz zz
};

/// What the coordinates of an image are known to be; VTK's files cannot say.
enum class ImageSpace : std::uint8_t {
  kPatient,  ///< RAS+ mm
  kUnknown   ///< in no known units and orientation: NRRD and NIfTI files claim none of them
};

/// Checks that `path` has a known ending, may be written, and does not exist unless `overwrite`; call it
/// before the work starts.
/// @throws Error (usage, or work failed where the folder cannot be written).
void check_image_output(const std::filesystem::path& path, bool overwrite);

/// Numbers that are not finite are written as they are; in NRRD, tensors have a mask that is zero there.
/// @param values of all points of `topology`, component_count() numbers each.
/// @throws Error as check_image_output(); (work failed) where the disk refuses; (usage) where the image is
/// too large for NIfTI-1 along an axis.
void write_image(const std::filesystem::path& path, const UniformTopology& topology, ImageContent content,
                 std::span<const float> values, ImageConvention convention, bool overwrite,
                 ImageSpace space = ImageSpace::kPatient);

/// Writes single numbers, or colours of three or four bytes, in the type in which they are; what is not finite stays
/// so. @pre not sparse.
/// @throws Error as above.
void write_image(const std::filesystem::path& path, const UniformTopology& topology, const DataArray& values,
                 bool overwrite, ImageSpace space = ImageSpace::kPatient);

}  // namespace palpate
