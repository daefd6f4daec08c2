/// Reads the texts of a PNG.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/render/png.h"

namespace palpate::test {

/// The texts of a PNG in memory; empty where it is none.
inline std::vector<PngText> png_texts(const std::vector<std::uint8_t>& png) {
  const std::string_view all(reinterpret_cast<const char*>(png.data()), png.size());
  constexpr std::string_view kMagic = "\x89PNG\r\n\x1A\n";
  if (!all.starts_with(kMagic)) return {};
  std::vector<PngText> texts;
  for (std::size_t at = kMagic.size(); at + 12 <= all.size();) {
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = 256 * length + png[at + i];
    if (length > all.size() - at - 12) break;
    const std::string_view type = all.substr(at + 4, 4), body = all.substr(at + 8, length);
    const auto end = body.find('\0');
    const std::size_t skip = type == "iTXt" ? 5 : 1;
    if ((type == "tEXt" || type == "iTXt") && end != std::string_view::npos && end + skip <= body.size())
      texts.push_back({std::string(body.substr(0, end)), std::string(body.substr(end + skip))});
    at += 12 + length;
  }
  return texts;
}

}  // namespace palpate::test
