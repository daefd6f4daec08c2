#include "common/render/color/palette.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

/// Of a colour in sRGB (IEC 61966-2-1), 1 for white.
double luminance(const Rgb& color) {
  const auto linear = [](float part) {
    const double x = part;
    return x <= 0.04045 ? x / 12.92 : std::pow((x + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.r) + 0.7152 * linear(color.g) + 0.0722 * linear(color.b);
}

constexpr Palette kDark{.background = Background::kDark,
                        .outline = {0.40F, 0.43F, 0.47F},
                        .plain_line = {0.80F, 0.83F, 0.88F},
                        .ink = {0.96F, 0.97F, 0.98F},
                        .tool = {0.62F, 0.66F, 0.72F},
                        .proxy = {0.98F, 0.36F, 0.68F},
                        .highlight = 0.42F,
                        .fading = 0.52F};
constexpr Palette kLight{.background = Background::kLight,
                         .outline = {0.62F, 0.65F, 0.69F},
                         .plain_line = {0.32F, 0.36F, 0.42F},
                         .ink = {0.16F, 0.18F, 0.21F},
                         .tool = {0.45F, 0.48F, 0.53F},
                         .proxy = {0.86F, 0.16F, 0.54F},
                         .highlight = 0.10F,
                         .fading = 0.55F};

}  // namespace

double contrast_ratio(const Rgb& a, const Rgb& b) noexcept {
  constexpr double kFlare = 0.05;  // of a screen
  const auto [darker, lighter] = std::minmax({luminance(a), luminance(b)});
  return (lighter + kFlare) / (darker + kFlare);
}

double contrast_ratio(const Rgb& color, const Background& background) noexcept {
  return std::min(contrast_ratio(color, background.top), contrast_ratio(color, background.bottom));
}

bool Background::is_light() const noexcept {
  return contrast_ratio(palpate::kLight.ink, *this) > contrast_ratio(palpate::kDark.ink, *this);
}

Palette palette_of(const Background& background) noexcept {
  Palette colors = background.is_light() ? kLight : kDark;
  if (background == colors.background) return colors;
  // As far from the background as in the palette it is taken from, on the way to the ink.
  const Rgb from = 0.5F * (colors.background.top + colors.background.bottom);
  const Rgb to = 0.5F * (background.top + background.bottom);
  for (Rgb* color : {&colors.outline, &colors.plain_line, &colors.tool}) {
    constexpr double kSeen = 2.0;
    constexpr float kNearer = 0.1F;
    float part = (color->g - from.g) / (colors.ink.g - from.g);
    do {
      *color = glm::mix(to, colors.ink, part);
      part += kNearer;
    } while (part < 1.0F && contrast_ratio(*color, background) < kSeen);
  }
  colors.background = background;
  return colors;
}

}  // namespace palpate
