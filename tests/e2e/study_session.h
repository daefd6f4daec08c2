/// A session of an experiment in the window, in a process of its own, worked by somebody with mouse and keyboard.
#pragma once

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>
#include <optional>
#include <set>
#include <string>
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

inline constexpr int kSpace = 32;  // GLFW's number of the key

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

inline void press_key(int key, std::vector<InputEvent>& events) {
  events.push_back({.kind = InputKind::kKeyDown, .key = key});
  events.push_back({.kind = InputKind::kKeyUp, .key = key});
}

using Clock = std::chrono::steady_clock;

/// Somebody with a mouse who does what the screens say, a few times faster than people do. What they do depends on what
/// they see and on the time, however long a picture takes: nothing is counted in frames.
class Hands {
 public:
  /// @param slow [s] for which each picture stays longer than it must. @param faults presses F12 at the first start and
  /// in the first trial.
  explicit Hands(double slow = 0.0, bool faults = false) : slow_(slow), faults_(faults) {}

  std::vector<InputEvent> operator()(const ParticipantSight& sight) {
    std::this_thread::sleep_for(std::chrono::duration<double>(slow_));
    std::vector<InputEvent> events;
    if (sight.screen != screen_ || sight.left != left_) {
      screen_ = sight.screen;
      left_ = sight.left;
      since_ = Clock::now();
      aim_.reset();
    }
    const double waited = std::chrono::duration<double>(Clock::now() - since_).count();
    constexpr double kRead = 0.1;  // [s]
    switch (sight.screen) {
      case ParticipantScreen::kWelcome:
      case ParticipantScreen::kTask:
      case ParticipantScreen::kPause:
        if (waited > kRead) press_key(kSpace, events);
        break;
      case ParticipantScreen::kStart:
        lead(sight, sight.trial->start(), events);
        if (std::exchange(faults_, false)) {
          off_in_trial_ = true;
          events.push_back({.kind = InputKind::kKeyDown, .key = kForceOff});
        }
        // The bar is pressed, and let go in the next frame, until the trial begins.
        events.push_back({.kind = down_ ? InputKind::kKeyUp : InputKind::kKeyDown, .key = kSpace});
        if (!down_ && glm::distance(sight.cursor, sight.trial->start()) > 0.003) events.pop_back();
        down_ = events.back().kind == InputKind::kKeyDown && events.back().key == kSpace;
        break;
      case ParticipantScreen::kTrial:
        // The bar is held longer than a shortest trial: a key that comes again ends none.
        events.push_back({.kind = InputKind::kKeyDown, .key = kSpace});
        if (waited > 0.4) {
          events.back().kind = InputKind::kKeyUp;
          down_ = false;
          if (std::exchange(off_in_trial_, false))
            events.push_back({.kind = InputKind::kKeyDown, .key = kForceOff});
          trace(sight, events);
        }
        break;
      case ParticipantScreen::kForm:
        fill_in(events);
        break;
      case ParticipantScreen::kThanks:
        break;
    }
    return events;
  }

 private:
  static constexpr int kForceOff = 301;  // GLFW's number of F12

  /// The mouse to where `x` is seen, the wheel to its depth.
  void lead(const ParticipantSight& sight, const Vec3& x, std::vector<InputEvent>& events) {
    const Vec3 pixel = project(sight.camera, x, sight.width, sight.height);
    events.push_back({.kind = InputKind::kMove, .x = pixel.x, .y = pixel.y});
    const double depth = glm::dot(sight.cursor - x, sight.camera.axes[2]);
    constexpr double kNotch = 0.002;  // [m]
    if (sight.camera.projection == Projection::kPerspective && std::abs(depth) > 0.5 * kNotch &&
        glm::length(sight.cursor) > 0.0)
      events.push_back({.kind = InputKind::kWheel, .y = std::clamp(std::round(depth / kNotch), -4.0, 4.0)});
  }
  /// The way on for as long as the last picture stayed, a little at a time: a slow window makes nobody slower.
  void trace(const ParticipantSight& sight, std::vector<InputEvent>& events) {
    const auto now = Clock::now();
    if (!aim_) {
      aim_ = sight.cursor;
      last_ = now;
    }
    constexpr double kSpeed = 0.06;                  // [m/s]
    constexpr double kPiece = 0.01, kLongest = 0.5;  // [s]
    double left = std::min(std::chrono::duration<double>(now - last_).count(), kLongest);
    last_ = now;
    TrialCue cue = sight.trial->cue(*aim_, 0.0);
    for (; left > 0.0 && !cue.arrived; left -= kPiece) {
      *aim_ += std::min(left, kPiece) * kSpeed * cue.along;
      cue = sight.trial->cue(*aim_, 0.0);
    }
    lead(sight, *aim_, events);
    if (cue.arrived || sight.trial->reached()) press_key(kSpace, events);
  }
  /// A 4 for each question, a control a frame; what was chosen is called otherwise then.
  void fill_in(std::vector<InputEvent>& events) {
    if (std::exchange(pressed_, false)) {
      events.push_back({.kind = InputKind::kRelease});
      return;
    }
    for (const char* label : {" 4 ", "Done"}) {
      for (const DrawnControl& control : drawn_controls()) {
        if (control.label != label) continue;
        events.push_back({.kind = InputKind::kMove,
                          .x = control.left + 0.5 * control.width,
                          .y = control.top + 0.5 * control.height});
        events.push_back({.kind = InputKind::kPress});
        pressed_ = true;
        return;
      }
    }
  }

  double slow_;
  bool faults_, off_in_trial_ = false, down_ = false, pressed_ = false;
  ParticipantScreen screen_ = ParticipantScreen::kThanks;
  std::size_t left_ = 0;
  std::optional<Vec3> aim_;
  Clock::time_point last_, since_;
};

/// A picture of each task, what is said before it, and the form, for the guide.
class Photographs {
 public:
  explicit Photographs(fs::path folder) : folder_(std::move(folder)) {}
  fs::path operator()(const ParticipantSight& sight) {
    frames_ = sight.screen == screen_ ? frames_ + 1 : 0;
    screen_ = sight.screen;
    const bool trial = screen_ == ParticipantScreen::kTrial;
    if (!trial && screen_ != ParticipantScreen::kTask && screen_ != ParticipantScreen::kForm) return {};
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

struct SessionWish {
  Hands hands;
  fs::path told;      ///< a file for what is told; empty: none
  fs::path pictures;  ///< a folder; empty: none
  StereoMode stereo = StereoMode::kNone;
};

/// The session of P01 in a process of its own. @return its number.
inline pid_t start_session(const fs::path& folder, const StudyPlan& plan, const SessionWish& wish) {
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
    options.hands = [&told, &hint, hands = wish.hands](const ParticipantSight& sight) mutable {
      if (std::exchange(hint, sight.hint) != sight.hint) told << "screen: " << sight.hint << std::endl;
      return hands(sight);
    };
    options.tell = [&told](const std::string& line) { told << line << std::endl; };
    if (wish.pictures.empty()) {  // a small picture is drawn sooner
      options.width = 576;
      options.height = 432;
    } else {
      options.photograph = Photographs(wish.pictures);
    }
    if (wish.stereo != StereoMode::kNone) options.height = 576;
    run_participant_window(opened, prepared_tasks(plan), who, {}, options);
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
