/// The part of the touch panel about transfer functions: what mode `linear` does along each axis, how the
/// drag of mode `density` follows the value, and how the hold across tracts follows the anisotropy.
#pragma once

#include <string_view>

#include "common/app/haptic/probe_session.h"

namespace palpate {

/// Edits choice.settings where `mode` has such functions; draws nothing for other modes.
void edit_curves(TouchChoice& choice, std::string_view mode, const ProbeSession& session);

}  // namespace palpate
