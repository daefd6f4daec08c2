/// A session of an experiment in the window, in a process of its own, worked by somebody with the mouse and keyboard of
/// its display.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <thread>
#include <utility>
#include <vector>

#include <sys/wait.h>
#include <unistd.h>

#include "apps/flow/study/path_task.h"
#include "common/cli/simulated_option.h"
#include "common/experiment/participant_window.h"
#include "common/study/study_folder.h"
#include "common/window/panels/panel_parts.h"

namespace palpate::test {

namespace fs = std::filesystem;

inline StudyPlan session_plan() {
  StudyPlan plan{.program = "flow",
                 .version = "test",
                 .tasks = {"tracing2d", "advection3d", "advection2d", "tracing3d"}};
  plan.design = {.participants = 2, .tasks = 4, .practice = 0, .recorded = 2, .seed = 11};
  return plan;
}

/// The tasks of a plan, as they are made of its seed.
inline StudyTasks prepared_tasks(const StudyPlan& plan) {
  Progress progress;
  StudyTasks out;
  for (const std::string& name : plan.tasks) {
    for (const auto& task :
         {make_tracing_2d(), make_advection_3d(), make_advection_2d(), make_tracing_3d()}) {
      if (task->info().name != name) continue;
      (void)task->prepare(plan.design.seed, plan.design.practice + plan.design.recorded, progress);
      out.push_back(task);
    }
  }
  return out;
}

using Clock = std::chrono::steady_clock;

/// Mouse and keyboard of the display, worked through the X server's own test extension by xdotool: events reach the
/// window as those of people do. What is to be done is done at its time, however long a picture takes.
class MouseAndKeys {
 public:
  struct Stroke {
    double after;      ///< [s] the one before it
    std::string what;  ///< a command of xdotool
  };

  [[nodiscard]] static bool is_there() { return std::system("command -v xdotool >/dev/null 2>&1") == 0; }

  MouseAndKeys()
      : to_(::popen("exec xdotool -", "w")), worker_([this](const std::stop_token& s) { work(s); }) {}
  MouseAndKeys(const MouseAndKeys&) = delete;
  MouseAndKeys& operator=(const MouseAndKeys&) = delete;
  ~MouseAndKeys() {
    worker_.request_stop();
    worker_.join();
    if (to_ != nullptr) (void)::pclose(to_);
  }

  void play(const std::vector<Stroke>& strokes) {
    const std::lock_guard lock(mutex_);
    Clock::time_point at = left_.empty() ? Clock::now() : left_.back().first;
    for (const auto& [after, what] : strokes) {
      at += std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(after));
      left_.emplace_back(at, what);
    }
  }
  /// What is not yet done will not be.
  void stop() {
    const std::lock_guard lock(mutex_);
    left_.clear();
  }
  [[nodiscard]] bool idle() const {
    const std::lock_guard lock(mutex_);
    return left_.empty();
  }

 private:
  void work(const std::stop_token& stopped) {
    while (!stopped.stop_requested()) {
      constexpr auto kTick = std::chrono::milliseconds(2);
      std::this_thread::sleep_for(kTick);
      const std::lock_guard lock(mutex_);
      for (; !left_.empty() && left_.front().first <= Clock::now(); left_.pop_front()) {
        std::fputs((left_.front().second + "\n").c_str(), to_);
        std::fflush(to_);
      }
    }
  }

  std::FILE* to_;
  mutable std::mutex mutex_;
  std::deque<std::pair<Clock::time_point, std::string>> left_;
  std::jthread worker_;
};

/// Somebody with a mouse who does what the screens say, a few times faster than people do. The window is in the upper
/// left corner of a display without a window manager.
class Hands {
 public:
  /// @param slow [s] for which each picture of the first two trials stays longer than it must. @param faults presses F12 at the first start and
  /// in the first trial.
  explicit Hands(double slow = 0.0, bool faults = false) : slow_(slow), faults_(faults) {}

  void operator()(const ParticipantSight& sight) {
    constexpr std::size_t kSlowTrials = 2;
    constexpr double kPause = 0.03;  // [s] more pictures than that cost time and show nothing
    if (!left_at_first_) left_at_first_ = sight.left;
    const bool slow = *left_at_first_ - sight.left < kSlowTrials;
    std::this_thread::sleep_for(std::chrono::duration<double>(slow ? std::max(slow_, kPause) : kPause));
    if (!x_) {
      x_ = std::make_shared<MouseAndKeys>();
      act({{0.0, "mousemove 200 200"},
           {0.0, "keyup space"},
           {0.0, "mouseup 1"}});  // who was killed held them
    }
    if (sight.screen != screen_ || sight.left != left_) {
      screen_ = sight.screen;
      left_ = sight.left;
      at_start_ = traced_ = said_ = false;
    }
    if (!x_->idle()) {
      frames_ = 0;
      rested_ = Clock::now();
    }
    ++frames_;
    switch (sight.screen) {
      case ParticipantScreen::kWelcome:
      case ParticipantScreen::kTask:
      case ParticipantScreen::kPause:
        if (ready()) press("space");
        break;
      case ParticipantScreen::kStart:
        begin(sight);
        break;
      case ParticipantScreen::kTrial:
        trace(sight);
        break;
      case ParticipantScreen::kForm:
        if (ready()) fill_in();
        break;
      case ParticipantScreen::kThanks:
        if (ready()) press("Escape");
        break;
    }
  }

 private:
  using Strokes = std::vector<MouseAndKeys::Stroke>;

  void act(const Strokes& strokes) {
    x_->play(strokes);
    frames_ = 0;
    rested_ = Clock::now();
  }
  void press(const std::string& key) { act({{0.0, "key " + key}}); }
  /// Whether what was done last has been seen for a while.
  [[nodiscard]] bool ready(double rest = 0.1) const {
    constexpr int kFrames = 4;
    return x_->idle() && frames_ >= kFrames &&
           std::chrono::duration<double>(Clock::now() - rested_).count() >= rest;
  }
  /// The mouse to where `x` is seen, the wheel by the notches that the depth is off. @param turned notches up till now.
  static void lead(const ParticipantSight& sight, const Vec3& x, double after, int& turned,
                   Strokes& strokes) {
    const Vec3 pixel = project(sight.camera, x, sight.width, sight.height);
    strokes.push_back({after, "mousemove " + std::to_string(std::lround(pixel.x)) + " " +
                                  std::to_string(std::lround(pixel.y))});
    if (sight.camera.projection != Projection::kPerspective) return;
    constexpr double kNotch = 0.002;  // [m]
    const auto wanted =
        static_cast<int>(std::lround(glm::dot(sight.lead - x, sight.camera.axes[2]) / kNotch));
    for (; turned < wanted; ++turned) strokes.push_back({0.0, "click 4"});
    for (; turned > wanted; --turned) strokes.push_back({0.0, "click 5"});
  }
  /// To the start, and the bar, until the trial begins. It is held longer than a shortest trial, and the first time
  /// until it comes again: neither ends the trial.
  void begin(const ParticipantSight& sight) {
    if (!ready()) return;
    if (!std::exchange(at_start_, true)) {
      Strokes strokes;
      int turned = 0;
      lead(sight, sight.trial->start(), 0.0, turned, strokes);
      if (faults_) strokes.push_back({0.1, "key F12"});
      off_in_trial_ = off_in_trial_ || std::exchange(faults_, false);
      act(strokes);
      return;
    }
    constexpr double kNear = 0.003;  // [m]
    if (!ready(0.3) || glm::distance(sight.cursor, sight.trial->start()) > kNear) return;
    constexpr double kLong = 1.0, kShort = 0.4;  // [s]
    act({{0.0, "keydown space"}, {std::exchange(hold_long_, false) ? kLong : kShort, "keyup space"}});
  }
  /// Along what is drawn from the cursor on, and the bar where the goal is met, or where there is no more to follow.
  void trace(const ParticipantSight& sight) {
    constexpr double kSpeed = 0.06, kPiece = 0.02, kFarthest = 0.14;  // [m/s], [s], [m]
    if (!traced_ && x_->idle()) {
      traced_ = true;
      Strokes strokes;
      if (std::exchange(off_in_trial_, false)) strokes.push_back({0.0, "key F12"});
      int turned = 0;
      corrections_ = 0;
      Vec3& aim = aim_ = sight.cursor;
      for (double far = 0.0; far < kFarthest; far += kPiece * kSpeed) {
        const TrialCue cue = sight.trial->cue(aim, 0.0);
        if (cue.arrived) break;
        aim += kPiece * kSpeed * cue.along;
        lead(sight, aim, kPiece, turned, strokes);
      }
      goal_ = aim;
      act(strokes);
    }
    constexpr double kRest = 0.15, kPatience = 1.5;  // [s]
    constexpr int kMostCorrections = 20;
    if (traced_ && !said_ && !sight.trial->reached() && ready(kRest) && corrections_++ < kMostCorrections) {
      // The drag keeps the crosshair short of the mouse: on by as much as it lacks.
      aim_ += goal_ - sight.cursor;
      int turned = 0;
      Strokes strokes;
      lead(sight, aim_, 0.0, turned, strokes);
      act(strokes);
    }
    if (!traced_ || !((sight.trial->reached() && !said_) || ready(kPatience))) return;
    said_ = true;
    x_->stop();
    press("space");
  }
  /// A 4 for each question, a control at a time; what was chosen is called otherwise then.
  void fill_in() {
    if (std::exchange(pressed_, false)) {
      act({{0.0, "mouseup 1"}});
      return;
    }
    for (const char* label : {" 4 ", "Done"}) {
      for (const DrawnControl& control : drawn_controls()) {
        if (control.label != label) continue;
        act({{0.0, "mousemove " + std::to_string(std::lround(control.left + 0.5 * control.width)) + " " +
                       std::to_string(std::lround(control.top + 0.5 * control.height))},
             {0.05, "mousedown 1"}});
        pressed_ = true;
        return;
      }
    }
  }

  double slow_;
  std::optional<std::size_t> left_at_first_;  ///< trials
  bool faults_, off_in_trial_ = false, hold_long_ = true, pressed_ = false;
  bool at_start_ = false, traced_ = false, said_ = false;  ///< what is done of a trial
  Vec3 aim_{0.0}, goal_{0.0};                              ///< [m] of the mouse, and of the crosshair at last
  int corrections_ = 0;
  ParticipantScreen screen_ = ParticipantScreen::kThanks;
  std::size_t left_ = 0;
  std::shared_ptr<MouseAndKeys> x_;  ///< made in the process of the session
  int frames_ = 0;                   ///< since the last stroke
  Clock::time_point rested_;         ///< likewise
};

/// A picture of each task with guidance, where nothing is wrong with the force, what is said before it, and the form.
class Photographs {
 public:
  explicit Photographs(fs::path folder) : folder_(std::move(folder)) {}
  fs::path operator()(const ParticipantSight& sight) {
    frames_ = sight.screen == screen_ ? frames_ + 1 : 0;
    screen_ = sight.screen;
    const bool trial = screen_ == ParticipantScreen::kTrial;
    if (!trial && screen_ != ParticipantScreen::kTask && screen_ != ParticipantScreen::kForm) return {};
    if (trial && (!sight.guided || !sight.hint.empty())) return {};
    // On the way: clear of the blue start, before the red end.
    constexpr double kOnTheWay = 0.02;  // [m]
    if (trial ? glm::distance(sight.cursor, sight.trial->start()) < kOnTheWay : frames_ != 2) return {};
    const std::string name = trial ? sight.task : "screen" + std::to_string(static_cast<int>(screen_));
    if (!taken_.insert(name).second) return {};
    return folder_ / ("study_" + name + ".png");
  }

 private:
  fs::path folder_;
  std::set<std::string> taken_;
  int frames_ = 0;
  ParticipantScreen screen_ = ParticipantScreen::kThanks;
};

/// What is told, before a number [m], of how deep the mouse leads as a start is shown: off the start, towards the viewer.
inline constexpr std::string_view kStartDepth = "depth off the start: ";

struct SessionWish {
  const StudyTasks& tasks;  ///< prepared
  Hands hands;
  fs::path told;      ///< a file for what is told; empty: none
  fs::path pictures;  ///< a folder; empty: none
  StereoMode stereo = StereoMode::kNone;
};

/// The session of P01 in a process of its own. @return its number.
inline pid_t start_session(const fs::path& folder, const SessionWish& wish) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int status = 0;
  try {
    StudyFolder opened(folder);
    const StudyParticipant who{"P01", 0, false, {}};
    ParticipantWindowOptions options;
    options.device = "simulated";
    options.touch.simulated = simulated_option("simulated");
    options.touch.limits = simulated_limits(*options.touch.simulated, {});
    options.stereo.mode = wish.stereo;
    std::ofstream told(wish.told);
    std::string hint;
    ParticipantScreen screen = ParticipantScreen::kThanks;
    options.each_frame = [&told, &hint, &screen, hands = wish.hands](const ParticipantSight& sight) mutable {
      const bool opened = std::exchange(screen, sight.screen) != sight.screen;
      if (opened && sight.screen == ParticipantScreen::kStart) {
        told << kStartDepth << glm::dot(sight.lead - sight.trial->start(), sight.camera.axes[2]) << std::endl;
      }
      if (std::exchange(hint, sight.hint) != sight.hint) told << "screen: " << sight.hint << std::endl;
      hands(sight);
    };
    options.tell = [&told](const std::string& line) { told << line << std::endl; };
    if (wish.pictures.empty()) {  // a small picture is drawn sooner
      options.width = 576;
      options.height = 432;
    } else {
      options.photograph = Photographs(wish.pictures);
    }
    if (wish.stereo != StereoMode::kNone) options.height = 576;
    run_participant_window(opened, wish.tasks, who, {}, options);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    status = 1;
  }
  std::fflush(nullptr);
  ::_exit(status);
}

/// Ends the session with the test, whichever way that ends.
class SessionGuard {
 public:
  explicit SessionGuard(pid_t child) : child_(child) {}
  SessionGuard(const SessionGuard&) = delete;
  SessionGuard& operator=(const SessionGuard&) = delete;
  ~SessionGuard() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(child_, nullptr, 0);
  }
  /// Its status once it has ended; none where it has not.
  [[nodiscard]] std::optional<int> ended() {
    int status = 0;
    if (::waitpid(child_, &status, WNOHANG) != child_) return std::nullopt;
    child_ = -1;
    return status;
  }

 private:
  pid_t child_;
};

inline bool wait_until(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(400);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// Its status once the session has ended; none where it takes too long.
inline std::optional<int> outcome_of(SessionGuard& session) {
  std::optional<int> status;
  (void)wait_until([&] { return (status = session.ended()).has_value(); });
  return status;
}

}  // namespace palpate::test
