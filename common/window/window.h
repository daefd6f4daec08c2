/// The window of an explorer: the picture, a panel, mouse and keys.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/compose/window_model.h"
#include "common/hand/probe_series.h"
#include "common/hand/probe_session.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/render/budget/frame_quality.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/scene_view.h"
#include "common/render/tensor/tensor_view.h"
#include "common/window/files/thumbnails.h"
#include "common/window/input_event.h"
#include "common/window/panels/panel.h"

namespace palpate {

/// [ms], where no other is asked for. What the hand does is seen after one and a half frames in the mean, two at most: with
/// panels and display that keeps 95 % of turning under 60 ms (tests/bench/window_latency_bench.cpp).
inline constexpr double kFrameBudget = 28.0;
inline constexpr double kPlayRate = 5.0;  ///< [1/s], likewise

struct WindowOptions {
  std::string program = "palpate";  ///< in the title bar
  int width = 1440;                 ///< [screen coordinates]
  int height = 900;
  /// Style, background and what is shown at the start; its lines, bounds and camera are set by the scene.
  SceneView view;
  double frame_budget = kFrameBudget;          ///< [ms] that a picture may take while something moves
  CameraAngles angles;                         ///< the first view, and that of a reset
  std::optional<Vec3> focal_point;             ///< of the first view; none: the middle of what is shown
  std::string command_line;                    ///< for the text of saved pictures
  std::string version;                         ///< version_text() (common/base/version.h), likewise
  FieldKind kind = FieldKind::kVector;         ///< of the fields that the program shows
  bool start_page = false;                     ///< in place of what the model was made for
  std::filesystem::path session;               ///< that Ctrl+S saves to; empty: it asks
  std::vector<InputFiles> recent;              ///< offered for opening, newest first
  std::filesystem::path picture_folder = ".";  ///< where "Save picture" and "Save lines" write
  /// Shows the data as a screen of a workbench does to the head before it; none: a desktop.
  std::optional<WorkbenchDisplayOptions> workbench;
  ProbeSessionOptions touch;         ///< without modes: the window knows no touch
  std::vector<PanelPart> panels;     ///< the program's parts of the panel, from above
  std::optional<Box> region;         ///< of interest, in a volume
  std::string plotted;               ///< one of SceneInfo::plotted, or empty
  double play_rate = kPlayRate;      ///< time steps a second
  int threads = 0;                   ///< of what is read beside the picture; 0: all cores
  std::filesystem::path thumbnails;  ///< where small pictures of inputs are kept; empty: nowhere
  DrawExample draw_example;          ///< for those of examples; may be empty
  /// Asked a few times a second; true closes the window (Ctrl-C in the terminal).
  std::function<bool()> stop_requested;

  /// @name For tests and demonstrations
  /// @{
  /// Events put in at their frame as if they came from mouse and keyboard. Frames are counted from the
  /// moment when the first scene is shown, or the start page.
  std::vector<ScriptedEvent> script;
  int frames = 0;           ///< > 0: closes after that many frames
  bool frames_wait = true;  ///< for background jobs; else they are counted while these run, too
  double patience = 0.0;    ///< [s] for which frames are not counted while a control of `script` is to come
  std::filesystem::path screenshot;  ///< picture of the whole window, panel and all, at the end
  bool hidden = false;               ///< never shown on the screen
  /// @}
};

/// What happened, for tests.
struct WindowResult {
  int frames = 0;      ///< drawn since the first scene was shown, or the start page
  bool shown = false;  ///< there was a scene, of which `document` is
  int width = 0;       ///< at the end, before a full screen [screen coordinates]
  int height = 0;
  std::vector<InputFiles> recent;  ///< with what was opened in this window
  SceneView view;                  ///< at the end
  Document document;               ///< at the end
  std::string log;                 ///< all that it said, a line each
  std::string message;             ///< last line that the window said to the user
  double median_frame_ms = 0.0;
  FrameQuality quality;        ///< of the last picture
  std::string tables_by;       ///< SceneRenderer::tables_by(), at the end
  std::vector<GpuObject> gpu;  ///< what its context holds at the end; without labels those of the panels
  std::optional<Box> region;   ///< at the end
  ProbeReadout probe;          ///< at the end
  std::optional<TensorPick> tensor;  ///< that is read out under the mouse at the end
  std::string replay;                ///< verdict on a replay that came to its end
  SeriesCurve series;                ///< that was plotted at the end
  std::vector<std::string> missing;  ///< labels of controls that the script named and no panel had
  std::vector<Image> screens;        ///< of a workbench, each in a window of its own, at the end
  double latency = 0.0;              ///< WorkbenchDisplay::latency()
};

/// Whether a window can be opened at all (a display is there).
[[nodiscard]] bool window_available();

/// Shows the window until it is closed. Call it on the main thread.
/// @throws Error (work failed) where no window can be opened, and whatever WindowModel::start() throws.
WindowResult run_window(WindowModel& model, const WindowOptions& options);

/// The same, of the size in which the user left it the last time (user_settings.h), for the next time to come.
/// @param given the document at the start: what the user changes of it may be a preference.
/// @param note told in a sentence what of the user's files cannot be written.
/// @throws Error as run_window().
WindowResult run_user_window(WindowModel& model, WindowOptions options, const Document& given,
                             const std::function<void(const std::string&)>& note);

/// Takes into `document` what the user of a program prefers, where nothing else was asked for.
/// @param note told in a sentence what of the user's files cannot be read.
void prefer(const std::string& program, Document& document,
            const std::function<void(const std::string&)>& note);

}  // namespace palpate
