#include "common/app/window/window.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <optional>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/app/window/background_job.h"
#include "common/app/window/gui.h"
#include "common/app/window/keys.h"
#include "common/app/window/panel.h"
#include "common/app/window/view_control.h"
#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/text.h"
#include "common/render/gl/target.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"

namespace palpate {
namespace {

// A job that answers within this time is waited for before the next one starts; a slower one is
// cancelled when the settings change again [s].
constexpr double kPatience = 0.4;
// Frames slower than this lower the resolution while the camera moves [ms], down to this share of the
// pixels along either edge.
constexpr double kSlowFrame = 60.0, kCoarsest = 0.35;
// Rest between two looks at the world while nothing happens [s].
constexpr double kIdleRest = 0.25, kBusyRest = 1.0 / 60.0;

// GLFW is started once and ended with the program: some virtual displays start anew, and refuse
// connections meanwhile, when their last one is closed.
bool start_glfw() {
  static const bool kStarted = glfwInit() == GLFW_TRUE && std::atexit(glfwTerminate) == 0;
  return kStarted;
}

// The window that owns the OpenGL context.
class GlfwWindow {
 public:
  explicit GlfwWindow(const WindowOptions& options) {
    if (!start_glfw()) throw work_error(no_window("no display"));
    glfwWindowHint(GLFW_CONTEXT_VERSION_MAJOR, 4);
    glfwWindowHint(GLFW_CONTEXT_VERSION_MINOR, 5);
    glfwWindowHint(GLFW_OPENGL_PROFILE, GLFW_OPENGL_CORE_PROFILE);
    glfwWindowHint(GLFW_VISIBLE, options.hidden ? GLFW_FALSE : GLFW_TRUE);
    // Never larger than what the screen shows of it.
    int width = options.width, height = options.height;
    if (GLFWmonitor* monitor = glfwGetPrimaryMonitor(); monitor != nullptr && !options.hidden) {
      int x = 0, y = 0, screen_width = 0, screen_height = 0;
      glfwGetMonitorWorkarea(monitor, &x, &y, &screen_width, &screen_height);
      if (screen_width > 0) width = std::min(width, screen_width);
      if (screen_height > 0) height = std::min(height, screen_height);
    }
    // The picture has its own multisampled framebuffer with depth.
    glfwWindowHint(GLFW_DEPTH_BITS, 0);
    glfwWindowHint(GLFW_STENCIL_BITS, 0);
    for (const int api : {GLFW_NATIVE_CONTEXT_API, GLFW_EGL_CONTEXT_API}) {
      glfwWindowHint(GLFW_CONTEXT_CREATION_API, api);
      window_ = glfwCreateWindow(width, height, options.program.c_str(), nullptr, nullptr);
      if (window_ != nullptr) break;
    }
    if (window_ == nullptr) throw work_error(no_window("the driver has no OpenGL 4.5 core context"));
    glfwMakeContextCurrent(window_);
  }
  ~GlfwWindow() { glfwDestroyWindow(window_); }
  GlfwWindow(const GlfwWindow&) = delete;
  GlfwWindow& operator=(const GlfwWindow&) = delete;

  [[nodiscard]] GLFWwindow* get() const { return window_; }

 private:
  static std::string no_window(const std::string& why) {
    const char* detail = nullptr;
    glfwGetError(&detail);
    return "no window can be opened: " + why + (detail != nullptr ? " (" + std::string(detail) + ")" : "") +
           "; `render` draws without a display";
  }

  GLFWwindow* window_ = nullptr;
};

class Window {
 public:
  Window(WindowModel& model, const WindowOptions& options)
      : model_(model), options_(options), glfw_(options), view_(options.view) {
    GLFWwindow* const window = glfw_.get();
    glfwSetWindowUserPointer(window, this);
    glfwSwapInterval(scripted() ? 0 : 1);
    listen(window);
    float scale = 1.0F;
    glfwGetWindowContentScale(window, &scale, nullptr);
    constexpr float kTextHeight = 14.0F;
    gui_ = std::make_unique<Gui>(window, std::round(kTextHeight * std::max(1.0F, scale)));
    renderer_ = std::make_unique<SceneRenderer>();
    job_ = std::make_unique<BackgroundJob>([] { glfwPostEmptyEvent(); });
    start_job(JobKind::kStart, [this](Progress& progress) { return model_.start(progress); });
  }

  WindowResult run() {
    Stopwatch frame_clock;
    while (glfwWindowShouldClose(glfw_.get()) == GLFW_FALSE) {
      wait_for_events();
      if (options_.stop_requested && options_.stop_requested()) break;
      take_outcome();
      const bool counted = scene_.has_value() && !job_->running();
      if (counted) inject(frame_);
      const double seconds = frame_clock.seconds();
      frame_clock.restart();
      draw_frame(seconds);
      if (counted && ++frame_ == options_.frames) {
        if (!options_.screenshot.empty()) save_screenshot();
        break;
      }
      glfwSwapBuffers(glfw_.get());
    }
    WindowResult result{frame_, view_, state_.settings, state_.message, 0.0};
    if (!frame_ms_.empty()) {
      const auto middle = frame_ms_.begin() + static_cast<std::ptrdiff_t>(frame_ms_.size() / 2);
      std::nth_element(frame_ms_.begin(), middle, frame_ms_.end());
      result.median_frame_ms = *middle;
    }
    return result;
  }

 private:
  enum class JobKind { kStart, kOpen, kUpdate };

  [[nodiscard]] bool scripted() const { return options_.frames > 0; }

  // Events, from the window system or the script, wait here for the next frame.

  void listen(GLFWwindow* window) {
    static const auto self = [](GLFWwindow* w) { return static_cast<Window*>(glfwGetWindowUserPointer(w)); };
    glfwSetCursorPosCallback(window, [](GLFWwindow* w, double x, double y) {
      const double scale = self(w)->pixels_per_coordinate();
      self(w)->events_.push_back({.kind = InputKind::kMove, .x = scale * x, .y = scale * y});
    });
    glfwSetMouseButtonCallback(window, [](GLFWwindow* w, int button, int action, int) {
      if (button < 0 || button > 2) return;
      self(w)->events_.push_back({.kind = action == GLFW_RELEASE ? InputKind::kRelease : InputKind::kPress,
                                  .button = static_cast<MouseButton>(button)});
    });
    glfwSetScrollCallback(window, [](GLFWwindow* w, double x, double y) {
      self(w)->events_.push_back({.kind = InputKind::kWheel, .x = x, .y = y});
    });
    glfwSetKeyCallback(window, [](GLFWwindow* w, int key, int, int action, int modifiers) {
      self(w)->events_.push_back({.kind = action == GLFW_RELEASE ? InputKind::kKeyUp : InputKind::kKeyDown,
                                  .key = key,
                                  .modifiers = modifiers});
    });
    glfwSetCharCallback(window, [](GLFWwindow* w, unsigned code_point) {
      self(w)->events_.push_back({.kind = InputKind::kText, .key = static_cast<int>(code_point)});
    });
    glfwSetDropCallback(window, [](GLFWwindow* w, int count, const char** paths) {
      self(w)->events_.push_back({.kind = InputKind::kDrop, .files = {paths, paths + count}});
    });
    glfwSetFramebufferSizeCallback(window, [](GLFWwindow* w, int, int) { self(w)->dirty_ = true; });
    glfwSetWindowRefreshCallback(window, [](GLFWwindow* w) { self(w)->dirty_ = true; });
  }

  [[nodiscard]] double pixels_per_coordinate() const {
    int window_width = 1, pixel_width = 1;
    glfwGetWindowSize(glfw_.get(), &window_width, nullptr);
    glfwGetFramebufferSize(glfw_.get(), &pixel_width, nullptr);
    return window_width > 0 ? static_cast<double>(pixel_width) / window_width : 1.0;
  }

  void wait_for_events() {
    if (scripted() && !job_->running()) {
      glfwPollEvents();
      return;
    }
    // Panels answer to an event one frame later at times: a few frames follow each event at full rate.
    const bool busy = job_->running() || lively_frames_ > 0 || state_.playing;
    glfwWaitEventsTimeout(busy ? kBusyRest : kIdleRest);
    lively_frames_ = events_.empty() ? std::max(0, lively_frames_ - 1) : 3;
  }

  void inject(int frame) {
    for (const ScriptedEvent& scripted : options_.script) {
      if (scripted.frame == frame) events_.push_back(scripted.event);
    }
  }

  // Jobs.

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
      dirty_ = true;
    }
    if (job_->running()) return;
    if (!dropped_.empty()) {
      start_job(JobKind::kOpen, [this, files = std::exchange(dropped_, {})](Progress& progress) {
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
    view_.lines = scene_->lines;
    adopt_color(scene_->color_array);
    view_.bounds = scene_->info->bounds;
    view_.outline = scene_->info->outline;
    view_.units = scene_->info->units;
    view_.title = scene_->info->name;
    view_.subtitle = scene_->settings.field + ", " + counted(scene_->lines->size(), "line");
    const std::vector<double>& times = scene_->info->times;
    if (times.size() > 1 && scene_->settings.time_step < times.size()) {
      view_.subtitle += ", time " + short_number(times[scene_->settings.time_step]);
    }
    if (job_kind_ != JobKind::kUpdate) {
      // Edits made while the input was being read belonged to the old one.
      state_.settings = requested_ = scene_->settings;
      view_.style.range.reset();
      needs_camera_ = true;
      glfwSetWindowTitle(glfw_.get(), (scene_->info->name + " - " + options_.program).c_str());
    } else {
      // What the panel has been set to meanwhile stays; what was left to a default is now known.
      if (state_.settings == requested_) state_.settings = scene_->settings;
      requested_ = scene_->settings;
    }
    state_.seeds = seed_choice(state_.settings.seeds);
    say({}, false);
  }

  /// Colours by `array`, or where there is none by a quantity of the lines.
  void adopt_color(const std::shared_ptr<const LineArray>& array) {
    LineStyle& style = view_.style;
    const bool by_array = style.color_by == ColorBy::kArray;
    const bool same = by_array && array && style.array && style.array->name == array->name;
    if (!same && (array || by_array)) {
      style.color_by = array ? ColorBy::kArray : ColorBy::kSpeed;
      style.range.reset();
      style.logarithmic.reset();
    }
    style.array = array;
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
      events_.clear();
      return;
    }
    const WindowLayout parts = layout(width, height, gui_->text_height());
    gui_->set_background(view_.background);
    gui_->begin_frame(events_, width, height, seconds);
    handle_events(parts);
    if (needs_camera_ && scene_) {
      view_.camera = make_camera(view_.bounds, options_.angles, parts.picture.width / parts.picture.height,
                                 view_.camera.projection);
      needs_camera_ = false;
    }
    state_.scene = scene_ ? &*scene_ : nullptr;
    state_.job = job_->running() ? &job_->progress() : nullptr;
    const SceneSettings settings_before = state_.settings;
    const PanelActions actions = draw_panels(state_, view_, parts);
    if (actions.cancel) job_->cancel();
    if (actions.reset_camera) needs_camera_ = true;
    if (actions.save_picture) run_command(Command::kSavePicture);
    if (actions.save_session) run_command(Command::kSaveSession);
    play();
    // A slow job whose answer is no longer wanted makes way for the next.
    if (!(state_.settings == settings_before) && job_->running() && job_kind_ == JobKind::kUpdate &&
        job_->seconds() > kPatience) {
      job_->cancel();
    }
    draw_picture(parts, width, height);
    gui_->end_frame();
    events_.clear();
  }

  // Panels first: what happens over them is not for the camera.
  void handle_events(const WindowLayout& parts) {
    const ImGuiIO& io = ImGui::GetIO();
    for (const InputEvent& event : events_) {
      if (event.kind == InputKind::kDrop) dropped_ = event.files;
      const bool begins = event.kind == InputKind::kPress || event.kind == InputKind::kWheel;
      if (!(begins && io.WantCaptureMouse && !control_.dragging())) {
        control_.handle(event, parts.picture, view_.bounds, view_.camera);
      }
      if (io.WantTextInput) continue;
      if (const auto command = command_of(event)) run_command(*command);
    }
  }

  void run_command(Command command) {
    switch (command) {
      case Command::kHelp:
        state_.show_help = !state_.show_help;
        break;
      case Command::kFullScreen:
        toggle_full_screen();
        break;
      case Command::kResetCamera:
        needs_camera_ = true;
        break;
      case Command::kPlay:
        if (scene_ && scene_->info->times.size() > 1) state_.playing = !state_.playing;
        break;
      case Command::kLetGo:
        control_.let_go();
        state_.show_help = state_.playing = false;
        if (job_->running() && job_kind_ != JobKind::kStart) job_->cancel();
        say({}, false);
        break;
      case Command::kQuit:
        glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
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
        attempt([this] { return save_picture(); });
        break;
      case Command::kSaveSession:
        if (scene_) attempt([this] { return model_.save_session(scene_->settings, view_); });
        break;
    }
  }

  // Says what was saved, or why it was not.
  template <class Save>
  void attempt(const Save& save) {
    try {
      say("saved " + std::string(save()), false);
    } catch (const std::exception& error) {
      say(error.what(), true);
    }
  }

  void play() {
    if (!state_.playing || !scene_ || job_->running()) return;
    const std::size_t count = scene_->info->times.size();
    if (count > 1) state_.settings.time_step = (state_.settings.time_step + 1) % count;
  }

  void toggle_full_screen() {
    GLFWwindow* const window = glfw_.get();
    if (glfwGetWindowMonitor(window) != nullptr) {
      glfwSetWindowMonitor(window, nullptr, windowed_.x, windowed_.y, windowed_.width, windowed_.height, 0);
      return;
    }
    GLFWmonitor* const monitor = glfwGetPrimaryMonitor();
    const GLFWvidmode* const mode = monitor == nullptr ? nullptr : glfwGetVideoMode(monitor);
    if (mode == nullptr) return;
    glfwGetWindowPos(window, &windowed_.x, &windowed_.y);
    glfwGetWindowSize(window, &windowed_.width, &windowed_.height);
    glfwSetWindowMonitor(window, monitor, 0, 0, mode->width, mode->height, mode->refreshRate);
  }

  [[nodiscard]] std::vector<PngText> picture_texts() const {
    return {{"Software", options_.version}, {"Comment", options_.command_line}};
  }

  // The picture alone, under the first number that is free.
  std::string save_picture() {
    constexpr int kMostPictures = 10'000;
    for (int number = 1; number < kMostPictures; ++number) {
      const std::string digits = std::to_string(number);
      const auto path = options_.picture_folder /
                        (options_.program + "-" +
                         std::string(3 - std::min<std::size_t>(3, digits.size()), '0') + digits + ".png");
      if (std::filesystem::exists(path)) continue;
      write_png(path, renderer_->read(), picture_texts());
      return path.string();
    }
    throw work_error(options_.picture_folder.string() + ": too many pictures");
  }

  // The whole window, as it stands in the framebuffer that is about to be shown.
  void save_screenshot() {
    int width = 0, height = 0;
    glfwGetFramebufferSize(glfw_.get(), &width, &height);
    write_png(options_.screenshot, read_framebuffer(0, width, height), picture_texts());
  }

  void draw_picture(const WindowLayout& parts, int width, int height) {
    const auto w = static_cast<int>(parts.picture.width), h = static_cast<int>(parts.picture.height);
    // While the camera moves, a picture that takes long is drawn coarser; it is sharp again at rest.
    const bool moving = control_.dragging() || state_.playing;
    if (dirty_ || w != picture_width_ || h != picture_height_ || !same_picture(view_, shown_) ||
        (!moving && state_.resolution < 1.0)) {
      if (!moving) {
        state_.resolution = 1.0;
      } else if (state_.frame_ms > kSlowFrame) {
        state_.resolution = std::max(kCoarsest, 0.7 * state_.resolution);
      }
      renderer_->draw(view_, w, h, state_.resolution);
      state_.frame_ms = renderer_->finish();
      frame_ms_.push_back(state_.frame_ms);
      const double now = glfwGetTime();
      state_.frames_per_second = now > last_drawn_ ? 1.0 / (now - last_drawn_) : 0.0;
      last_drawn_ = now;
      state_.automatic_range = renderer_->range();
      shown_ = view_;
      picture_width_ = w;
      picture_height_ = h;
      dirty_ = false;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    renderer_->show(static_cast<int>(parts.picture.left), height - h);
  }

  WindowModel& model_;
  const WindowOptions& options_;
  GlfwWindow glfw_;  // first in, last out: the others need its context
  std::unique_ptr<Gui> gui_;
  std::unique_ptr<SceneRenderer> renderer_;

  SceneView view_;   // as the user wants it
  SceneView shown_;  // as it was drawn last
  int picture_width_ = 0, picture_height_ = 0;
  bool dirty_ = true, needs_camera_ = true;
  std::optional<SceneState> scene_;
  PanelState state_;
  SceneSettings requested_;  // of the last job
  ViewControl control_;
  std::vector<InputEvent> events_;
  std::vector<std::filesystem::path> dropped_;
  struct {
    int x = 0, y = 0, width = 1, height = 1;
  } windowed_;
  int frame_ = 0, lively_frames_ = 3;
  double last_drawn_ = 0.0;  // [s]
  std::vector<double> frame_ms_;
  JobKind job_kind_ = JobKind::kStart;
  std::unique_ptr<BackgroundJob> job_;  // last in, first out: its thread ends before what it uses
};

}  // namespace

bool window_available() { return start_glfw(); }

WindowResult run_window(WindowModel& model, const WindowOptions& options) {
  return Window(model, options).run();
}

}  // namespace palpate
