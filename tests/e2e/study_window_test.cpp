// A whole session of an experiment in the window, driven by mouse and keyboard under a virtual display: killed in the
// middle of a trial, gone on with, and played back.

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/flow/study/path_task.h"
#include "common/base/error.h"
#include "common/cli/simulated_option.h"
#include "common/experiment/participant_window.h"
#include "common/study/study_folder.h"
#include "common/window/panels/panel_parts.h"
#include "tests/support/project_folders.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

constexpr int kSpace = 32;  // GLFW's number of the key

StudyPlan session_plan() {
  StudyPlan plan{.program = "flow", .version = "test", .tasks = {"tracing2d", "advection3d"}};
  plan.design = {.participants = 2, .tasks = 2, .practice = 1, .recorded = 2, .seed = 11};
  return plan;
}

StudyTasks session_tasks() {
  const DesignRequest design = session_plan().design;
  Progress progress;
  StudyTasks tasks{make_tracing_2d(), make_advection_3d()};
  for (const auto& task : tasks)
    (void)task->prepare(design.seed, design.practice + design.recorded, progress);
  return tasks;
}

void press_key(int key, std::vector<InputEvent>& events) {
  events.push_back({.kind = InputKind::kKeyDown, .key = key});
  events.push_back({.kind = InputKind::kKeyUp, .key = key});
}

/// Somebody with a mouse who does what the screens say, a few times faster than people do.
class Hands {
 public:
  std::vector<InputEvent> operator()(const ParticipantSight& sight) {
    std::vector<InputEvent> events;
    if (sight.screen != screen_) {
      screen_ = sight.screen;
      since_ = sight.frame;
      held_since_ = std::chrono::steady_clock::now();
      aim_.reset();
    }
    const int waited = sight.frame - since_;
    constexpr int kRest = 4;  // frames
    switch (sight.screen) {
      case ParticipantScreen::kWelcome:
      case ParticipantScreen::kTask:
      case ParticipantScreen::kPause:
        if (waited == kRest) press_key(kSpace, events);
        break;
      case ParticipantScreen::kStart:
        lead(sight, sight.trial->start(), events);
        events.push_back({.kind = InputKind::kKeyUp, .key = kSpace});
        if (waited >= kRest && waited % kRest == 0 &&
            glm::distance(sight.cursor, sight.trial->start()) < 0.003)
          events.push_back({.kind = InputKind::kKeyDown, .key = kSpace});
        break;
      case ParticipantScreen::kTrial:
        // The bar is held longer than a shortest trial: a key that comes again ends none.
        events.push_back({.kind = InputKind::kKeyDown, .key = kSpace});
        if (held_since_ + std::chrono::milliseconds(400) < std::chrono::steady_clock::now()) {
          events.back().kind = InputKind::kKeyUp;
          trace(sight, events);
        }
        break;
      case ParticipantScreen::kForm:
        fill_in(waited, events);
        break;
      case ParticipantScreen::kThanks:
        break;
    }
    return events;
  }

 private:
  /// The mouse to where `x` is seen, the wheel to its depth.
  void lead(const ParticipantSight& sight, const Vec3& x, std::vector<InputEvent>& events) {
    const Vec3 pixel = project(sight.camera, x, sight.width, sight.height);
    events.push_back({.kind = InputKind::kMove, .x = pixel.x, .y = pixel.y});
    const double depth = glm::dot(sight.cursor - x, sight.camera.axes[2]);
    constexpr double kNotch = 0.002;  // [m]
    if (std::abs(depth) > 0.5 * kNotch && glm::length(sight.cursor) > 0.0)
      events.push_back({.kind = InputKind::kWheel, .y = std::clamp(std::round(depth / kNotch), -4.0, 4.0)});
  }
  void trace(const ParticipantSight& sight, std::vector<InputEvent>& events) {
    const auto now = std::chrono::steady_clock::now();
    if (!aim_) {
      aim_ = sight.cursor;
      last_ = now;
    }
    const double seconds = std::chrono::duration<double>(now - last_).count();
    last_ = now;
    constexpr double kSpeed = 0.06;  // [m/s]
    const TrialCue cue = sight.trial->cue(*aim_);
    *aim_ += std::min(seconds, 0.1) * kSpeed * cue.along;
    lead(sight, *aim_, events);
    if (cue.arrived || sight.trial->reached()) press_key(kSpace, events);
  }
  static void fill_in(int waited, std::vector<InputEvent>& events) {
    constexpr int kEach = 4;
    if (waited % kEach == 3) events.push_back({.kind = InputKind::kRelease});
    if (waited % kEach != 1) return;
    const std::string label = waited < 3 * kEach ? " 4 " : "Done";
    for (const DrawnControl& control : drawn_controls()) {
      if (control.label != label) continue;  // one that was chosen is called otherwise
      events.push_back({.kind = InputKind::kMove,
                        .x = control.left + 0.5 * control.width,
                        .y = control.top + 0.5 * control.height});
      events.push_back({.kind = InputKind::kPress});
      return;
    }
  }

  ParticipantScreen screen_ = ParticipantScreen::kThanks;
  int since_ = 0;
  std::optional<Vec3> aim_;
  std::chrono::steady_clock::time_point last_, held_since_;
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
    constexpr int kRead = 2, kOnTheWay = 8;
    if (frames_ != (trial ? kOnTheWay : kRead)) return {};
    const bool flat = sight.trial != nullptr && sight.camera.projection == Projection::kOrthographic;
    const std::string name =
        trial ? (flat ? "tracing2d" : "advection3d") : "screen" + std::to_string(static_cast<int>(screen_));
    return folder_ / ("study_" + name + ".png");
  }

 private:
  fs::path folder_;
  int frames_ = 0;
  ParticipantScreen screen_ = ParticipantScreen::kThanks;
};

/// The session in a process of its own. @return its number.
pid_t start_session(const fs::path& folder, const std::string& code) {
  const pid_t child = ::fork();
  if (child != 0) return child;
  int status = 0;
  try {
    StudyFolder opened(folder);
    const StudyParticipant who{code, 0, false, {}};
    ParticipantWindowOptions options;
    options.device = "simulated";
    options.touch.simulated = simulated_option("simulated");
    options.touch.limits = simulated_limits(*options.touch.simulated, {});
    options.hands = Hands();
    // PALPATE_WRITE_PAGES makes the pictures of docs/guide/study.md.
    if (std::getenv("PALPATE_WRITE_PAGES") != nullptr)
      options.photograph = Photographs(source_folder() / "docs" / "guide");
    run_participant_window(opened, session_tasks(), who, {}, options);
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

bool wait_until(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(400);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

TEST(StudyWindow, ASessionThatIsKilledGoesOnWithoutLoss) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  TempFolder temporary;
  const fs::path path = temporary.path("s");
  const StudyParticipant who{"P01", 0, false, {}};
  StudyFolder folder = StudyFolder::make(path, session_plan(), {}, false);
  ASSERT_EQ(folder.left_for(who).size(), 6U);

  const pid_t first = start_session(path, who.code);
  const fs::path at_work = path / "sub-P01" / "trial_at_work.txt";
  SessionGuard first_guard(first);
  ASSERT_GT(first, 0);
  // What is recorded is handed on each second: a trial that has begun is in the file then.
  std::optional<int> status;
  const auto begun = [&] {
    return fs::exists(at_work) && read_file(at_work).find(kBeginEvent) != std::string::npos;
  };
  ASSERT_TRUE(wait_until([&] {
    status = first_guard.ended();
    return status || (folder.left_for(who).size() <= 4 && begun());
  }));
  ASSERT_FALSE(status) << "it is to be killed, and not to end";
  ASSERT_EQ(::kill(first, SIGKILL), 0);
  ASSERT_TRUE(wait_until([&] { return (status = first_guard.ended()).has_value(); }));
  EXPECT_TRUE(WIFSIGNALED(*status));
  const std::vector<TrialRecord> before = folder.trials();
  EXPECT_GE(before.size(), 2U) << "all that were done are there";
  EXPECT_EQ(folder.participants().size(), 1U) << "the window has entered who began";

  const pid_t second = start_session(path, who.code);
  SessionGuard second_guard(second);
  ASSERT_GT(second, 0);
  ASSERT_TRUE(wait_until([&] { return (status = second_guard.ended()).has_value(); }));
  ASSERT_TRUE(WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 0);
  EXPECT_TRUE(folder.left_for(who).empty());
  EXPECT_FALSE(fs::exists(at_work));
  EXPECT_EQ(folder.answers("P01").at("harder_3d"), "4");
  const std::vector<TrialRecord> trials = folder.trials();
  ASSERT_EQ(trials.size(), 6U);
  for (std::size_t i = 0; i < before.size(); ++i)
    EXPECT_EQ(trials[i].outcome.error, before[i].outcome.error) << "what was done before stays";

  // What was lived is what is played back: the servo's thread and its clock change nothing.
  const StudyTasks tasks = session_tasks();
  for (const TrialRecord& record : trials) {
    EXPECT_FALSE(record.simulated);
    EXPECT_FALSE(record.outcome.flaws.any());
    EXPECT_FALSE(record.outcome.timed_out) << record.task << " " << record.run;
    EXPECT_GT(record.outcome.seconds, 0.5);
    const std::unique_ptr<StudyTrial> trial =
        tasks[record.task == "tracing2d" ? 0 : 1]->open(record.stimulus);
    const TrialReplay again = replay_trial(*trial, folder.recording("P01", record.task, record.run));
    EXPECT_TRUE(again.identical) << again.verdict;
    EXPECT_EQ(again.outcome.error, record.outcome.error) << record.task << " " << record.run;
    EXPECT_EQ(again.outcome.seconds, record.outcome.seconds);
    EXPECT_LT(record.outcome.error, 60.0);
  }
}

}  // namespace
}  // namespace palpate::test
