/// The part of the touch panel about transfer functions: what mode `linear` does along each axis, how the
/// drag of mode `density` follows the value, how the hold across tracts follows the anisotropy, and how the
/// grain of a texture follows the noise.
#pragma once

#include <string_view>

#include "common/hand/probe_session.h"

namespace palpate {

/// Edits choice.settings where `mode` has such functions; draws nothing for other modes.
void edit_curves(TouchChoice& choice, std::string_view mode, const ProbeSession& session);

/// Edits `settings` in modes that have a texture by noise; draws nothing for other modes.
void edit_texture(TextureSettings& settings, const HapticMode& mode, const ProbeSession& session);

}  // namespace palpate
