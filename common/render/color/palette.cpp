#include "common/render/color/palette.h"

namespace palpate {

const Palette& palette_of(Background background) noexcept {
  static constexpr Palette kDark{.top = {0.125F, 0.135F, 0.150F},
                                 .bottom = {0.055F, 0.060F, 0.068F},
                                 .outline = {0.40F, 0.43F, 0.47F},
                                 .plain_line = {0.80F, 0.83F, 0.88F},
                                 .ink = {0.96F, 0.97F, 0.98F},
                                 .tool = {0.62F, 0.66F, 0.72F},
                                 .proxy = {0.98F, 0.36F, 0.68F},
                                 .highlight = 0.42F,
                                 .fading = 0.52F};
  static constexpr Palette kLight{.top = {1.0F, 1.0F, 1.0F},
                                  .bottom = {0.955F, 0.960F, 0.968F},
                                  .outline = {0.62F, 0.65F, 0.69F},
                                  .plain_line = {0.32F, 0.36F, 0.42F},
                                  .ink = {0.16F, 0.18F, 0.21F},
                                  .tool = {0.45F, 0.48F, 0.53F},
                                  .proxy = {0.86F, 0.16F, 0.54F},
                                  .highlight = 0.10F,
                                  .fading = 0.55F};
  return background == Background::kDark ? kDark : kLight;
}

}  // namespace palpate
