/// What a workbench's screens show, from options: pictures of a screen as a head before it sees it, and the
/// display of a window.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/hand/probe_session.h"
#include "common/hand/technique/probe_mouse.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/render/scene_view.h"
#include "common/scene/document/document.h"

namespace palpate {

/// A screen as a head before it sees it. Metres in the tracker's frame.
struct SeenScreen {
  Screen corners;
  Eyes eyes{};
  InteractionGeometry place;
};

/// A picture that is asked for: of no screen, or of one of a workbench's.
struct ScreenPicture {
  std::string name;  ///< put behind that of the file where there are several: "-front", "-2"
  PictureSize size;
  StereoView stereo;
  std::optional<SeenScreen> screen;
};

/// All pictures that `render` makes: one, or with `--screen all` one for each screen. Refuses what can be
/// refused before data is read: a head without a workbench with a screen, a pose that is none, a head behind
/// a screen, a picture of another shape than its screen's.
/// @throws Error.
[[nodiscard]] std::vector<ScreenPicture> asked_pictures(const Document& options);

/// Puts the camera before the picture's screen, with the eyes of the head: the middle of `view.bounds` is
/// shown at [interaction] middle, turned by its rotation, `gain` metres of the workspace for a metre there
/// (InteractionGeometry). Nothing where the picture is of no screen.
void take_head(const ScreenPicture& picture, SceneView& view);

/// The display of a window: none where neither `--head` nor the workbench's [head] names a head to be
/// followed. @param touch with the hands of `--device`, recorded or live, for the head "hands".
/// @throws Error (usage), (bad input).
[[nodiscard]] std::optional<WorkbenchDisplayOptions> workbench_display_of(const Document& options,
                                                                          const ProbeSessionOptions& touch);

}  // namespace palpate
