#include "common/render/overlay/overlay_pen.h"

#include <algorithm>
#include <cfloat>
#include <cmath>

#include "common/render/color/palette.h"

namespace palpate {
namespace {

ImFont* font_of(Lettering lettering) { return ImGui::GetIO().Fonts->Fonts[static_cast<int>(lettering)]; }

}  // namespace

OverlayPen::OverlayPen(ImDrawList& list, float text_height, const Background& background)
    : list_(list),
      text_height_(text_height),
      dark_(!background.is_light()),
      ink_(dark_ ? IM_COL32(232, 235, 240, 255) : IM_COL32(28, 31, 36, 255)),
      faint_ink_(dark_ ? IM_COL32(168, 174, 184, 255) : IM_COL32(86, 92, 102, 255)) {
  // Small words need this much (WCAG 2.2, 1.4.3).
  constexpr double kReadable = 4.5;
  const ImVec4 faint = ImGui::ColorConvertU32ToFloat4(faint_ink_);
  if (contrast_ratio(Rgb{faint.x, faint.y, faint.z}, background) < kReadable) faint_ink_ = ink_;
}

ImU32 packed(const Rgb& color, float opacity) {
  return ImGui::ColorConvertFloat4ToU32({color.r, color.g, color.b, opacity});
}

ImVec2 OverlayPen::size_of(const std::string& text, Lettering lettering) {
  const ImFont* const font = font_of(lettering);
  return font->CalcTextSizeA(font->FontSize, FLT_MAX, 0.0F, text.c_str());
}

void OverlayPen::text(float x, float y, const std::string& words, ImU32 color, float align,
                      Lettering lettering) const {
  const ImFont* const font = font_of(lettering);
  x = std::round(x - align * size_of(words, lettering).x);
  y = std::round(y);
  // A rim in the colour of the background keeps letters readable over lines.
  const float rim = std::max(1.0F, std::round(text_height_ / 14.0F));
  for (const ImVec2 shift : {ImVec2(-rim, 0), ImVec2(rim, 0), ImVec2(0, -rim), ImVec2(0, rim)}) {
    list_.AddText(font, font->FontSize, {x + shift.x, y + shift.y}, paper(110), words.c_str());
  }
  list_.AddText(font, font->FontSize, {x, y}, color, words.c_str());
}

void OverlayPen::label(float x, float y, const std::string& words) const {
  const ImVec2 size = size_of(words);
  const float margin = 0.3F * text_height_;
  list_.AddRectFilled({x - margin, y - 0.5F * margin}, {x + size.x + margin, y + size.y + 0.5F * margin},
                      paper(190), margin);
  text(x, y, words, ink());
}

}  // namespace palpate
