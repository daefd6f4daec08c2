/// The part of the touch panel about cutting planes: their numbers, and what puts them somewhere in one go.
#pragma once

#include <cstddef>
#include <span>
#include <string_view>
#include <vector>

#include "common/hand/probe_session.h"
#include "common/render/camera.h"
#include "common/render/volume/volume_view.h"
#include "common/window/panels/touch_panel.h"

namespace palpate {

/// Draws nothing in modes without planes. @param camera for planes that face the view. @param cuts of the
/// picture, the first ones for the planes: whether they cut.
void edit_planes(ProbeSession& session, const Camera& camera, std::span<CuttingPlane> cuts);
/// Planes that cut and that no hand moves. @param first of them: those before it are the hand's.
/// @pre first <= cuts.size().
void edit_cuts(std::vector<CuttingPlane>& cuts, std::size_t first);
/// What is drawn on planes: the values, their grey levels and lines of equal value.
/// @param histogram of the values, for a window to begin with; may be null.
void edit_plane_images(VolumeView& volume, const ValueHistogram* histogram);
/// Annotations: what the next clicks mark, and a row for each that is there, from three points on with a
/// button for a plane through them.
void edit_notes(ProbeSession& session, VolumeView& volume, bool marking, TouchActions& actions);
/// The numbers of the haptic grid, landmarks at the proxy and at planes that cut, and such planes across its
/// axes at the proxy; draws nothing in other modes. @param cuts of the volume that is shown; may be null.
void edit_grid(TouchChoice& choice, std::string_view mode, const ProbeSession& session,
               std::vector<CuttingPlane>* cuts);

}  // namespace palpate
