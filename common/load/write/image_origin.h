/// Images that are made of others: what they come from, which their files say again as far as the formats can.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/load/image/image_header.h"
#include "common/load/write/write_image.h"

namespace palpate {

struct ImageOrigin {
  ImageSpace space = ImageSpace::kPatient;
  std::optional<ImageHeader> header;  ///< of the file that the image is made of
};

/// write_image() of write_image.h, with the header of what the image is made of.
/// @return what the format has no place for: where voxels lie, in NIfTI files of no known space.
std::vector<std::string> write_image(const std::filesystem::path& path, const UniformTopology& topology,
                                     ImageContent content, std::span<const float> values,
                                     ImageConvention convention, bool overwrite, const ImageOrigin& origin);

/// The same of single numbers, or colours. NIfTI files store numbers as the header's scaling says, where that changes
/// none of them.
std::vector<std::string> write_image(const std::filesystem::path& path, const UniformTopology& topology,
                                     const DataArray& values, bool overwrite, const ImageOrigin& origin);

}  // namespace palpate
