/// Finding out how voxels without a header lie in their file.
///
/// Options win; else a sidecar beside the file, "volume.raw.toml", in the grammar of the options
///
///   [raw]
///   size = "256x256x178"
///   type = "uint16"
///   endian = "big"          # little where it is left out
///   spacing = "0.5,0.5,1"   # 1,1,1
///   origin = "0,0,0"
///   skip = 1024             # bytes before the first voxel
///
/// else the file's own name, as public collections have it: "tooth_103x94x161_uint8.raw".
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "common/load/raw_layout.h"

namespace palpate {

/// The layout of `file`; none where nothing says that it holds voxels without a header.
/// @param options empty where none was given.
/// @param note what was taken from where, for the user; empty where there is nothing to say.
/// @throws Error (usage) for options, (bad input) for a sidecar that makes no sense.
[[nodiscard]] std::optional<RawLayout> raw_layout_of(const std::filesystem::path& file,
                                                     const RawSpec& options, std::string& note);

}  // namespace palpate
