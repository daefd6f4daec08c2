/// The part of the touch panel about cutting planes: their numbers, and what puts them somewhere in one go.
#pragma once

#include <string_view>

#include "common/app/haptic/probe_session.h"
#include "common/app/window/touch_panel.h"
#include "common/render/camera.h"

namespace palpate {

/// Draws nothing in modes without planes. @param camera for planes that face the view.
void edit_planes(ProbeSession& session, const Camera& camera);
/// The numbers of the haptic grid, and landmarks at the proxy; draws nothing in other modes.
/// Annotations: what the next clicks mark, and a row for each that is there.
void edit_notes(AnnotationList& notes, bool marking, TouchActions& actions);
void edit_grid(TouchChoice& choice, std::string_view mode, const ProbeSession& session);

}  // namespace palpate
