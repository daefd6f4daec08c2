#include "common/experiment/participant_window.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <thread>
#include <utility>

#include <GLFW/glfw3.h>
#include <epoxy/gl.h>
#include <imgui.h>

#include "common/base/clock.h"
#include "common/base/error.h"
#include "common/base/index.h"
#include "common/device/mouse_device.h"
#include "common/device/simulated_device.h"
#include "common/experiment/screen_texts.h"
#include "common/render/gl/target.h"
#include "common/render/png.h"
#include "common/render/scene_renderer.h"
#include "common/servo/placed_device.h"
#include "common/servo/recorder.h"
#include "common/servo/servo_loop.h"
#include "common/window/glfw_window.h"
#include "common/window/gui.h"
#include "common/window/panels/panel_parts.h"
#include "common/window/window.h"

namespace palpate {
namespace {

/// The device in the participant's hand: a mouse, a simulated hand that follows it, or a real one.
class HandDevice {
 public:
  explicit HandDevice(const ProbeSessionOptions& touch) : mouse_(touch.limits) {
    if (touch.simulated) {
      SimulatedDeviceOptions simulated = *touch.simulated;
      simulated.limits = touch.limits;
      simulated.wander.reset();
      simulated_ = std::make_unique<SimulatedDevice>(simulated, mouse_);
    }
    if (!touch.link) return;
    linked_ = std::make_unique<LinkedDevice>(touch.link, touch.enabling, touch.limits);
    placed_ = std::make_unique<PlacedDevice>(*linked_, touch.limits, Placement{}, Box{Vec3{-1.0}, Vec3{1.0}});
  }

  [[nodiscard]] Device& get() {
    if (placed_) return *placed_;
    return simulated_ ? static_cast<Device&>(*simulated_) : mouse_;
  }
  [[nodiscard]] bool by_mouse() const noexcept { return placed_ == nullptr; }
  /// The middle of the device is at the middle of the picture, its axes are those of the view.
  void place(const Camera& camera) {
    if (placed_) placed_->place({.middle = camera.focal_point, .axes = camera.axes});
  }
  void grab(double time, const Vec3& x) { mouse_.grab(time, x, 0); }
  void move(double time, const Vec3& x, bool button) { mouse_.move(time, x, button ? 1U : 0U); }
  void let_go() {
    if (mouse_.grabbed()) mouse_.let_go();
  }
  [[nodiscard]] std::string advice() const { return linked_ ? linked_->advice() : std::string(); }

 private:
  MouseDevice mouse_;
  std::unique_ptr<SimulatedDevice> simulated_;
  std::unique_ptr<LinkedDevice> linked_;
  std::unique_ptr<PlacedDevice> placed_;
};

/// One trial at work: the servo with its recording.
struct LiveTrial {
  PlannedTrial planned;
  const StudyTask* task = nullptr;
  std::unique_ptr<StudyTrial> trial;
  std::unique_ptr<Recorder> recorder;
  std::unique_ptr<ServoLoop> servo;  // last: it uses the recorder
  std::vector<HandStep> steps;       ///< from begin on
  std::uint64_t begin = 0, end = 0;
  std::optional<HandStep> newest;
  Stopwatch opened;
  bool begun = false, ended = false;
};

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
    glfwSwapInterval(options.hands ? 0 : 1);
    gui_.set_background(kGround);
    done_ = static_cast<std::size_t>(
                std::ranges::count(folder.design(), who_.number, &PlannedTrial::participant)) -
            left_.size();
    if (left_.empty()) screen_ = form_is_filled() ? ParticipantScreen::kThanks : ParticipantScreen::kForm;
  }

  void run();

 private:
  static constexpr float kTextHeight = 20.0F;
  static constexpr Background kGround{{0.62F, 0.62F, 0.62F}, {0.62F, 0.62F, 0.62F}};
  static constexpr double kAtStart = 0.004;      ///< [m] from the start where a trial may begin
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
  [[nodiscard]] double trial_seconds() const;
  void open_trial();
  void leave_start();
  void begin_trial();
  void end_trial(bool by_clock);
  void save_trial(bool by_clock);
  void follow();
  void lead_mouse(bool grab);
  void draw(const std::vector<InputEvent>& events, double seconds);
  void draw_text();
  void draw_form();
  void draw_hint();

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
  std::string last_;  ///< what is said of the last trial
  Camera camera_;
  Vec2 mouse_{0.0};
  double depth_ = 0.0;  ///< [m] of the mouse's cursor, towards the viewer from the focal point
  bool pressed_ = false;
  bool space_down_ = false;
  bool entered_ = false;
  int width_ = 1, height_ = 1, frame_ = 0;
};

ParticipantSight ParticipantWindow::sight() const {
  ParticipantSight out{.frame = frame_, .screen = screen_, .width = width_, .height = height_};
  out.left = left_.size();
  if (!live_ || !in_trial()) return out;
  out.camera = camera_;
  out.trial = live_->trial.get();
  if (live_->newest) out.cursor = live_->newest->probe;
  return out;
}

double ParticipantWindow::trial_seconds() const {
  return live_->steps.empty() ? 0.0 : live_->steps.back().time - live_->steps.front().time;
}

void ParticipantWindow::open_trial() {
  if (!entered_) folder_.enter(who_);  // not before: who leaves at the welcome takes no place
  entered_ = true;
  live_ = std::make_unique<LiveTrial>();
  live_->planned = left_.front();
  live_->task = tasks_[as_size(live_->planned.task)].get();
  live_->trial = live_->task->open(live_->planned.stimulus);
  live_->trial->begin();
  const Vec3 start = live_->trial->start();
  camera_ = live_->trial->view(nullptr, static_cast<double>(width_) / height_).camera;
  depth_ = live_->task->info().flat ? 0.0 : glm::dot(start - camera_.focal_point, camera_.axes[2]) + 0.02;
  device_.place(camera_);
  // A trial that was at work when the window was killed is done again.
  const auto file = folder_.path() / ("sub-" + who_.code) / "trial_at_work.txt";
  live_->recorder = std::make_unique<Recorder>(file, header_, true);
  ServoOptions servo{.rate = options_.touch.servo_rate};
  const std::string words = start_text(options_.touch.most_stiffness);
  live_->servo = std::make_unique<ServoLoop>(device_.get(), chain_of(*live_->trial, words), words, servo,
                                             live_->recorder.get());
  screen_ = ParticipantScreen::kStart;
  lead_mouse(true);
}

/// Nobody began: the recording is not to grow for as long as nobody does.
void ParticipantWindow::leave_start() {
  live_->servo.reset();
  live_->recorder->finish();
  device_.let_go();
  live_.reset();
  std::error_code ignored;
  std::filesystem::remove(folder_.path() / ("sub-" + who_.code) / "trial_at_work.txt", ignored);
  last_ = "Nobody has begun the trial for a minute.";
  screen_ = ParticipantScreen::kPause;
}

void ParticipantWindow::begin_trial() {
  const ChainWords words{live_->task->info().name, live_->planned.stimulus, live_->planned.guided,
                         folder_.plan().guidance, options_.touch.most_stiffness};
  const std::string text = chain_text(words);
  live_->servo->swap_chain(chain_of(*live_->trial, text), text);
  live_->begin = live_->servo->next_step();
  live_->recorder->event(live_->begin, static_cast<std::uint64_t>(frame_), kBeginEvent);
  live_->begun = true;
  screen_ = ParticipantScreen::kTrial;
}

void ParticipantWindow::end_trial(bool by_clock) {
  live_->end = live_->servo->next_step();
  live_->recorder->event(live_->end, static_cast<std::uint64_t>(frame_), by_clock ? kTimeEvent : kDoneEvent);
  live_->ended = true;
  follow();
  live_->servo.reset();
  live_->recorder->finish();
  device_.let_go();
  save_trial(by_clock);
  left_.erase(left_.begin());
  ++done_;
  const bool same_task = !left_.empty() && left_.front().task == live_->planned.task;
  live_.reset();
  screen_ = left_.empty() ? ParticipantScreen::kForm
            : same_task   ? ParticipantScreen::kPause
                          : ParticipantScreen::kTask;
}

void ParticipantWindow::save_trial(bool by_clock) {
  const PlannedTrial& planned = live_->planned;
  const auto file = folder_.path() / ("sub-" + who_.code) / "trial_at_work.txt";
  const std::string text = read_whole(file);
  TrialRecord record{who_.code,
                     live_->task->info().name,
                     planned.trial + 1,
                     planned.stimulus,
                     planned.practice,
                     planned.guided,
                     false,
                     options_.device,
                     TrialOutcome{},
                     options_.touch.most_stiffness};
  TrialOutcome& outcome = record.outcome;
  outcome.begin = live_->begin;
  outcome.end = live_->end;
  outcome.timed_out = by_clock;
  if (live_->steps.size() == live_->end - live_->begin && !live_->steps.empty()) {
    outcome.seconds = trial_seconds();
    outcome.error = live_->trial->error();
    outcome.reached = live_->trial->reached();
    outcome.flaws = flaws_of(live_->steps, live_->recorder->lost());
  } else {  // a picture took so long that steps were dropped on their way here: the recording has them all
    const std::unique_ptr<StudyTrial> again = live_->task->open(planned.stimulus);
    outcome = replay_trial(*again, read_recording(file.string())).outcome;
  }
  folder_.write(record, text, live_->steps);
  std::error_code ignored;
  std::filesystem::remove(file, ignored);
  last_ = outcome.timed_out                             ? "The time was up."
          : outcome.seconds > live_->task->info().limit ? "Please be quicker."
                                                        : "";
}

void ParticipantWindow::follow() {
  if (!live_ || !live_->servo) return;
  live_->servo->collect_retired();
  constexpr auto kPatience = std::chrono::milliseconds(1);
  constexpr int kTries = 500;
  for (int tries = 0; tries < kTries; ++tries) {
    HandStep step;
    bool last = false;
    while (live_->servo->pop_step(step)) {
      live_->newest = step;
      if (live_->begun && step.number >= live_->begin && (!live_->ended || step.number < live_->end)) {
        live_->trial->follow(step);
        live_->steps.push_back(step);
      }
      last = live_->ended && step.number + 1 >= live_->end;
    }
    if (!live_->ended || last) return;
    std::this_thread::sleep_for(kPatience);  // the last step is still on its way
  }
}

/// The mouse leads in a plane parallel to the picture, the wheel through its depth.
/// @param grab the hand is put on it.
void ParticipantWindow::lead_mouse(bool grab) {
  if (!device_.by_mouse() || !in_trial()) return;
  const double perspective =
      camera_.projection == Projection::kPerspective ? 1.0 - depth_ / distance(camera_) : 1.0;
  const double unit = camera_.view_height / height_ * perspective;
  const Vec3 x = camera_.focal_point + unit * (mouse_.x - 0.5 * width_) * camera_.axes[0] -
                 unit * (mouse_.y - 0.5 * height_) * camera_.axes[1] + depth_ * camera_.axes[2];
  const double now = glfwGetTime();
  if (grab) device_.grab(now, x);
  device_.move(now, x, pressed_);
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
      if (live_->newest && live_->newest->present) {
        Vec3 off = live_->newest->probe - live_->trial->start();
        if (live_->task->info().flat) off.z = 0.0;
        if (glm::length(off) <= kAtStart) begin_trial();
      }
      break;
    case ParticipantScreen::kTrial:
      if (trial_seconds() >= kLeastTrial) end_trial(false);
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
    if (event.kind == InputKind::kWheel && live_ && !live_->task->info().flat) depth_ -= kNotch * event.y;
    if (event.key == GLFW_KEY_SPACE && event.kind == InputKind::kKeyUp) space_down_ = false;
    if (event.key == GLFW_KEY_SPACE && event.kind == InputKind::kKeyDown) {
      const bool repeated = std::exchange(space_down_, true);  // held, a key comes again and again
      if (!repeated) space();
    }
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

/// A line below the picture: what to do now.
void ParticipantWindow::draw_hint() {
  const StudyTaskInfo& info = live_->task->info();
  std::string text = device_.advice();
  if (text.empty() && screen_ == ParticipantScreen::kStart)
    text = "Bring the crosshair to the blue dot, then press the space bar.";
  if (text.empty() && trial_seconds() > info.limit)
    text = "The time is up: finish, then press the space bar.";
  if (text.empty()) return;
  const ImVec2 size = ImGui::CalcTextSize(text.c_str());
  ImGui::GetForegroundDrawList()->AddText(
      {0.5F * (static_cast<float>(width_) - size.x), static_cast<float>(height_) - 2.0F * size.y},
      IM_COL32(10, 10, 12, 255), text.c_str());
}

void ParticipantWindow::draw(const std::vector<InputEvent>& events, double seconds) {
  gui_.begin_frame(events, width_, height_, seconds);
  begin_controls();
  if (in_trial()) {
    const Vec3 cursor = live_->newest ? live_->newest->probe : camera_.focal_point;
    const bool there = live_->newest && live_->newest->present;
    SceneView view = live_->trial->view(there ? &cursor : nullptr, static_cast<double>(width_) / height_);
    view.stereo = options_.stereo;
    view.stereo.first = pixel_on_monitor(glfw_.get());
    renderer_.draw(view, width_, height_);
    renderer_.show(0, 0);
    draw_hint();
  } else {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width_, height_);
    glClearColor(kGround.top.r, kGround.top.g, kGround.top.b, 1.0F);
    glClear(GL_COLOR_BUFFER_BIT);
    constexpr float kPart = 0.62F;
    const auto w = static_cast<float>(width_), h = static_cast<float>(height_);
    ImGui::SetNextWindowPos({0.5F * (1.0F - kPart) * w, 0.12F * h});
    ImGui::SetNextWindowSize({kPart * w, 0.76F * h});
    ImGui::Begin("study", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings);
    screen_ == ParticipantScreen::kForm ? draw_form() : draw_text();
    ImGui::End();
  }
  gui_.end_frame();
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
    std::vector<InputEvent> events = std::exchange(glfw_.events(), {});
    if (options_.hands) {
      for (InputEvent& event : options_.hands(sight())) events.push_back(std::move(event));
    }
    take(events);
    lead_mouse(false);
    follow();
    if (screen_ == ParticipantScreen::kTrial && trial_seconds() >= live_->task->info().most_seconds())
      end_trial(true);
    if (screen_ == ParticipantScreen::kStart && live_->opened.seconds() > kLongestStart) leave_start();
    const double seconds = clock.seconds();
    clock.restart();
    draw(events, seconds);
    if (options_.photograph) {
      if (const auto file = options_.photograph(sight()); !file.empty())
        write_png(file, read_framebuffer(0, width_, height_), {});
    }
    glfwSwapBuffers(glfw_.get());
    ++frame_;
    if (screen_ == ParticipantScreen::kThanks && options_.hands) break;
  }
}

}  // namespace

void run_participant_window(StudyFolder& folder, const StudyTasks& tasks, const StudyParticipant& who,
                            const RecordingHeader& header, const ParticipantWindowOptions& options) {
  ParticipantWindow(folder, tasks, who, header, options).run();
}

}  // namespace palpate
