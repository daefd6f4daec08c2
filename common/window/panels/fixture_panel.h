/// The part of the panel about fixtures: the list of them, how they hold, carry and rub, viscosity, and the
/// vibrations that tell of events.
#pragma once

#include <string>

#include "common/hand/probe_session.h"

namespace palpate {

/// Folded until something of it is in use: few hands need it.
/// @param typed the fixture that is being typed, and is not in the list yet.
void draw_fixture_panel(ProbeSession& session, std::string& typed);

}  // namespace palpate
