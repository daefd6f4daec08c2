/// The part of the touch panel about fixtures: the list of them, how they hold, carry and rub, viscosity, and the
/// vibrations that tell of events.
#pragma once

#include <string>

#include "common/hand/probe_session.h"

namespace palpate {

/// Edits choice.fixtures and what of choice.settings concerns them.
/// @param typed the fixture that is being typed, and is not in the list yet.
void edit_fixtures(TouchChoice& choice, const ProbeSession& session, std::string& typed);

}  // namespace palpate
