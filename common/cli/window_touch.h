/// Touch in an explorer's window: from options to a session, and what is said of it at the end.
#pragma once

#include <vector>

#include "common/cli/explorer.h"
#include "common/hand/probe_session.h"
#include "common/hand/window_request.h"
#include "common/scene/document/document.h"

namespace palpate {

/// What the hand feels in the window, and where it is recorded or comes from. Says on stderr what a simulated
/// device is and what of a recording's inputs has changed.
/// @param modes the program's, the default one first.
/// @throws Error (usage), (bad input) for a path or recording that cannot be read.
[[nodiscard]] ProbeSessionOptions window_touch(std::vector<HapticMode> modes, const Document& options,
                                               const VerbContext& context);

/// When the window is closed: how the servo did, in a row a line, or as JSON.
void tell_of_touch(const WindowOutcome& outcome, const VerbContext& context);

}  // namespace palpate
