#include "common/render/font.h"

#include <filesystem>

#include <imgui.h>

namespace palpate {

void add_font(ImFontAtlas& atlas, float pixels) {
  // Latin letters with accents, Greek, and the signs that units use (superscripts, middle dot).
  static constexpr ImWchar kRanges[] = {0x20, 0xFF, 0x391, 0x3C9, 0x2010, 0x2027, 0x2070, 0x209C, 0};
  static constexpr const char* kFile = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
  std::error_code error;
  if (std::filesystem::exists(kFile, error)) {
    ImFontConfig config;
    config.OversampleH = 2;
    config.OversampleV = 1;
    if (atlas.AddFontFromFileTTF(kFile, pixels, &config, kRanges) != nullptr) return;
  }
  ImFontConfig config;
  config.SizePixels = pixels;
  atlas.AddFontDefault(&config);
}

}  // namespace palpate
