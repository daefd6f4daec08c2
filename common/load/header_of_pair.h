/// Images in two files: which one is the header.
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace palpate {

/// The header of a NIfTI or Analyze pair of which `path` names the voxels (.img); nothing where it does not.
/// @param head the start of that file, as it is.
[[nodiscard]] std::optional<std::filesystem::path> header_of_pair(const std::filesystem::path& path,
                                                                  std::string_view head);

}  // namespace palpate
