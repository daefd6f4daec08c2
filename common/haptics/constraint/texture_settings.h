/// What can be edited of textures that tell of noise. Apart from noise_texture.h, which needs all settings.
#pragma once

#include "common/haptics/transfer_function.h"

namespace palpate {

struct TextureSettings {
  bool by_noise = false;  ///< whether modes of a volume have one; takes effect when the chain is built

  /// Size of its grain [m], by the noise as a part of the range of the values (field/noise_field.h).
  HapticTransferFunction grain{{0.001, 0.0}, {0.02, 0.002}};

  bool operator==(const TextureSettings&) const = default;

  [[nodiscard]] bool valid() const noexcept { return grain.lowest() >= 0.0 && grain.highest() < 1.0; }

  /// See ChainSettings::each().
  template <typename Self, typename Visit>
  static void each(Self& self, Visit&& visit) {
    visit("texture.by_noise", self.by_noise);
    visit("texture.grain", self.grain);
  }
};

}  // namespace palpate
