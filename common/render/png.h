/// PNG files that say how they were made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/render/scene_view.h"

namespace palpate {

/// An entry of the file's text: keyword (1 to 79 Latin-1 characters, such as "Software") and words (UTF-8).
struct PngText {
  std::string keyword;
  std::string text;
};

/// The bytes of a PNG (ISO/IEC 15948) with the texts before the image data: tEXt where the text is
/// ASCII, iTXt otherwise.
[[nodiscard]] std::vector<std::uint8_t> encode_png(const Image& image, const std::vector<PngText>& texts);

/// Writes a PNG under a temporary name and renames it; a file of that name is replaced.
/// @throws Error (work failed) naming the file.
void write_png(const std::filesystem::path& path, const Image& image, const std::vector<PngText>& texts);

}  // namespace palpate
