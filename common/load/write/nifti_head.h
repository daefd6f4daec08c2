/// What NIfTI files begin with, and what of an image's own header other formats say, too.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/write/image_origin.h"

namespace palpate {

/// What the numbers of a voxel are, and how they are stored.
struct Stored {
  ImageContent content = ImageContent::kScalar;
  ScalarType type = ScalarType::kFloat32;
  int components = 1;
  double slope = 1.0, intercept = 0.0;  ///< of NIfTI: values are slope * number + intercept

  [[nodiscard]] bool colors() const noexcept { return content == ImageContent::kColor; }
};

/// How the formats call a number type: the code of nifti1.h, the names of NRRD and of VTK.
struct TypeNames {
  std::int16_t nifti;
  const char *nrrd, *vtk;
};
[[nodiscard]] TypeNames names_of(ScalarType type) noexcept;

/// The description of an image whose own header cannot say along which axes directions and tensors are; empty for
/// single numbers and colours.
[[nodiscard]] std::string nifti_description(ImageContent content, ImageConvention convention);
/// What the image came from is said behind it, but for axes that its numbers are not along.
[[nodiscard]] std::string with_description_of(const ImageHeader& header, std::string text);
/// That of the origin; where it states none of NIfTI's fields, what is known of coordinates.
[[nodiscard]] ImageHeader header_of(const ImageOrigin& origin);

/// The header of nifti1.h (348 bytes) with its 4 bytes of extension flags.
/// @param lost is told what it has no place for.
[[nodiscard]] std::string nifti_head(const UniformTopology& topology, const Stored& stored,
                                     const ImageHeader& origin, const std::string& description,
                                     std::vector<std::string>& lost);

/// The numbers that `scaling` makes exactly these values of, as readers do; nothing where there are none.
[[nodiscard]] std::optional<DataArray> stored_numbers(const DataArray& values,
                                                      const ImageHeader::Scaling& scaling);

}  // namespace palpate
