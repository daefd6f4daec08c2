#include "common/app/window/window.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <tuple>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/app/haptic/probe_picture.h"
#include "common/app/haptic/view_hold.h"
#include "common/app/window/background_job.h"
#include "common/app/window/color_lens_control.h"
#include "common/app/window/event_text.h"
#include "common/app/window/glfw_window.h"
#include "common/app/window/gui.h"
#include "common/app/window/keys.h"
#include "common/app/window/lens_control.h"
#include "common/app/window/live_picture.h"
#include "common/app/window/menu_control.h"
#include "common/app/window/panel.h"
#include "common/app/window/plane_control.h"
#include "common/app/window/plane_image_control.h"
#include "common/app/window/pointer.h"
#include "common/app/window/probe_plot.h"
#include "common/app/window/region_control.h"
#include "common/app/window/saved_files.h"
#include "common/app/window/screen_windows.h"
#include "common/app/window/shown_scene.h"
#include "common/app/window/slice_control.h"
#include "common/app/window/touch_control.h"
#include "common/app/window/unsaved_question.h"
#include "common/app/window/user_settings.h"
#include "common/app/window/view_control.h"
#include "common/app/window/view_edits.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/geometry/box_edges.h"
#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/target.h"
#include "common/render/png.h"

namespace palpate {
namespace {

// A job that answers within this time is waited for before the next one starts; a slower one is
// cancelled when the settings change again [s].
constexpr double kPatience = 0.4;
// Rest between two looks at the world while nothing happens [s], while something moves, and while only a job
// runs: without a graphics card each picture of its progress takes processors from it.
constexpr double kIdleRest = 0.25, kBusyRest = 1.0 / 60.0, kJobRest = 0.1;

class Window {
 public:
  Window(WindowModel& model, const WindowOptions& options)
      : model_(model),
        options_(options),
        job_(start_model(model)),
        files_(options.picture_folder, options.program),
        glfw_(options),
        view_(options.view),
        region_control_(options.region),
        focal_point_(options.focal_point) {
    GLFWwindow* const window = glfw_.get();
    glfwSwapInterval(scripted() ? 0 : 1);
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    constexpr float kTextHeight = 14.0F;
    gui_ = std::make_unique<Gui>(window, std::round(kTextHeight * std::max(1.0F, scale)));
    live_ = std::make_unique<LivePicture>(options_.frame_budget);
    touch_ = std::make_unique<ProbeSession>(options_.touch, [] { glfwPostEmptyEvent(); });
    touch_control_ = std::make_unique<TouchControl>(*touch_);
    if (options_.bench) {
      bench_ = std::make_unique<BenchDisplay>(*options_.bench);
      if (options_.bench->several) {
        screens_ = std::make_unique<ScreenWindows>(glfw_, *options_.bench, view_.stereo, options_.hidden);
        // The desktop is one more display, for one eye that rests.
        view_.stereo.mode = StereoMode::kNone;
      }
    }
    state_.touch = touch_.get();
    state_.region = &region_control_;
    state_.recent = options_.recent;
    state_.plotted = options_.plotted;
    state_.play_rate = options_.play_rate;
  }

  WindowResult run() {
    Stopwatch frame_clock;
    while (!closes()) {
      wait_for_events();
      if (options_.stop_requested && options_.stop_requested()) break;
      take_outcome();
      const bool counted = scene_.has_value() && !job_->running();
      if (counted) inject(frame_);
      if (touch_->replaying()) inject_replayed();
      const double seconds = frame_clock.seconds();
      frame_clock.restart();
      draw_frame(seconds);
      if (counted && ++frame_ == options_.frames) {
        if (!options_.screenshot.empty()) save_screenshot();
        break;
      }
      glfwSwapBuffers(glfw_.get());
      if (bench_) bench_->finished(BenchDisplay::now());
    }
    touch_->finish();
    WindowResult result{.frames = frame_,
                        .recent = state_.recent,
                        .view = view_,
                        .settings = state_.settings,
                        .message = state_.message,
                        .region = region_control_.box(),
                        .probe = touch_->readout(),
                        .tensor = state_.tensor,
                        .replay = touch_->replay_verdict(),
                        .series = plot_.curve()};
    if (screens_) result.screens = screens_->read();
    if (bench_) result.latency = bench_->latency();
    std::tie(result.width, result.height) = glfw_.size();
    result.median_frame_ms = live_->median_milliseconds();
    result.gpu = gpu_objects();
    return result;
  }

 private:
  enum class JobKind { kStart, kOpen, kUpdate };

  [[nodiscard]] bool scripted() const { return options_.frames > 0; }

  void wait_for_events() {
    if (scripted() && !job_->running()) {
      glfwPollEvents();
      return;
    }
    // Panels answer to an event one frame later at times: a few frames follow each event at full rate.
    if (live_->complete()) {
      glfwWaitEventsTimeout(lively() ? kBusyRest : job_->running() ? kJobRest : kIdleRest);
    } else {
      glfwPollEvents();  // there is work to do meanwhile: more tracts
    }
    lively_frames_ = glfw_.events().empty() ? std::max(0, lively_frames_ - 1) : 3;
  }

  /// Whether the window is to be closed, and nothing is lost by that or the user has said so.
  [[nodiscard]] bool closes() {
    if (screens_ && screens_->close_asked()) glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
    if (glfwWindowShouldClose(glfw_.get()) == GLFW_FALSE) return false;
    if (leave_ || !asked_about(std::nullopt)) return true;
    glfwSetWindowShouldClose(glfw_.get(), GLFW_FALSE);
    return false;
  }

  /// Asks what to do with lines and tracts that are in no file; false where there are none.
  bool asked_about(std::optional<InputFiles> opens) {
    const std::size_t count =
        files_.unsaved(touch_->kept()) +
        static_cast<std::size_t>(std::ranges::count_if(
            touch_->drawn(), [](const DrawnTract& tract) { return tract.line.points.size() > 1; }));
    if (count == 0 || touch_->replaying()) return false;
    touch_control_->let_go();
    const std::string lines = counted(count, touch_->has_tensors() ? "tract" : "line");
    question_.ask(lines + (count == 1 ? " is" : " are") + " not saved." +
                      (opens ? " Opening another input in place of this one forgets " +
                                   std::string(count == 1 ? "it." : "them.")
                             : " Save before the window closes?"),
                  std::move(opens));
    return true;
  }

  void open(const InputFiles& files) {
    if (!asked_about(files)) to_open_ = files;
  }

  void answer_question() {
    const auto answer = question_.draw();
    if (answer == UnsavedQuestion::Answer::kNone || answer == UnsavedQuestion::Answer::kCancel) return;
    if (answer == UnsavedQuestion::Answer::kSave && !attempt([this] { return save_lines(); })) return;
    if (question_.opens()) {
      to_open_ = question_.opens();
    } else {
      leave_ = true;
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
    }
  }

  [[nodiscard]] bool lively() const {
    return lively_frames_ > 0 || state_.playing || touch_->lively() || (bench_ && bench_->lively());
  }

  void inject(int frame) {
    for (const ScriptedEvent& scripted : options_.script) {
      if (scripted.frame == frame) glfw_.events().push_back(scripted.event);
    }
  }

  /// What a replayed recording says that mouse and keys did. It saves nothing again and does not close the
  /// window.
  void inject_replayed() {
    for (const std::string& text : touch_->due_events()) {
      const auto event = event_from_text(text);
      if (!event) continue;
      const auto command = command_of(*event);
      if (command == Command::kQuit || command == Command::kFullScreen || command == Command::kSavePicture ||
          command == Command::kSaveSession || command == Command::kSaveLines) {
        continue;
      }
      glfw_.events().push_back(*event);
    }
    if (const std::string verdict = touch_->replay_verdict(); verdict != state_.replay_verdict) {
      state_.replay_verdict = verdict;
      say("replay " + verdict, false);
    }
  }

  // Jobs.

  /// Reading begins before there is a window, which takes its own while.
  static std::unique_ptr<BackgroundJob> start_model(WindowModel& model) {
    require_glfw();
    auto job = std::make_unique<BackgroundJob>([] { glfwPostEmptyEvent(); });
    job->start([&model](Progress& progress) { return model.start(progress); });
    return job;
  }

  void start_job(JobKind kind, BackgroundJob::Work work) {
    job_kind_ = kind;
    job_->start(std::move(work));
  }

  void take_outcome() {
    if (auto outcome = job_->take()) {
      if (outcome->scene) {
        adopt(std::move(*outcome->scene));
      } else {
        fail(outcome->error);
      }
      live_->damage();
    }
    if (job_->running()) return;
    if (to_open_) {
      start_job(JobKind::kOpen, [this, files = *std::exchange(to_open_, {})](Progress& progress) {
        return model_.open(files, progress);
      });
    } else if (scene_ && !(state_.settings == requested_)) {
      requested_ = state_.settings;
      start_job(JobKind::kUpdate, [this, settings = requested_](Progress& progress) {
        return model_.update(settings, progress);
      });
    }
  }

  void adopt(SceneState scene) {
    scene_ = std::move(scene);
    if (scene_->joined) {
      job_kind_ = JobKind::kUpdate;
      state_.settings = requested_ = scene_->settings;
    }
    show_scene(*scene_, job_kind_ != JobKind::kUpdate, view_);
    if (job_kind_ != JobKind::kUpdate) {
      plot_.forget();
      menu_.hide();
      if (job_kind_ == JobKind::kOpen) region_control_ = RegionControl();
      view_edits_.forget();
      // Edits made while the input was being read belonged to the old one.
      state_.settings = requested_ = scene_->settings;
      needs_camera_ = true;
      remember(state_.recent, scene_->info->files);
      glfwSetWindowTitle(glfw_.get(), (scene_->info->name + " - " + options_.program).c_str());
    } else {
      // What the panel has been set to meanwhile stays; what was left to a default is now known.
      if (state_.settings == requested_) state_.settings = scene_->settings;
      requested_ = scene_->settings;
    }
    state_.seeds = seed_choice(state_.settings.seeds);
    adopt_field();
    say({}, false);
  }

  /// The hand feels what the lines show.
  void adopt_field() {
    NamedField open{.field = scene_->probed, .name = {}, .scalar = scene_->felt_scalar};
    open.tensor = scene_->tensors ? scene_->tensors->image->field : scene_->felt_tensor;
    if (open.empty() || !touch_->available()) return;
    // The fields of all examples have the same label.
    const SceneInfo& info = *scene_->info;
    std::string label = scene_->settings.field;
    if (info.files.files.empty()) label.insert(0, info.name + " ");
    open.name = field_key(label, scene_->settings.time_step) + scene_->felt_scalar_key;
    if (touch_->set_field(std::move(open))) touch_control_->let_go();
    if (job_kind_ != JobKind::kUpdate)
      state_.lines_file = touch_->has_tensors() ? "tracts.tck" : PanelState{}.lines_file;
    if (!view_.probe) view_.probe.emplace();
    view_.probe->reference_speed = reference_speed(view_);
  }

  void fail(const std::exception_ptr& error) {
    if (job_kind_ == JobKind::kStart) std::rethrow_exception(error);
    // What was open stays; so do the settings that made it.
    state_.settings = requested_ = scene_->settings;
    state_.seeds = seed_choice(state_.settings.seeds);
    state_.playing = false;
    try {
      std::rethrow_exception(error);
    } catch (const Cancelled&) {
      say("cancelled; what is shown is as before", false);
    } catch (const std::exception& e) {
      say(e.what(), true);
    }
  }

  void say(const std::string& message, bool is_error) {
    state_.message = message;
    state_.message_is_error = is_error;
  }

  // One frame.

  void draw_frame(double seconds) {
    int width = 0, height = 0;
    glfwGetFramebufferSize(glfw_.get(), &width, &height);
    if (width < 1 || height < 1) {  // iconified
      glfw_.events().clear();
      glfwWaitEventsTimeout(kIdleRest);
      return;
    }
    const WindowLayout parts = layout(width, height, gui_->text_height());
    picture_ = parts.picture;
    gui_->set_background(view_.background);
    // Those that come while the picture is drawn are for the next frame.
    const auto handled = static_cast<std::ptrdiff_t>(glfw_.events().size());
    gui_->begin_frame(glfw_.events(), width, height, seconds);
    look();
    menu_.place(view_.camera, picture_);
    // An orthographic picture has one eye, but a workbench's is never that.
    const bool two = has_two_eyes(view_) || (bench_ && !screens_);
    pointer_.over(two ? view_.stereo : StereoView{}, picture_);
    handle_events();
    follow_menu();
    if (needs_camera_ && scene_) reset_camera();
    state_.scene = scene_ ? &*scene_ : nullptr;
    state_.job =
        job_->running() && (job_kind_ != JobKind::kUpdate || is_slow()) ? &job_->progress() : nullptr;
    state_.marking = touch_control_->marking();
    state_.grabbed = touch_control_->grabbed() || touch_control_->waiting();
    const bool looking =
        view_.tensors && !control_.dragging() && !touch_->readout().held && !ImGui::GetIO().WantCaptureMouse;
    state_.tensor =
        looking ? slice_control_.under_mouse(pointer_.area(), seeing(), *view_.tensors) : std::nullopt;
    state_.series.reset();
    if (scene_) plot_.update(*scene_->info, scene_->settings.time_step, options_.threads, state_);
    const SceneSettings settings_before = state_.settings;
    const PanelActions actions = draw_panels(state_, view_, parts);
    if (actions.cancel) job_->cancel();
    if (actions.reset_camera) needs_camera_ = true;
    if (actions.look) run_command(*actions.look);
    if (actions.time && has_times())
      state_.settings.time_step = nearest_step(scene_->info->times, *actions.time);
    if (actions.open) open(*actions.open);
    answer_question();
    if (actions.save_picture) run_command(Command::kSavePicture);
    if (actions.save_session) run_command(Command::kSaveSession);
    if (actions.save_transfer && view_.volume) {
      attempt([this] {
        Lens context;
        context.transfer = view_.volume->transfer;
        context.regions = view_.volume->regions;
        return files_.save_transfer(state_.transfer_file, context);
      });
    }
    if (actions.save_focus && scene_) {
      attempt([this] { return files_.save_transfer(state_.focus_file, scene_->look(0)); });
    }
    if (actions.touch.grab) run_command(Command::kGrab);
    if (actions.touch.keep) run_command(Command::kKeepLine);
    if (actions.touch.undo) run_command(Command::kUndo);
    if (actions.touch.save_lines) run_command(Command::kSaveLines);
    if (actions.touch.mark) touch_control_->mark(!touch_control_->marking());
    if (!actions.touch.save_notes.empty())
      attempt([&] { return files_.save_annotations(touch_->notes().entries(), actions.touch.save_notes); });
    if (!actions.region.crop.empty()) {
      attempt([&] {
        return files_.save_region(*view_.volume->image, *region_control_.box(), actions.region.crop,
                                  view_.anatomical ? ImageSpace::kPatient : ImageSpace::kUnknown);
      });
    }
    if (actions.lens) say(lens_control_.follow(*actions.lens), false);
    if (bench_) touch_->place_bench(place_of(view_.camera, bench_->screen()));
    if (view_.probe) touch_->update(glfwGetTime(), view_.camera, view_.style.color_by, *view_.probe);
    cut_volume();
    lead_by_grid();
    follow_edits();
    // Surfaces are solid: they would hide what is in a lens.
    const bool lenses =
        view_.volume && view_.volume->shown && (!view_.volume->lenses.empty() || is_cut(*view_.volume));
    view_.surfaces = lenses ? std::vector<SurfaceView>() : show_surfaces(touch_->surfaces().meshes);
    if (scene_) view_.surfaces.insert(view_.surfaces.end(), scene_->surfaces.begin(), scene_->surfaces.end());
    if (const int popped = touch_->readout().popped; popped != told_popped_) {
      if (popped > told_popped_)
        say(touch_->felt_levels().field ? "popped through to the other side" : "popped over to the next line",
            false);
      told_popped_ = popped;
    }
    if (touch_->readout().fault != told_fault_) {
      told_fault_ = touch_->readout().fault;
      say(told_fault_, true);
    }
    if (touch_->readout().device != told_device_) {
      told_device_ = touch_->readout().device;
      say(told_device_.empty() ? "the device is ready" : told_device_, false);
    }
    play();
    follow_layer();
    // A slow job whose answer is no longer wanted makes way for the next.
    if (!(state_.settings == settings_before) && job_->running() && job_kind_ == JobKind::kUpdate &&
        job_->seconds() > kPatience) {
      job_->cancel();
    }
    const SceneView picture = with_focus();
    draw_picture(picture, parts, width, height);
    draw_second_pointer();
    gui_->end_frame();
    if (screens_) screens_->draw(picture, *bench_, state_.picture.quality);
    std::vector<InputEvent>& events = glfw_.events();
    events.erase(events.begin(), events.begin() + handled);
  }

  /// The volume is cut where the hand has put the planes. They begin where it is cut already.
  void cut_volume() {
    if (!touch_->planes() || !view_.volume) return;
    if (touch_->choice().settings.plane_widget.poses.count == 0) {
      const PlanePoses planes = planes_of(*view_.volume, view_.bounds.center());
      if (planes.count > 0) {
        touch_->begin_planes(planes);
        return;
      }
    }
    const PlanePoses& poses = touch_->planes()->poses;
    if (!(poses == cut_planes_)) live_->lens_moved(glfwGetTime());
    cut_by_planes(*view_.volume, poses, cut_planes_.count);
    cut_planes_ = poses;
  }

  /// The hand on a haptic grid takes hold of the faces of the region of interest, or else of the view.
  void lead_by_grid() {
    const bool holds = touch_->holds_on_grid();
    const Vec3& hand = touch_->readout().proxy;
    if (has_region())
      region_control_.follow_hand(holds, hand, holds ? touch_->box_reach() : 0.0, view_.bounds);
    const std::optional<Vec3> left = view_hold_.follow(holds && !region_control_.dragging(), hand);
    if (!left) return;
    view_.camera.focal_point += *left;
    touch_->shift_hand(glfwGetTime(), *left);
  }

  /// Where the head is, and which part of its screen the picture is.
  void look() {
    if (!bench_) return;
    bench_->follow(BenchDisplay::now());
    state_.head_rows = bench_->rows();
    // The desktop beside several screens shows all of the one that its camera is of.
    if (screens_) return;
    const auto [left, top] = glfw_.position();
    const double scale = glfw_.pixels_per_coordinate();
    bench_->cover(scale * left + picture_.left, scale * top + picture_.top, picture_.width, picture_.height,
                  view_.camera);
  }

  /// What the stylus does to the menu, and what either hand has done to it.
  void follow_menu() {
    if (!menu_.shown()) return;
    const auto& pointing = touch_->intent().pointing;
    touch_->engage(pointing && menu_.point(*pointing, touch_->intent().acts));
    for (const Command command : menu_.act(state_.settings, view_)) run_command(command);
  }

  void toggle_menu() {
    if (!scene_) return;
    std::vector<std::string> modes;
    for (const HapticMode& mode : touch_->modes()) modes.push_back(mode.name);
    menu_.toggle(*scene_, view_, modes);
    touch_->engage(false);
  }

  void reset_camera() {
    needs_camera_ = false;
    if (bench_) {
      view_.camera = bench_->camera(view_.bounds, options_.touch.workspace_scale);
      return;
    }
    view_.camera =
        make_camera(view_.bounds, options_.angles,
                    eye_aspect(view_.stereo.mode, picture_.width, picture_.height), view_.camera.projection);
    // Of the first view alone: a reset shows all there is.
    view_.camera.focal_point = std::exchange(focal_point_, {}).value_or(view_.camera.focal_point);
  }

  /// The camera of what is seen there.
  [[nodiscard]] Camera seeing() const {
    if (!bench_ || screens_) return seeing_camera(view_, pointer_.eye());
    SceneView seen = view_;
    bench_->show(seen);
    return seeing_camera(seen, pointer_.eye());
  }

  /// A pointer is seen by both eyes where it is in both halves, at the same place.
  void draw_second_pointer() const {
    const auto there = pointer_.twin();
    if (!there || ImGui::GetIO().WantCaptureMouse) return;
    const ImVec2 at{static_cast<float>(there->x), static_cast<float>(there->y)};
    const float size = 0.8F * gui_->text_height();
    ImGui::GetForegroundDrawList()->AddTriangleFilled(
        at, {at.x, at.y + size}, {at.x + 0.7F * size, at.y + 0.7F * size}, IM_COL32(255, 255, 255, 230));
  }

  // Panels first: what happens over them is not for the camera.
  void handle_events() {
    const ImGuiIO& io = ImGui::GetIO();
    for (const InputEvent& event : glfw_.events()) {
      pointer_.follow(event);
      const Aim aim(view_.camera, seeing());
      if (event.kind == InputKind::kDrop && !question_.asking()) open({event.files, {}});
      if (const std::string text = event_text(event); !text.empty()) {
        touch_->record_event(static_cast<std::uint64_t>(frame_), text);
      }
      const auto command = command_of(event);
      // The one key that works in text fields, too.
      if (command == Command::kForceOff) run_command(*command);
      if (question_.handle(event)) continue;
      const bool begins = event.kind == InputKind::kPress || event.kind == InputKind::kWheel;
      const bool key = event.kind == InputKind::kKeyDown || event.kind == InputKind::kKeyUp;
      const bool of_panel =
          (begins && io.WantCaptureMouse && !control_.dragging()) || (key && io.WantTextInput);
      // A lens that follows the mouse is left where it is clicked, whatever the hand could take there.
      const bool of_lens =
          event.kind == InputKind::kPress && (lens_control_.followed() || color_lens_control_.followed());
      if (!of_panel && !menu_.handle(event, pointer_.area(), view_.camera) &&
          !handle_region(event, pointer_.area()) && !handle_plane_image(event, pointer_.area()) &&
          !(of_lens && handle_lens(event, pointer_.area())) &&
          !touch_control_->handle(event, pointer_.area(), view_, glfwGetTime(), io.WantCaptureMouse) &&
          !handle_lens(event, pointer_.area()) &&
          !(view_.tensors && slice_control_.handle(event, pointer_.area(), view_.camera, *view_.tensors))) {
        control_.handle(event, pointer_.area(), view_.bounds, view_.camera);
      } else if (event.kind == InputKind::kMove) {
        control_.place(event.x, event.y);
        slice_control_.place(event.x, event.y);
      }
      // An open list takes Esc for itself.
      const bool of_list =
          command == Command::kLetGo && ImGui::IsPopupOpen(nullptr, ImGuiPopupFlags_AnyPopupId);
      if (command && !io.WantTextInput && !of_list && command != Command::kForceOff) run_command(*command);
    }
  }

  bool handle_lens(const InputEvent& event, const PictureArea& area) {
    bool taken = false;
    if (scene_ && scene_->info->layers) {
      taken = color_lens_control_.handle(event, area, {scene_->felt_scalar, scene_->settings.layer}, view_);
    } else if (view_.volume) {
      if (lens_control_.followed()) live_->lens_moved(glfwGetTime());
      taken = lens_control_.handle(event, area, view_.camera, view_.bounds, *view_.volume);
    }
    // Where it is left, what was said of moving it is over.
    if (taken && event.kind == InputKind::kPress) say({}, false);
    return taken;
  }

  /// Whether the volume is what is looked at, and may be cropped: that of tensors is made of them.
  [[nodiscard]] bool has_region() const { return view_.volume && !view_.tensors; }

  [[nodiscard]] EditedView edited_view() const {
    return {region_control_.box(), view_.volume ? view_.volume->planes.window : std::nullopt};
  }

  /// Remembers what is edited in the view, a drag as one edit.
  void follow_edits() {
    if (!view_.volume) return;
    const bool resting =
        !region_control_.dragging() && !plane_image_control_.dragging() && !ImGui::IsAnyItemActive();
    view_edits_.follow(edited_view(), cut_planes_, resting);
  }

  /// Takes back the last edit of the view, if that came after all that the hand has done to planes.
  bool undo_view_edit() {
    if (!view_.volume || touch_control_->marking()) return false;
    const auto before = view_edits_.undo(cut_planes_);
    if (!before) return false;
    region_control_.put(before->region);
    view_.volume->planes.window = before->window;
    say("undone", false);
    return true;
  }

  // While the probe is grabbed the mouse is its own.
  bool handle_region(const InputEvent& event, const PictureArea& area) {
    if (!has_region() || (touch_control_->grabbed() && event.kind != InputKind::kMove)) return false;
    return region_control_.handle(event, area, view_.camera, view_.bounds);
  }

  bool handle_plane_image(const InputEvent& event, const PictureArea& area) {
    if (!view_.volume) return false;
    const bool taken = plane_image_control_.handle(event, area, view_.camera, *view_.volume);
    if (plane_image_control_.dragging()) live_->lens_moved(glfwGetTime());
    return taken;
  }

  void run_command(Command command) {
    switch (command) {
      case Command::kHelp:
        state_.show_help = !state_.show_help;
        break;
      case Command::kFullScreen:
        glfw_.toggle_full_screen();
        break;
      case Command::kResetCamera:
        needs_camera_ = true;
        break;
      case Command::kPlay:
        // Along layers there are no lines to keep.
        if (touch_control_->grabbed() && (touch_->has_flow() || touch_->has_tensors())) {
          run_touch(Command::kKeepLine);
        } else if (has_times())
          state_.playing = !state_.playing;
        break;
      case Command::kStepBack:
      case Command::kStepOn:
        state_.playing = false;
        step_in_time(command == Command::kStepOn);
        break;
      case Command::kLetGo:
        control_.let_go();
        slice_control_.let_go();
        lens_control_.let_go();
        color_lens_control_.follow(false);
        plane_image_control_.let_go();
        region_control_.let_go();
        touch_control_->let_go();
        touch_control_->mark(false);
        state_.show_help = state_.playing = false;
        if (job_->running() && job_kind_ != JobKind::kStart) job_->cancel();
        say({}, false);
        break;
      case Command::kQuit:
        glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
        break;
      case Command::kCorner:
        if (!has_region()) break;
        if (touch_->readout().held) {
          say(region_control_.put_corner(touch_->readout().proxy), false);
        } else {
          say("grab the probe (G) first: the corner is put where it is", false);
        }
        break;
      case Command::kUndo:
        if (!undo_view_edit()) run_touch(command);
        break;
      case Command::kMenu:
        toggle_menu();
        break;
      case Command::kVolume:
        if (view_.volume) view_.volume->shown = !view_.volume->shown;
        break;
      case Command::kLens:
      case Command::kLensSmaller:
      case Command::kLensLarger:
        run_lens(command);
        break;
      case Command::kColorBar:
        view_.show_color_bar = !view_.show_color_bar;
        break;
      case Command::kAxes:
        view_.show_axes = !view_.show_axes;
        break;
      case Command::kRates:
        state_.show_rates = !state_.show_rates;
        break;
      case Command::kSavePicture:
        attempt([this] { return files_.save_picture(live_->read(), picture_texts()); });
        break;
      case Command::kSaveSession:
        if (scene_) attempt([this] { return model_.save_session(scene_->settings, view_, set_options()); });
        break;
      case Command::kSaveLines:
        attempt([this] { return save_lines(); });
        break;
      default:
        run_touch(command);
    }
  }

  void run_lens(Command command) {
    if (scene_ && scene_->info->layers) {
      if (command == Command::kLens && state_.settings.lens_array.empty())
        state_.settings.lens_array = scene_->info->color_arrays.front();  // is sampled before it is there
      say(color_lens_control_.run(command, view_), false);
      return;
    }
    if (!scene_ || !view_.volume) return;
    say(lens_control_.run(command, pointer_.area(), view_.camera, view_.bounds, scene_->look(0),
                          *view_.volume),
        false);
    live_->lens_moved(glfwGetTime());
  }

  void run_touch(Command command) {
    if (ViewControl::look(command, view_.bounds,
                          eye_aspect(view_.stereo.mode, picture_.width, picture_.height), view_.camera))
      return;
    if (view_.tensors && SliceControl::run(command, *view_.tensors)) return;
    if (const auto words = touch_control_->run(command, pointer_.area(), view_, glfwGetTime()))
      say(*words, false);
  }

  std::filesystem::path save_lines() {
    if (!touch_->drawn().empty()) (void)touch_->keep_line();
    if (touch_->kept().entries().empty())
      throw work_error(touch_->has_tensors() ? "no tract is drawn; press G, then drag along one"
                                             : "no line is kept; grab the probe (G), then K keeps one");
    return files_.save_lines(touch_->kept(), state_.lines_file);
  }

  // Says what was saved, or why it was not; whether it was.
  template <class Save>
  bool attempt(const Save& save) {
    try {
      say("saved " + std::filesystem::path(save()).string(), false);
      return true;
    } catch (const std::exception& error) {
      say(error.what(), true);
      return false;
    }
  }

  void play() {
    if (!state_.playing || !scene_ || job_->running()) return;
    if (since_step_.seconds() * state_.play_rate < 1.0) return;
    since_step_.restart();
    step_in_time(true);
  }

  /// To the step whose time comes next, and round from the last to the first.
  void step_in_time(bool on) {
    if (has_times())
      state_.settings.time_step = step_beside(scene_->info->times, state_.settings.time_step, on);
  }

  /// Of an update: its progress is shown. One that comes and goes would move the panel under the mouse with
  /// each step of a series that plays, which "Stop" ends.
  [[nodiscard]] bool is_slow() const { return !state_.playing && job_->seconds() > kPatience; }

  [[nodiscard]] bool has_times() const { return scene_ && scene_->info->times.size() > 1; }

  /// What a session holds beside the scene and its view.
  [[nodiscard]] std::vector<std::pair<std::string, std::string>> set_options() const {
    auto set = touch_->options();
    if (!state_.plotted.empty()) set.emplace_back("plot", state_.plotted);
    if (const auto& box = region_control_.box(); box && has_region()) set.emplace_back("box", box_text(*box));
    if (state_.play_rate != kPlayRate) set.emplace_back("play-rate", exact_number(state_.play_rate));
    return set;
  }

  /// A heart shows the layer that the hand is on, with its fibres.
  void follow_layer() {
    const ProbeReadout& hand = touch_->readout();
    if (!scene_ || !scene_->info->layers || !hand.held || !hand.scalar) return;
    if (const auto level = felt_level(touch_->felt_levels(), *hand.scalar)) state_.settings.layer = *level;
  }

  [[nodiscard]] std::vector<PngText> picture_texts() const {
    return {{"Software", options_.version}, {"Comment", options_.command_line}};
  }

  // The whole window, as it stands in the framebuffer that is about to be shown.
  void save_screenshot() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(glfw_.get(), &width, &height);
    write_png(options_.screenshot, read_framebuffer(0, width, height), picture_texts());
  }

  /// The place under the mouse that is the next one of an annotation which is begun; none where none is.
  [[nodiscard]] std::optional<Vec3> next_mark() const {
    if (touch_->notes().pending().empty()) return std::nullopt;
    SceneView seen = view_;
    seen.camera = seeing();
    return touch_control_->next_mark(pointer_.area(), seen);
  }

  /// The view with the lines stepping back while a hand is on the probe, and where lines are kept or
  /// isosurfaces felt, which they would bury.
  [[nodiscard]] SceneView with_focus() const {
    SceneView picture = view_;
    if (const Vec3 moved = view_hold_.moved(); moved != Vec3{0.0}) {
      // The hand is drawn on the place of the scene that it has taken hold of.
      picture.camera.focal_point += moved;
      if (picture.probe) {
        picture.probe->probe += moved;
        picture.probe->proxy += moved;
      }
    }
    const bool hand = touch_->readout().held || !touch_->kept().entries().empty();
    // Those on a layer are its grain.
    const bool on_layer = scene_ && scene_->info->layers;
    if ((hand || !view_.surfaces.empty()) && !on_layer && touch_->choice().fade_rest) fade_lines(picture);
    if (auto menu = menu_.drawn()) picture.signs.push_back(std::move(*menu));
    picture.notes = notes_of(touch_->notes(), length_unit(picture), next_mark());
    std::vector<std::vector<Vec3>> handled;
    if (touch_->planes())
      handled = lines_of_planes(touch_->planes()->poses, picture.bounds, touch_->sphere_radius());
    if (const auto lens = lens_control_.followed();
        lens && view_.volume && *lens < view_.volume->lenses.size()) {
      if (auto circle = outline_of(view_.volume->lenses[*lens], view_.camera); !circle.empty())
        handled.push_back(std::move(circle));
    }
    if (has_region()) {
      if (region_control_.box()) {
        for (auto& edge : box_edges(*region_control_.box())) handled.push_back(std::move(edge));
      }
      if (auto dots = region_control_.dots(); !dots.empty())
        picture.notes.push_back({.points = std::move(dots), .outline = {}, .words = {}});
    }
    if (!handled.empty() && picture.outline.empty()) picture.outline = box_edges(picture.bounds);
    picture.outline.insert(picture.outline.end(), handled.begin(), handled.end());
    return picture;
  }

  void draw_picture(SceneView picture, const WindowLayout& parts, int width, int height) {
    const auto w = static_cast<int>(parts.picture.width), h = static_cast<int>(parts.picture.height);
    if (glfw_.take_damage()) live_->damage();
    PictureMoment moment{.seconds = glfwGetTime(),
                         .moving = control_.dragging() || slice_control_.dragging() || state_.playing ||
                                   (bench_ && bench_->moved())};
    if (!lively() && !job_->running() && !scripted()) {
      moment.interrupted = [this] {
        glfwPollEvents();
        return !glfw_.events().empty();
      };
    }
    if (touch_->planes()) moment.next_cut = static_cast<std::size_t>(touch_->planes()->current);
    if (bench_ && !screens_) bench_->show(picture);
    live_->draw(std::move(picture), w, h, moment);
    state_.picture = live_->figures();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    live_->show(static_cast<int>(parts.picture.left), height - h);
  }

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

}  // namespace

bool window_available() { return start_glfw(); }

WindowResult run_window(WindowModel& model, const WindowOptions& options) {
  return Window(model, options).run();
}

}  // namespace palpate
