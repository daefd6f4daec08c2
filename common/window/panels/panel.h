/// The panel at the left of the window, and the layout of its parts.
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "common/compose/window_model.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/window/controls/brush_control.h"
#include "common/window/controls/seed_choice.h"
#include "common/window/controls/tract_pick_control.h"
#include "common/window/controls/view_control.h"
#include "common/window/panels/message_log.h"
#include "common/window/panels/series_panel.h"
#include "common/window/panels/setting_search.h"
#include "common/window/panels/touch_panel.h"
#include "common/window/panels/volume/region_panel.h"
#include "common/window/panels/volume/transfer_panel.h"
#include "common/window/picture/live_picture.h"

namespace palpate {

/// What panel and status line show and change.
struct PanelState {
  const SceneState* scene = nullptr;  ///< null until the first one is there
  const Progress* job = nullptr;      ///< null while none runs
  Document document;                  ///< edited
  SeedChoice seeds;                   ///< edited; goes into the document
  PictureFigures picture;             ///< of the picture that was drawn
  std::string message;
  std::string aside;  ///< news that no act asked for, shown after `message` until the next one
  /// What went wrong last, until it is closed or what it was of goes well; empty: nothing.
  std::string error;
  bool error_of_job = false;           ///< of what was read or made
  std::set<std::string> closed_notes;  ///< of the scene, that are no banners any more
  bool show_help = false;
  bool show_panel = true;  ///< else the picture has its place
  MessageLog log;          ///< of all that was said
  SettingSearch search;
  bool show_rates = false;
  std::vector<std::pair<std::string, std::string>> head_rows;  ///< of a tracked head, told with the rates
  bool playing = false;
  double play_rate = 0.0;            ///< time steps a second
  std::string plotted;               ///< edited; empty: nothing
  bool keep_steps = false;           ///< edited: those that were read for the plot stay in memory
  std::optional<SeriesPlot> series;  ///< none where nothing is plotted
  RegionControl* region = nullptr;   ///< of a volume
  BrushControl* brush = nullptr;     ///< on slices
  TractPickControl* tract_pick = nullptr;
  std::vector<NoteView> marks;    ///< that panels put into the picture of this frame
  ProbeSession* touch = nullptr;  ///< null or not available(): no such part
  bool grabbed = false;
  bool marking = false;                                                  ///< clicks mark places
  std::optional<TensorPick> tensor;                                      ///< under the mouse
  std::vector<InputFiles> recent;                                        ///< newest first
  std::string replay_verdict;                                            ///< that was said
  std::string lines_file = "followed.vtp";                               ///< edited
  std::string fixture;                                                   ///< that is being typed
  std::string transfer_file = "transfer.csv", focus_file = "focus.csv";  ///< edited
  CachedHistogram histogram;                                             ///< of the volume

  /// The line at the bottom.
  void say(std::string words) {
    log.add(words, false);
    aside.clear();
    message = std::move(words);
  }
  /// After the line at the bottom, which may be an answer that was not read yet.
  void add(std::string words) {
    log.add(words, false);
    aside = std::move(words);
  }
  /// A banner over the picture.
  void fail(std::string words, bool of_job = false) {
    log.add(words, true);
    message.clear();
    error = std::move(words);
    error_of_job = of_job;
  }
};

/// What the user asked for in this frame.
struct PanelActions {
  bool cancel = false;
  bool reset_camera = false;
  std::optional<Command> look;  ///< along an axis
  bool save_picture = false;
  bool export_picture = false;
  bool ask_to_open = false;
  bool save_session = false;
  std::optional<InputFiles> open;  ///< one of the recent inputs
  bool save_transfer = false;      ///< that of the context to PanelState::transfer_file
  bool save_focus = false;         ///< that of new lenses to PanelState::focus_file
  std::optional<double> time;      ///< of the step nearest to it
  TouchActions touch;
  RegionActions region;
  std::optional<std::size_t> lens;  ///< that the mouse is to move
};

/// What a part of the panel shows and changes.
struct PanelContext {
  PanelState& state;
  const SceneState& scene;
  SceneView& view;
  PanelActions& actions;
  const PictureArea& picture;  ///< where the scene is drawn
};

/// A part of the panel that a program puts between those that all have: heading and controls. It draws nothing
/// where it has nothing to show.
using PanelPart = std::function<void(PanelContext&)>;

/// Parts of the window [pixels].
struct WindowLayout {
  double panel_width = 0.0;
  double status_height = 0.0;
  PictureArea picture;
};

/// @param panel whether it is shown.
[[nodiscard]] WindowLayout layout(int width, int height, float text_height, bool panel = true);

/// Draws all of it; changes `view` (style, what is shown, projection) and `state`.
/// @param parts the program's, below input and touch.
[[nodiscard]] PanelActions draw_panels(std::span<const PanelPart> parts, PanelState& state, SceneView& view,
                                       const WindowLayout& layout);

}  // namespace palpate
