/// A task of an experiment: what a participant sees, feels and has to do, when it is done, and what is measured.
///
/// A task is one file that derives from StudyTask and makes a StudyTrial for each stimulus. Everything else, design,
/// session, recording, simulated operators and analysis, knows tasks by these two alone. Positions are in the
/// workspace [m]; what is drawn is in the same frame.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/progress.h"
#include "common/haptics/proxy_chain.h"
#include "common/render/scene_view.h"
#include "common/servo/hand_step.h"
#include "common/study/data_column.h"

namespace palpate {

/// ISO: the same slight drag in all directions. ANISO: guided along what is to be followed (Ikits 2006, sec. 7.1).
[[nodiscard]] constexpr std::string_view condition_name(bool guided) noexcept {
  return guided ? "ANISO" : "ISO";
}

struct StudyTaskInfo {
  std::string name;            ///< in files: "advection2d"
  std::string title;           ///< "2D advection"
  std::string pair;            ///< the same task in another number of dimensions; empty: none
  std::string instruction;     ///< what the participant is told
  std::string error;           ///< what the position error is, for the data dictionary
  bool flat = false;           ///< seen face on: depth means nothing
  double limit = 10.0;         ///< [s] that participants are asked to keep
  double cutoff_time = 10.0;   ///< [s] slower trials are left out of the analysis
  double cutoff_error = 30.0;  ///< [mm] those with a larger error too

  /// [s] after which a trial ends by itself.
  [[nodiscard]] double most_seconds() const noexcept { return cutoff_time + 1.0; }
};

/// What the picture tells somebody about where to go next.
struct TrialCue {
  Vec3 along{0.0};         ///< direction to move on in, of length one; zero: stay
  double left = HUGE_VAL;  ///< [m] way to the place to stop at, where that is seen
  Vec3 off{0.0};           ///< [m] way back to the path, where that is shown
  bool arrived = false;    ///< there is nothing left to do but to say so
  bool marks = false;      ///< the button is to be pressed here
};

/// One stimulus, and how far a participant has come with it. Not shared between threads.
class StudyTrial {
 public:
  StudyTrial() = default;
  StudyTrial(const StudyTrial&) = delete;
  StudyTrial& operator=(const StudyTrial&) = delete;
  virtual ~StudyTrial() = default;

  /// Where the participant begins [m].
  [[nodiscard]] virtual Vec3 start() const = 0;
  /// What holds the hand during the trial.
  /// @param guidance factor of the stiffness of everything that is felt.
  [[nodiscard]] virtual std::unique_ptr<ProxyChain> chain(bool guided, double guidance) const = 0;
  /// Columns right, up and towards the viewer.
  [[nodiscard]] virtual Mat3 view_axes() const = 0;
  /// The trial begins anew: what follow() noted is forgotten.
  virtual void begin() = 0;
  /// The next step of the hand, from the beginning of the trial to its end.
  virtual void follow(const HandStep& step) = 0;
  /// What somebody sees who believes the cursor to be at `seen`.
  /// @param ahead [m] how far along what is drawn there they look, where a way is drawn: its direction there.
  [[nodiscard]] virtual TrialCue cue(const Vec3& seen, double ahead) const = 0;
  /// Whether the goal was reached.
  [[nodiscard]] virtual bool reached() const = 0;
  /// The position error of the trial as it ended [mm].
  [[nodiscard]] virtual double error() const = 0;
  /// The picture, but for background and stereo. @param cursor null: none is shown.
  [[nodiscard]] virtual SceneView view(const Vec3* cursor, double aspect) const = 0;
};

class StudyTask {
 public:
  StudyTask() = default;
  StudyTask(const StudyTask&) = delete;
  StudyTask& operator=(const StudyTask&) = delete;
  virtual ~StudyTask() = default;

  [[nodiscard]] virtual const StudyTaskInfo& info() const = 0;
  /// Makes `count` stimuli, all from `seed`, which open() gives from then on.
  /// @return a sentence: out of how many they were chosen. @throws Error (work failed) where too few are good; Cancelled.
  virtual std::string prepare(std::uint64_t seed, int count, Progress& progress) = 0;
  /// @pre prepare() was called with a larger count. Any thread.
  [[nodiscard]] virtual std::unique_ptr<StudyTrial> open(int stimulus) const = 0;
  /// A row for each stimulus, for those who analyse the data: columns, then numbers.
  [[nodiscard]] virtual std::vector<DataColumn> stimulus_columns() const = 0;
  [[nodiscard]] virtual std::vector<double> stimulus_row(int stimulus) const = 0;
};

using StudyTasks = std::vector<std::shared_ptr<StudyTask>>;

}  // namespace palpate
