/// The window of an explorer while it is open: what window.h runs. Its parts stand in files by what they do:
/// - explorer_window.cpp   the loop: waits, injected events, closing
/// - window_scene.cpp      what is open: its jobs, what their outcomes change, its time steps
/// - window_frame.cpp      one frame: follows the hand, composes the picture, draws it
/// - window_input.cpp      what mouse, keys and panels ask for; taking it back
/// - window_files.cpp      what is written on request, and asked before it would be lost
#pragma once

#include <cstdint>
#include <exception>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/base/clock.h"
#include "common/hand/bench/bench_display.h"
#include "common/hand/probe_session.h"
#include "common/hand/technique/view_hold.h"
#include "common/render/png.h"
#include "common/window/background_job.h"
#include "common/window/controls/color_lens_control.h"
#include "common/window/controls/lens_control.h"
#include "common/window/controls/plane_image_control.h"
#include "common/window/controls/pointer.h"
#include "common/window/controls/region_control.h"
#include "common/window/controls/slice_control.h"
#include "common/window/controls/touch_control.h"
#include "common/window/controls/view_control.h"
#include "common/window/controls/view_edits.h"
#include "common/window/glfw_window.h"
#include "common/window/gui.h"
#include "common/window/immersive/hand_in_space.h"
#include "common/window/immersive/menu_control.h"
#include "common/window/immersive/screen_windows.h"
#include "common/window/keys.h"
#include "common/window/live_picture.h"
#include "common/window/panels/panel.h"
#include "common/window/panels/probe_plot.h"
#include "common/window/panels/unsaved_question.h"
#include "common/window/saved_files.h"
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
  enum class JobKind : std::uint8_t { kStart, kOpen, kUpdate };
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
  void say(const std::string& message, bool is_error);
  /// The whole window, as it stands in the framebuffer that is about to be shown.
  void save_screenshot();
  /// @}

  /// @name What is open
  /// @{
  /// Reading begins before there is a window, which takes its own while.
  static std::unique_ptr<BackgroundJob> start_model(WindowModel& model);
  void start_job(JobKind kind, BackgroundJob::Work work);
  void take_outcome();
  void adopt(SceneState scene);
  /// The hand feels what the lines show.
  void adopt_field();
  void fail(const std::exception_ptr& error);
  /// A slow job whose answer is no longer wanted makes way for the next.
  void give_way();
  /// Of an update: its progress is shown. One that comes and goes would move the panel under the mouse with
  /// each step of a series that plays, which "Stop" ends.
  [[nodiscard]] bool is_slow() const;
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
  /// Where the head is, and which part of its screen the picture is.
  void look();
  void reset_camera();
  /// The camera of what is seen where the mouse points.
  [[nodiscard]] Camera seeing() const;
  /// What the panels show.
  void tell_panels();
  /// The view shows what hand and planes have done.
  void follow_hand();
  /// Says what has happened to hand and device.
  void tell_news();
  /// The volume is cut where the hand has put the planes. They begin where it is cut already.
  void cut_volume();
  /// The hand on a haptic grid takes hold of the faces of the region of interest, or else of the view.
  void lead_by_grid();
  /// The place under the mouse that is the next one of an annotation which is begun; none where none is.
  [[nodiscard]] std::optional<Vec3> next_mark() const;
  /// The view with the lines stepping back while a hand is on the probe, and where lines are kept or
  /// isosurfaces felt, which they would bury.
  [[nodiscard]] SceneView with_focus() const;
  void draw_picture(SceneView picture, const WindowLayout& parts, int width, int height);
  /// A pointer is seen by both eyes where it is in both halves, at the same place.
  void draw_second_pointer() const;
  /// @}

  /// @name Mouse, keys and panels
  /// @{
  /// Those of this frame; others stay for the next one.
  [[nodiscard]] std::vector<InputEvent> take_events();
  /// Panels first: what happens over them is not for the camera.
  void handle_events(const std::vector<InputEvent>& events);
  /// While the probe is grabbed the mouse is its own.
  bool handle_region(const InputEvent& event, const PictureArea& area);
  bool handle_plane_image(const InputEvent& event, const PictureArea& area);
  bool handle_lens(const InputEvent& event, const PictureArea& area);
  /// Whether a volume is all that is looked at, and may be cropped: that of tensors is made of them, that of
  /// a flow has lines in it.
  [[nodiscard]] bool has_region() const { return view_.volume && scene_ && scene_->is_volume_alone(); }
  void obey(const PanelActions& actions);
  void run_command(Command command);
  void run_lens(Command command);
  void run_touch(Command command);
  /// Of everything that is being dragged, moved or played.
  void let_go();
  void put_corner();
  /// What a stylus or a device does to the menu and picks in the scene, and what was done to the menu.
  void work_in_space();
  void toggle_menu();
  [[nodiscard]] EditedView edited_view() const;
  /// Remembers what is edited in the view, a drag as one edit.
  void follow_edits();
  /// Takes back the last edit of the view, if that came after all that the hand has done to planes.
  bool undo_view_edit();
  /// @}

  /// @name Files
  /// @{
  void open(const InputFiles& files);
  /// Asks what to do with lines and tracts that are in no file; false where there are none.
  bool asked_about(std::optional<InputFiles> opens);
  void answer_question();
  /// Says what was saved, or why it was not; whether it was.
  bool attempt(const std::function<std::filesystem::path()>& save);
  std::filesystem::path save_lines();
  /// The files that the panels have a button for.
  void save_asked(const PanelActions& actions);
  /// What a session holds beside the scene and its view.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> set_options() const;
  [[nodiscard]] std::vector<PngText> picture_texts() const;
  /// @}

  WindowModel& model_;
  const WindowOptions& options_;
  std::unique_ptr<BackgroundJob> job_;  // uses nothing below it
  JobKind job_kind_ = JobKind::kStart;
  SavedFiles files_;
  GlfwWindow glfw_;  // first in, last out: the others need its context
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<LivePicture> live_;

  SceneView view_;  // as the user wants it
  PictureArea picture_;
  Pointer pointer_;
  MenuControl menu_;
  HandInSpace hand_in_space_;
  bool needs_camera_ = true;
  std::optional<SceneState> scene_;
  PanelState state_;
  SceneSettings requested_;  // of the last job
  ViewControl control_;
  SliceControl slice_control_;
  LensControl lens_control_;
  ColorLensControl color_lens_control_;
  PlaneImageControl plane_image_control_;
  RegionControl region_control_;
  std::optional<Vec3> focal_point_;  ///< of the first camera
  ViewHold view_hold_;
  ViewEdits view_edits_;
  PlanePoses cut_planes_;  // those of the hand for which the first cuts stand
  std::optional<InputFiles> to_open_;
  UnsavedQuestion question_;
  bool leave_ = false;  // what is not saved is to be forgotten, or was saved
  int frame_ = 0, lively_frames_ = 3;
  Stopwatch since_step_;  // in time
  ProbePlot plot_;
  std::string told_fault_, told_device_;
  int told_popped_ = 0;
  std::unique_ptr<ProbeSession> touch_;
  std::unique_ptr<TouchControl> touch_control_;
  std::unique_ptr<BenchDisplay> bench_;
  std::unique_ptr<ScreenWindows> screens_;  // each beside that of the desktop
};

}  // namespace palpate
