/// The texture that tells of noise, at the end of the chain of a mode.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/constraint/isosurface.h"
#include "common/haptics/constraint/link_settings.h"

namespace palpate {

/// Appends a texture by the noise of scene.scalar to `links` where scene.settings.texture asks for one.
/// @param surface as of NoiseTexture.
/// @return that noise; null where nothing was appended, as for scalars on other than box grids.
[[nodiscard]] std::shared_ptr<const ScalarField> add_texture(std::vector<std::unique_ptr<Constraint>>& links,
                                                             const HapticScene& scene,
                                                             const IsosurfaceConstraint* surface = nullptr);

/// A chain of `link` alone, or with a texture.
[[nodiscard]] HapticChain textured_chain(std::unique_ptr<Constraint> link, const HapticScene& scene);

/// What `--noise-texture` says: "off", "on", or the curve of the grain [mm].
/// @throws Error (usage) that says what is expected.
[[nodiscard]] TextureSettings texture_settings(const std::string& text);
/// The inverse of texture_settings().
[[nodiscard]] std::string texture_text(const TextureSettings& settings);

}  // namespace palpate
