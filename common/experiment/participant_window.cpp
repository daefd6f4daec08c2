#include "common/experiment/participant_window.h"

#include <algorithm>
#include <map>
#include <memory>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/base/clock.h"
#include "common/base/index.h"
#include "common/experiment/hand_device.h"
#include "common/experiment/live_trial.h"
#include "common/experiment/screen_texts.h"
#include "common/render/gl/target.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"
#include "common/window/controls/pointer.h"
#include "common/window/glfw_window.h"
#include "common/window/gui.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/window.h"

namespace palpate {
namespace {

class ParticipantWindow {
 public:
  ParticipantWindow(StudyFolder& folder, const StudyTasks& tasks, StudyParticipant who,
                    const RecordingHeader& header, const ParticipantWindowOptions& options)
      : folder_(folder),
        tasks_(tasks),
        who_(std::move(who)),
        header_(header),
        options_(options),
        glfw_(window_options()),
        gui_(glfw_.get(), kTextHeight),
        device_(options.touch),
        left_(folder.left_for(who_)) {
    header_.limits = options.touch.limits;
    glfwSwapInterval(1);
    gui_.set_background(kGround);
    done_ =
        as_size(std::ranges::count(folder.design(), who_.number, &PlannedTrial::participant)) - left_.size();
    if (left_.empty()) screen_ = form_is_filled() ? ParticipantScreen::kThanks : ParticipantScreen::kForm;
  }

  void run();

 private:
  static constexpr float kTextHeight = 20.0F;
  static constexpr Background kGround{{0.62F, 0.62F, 0.62F}, {0.62F, 0.62F, 0.62F}};
  static constexpr double kLeastTrial = 0.3;     ///< [s] before which none is ended: a slip of the finger
  static constexpr double kLongestStart = 60.0;  ///< [s] that the start waits

  [[nodiscard]] WindowOptions window_options() const {
    WindowOptions window;
    window.program = "study " + who_.code;
    window.width = options_.width;
    window.height = options_.height;
    window.view.stereo = options_.stereo;
    return window;
  }
  [[nodiscard]] bool form_is_filled() const { return !folder_.answers(who_.code).empty(); }
  [[nodiscard]] bool in_trial() const noexcept {
    return screen_ == ParticipantScreen::kStart || screen_ == ParticipantScreen::kTrial;
  }
  [[nodiscard]] ParticipantSight sight() const;
  void take(const std::vector<InputEvent>& events);
  void space();
  void open_trial();
  void close_trial();
  void leave_start();
  [[nodiscard]] bool mouse_is_off_start() const;
  void end_trial(bool by_clock);
  void watch_force();
  void tell(const std::string& what) const {
    if (options_.tell) options_.tell(who_.code + ": " + what);
  }
  /// The picture of the trial at work, for the part of the window that an eye has.
  [[nodiscard]] SceneView seen(const Vec3* cursor = nullptr) const;
  [[nodiscard]] std::string hint() const;
  /// Upper left corners of the parts of the window that hold the same text: one an eye where each has its half.
  [[nodiscard]] std::vector<Vec2> corners() const;
  void lead_mouse(bool grab);
  void draw(const std::vector<InputEvent>& events, double seconds);
  void draw_text();
  void draw_form();
  void draw_hint();
  void draw_page();

  StudyFolder& folder_;
  const StudyTasks& tasks_;
  StudyParticipant who_;
  RecordingHeader header_;
  const ParticipantWindowOptions& options_;
  GlfwWindow glfw_;
  Gui gui_;
  SceneRenderer renderer_;
  HandDevice device_;
  std::vector<PlannedTrial> left_;
  std::size_t done_ = 0;
  std::unique_ptr<LiveTrial> live_;
  ParticipantScreen screen_ = ParticipantScreen::kWelcome;
  std::map<std::string, std::string> answers_;
  std::string last_;                    ///< what is said of the last trial
  ForceCut refusal_ = ForceCut::kNone;  ///< what was told of the trial at work
  Camera camera_;
  Vec2 mouse_{0.0};
  Vec3 lead_{0.0};      ///< [m] where the mouse leads the cursor
  double depth_ = 0.0;  ///< [m] of the mouse's cursor, towards the viewer from the focal point
  bool pressed_ = false;
  bool space_down_ = false;
  bool entered_ = false;
  int width_ = 1, height_ = 1, frame_ = 0;
  EyePictureSize eye_{1, 1};  ///< the window, or its half
  struct PageSize {
    ParticipantScreen screen = ParticipantScreen::kWelcome;
    int width = 0, height = 0;

    bool operator==(const PageSize&) const = default;
  };
  PageSize page_;            ///< that was drawn last
  float text_scale_ = 1.0F;  ///< of its text
};

SceneView ParticipantWindow::seen(const Vec3* cursor) const {
  SceneView view =
      live_->trial().view(cursor, static_cast<double>(eye_.width) / static_cast<double>(eye_.height));
  if (view.camera.projection != Projection::kPerspective) return view;  // flat: both eyes see the same
  view.stereo = options_.stereo;
  view.stereo.first = pixel_on_monitor(glfw_.get());
  return view;
}

std::vector<Vec2> ParticipantWindow::corners() const {
  std::vector<Vec2> out{Vec2{0.0}};
  if (const auto twin = in_other_half(
          options_.stereo, {0.0, 0.0, static_cast<double>(width_), static_cast<double>(height_)}, 0.0, 0.0))
    out.push_back(*twin);
  return out;
}

ParticipantSight ParticipantWindow::sight() const {
  ParticipantSight out{.frame = frame_, .screen = screen_, .width = eye_.width, .height = eye_.height};
  out.left = left_.size();
  if (!live_ || !in_trial()) return out;
  out.camera = camera_;
  out.trial = &live_->trial();
  out.task = live_->info().name;
  out.hint = hint();
  out.guided = live_->planned().guided;
  out.lead = lead_;
  if (live_->newest() != nullptr) out.cursor = live_->newest()->probe;
  return out;
}

void ParticipantWindow::open_trial() {
  if (!entered_) folder_.enter(who_);  // not before: who leaves at the welcome takes no place
  entered_ = true;
  const PlannedTrial& next = left_.front();
  const StudyTask& task = *tasks_[as_size(next.task)];
  live_ = std::make_unique<LiveTrial>(next, task, device_.get(), header_,
                                      folder_.path() / ("sub-" + who_.code) / "trial_at_work.txt",
                                      options_.touch);
  const Vec3 start = live_->trial().start();
  camera_ = seen().camera;
  depth_ = task.info().flat ? 0.0 : glm::dot(start - camera_.focal_point, camera_.axes[2]);
  device_.place(camera_);
  refusal_ = ForceCut::kNone;
  screen_ = ParticipantScreen::kStart;
  lead_mouse(true);
}

void ParticipantWindow::close_trial() {
  device_.let_go();
  live_.reset();
}

/// Nobody began: the recording is not to grow for as long as nobody does.
void ParticipantWindow::leave_start() {
  close_trial();
  last_ = "Nobody has begun the trial for a minute.";
  screen_ = ParticipantScreen::kPause;
}

void ParticipantWindow::end_trial(bool by_clock) {
  const TrialOutcome outcome = live_->end(by_clock, static_cast<std::uint64_t>(frame_));
  const PlannedTrial planned = live_->planned();
  const StudyTaskInfo& info = live_->info();
  const TrialRecord record{
      who_.code,      info.name, folder_.run_of(planned), planned.stimulus, planned.practice,
      planned.guided, false,     options_.device,         outcome,          options_.touch.most_stiffness,
      planned.attempt};
  folder_.write(record, live_->recording(), live_->steps());
  last_ = outcome.timed_out ? "The time was up." : outcome.seconds > info.limit ? "Please be quicker." : "";
  if (outcome.flaws.any()) {
    const bool again = planned.attempt + 1 < StudyFolder::kMostAttempts;
    last_ = flaw_text(again);
    tell(record.task + "/" + std::to_string(record.run) + ": " + flaws_text(outcome.flaws) +
         (again ? "; it is repeated at the end of its block"
                : "; it was repeated often enough, and is left out"));
  }
  close_trial();
  left_ = folder_.left_for(who_);
  ++done_;
  const bool same_task = !left_.empty() && left_.front().task == planned.task;
  screen_ = left_.empty() ? ParticipantScreen::kForm
            : same_task   ? ParticipantScreen::kPause
                          : ParticipantScreen::kTask;
}

/// What keeps the force away before a trial is told as it changes.
void ParticipantWindow::watch_force() {
  live_->follow();
  if (screen_ != ParticipantScreen::kStart) return;
  const ForceCut now = live_->refusal();
  if (std::exchange(refusal_, now) != now && now != ForceCut::kNone)
    tell("before " + live_->info().name + "/" + std::to_string(folder_.run_of(live_->planned())) +
         ": no force (" + std::string(name_of(now)) +
         "); on the screen: " + refusal_text(now, live_->latched()));
}

/// The mouse leads in a plane parallel to the picture, the wheel through its depth.
/// @param grab the hand is put on it.
void ParticipantWindow::lead_mouse(bool grab) {
  if (!device_.by_mouse() || !in_trial()) return;
  const double perspective =
      camera_.projection == Projection::kPerspective ? 1.0 - depth_ / distance(camera_) : 1.0;
  const double unit = camera_.view_height / eye_.height * perspective;
  lead_ = camera_.focal_point + unit * (mouse_.x - 0.5 * eye_.width) * camera_.axes[0] -
          unit * (mouse_.y - 0.5 * eye_.height) * camera_.axes[1] + depth_ * camera_.axes[2];
  const double now = glfwGetTime();
  if (grab) device_.grab(now, lead_);
  device_.move(now, lead_, pressed_);
}

/// Whether a hand that is led by the mouse would leave the start as soon as nothing holds it there any more.
bool ParticipantWindow::mouse_is_off_start() const {
  if (!device_.by_mouse()) return false;
  Vec3 off = lead_ - live_->trial().start();
  if (live_->info().flat) off.z = 0.0;
  return glm::length(off) > LiveTrial::kAtStart;
}

void ParticipantWindow::space() {
  switch (screen_) {
    case ParticipantScreen::kWelcome:
      screen_ = ParticipantScreen::kTask;
      break;
    case ParticipantScreen::kTask:
    case ParticipantScreen::kPause:
      open_trial();
      break;
    case ParticipantScreen::kStart:
      if (live_->latched()) {
        live_->arm();
      } else if (live_->may_begin() && !mouse_is_off_start()) {
        live_->begin(folder_.plan().guidance, static_cast<std::uint64_t>(frame_));
        screen_ = ParticipantScreen::kTrial;
      }
      break;
    case ParticipantScreen::kTrial:
      if (live_->seconds() >= kLeastTrial) end_trial(false);
      break;
    case ParticipantScreen::kForm:
    case ParticipantScreen::kThanks:
      break;
  }
}

void ParticipantWindow::take(const std::vector<InputEvent>& events) {
  constexpr double kNotch = 0.002;  // [m] of depth
  for (const InputEvent& event : events) {
    if (event.kind == InputKind::kMove) mouse_ = {event.x, event.y};
    if (event.kind == InputKind::kPress && event.button == MouseButton::kLeft) pressed_ = true;
    if (event.kind == InputKind::kRelease && event.button == MouseButton::kLeft) pressed_ = false;
    if (event.kind == InputKind::kWheel && live_ && !live_->info().flat) depth_ -= kNotch * event.y;
    if (event.key == GLFW_KEY_SPACE && event.kind == InputKind::kKeyUp) space_down_ = false;
    if (event.key == GLFW_KEY_SPACE && event.kind == InputKind::kKeyDown) {
      const bool repeated = std::exchange(space_down_, true);  // held, a key comes again and again
      if (!repeated) space();
    }
    if (event.kind == InputKind::kKeyDown && event.key == GLFW_KEY_F12 && live_) live_->force_off();
    if (event.kind == InputKind::kKeyDown && event.key == GLFW_KEY_ESCAPE)
      glfwSetWindowShouldClose(glfw_.get(), GLFW_TRUE);
  }
}

void ParticipantWindow::draw_text() {
  std::string text;
  const auto next_task = [&]() -> const StudyTaskInfo& {
    return tasks_[as_size(left_.front().task)]->info();
  };
  switch (screen_) {
    case ParticipantScreen::kWelcome:
      text = welcome_text(done_, left_.size(), device_.by_mouse());
      break;
    case ParticipantScreen::kTask:
      text = task_text(next_task(), left_.front().practice, !next_task().flat && device_.by_mouse());
      break;
    case ParticipantScreen::kPause:
      text = pause_text(done_, left_.size(), left_.front().practice, last_);
      break;
    default:
      text = kThanksText;
      break;
  }
  ImGui::PushTextWrapPos(0.0F);
  ImGui::TextUnformatted(text.c_str());
  ImGui::PopTextWrapPos();
}

void ParticipantWindow::draw_form() {
  ImGui::TextUnformatted("Thank you. A few questions, which you may leave open:");
  ImGui::Spacing();
  for (const StudyQuestion& question : study_questions()) {
    ImGui::PushTextWrapPos(0.0F);
    ImGui::TextUnformatted(question.text.c_str());
    ImGui::PopTextWrapPos();
    std::string& answer = answers_[question.key];
    if (question.choices.empty()) {
      ImGui::SetNextItemWidth(-1.0F);
      input_text(("##" + question.key).c_str(), &answer);
    }
    for (const std::string& choice : question.choices) {
      const bool chosen = answer == choice;
      const std::string label = (chosen ? "[" + choice + "]" : " " + choice + " ") + "##" + question.key;
      ImGui::PushID(question.key.c_str());
      if (button(label.c_str())) answer = choice;
      ImGui::PopID();
      ImGui::SameLine();
    }
    ImGui::NewLine();
    ImGui::Spacing();
  }
  if (!button("Done")) return;
  folder_.write_answers(who_.code, answers_);
  screen_ = ParticipantScreen::kThanks;
}

/// A line below the picture: what to do now; empty: nothing is to be said.
std::string ParticipantWindow::hint() const {
  if (std::string advice = device_.advice(); !advice.empty()) return advice;
  if (screen_ == ParticipantScreen::kStart) {
    const std::string refusal = refusal_text(live_->refusal(), live_->latched());
    if (!refusal.empty()) return refusal;
    return live_->may_begin() && mouse_is_off_start()
               ? "Bring the mouse to the blue dot, too, then press the space bar."
               : "Bring the crosshair to the blue dot, then press the space bar.";
  }
  if (live_->flawed()) return kNoForceInTrial;
  return live_->seconds() > live_->info().limit ? "The time is up: finish, then press the space bar." : "";
}

void ParticipantWindow::draw_hint() {
  const std::string text = hint();
  if (text.empty()) return;
  const auto w = static_cast<float>(eye_.width), h = static_cast<float>(eye_.height);
  const float wrap = 0.94F * w;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str(), nullptr, false, wrap);
  ImGui::GetForegroundDrawList()->AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                                          {0.5F * (w - size.x), h - size.y - ImGui::GetFontSize()},
                                          IM_COL32(10, 10, 12, 255), text.c_str(), nullptr, wrap);
}

/// Text or form in the middle of the window, as small as it must be to fit.
void ParticipantWindow::draw_page() {
  constexpr float kHeight = 0.76F, kLeast = 0.62F, kMost = 0.96F,
                  kLine = 38.0F;  // kLine: heights of the text
  constexpr float kSmallest = 0.4F, kSpare = 0.98F;
  const auto w = static_cast<float>(eye_.width), h = static_cast<float>(eye_.height);
  const PageSize page{screen_, eye_.width, eye_.height};
  if (std::exchange(page_, page) != page) text_scale_ = 1.0F;
  const float wide = std::min(kMost * w, std::max(kLeast * w, kLine * gui_.text_height()));
  const float high = text_scale_ < 1.0F ? kMost * h : kHeight * h;
  ImGui::SetNextWindowPos({0.5F * (w - wide), 0.5F * (h - high)});
  ImGui::SetNextWindowSize({wide, high});
  ImGui::Begin("study", nullptr,
               ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
  ImGui::SetWindowFontScale(text_scale_);
  screen_ == ParticipantScreen::kForm ? draw_form() : draw_text();
  // What it takes at this size is known only now: the next picture is drawn smaller.
  if (const float taken = ImGui::GetCursorPosY() + ImGui::GetStyle().WindowPadding.y; taken > high)
    text_scale_ = std::max(kSmallest, kSpare * text_scale_ * std::min(1.0F, kMost * h / taken));
  ImGui::End();
}

void ParticipantWindow::draw(const std::vector<InputEvent>& events, double seconds) {
  gui_.begin_frame(events, eye_.width, eye_.height, seconds);
  begin_controls();
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  glViewport(0, 0, width_, height_);
  glClearColor(kGround.top.r, kGround.top.g, kGround.top.b, 1.0F);
  glClear(GL_COLOR_BUFFER_BIT);
  const std::vector<Vec2> parts = corners();
  if (in_trial()) {
    const HandStep* const newest = live_->newest();
    const SceneView view = seen(newest != nullptr && newest->present ? &newest->probe : nullptr);
    if (has_two_eyes(view)) {
      renderer_.draw(view, width_, height_);
      renderer_.show(0, 0);
    } else {
      renderer_.draw(view, eye_.width, eye_.height);
      for (const Vec2& corner : parts)
        renderer_.show(static_cast<int>(corner.x), height_ - eye_.height - static_cast<int>(corner.y));
    }
    draw_hint();
  } else {
    draw_page();
  }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  gui_.end_frame(parts, width_, height_);
}

void ParticipantWindow::run() {
  Stopwatch clock;
  while (glfwWindowShouldClose(glfw_.get()) == GLFW_FALSE) {
    if (options_.stop_requested && options_.stop_requested()) break;
    glfwPollEvents();
    glfwGetFramebufferSize(glfw_.get(), &width_, &height_);
    if (width_ < 1 || height_ < 1) {
      constexpr double kRest = 0.1;
      glfwWaitEventsTimeout(kRest);
      continue;
    }
    eye_ = eye_picture_size(options_.stereo.mode, width_, height_);
    std::vector<InputEvent> events = std::exchange(glfw_.events(), {});
    if (options_.each_frame) options_.each_frame(sight());
    for (InputEvent& event : events) {  // in either half the mouse is where the same thing is seen
      if (event.kind != InputKind::kMove) continue;
      const PictureArea window{0.0, 0.0, static_cast<double>(width_), static_cast<double>(height_)};
      const PictureArea area = eye_area(options_.stereo, window, event.x, event.y).area;
      event.x -= area.left;
      event.y -= area.top;
    }
    take(events);
    lead_mouse(false);
    if (live_) watch_force();
    if (screen_ == ParticipantScreen::kTrial && live_->seconds() >= live_->info().most_seconds())
      end_trial(true);
    if (screen_ == ParticipantScreen::kStart && live_->waited() > kLongestStart) leave_start();
    const double seconds = clock.seconds();
    clock.restart();
    draw(events, seconds);
    if (options_.photograph) {
      if (const auto file = options_.photograph(sight()); !file.empty())
        write_png(file, read_framebuffer(0, width_, height_), {});
    }
    glfwSwapBuffers(glfw_.get());
    ++frame_;
  }
}

}  // namespace

void run_participant_window(StudyFolder& folder, const StudyTasks& tasks, const StudyParticipant& who,
                            const RecordingHeader& header, const ParticipantWindowOptions& options) {
  ParticipantWindow(folder, tasks, who, header, options).run();
}

}  // namespace palpate
