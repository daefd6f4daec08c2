/// The part of the panel about touch, and the read-out of the probe over the picture.
#pragma once

#include <string>

#include "common/hand/probe_session.h"
#include "common/render/scene_view.h"

namespace palpate {

class ReadoutRows;

/// What the user asked for in this frame.
struct TouchActions {
  bool grab = false;  ///< or let go
  bool keep = false;
  bool undo = false;
  bool save_lines = false;
  bool mark = false;       ///< clicks into the picture mark places, or no longer do
  std::string save_notes;  ///< ending of the file; empty: they are not saved
};

/// What a hand does, in sight at any height of the window: grab, take the force off, keep, undo. @param grabbed the probe is grabbed, or the next click grabs it.
[[nodiscard]] TouchActions draw_acts(ProbeSession& session, bool grabbed);

/// Changes the session's choice and its kept lines, and adds to what the user asked for.
/// @param file where the kept lines go, edited. @param view whose camera planes face, and whose cuts they are.
/// @param marking clicks mark places.
void draw_touch_panel(ProbeSession& session, std::string& file, SceneView& view, bool marking,
                      TouchActions& actions);

/// The settings of forces: folded until they are changed, the probe is grabbed, or a device leads it.
void draw_force_panel(ProbeSession& session, bool grabbed);

/// A small window with its upper left corner at `left`, `top` [pixels], while a hand is on the probe.
/// @param histogram of the scalar that is felt, to tell the place of its value in it; may be null.
/// @return its height; 0 where there is none.
float draw_probe_readout(const ProbeSession& session, const ValueHistogram* histogram, float left, float top);

/// The servo's rows of the rates.
void add_servo_rates(const ProbeSession& session, ReadoutRows& rows);

}  // namespace palpate
