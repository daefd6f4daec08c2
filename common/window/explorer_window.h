/// The window of an explorer while it is open: what window.h runs. It joins the parts that have one job each:
/// SceneJobs (what is read and made), SceneControls (mouse, keys and hands in the picture), PanelState and
/// draw_panels(), LivePicture, WindowFiles, ProbeSession.
/// - explorer_window.cpp   the loop: waits, injected events, closing
/// - window_scene.cpp      what is open: what the outcome of a job changes, its time steps
/// - window_frame.cpp      one frame: follows the hand, composes the picture, draws it
/// - window_input.cpp      what mouse, keys and panels ask for; taking it back
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
#include "common/base/history.h"
#include "common/hand/probe_session.h"
#include "common/hand/workbench/workbench_display.h"
#include "common/render/png.h"
#include "common/window/controls/scene_controls.h"
#include "common/window/files/thumbnails.h"
#include "common/window/files/window_files.h"
#include "common/window/glfw_window.h"
#include "common/window/gui.h"
#include "common/window/hand_news.h"
#include "common/window/immersive/screen_windows.h"
#include "common/window/keys.h"
#include "common/window/live_picture.h"
#include "common/window/pane_pictures.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/probe_plot.h"
#include "common/window/panels/start_page.h"
#include "common/window/scene_jobs.h"
#include "common/window/shown_scene.h"
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
  /// What edits are of: the document but for the camera, whose moves are none, and what the hand has made.
  struct Edited {
    Document document;
    HandMade made;
    ViewEdits view;

    bool operator==(const Edited& other) const { return document == other.document && made == other.made; }
  };
  /// Rest between two looks at the world while nothing happens [s].
  static constexpr double kIdleRest = 0.25;

  /// @name The loop
  /// @{
  [[nodiscard]] bool scripted() const { return options_.frames > 0; }
  void wait_for_events();
  [[nodiscard]] bool lively() const;
  /// Whether the window is to be closed, and nothing is lost by that or the user has said so.
  [[nodiscard]] bool closes();
  void inject(int frame);
  /// What a replayed recording says that mouse and keys did. It saves nothing again and does not close the
  /// window.
  void inject_replayed();
  /// The whole window, as it stands in the framebuffer that is about to be shown.
  void save_screenshot();
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
  void put_region(const std::string& box);
  /// The picture that is shown becomes that of the data on the start page.
  void keep_thumbnail();
  void adopt(SceneState scene);
  /// The hand feels what the lines show.
  void adopt_field();
  void fail(const std::exception_ptr& error);
  [[nodiscard]] bool has_times() const { return scene_ && scene_->info->times.size() > 1; }
  void play();
  /// To the step whose time comes next, and round from the last to the first.
  void step_in_time(bool on);
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
  /// The volume is cut where the hand has put the planes. They begin where it is cut already.
  void cut_volume();
  /// The view with the lines stepping back while a hand is on the probe, and where lines are kept or
  /// isosurfaces felt, which they would bury.
  [[nodiscard]] SceneView with_focus();
  void draw_picture(SceneView picture, int width, int height);
  /// Finds the pane of the scene itself in the picture.
  void place_picture();
  /// How the picture is divided.
  [[nodiscard]] std::vector<Pane> panes() const;
  /// A pointer is seen by both eyes where it is in both halves, at the same place.
  void draw_second_pointer() const;
  /// @}

  /// @name Mouse, keys and panels
  /// @{
  /// Those of this frame; others stay for the next one.
  [[nodiscard]] std::vector<InputEvent> take_events();
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
  /// Gives a setting its default, whose control cannot do so itself.
  void reset_setting(const std::string& name);
  void export_picture(const std::filesystem::path& file);
  /// Says what became of a picture that was exported.
  void follow_export();
  void run_command(Command command);
  void toggle_volume();
  void say(const std::optional<std::string>& words) {
    if (words) state_.say(*words);
  }
  /// Of everything that is being dragged, moved or played.
  void let_go();
  void work_in_space();
  /// What mouse, hand and panels did to the picture goes into the document, and what the user did into its
  /// history: a drag as one edit.
  void keep_document();
  void follow_edits();
  [[nodiscard]] Edited edited() const;
  /// Something goes on that is one edit when it ends.
  [[nodiscard]] bool dragging() const;
  /// Takes back the last edit, or restores the last that was taken back; what goes on is an edit up to now.
  /// @return what to tell the user.
  std::string undo();
  std::string redo();
  /// Shows `to` in place of what is shown, from where it is seen now.
  void restore(const Edited& to);
  [[nodiscard]] std::vector<PngText> picture_texts() const;
  /// All panes of it.
  [[nodiscard]] Image whole_picture();
  /// @}

  WindowModel& model_;
  const WindowOptions& options_;
  SceneJobs jobs_;   // uses nothing below it
  GlfwWindow glfw_;  // first in, last out: the others need its context
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<LivePicture> live_;
  std::unique_ptr<Thumbnails> thumbnails_;
  std::unique_ptr<PanePictures> slices_;  // beside it; none until they are asked for

  SceneView view_;       // as the user wants it
  PictureArea panes_;    // all of the picture
  PictureArea picture_;  // the pane of the scene itself
  bool needs_camera_ = true;
  std::optional<Vec3> focal_point_;  ///< of the first camera
  CameraAngles angles_;              ///< of that, and of a reset
  std::optional<SceneState> scene_;
  bool shown_ = false;  // there was one
  PanelState state_;
  SceneView kept_;                          // that the document was kept of last
  std::optional<History<Edited>> history_;  // from the first picture of an input on
  PlanePoses cut_planes_;                   // those of the hand for which the first cuts stand
  bool leave_ = false;                      // what is not saved is to be forgotten, or was saved
  StartPage start_page_;
  bool start_asked_ = false;  // though something is open
  int frame_ = 0, lively_frames_ = 3;
  std::vector<std::string> missing_;  // controls that a script named
  Stopwatch since_step_;              // in time
  ProbePlot plot_;
  HandNews news_;
  ProbeSession touch_;
  SceneControls controls_;
  WindowFiles files_;
  std::unique_ptr<WorkbenchDisplay> workbench_;
  std::unique_ptr<ScreenWindows> screens_;  // each beside that of the desktop
};

}  // namespace palpate
