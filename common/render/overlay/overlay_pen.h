/// What the overlay is drawn with: text and shapes of Dear ImGui in the colours of the background.
#pragma once

#include <cstdint>
#include <string>

#include <imgui.h>

#include "common/render/scene_view.h"

namespace palpate {

[[nodiscard]] ImU32 packed(const Rgb& color, float opacity = 1.0F);

/// Fonts of the atlas, in the order in which they are added.
enum class Lettering : std::uint8_t { kText, kTitle };
inline constexpr float kTitleScale = 1.35F;  ///< of the text's height

/// Needs the overlay's ImGui context current. Lengths are pixels.
class OverlayPen {
 public:
  OverlayPen(ImDrawList& list, float text_height, const Background& background);

  [[nodiscard]] float text_height() const { return text_height_; }
  [[nodiscard]] ImU32 ink() const { return ink_; }
  [[nodiscard]] ImU32 faint_ink() const { return faint_ink_; }
  [[nodiscard]] ImU32 paper(int opacity) const {
    return dark_ ? IM_COL32(16, 18, 21, opacity) : IM_COL32(255, 255, 255, opacity);
  }

  [[nodiscard]] static ImVec2 size_of(const std::string& text, Lettering lettering = Lettering::kText);

  /// @param align the share of the text's width that lies left of x.
  void text(float x, float y, const std::string& words, ImU32 color, float align = 0.0F,
            Lettering lettering = Lettering::kText) const;
  /// Words on a plate in the colour of the background, for places where anything may lie behind them.
  void label(float x, float y, const std::string& words) const;

  [[nodiscard]] ImDrawList& list() const { return list_; }

 private:
  ImDrawList& list_;
  float text_height_;
  bool dark_;
  ImU32 ink_, faint_ink_;
};

}  // namespace palpate
