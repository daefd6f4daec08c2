/// The window of an explorer while it is open: what window.h runs. It joins the parts that have one job each:
/// SceneJobs (what is read and made), SceneControls (mouse, keys and hands in the picture), PanelState and
/// draw_panels(), WindowPicture, EditHistory, WindowFiles, ProbeSession.
/// - explorer_window.cpp   the loop: waits, closing
/// - window_scene.cpp      what is open: what the outcome of a job changes, its time steps
/// - window_frame.cpp      one frame: follows the hand, composes the picture, draws it
/// - window_input.cpp      what mouse, keys and panels ask for
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/hand/probe_session.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/render/png.h"
#include "common/window/controls/plane_cuts.h"
#include "common/window/controls/scene_controls.h"
#include "common/window/controls/slice_control.h"
#include "common/window/edit_history.h"
#include "common/window/files/thumbnails.h"
#include "common/window/files/window_files.h"
#include "common/window/glfw_window.h"
#include "common/window/gui.h"
#include "common/window/hand_news.h"
#include "common/window/immersive/screen_windows.h"
#include "common/window/keys.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/probe_plot.h"
#include "common/window/panels/series_choice.h"
#include "common/window/panels/start_page.h"
#include "common/window/picture/window_picture.h"
#include "common/window/scene_jobs.h"
#include "common/window/time_play.h"
#include "common/window/window.h"

namespace palpate {

/// Lives on the main thread; `model` and `options` outlive it.
class ExplorerWindow {
 public:
  /// @throws Error (work failed) where no window can be opened.
  ExplorerWindow(WindowModel& model, const WindowOptions& options);

  /// Shows it until it is closed. @throws what WindowModel::start() throws.
  WindowResult run();

 private:
  /// Rest between two looks at the world while nothing happens [s].
  static constexpr double kIdleRest = 0.25;

  /// @name The loop
  /// @{
  [[nodiscard]] bool scripted() const { return options_.frames > 0; }
  void wait_for_events();
  [[nodiscard]] bool lively() const;
  /// Whether this frame is one of those that the script counts.
  [[nodiscard]] bool counts();
  /// Whether the window is to be closed, and nothing is lost by that or the user has said so.
  [[nodiscard]] bool closes();
  /// @}

  /// @name What is open
  /// @{
  void take_outcome();
  /// What was of places and values of the input that was open.
  void forget_input();
  /// The start page is shown: nothing is open, or the user asked for it.
  [[nodiscard]] bool on_start_page() const { return start_asked_ || (!scene_ && !jobs_.busy()); }
  void close_data();
  /// Shows and feels what a session says besides its scene.
  void restore_session();
  /// The picture that is shown becomes that of the data on the start page.
  void keep_thumbnail();
  void adopt(SceneState scene);
  /// The hand feels what the lines show.
  void adopt_field();
  void fail(const std::exception_ptr& error);
  /// A heart shows the layer that the hand is on, with its fibres.
  void follow_layer();
  /// @}

  /// @name One frame
  /// @{
  void draw_frame(double seconds);
  [[nodiscard]] ControlledScene controlled();
  /// Where the head is, and which part of its screen the picture is.
  void look();
  void reset_camera();
  /// What the panels show.
  void update_panels();
  /// The view shows what hand and planes have done.
  void follow_hand();
  /// The view with the lines stepping back while a hand is on the probe, and where lines are kept or
  /// isosurfaces felt, which they would bury.
  [[nodiscard]] SceneView with_focus();
  void draw_picture(SceneView picture, int width, int height);
  /// @}

  /// @name Mouse, keys and panels
  /// @{
  /// Panels first: what happens over them is not for the camera.
  void handle_events(const std::vector<InputEvent>& events);
  /// Opens files that were dropped or chosen together; tables alone go into what is open.
  void open(const std::vector<std::filesystem::path>& files);
  /// Asks first where something would be lost.
  void leave(const Leaving& leaving);
  void go_on(const Leaving& leaving);
  void obey(const PanelActions& actions);
  /// Questions and dialogs of files.
  void answer_questions();
  void handle_on_start_page(const InputEvent& event);
  [[nodiscard]] PanelActions draw_start_page(const WindowLayout& parts);
  void save_session(bool asks);
  void run_command(Command command);
  void say(const std::optional<std::string>& words) {
    if (words) state_.say(*words);
  }
  /// Of everything that is being dragged, moved or played.
  void let_go();
  void work_in_space();
  [[nodiscard]] std::vector<PngText> picture_texts() const;
  /// @}

  WindowModel& model_;
  const WindowOptions& options_;
  SceneJobs jobs_;   // uses nothing below it
  GlfwWindow glfw_;  // first in, last out: the others need its context
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<WindowPicture> picture_;
  std::unique_ptr<Thumbnails> thumbnails_;

  SceneView view_;  // as the user wants it
  bool needs_camera_ = true;
  std::optional<Vec3> focal_point_;  ///< of the first camera
  CameraAngles angles_;              ///< of that, and of a reset
  std::optional<SceneState> scene_;
  bool shown_ = false;  // there was one
  PanelState state_;
  CrosshairLink crosshair_;
  bool leave_ = false;  // what is not saved is to be forgotten, or was saved
  StartPage start_page_;
  SeriesChoice series_choice_;
  bool start_asked_ = false;  // though something is open
  int frame_ = 0, lively_frames_ = 3;
  std::optional<Stopwatch> awaiting_;  // a control that the script names
  std::vector<std::string> missing_;   // controls that a script named
  TimePlay time_;
  ProbePlot plot_;
  HandNews news_;
  ProbeSession touch_;
  SceneControls controls_;
  PlaneCuts cuts_;
  EditHistory edits_;
  WindowFiles files_;
  std::unique_ptr<WorkbenchDisplay> workbench_;
  std::unique_ptr<ScreenWindows> screens_;  // each beside that of the desktop
};

}  // namespace palpate
