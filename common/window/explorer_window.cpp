#include "common/window/explorer_window.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include <GLFW/glfw3.h>

#include "common/render/gl/gpu_objects.h"
#include "common/render/gl/target.h"
#include "common/render/png.h"
#include "common/window/injected_events.h"
#include "common/window/panels/panel_parts.h"

namespace palpate {
namespace {

// Rest between two looks at the world while something moves [s], and while only a job runs: without a
// graphics card each picture of its progress takes processors from it.
constexpr double kBusyRest = 1.0 / 60.0, kJobRest = 0.1;

}  // namespace

ExplorerWindow::ExplorerWindow(WindowModel& model, const WindowOptions& options)
    : model_(model),
      options_(options),
      jobs_(model, !options.start_page),
      glfw_(options),
      view_(options.view),
      focal_point_(options.focal_point),
      angles_(options.angles),
      start_page_(options.program, options.kind),
      touch_(options.touch, [] { glfwPostEmptyEvent(); }),
      controls_(touch_, options.region),
      edits_({model_, state_, view_, scene_, needs_camera_, touch_, controls_, cuts_}),
      files_(options.picture_folder, options.program, touch_, state_) {
  GLFWwindow* const window = glfw_.get();
  glfwSwapInterval(scripted() ? 0 : 1);
  float scale = 1.0F;
  glfwGetWindowContentScale(window, &scale, nullptr);
  constexpr float kTextHeight = 14.0F;
  gui_ = std::make_unique<Gui>(window, std::round(kTextHeight * std::max(1.0F, scale)));
  picture_ = std::make_unique<WindowPicture>(options_.frame_budget);
  thumbnails_ = std::make_unique<Thumbnails>(options_.thumbnails, options_.program, options_.draw_example);
  if (options_.workbench) {
    workbench_ = std::make_unique<WorkbenchDisplay>(*options_.workbench);
    if (options_.workbench->several) {
      screens_ = std::make_unique<ScreenWindows>(glfw_, *options_.workbench, view_.stereo, options_.hidden);
      // The desktop is one more display, for one eye that rests.
      view_.stereo.mode = StereoMode::kNone;
    }
  }
  state_.touch = &touch_;
  state_.region = &controls_.region();
  state_.brush = &controls_.brush();
  state_.tract_pick = &controls_.tract_pick();
  state_.recent = options_.recent;
  state_.plotted = options_.plotted;
  state_.play_rate = options_.play_rate;
  files_.note_opened(options_.session);
  forget_controls();
}

WindowResult ExplorerWindow::run() {
  Stopwatch frame_clock;
  while (!closes()) {
    wait_for_events();
    if (options_.stop_requested && options_.stop_requested()) break;
    take_outcome();
    const bool counted = counts();
    if (counted) {
      const std::vector<std::string> missing = inject_script(options_.script, frame_, glfw_.events());
      missing_.insert(missing_.end(), missing.begin(), missing.end());
    }
    if (touch_.servo().replaying()) inject_replayed(touch_, glfw_.events(), state_);
    const double seconds = frame_clock.seconds();
    frame_clock.restart();
    draw_frame(seconds);
    if (counted && ++frame_ == options_.frames) {
      if (!options_.screenshot.empty()) {
        int width = 0, height = 0;
        glfwGetFramebufferSize(glfw_.get(), &width, &height);
        write_png(options_.screenshot, read_framebuffer(0, width, height), picture_texts());
      }
      break;
    }
    glfwSwapBuffers(glfw_.get());
    if (workbench_) workbench_->finished(WorkbenchDisplay::now());
  }
  keep_thumbnail();
  touch_.finish();
  WindowResult result{.frames = frame_,
                      .shown = shown_,
                      .recent = state_.recent,
                      .view = view_,
                      .document = state_.document,
                      .log = state_.log.text(),
                      .message = state_.message.empty() ? state_.error : state_.message,
                      .region = controls_.region().box(),
                      .probe = touch_.readout(),
                      .tensor = state_.tensor,
                      .replay = touch_.servo().replay_verdict(),
                      .series = plot_.curve(),
                      .missing = missing_};
  if (screens_) result.screens = screens_->read();
  if (workbench_) result.latency = workbench_->latency();
  std::tie(result.width, result.height) = glfw_.size();
  result.median_frame_ms = picture_->live().median_milliseconds();
  result.quality = picture_->live().figures().quality;
  result.tables_by = picture_->live().tables_by();
  result.gpu = gpu_objects();
  enter_gpu_objects(result.gpu, result.tables_by);
  return result;
}

void ExplorerWindow::wait_for_events() {
  if (scripted() && !(options_.frames_wait && jobs_.running())) {
    glfwPollEvents();
    return;
  }
  // Panels answer to an event one frame later at times: a few frames follow each event at full rate.
  if (picture_->live().complete() && glfw_.events().empty()) {
    glfwWaitEventsTimeout(lively() ? kBusyRest : jobs_.running() ? kJobRest : kIdleRest);
  } else {
    glfwPollEvents();  // there is work to do meanwhile: more tracts, or events that the last frame has left
  }
  lively_frames_ = glfw_.events().empty() ? std::max(0, lively_frames_ - 1) : 3;
}

bool ExplorerWindow::lively() const {
  return lively_frames_ > 0 || state_.playing || touch_.lively() || (workbench_ && workbench_->lively());
}

bool ExplorerWindow::counts() {
  if ((!scene_ && !on_start_page()) || (options_.frames_wait && jobs_.running())) return false;
  if (options_.patience > 0.0 && awaits_control(options_.script, frame_)) {
    if (!awaiting_) awaiting_.emplace();
    // Behind one that has not come others would not come either: each waited for would be minutes in all.
    if (missing_.empty() && awaiting_->seconds() < options_.patience) return false;
  }
  awaiting_.reset();
  return true;
}

bool ExplorerWindow::closes() {
  if (screens_ && screens_->close_asked()) glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
  if (glfwWindowShouldClose(glfw_.get()) == GLFW_FALSE) return false;
  if (leave_ || !files_.ask({})) return true;
  controls_.touch().let_go();
  glfwSetWindowShouldClose(glfw_.get(), GLFW_FALSE);
  return false;
}

}  // namespace palpate
