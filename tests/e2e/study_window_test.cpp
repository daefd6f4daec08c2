// A whole session of an experiment, all four tasks, in the window, driven by mouse and keyboard under a virtual display:
// killed in the middle of a trial, gone on with, and played back; and what is said where there is no force.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <stb_image.h>
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
  StudyPlan plan{.program = "flow",
                 .version = "test",
                 .tasks = {"tracing2d", "advection3d", "advection2d", "tracing3d"}};
  plan.design = {.participants = 2, .tasks = 4, .practice = 0, .recorded = 2, .seed = 11};
  return plan;
}

/// The tasks of a plan, as they are made of its seed.
StudyTasks prepared_tasks(const StudyPlan& plan) {
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

void press_key(int key, std::vector<InputEvent>& events) {
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
pid_t start_session(const fs::path& folder, const StudyPlan& plan, const SessionWish& wish) {
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

bool wait_until(const std::function<bool()>& happened) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(400);
  while (!happened()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

/// Its status once the session has ended; none where it takes too long.
std::optional<int> outcome_of(SessionGuard& session) {
  std::optional<int> status;
  (void)wait_until([&] { return (status = session.ended()).has_value(); });
  return status;
}

TEST(StudyWindow, ASessionThatIsKilledGoesOnWithoutLoss) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  TempFolder temporary;
  const fs::path path = temporary.path("s");
  const StudyPlan plan = session_plan();
  const StudyParticipant who{"P01", 0, false, {}};
  StudyFolder folder = StudyFolder::make(path, plan, {}, false);
  ASSERT_EQ(folder.left_for(who).size(), 8U);
  // PALPATE_WRITE_PAGES makes the pictures of docs/guide/study.md.
  const fs::path pictures =
      std::getenv("PALPATE_WRITE_PAGES") != nullptr ? source_folder() / "docs" / "guide" : fs::path();

  const pid_t first = start_session(path, plan, {.hands = Hands(), .pictures = pictures});
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
    return status || (folder.trials().size() >= 3 && begun());
  }));
  ASSERT_FALSE(status) << "it is to be killed, and not to end";
  ASSERT_EQ(::kill(first, SIGKILL), 0);
  status = outcome_of(first_guard);
  ASSERT_TRUE(status);
  EXPECT_TRUE(WIFSIGNALED(*status));
  const std::vector<TrialRecord> before = folder.trials();
  EXPECT_GE(before.size(), 3U) << "all that were done are there";
  EXPECT_EQ(folder.participants().size(), 1U) << "the window has entered who began";

  // The second part under a window that is slow: nothing depends on how many pictures there are.
  constexpr double kSlow = 0.12;  // [s]
  SessionGuard second(start_session(path, plan, {.hands = Hands(kSlow), .pictures = pictures}));
  status = outcome_of(second);
  ASSERT_TRUE(status && WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 0);
  EXPECT_TRUE(folder.left_for(who).empty());
  EXPECT_FALSE(fs::exists(at_work));
  EXPECT_EQ(folder.answers("P01").at("harder_3d"), "4");
  const std::vector<TrialRecord> trials = folder.trials();
  for (const TrialRecord& was : before) {
    const auto now = std::ranges::find_if(
        trials, [&](const TrialRecord& r) { return r.task == was.task && r.run == was.run; });
    ASSERT_NE(now, trials.end());
    EXPECT_EQ(now->outcome.error, was.outcome.error) << "what was done before stays";
  }

  // What was lived is what is played back: the servo's thread and its clock change nothing.
  const StudyTasks tasks = prepared_tasks(plan);
  std::map<std::string, int> good;
  for (const TrialRecord& record : trials) {
    EXPECT_FALSE(record.simulated);
    EXPECT_GT(record.outcome.seconds, 0.5);
    const auto task =
        std::ranges::find_if(tasks, [&](const auto& t) { return t->info().name == record.task; });
    const std::unique_ptr<StudyTrial> trial = (*task)->open(record.stimulus);
    const TrialReplay again = replay_trial(*trial, folder.recording("P01", record.task, record.run));
    EXPECT_TRUE(again.identical) << again.verdict;
    EXPECT_EQ(again.outcome.error, record.outcome.error) << record.task << " " << record.run;
    EXPECT_EQ(again.outcome.seconds, record.outcome.seconds);
    EXPECT_LT(record.outcome.error, 60.0);
    // A servo that a busy machine lets stand still cuts the force, and a window that it lets stand still for seconds
    // lets the time run out: of the trials of a task one is neither.
    if (!record.outcome.flaws.any() && !record.outcome.timed_out) ++good[record.task];
  }
  EXPECT_EQ(good.size(), 4U) << "each task was done";
}

TEST(StudyWindow, SaysThatThereIsNoForceAndRepeatsTheTrial) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  TempFolder temporary;
  StudyPlan plan = session_plan();
  plan.tasks = {"tracing2d"};
  plan.design.tasks = 1;
  const StudyFolder folder = StudyFolder::make(temporary.path("s"), plan, {}, false);
  SessionGuard session(
      start_session(folder.path(), plan, {.hands = Hands(0.0, true), .told = temporary.path("told.txt")}));
  const std::optional<int> status = outcome_of(session);
  ASSERT_TRUE(status && WIFEXITED(*status));
  ASSERT_EQ(WEXITSTATUS(*status), 0);
  const std::string told = read_file(temporary.path("told.txt"));
  for (const std::string words :
       {"screen: The force is switched off. Hold the hand still, then press the space bar",
        "P01: before tracing2d/1: no force (switched_off)", "screen: The force is off. Press the space bar",
        "P01: tracing2d/1: ", "with the force switched off; it is repeated at the end of its block"})
    EXPECT_NE(told.find(words), std::string::npos) << words << "\n" << told;

  std::map<int, TrialRecord> trials;
  for (const TrialRecord& record : folder.trials()) trials[record.run] = record;
  ASSERT_GE(trials.size(), 3U);
  EXPECT_GT(trials.at(1).outcome.flaws.off, 0U);
  EXPECT_EQ(trials.at(3).attempt, 1) << "two trials are planned: the third is the first one again";
  EXPECT_EQ(trials.at(3).stimulus, trials.at(1).stimulus);
  EXPECT_EQ(trials.at(3).guided, trials.at(1).guided);
  EXPECT_EQ(trials.at(3).outcome.flaws.off, 0U) << "the force came back";
  const auto written = [&](int run) {
    return fs::last_write_time(folder.path() / "sub-P01" / "beh" /
                               ("sub-P01_task-tracing2d_run-0" + std::to_string(run) + "_beh.json"));
  };
  EXPECT_GT(written(3), written(2)) << "at the end of the block";
}

/// A picture of a session as it was photographed.
struct Picture {
  explicit Picture(const fs::path& file) {
    int channels = 0;
    unsigned char* data = stbi_load(file.c_str(), &width, &height, &channels, 3);
    if (data == nullptr) return;
    pixels.assign(data, data + std::ptrdiff_t{3} * width * height);
    stbi_image_free(data);
  }
  [[nodiscard]] std::array<int, 3> at(int x, int y) const {
    const auto i = static_cast<std::size_t>(3 * (y * width + x));
    return {pixels[i], pixels[i + 1], pixels[i + 2]};
  }

  int width = 0, height = 0;
  std::vector<unsigned char> pixels;
};

bool far_apart(const std::array<int, 3>& a, const std::array<int, 3>& b) {
  constexpr int kRounding = 24;
  return std::abs(a[0] - b[0]) + std::abs(a[1] - b[1]) + std::abs(a[2] - b[2]) > kRounding;
}

TEST(StudyWindow, GivesEachEyeAWholePictureAndAllOfTheText) {
  if (std::getenv("DISPLAY") == nullptr) GTEST_SKIP() << "no display: run under xvfb-run";
  TempFolder temporary;
  StudyPlan plan = session_plan();
  plan.tasks = {"tracing2d", "tracing3d"};
  plan.design.tasks = 2;
  const StudyFolder folder = StudyFolder::make(temporary.path("s"), plan, {}, false);
  fs::create_directory(temporary.path("pictures"));
  SessionGuard session(start_session(
      folder.path(), plan,
      {.hands = Hands(), .pictures = temporary.path("pictures"), .stereo = StereoMode::kSideBySide}));
  const std::optional<int> status = outcome_of(session);
  ASSERT_TRUE(status && WIFEXITED(*status));
  EXPECT_EQ(WEXITSTATUS(*status), 0) << "the form was filled in, in a half of the window";
  for (const std::string name : {"screen1", "screen5", "tracing2d", "tracing3d"}) {
    const Picture picture(temporary.path("pictures/study_" + name + ".png"));
    ASSERT_GT(picture.width, 0) << name;
    const int half = picture.width / 2;
    long differ = 0, red[2]{}, dark_at_edge = 0;
    const std::array<int, 3> ground = picture.at(half / 2, 2);
    for (int y = 0; y < picture.height; ++y) {
      for (int x = 0; x < half; ++x) {
        const std::array<int, 3> eyes[]{picture.at(x, y), picture.at(half + x, y)};
        if (far_apart(eyes[0], eyes[1])) ++differ;
        for (int eye = 0; eye < 2; ++eye) {
          const auto& [r, g, b] = eyes[eye];
          if (r > g + 80 && r > b + 80) ++red[eye];
          if ((x == 0 || x == half - 1) && far_apart(eyes[eye], ground)) ++dark_at_edge;
        }
      }
    }
    if (name == "tracing3d") {
      EXPECT_GT(differ, 100) << "both eyes see it from places of their own";
    } else {
      EXPECT_LT(differ, 20) << name << ": both halves hold the same, but for rounding at edges of letters";
    }
    EXPECT_EQ(dark_at_edge, 0) << name << ": nothing is cut off at the sides of a half";
    if (!name.starts_with("tracing")) continue;
    EXPECT_GT(red[0], 50) << name;
    EXPECT_NEAR(red[0], red[1], 0.2 * static_cast<double>(red[0])) << name << ": the whole path for each";
  }
}

}  // namespace
}  // namespace palpate::test
