/// A trial at work in the window: the servo with its recording, and what has come of it so far.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/base/clock.h"
#include "common/hand/probe_options.h"
#include "common/servo/recorder.h"
#include "common/servo/servo_loop.h"
#include "common/study/design.h"
#include "common/study/trial_run.h"

namespace palpate {

class LiveTrial {
 public:
  static constexpr double kAtStart = 0.004;  ///< [m] from the start where a trial may begin

  /// The hand is pulled to the start from now on, where the device can.
  /// @param task is prepared. @param device outlives this. @param file of the recording; one that is there was left by a
  /// window that was killed, and is written over. @throws Error (work failed) where it cannot be written.
  LiveTrial(const PlannedTrial& planned, const StudyTask& task, Device& device, const RecordingHeader& header,
            std::filesystem::path file, const ProbeSessionOptions& touch);
  /// The recording is removed: what is worth keeping was kept before.
  ~LiveTrial();
  LiveTrial(const LiveTrial&) = delete;
  LiveTrial& operator=(const LiveTrial&) = delete;

  [[nodiscard]] const PlannedTrial& planned() const noexcept { return planned_; }
  [[nodiscard]] const StudyTaskInfo& info() const { return task_.info(); }
  [[nodiscard]] const StudyTrial& trial() const noexcept { return *trial_; }

  /// Takes what the servo has done since; once a frame.
  void follow();
  /// Null before the first step.
  [[nodiscard]] const HandStep* newest() const noexcept { return newest_ ? &*newest_ : nullptr; }
  /// [s] since it was begun, as its steps have it; 0 before.
  [[nodiscard]] double seconds() const;
  /// [s] since it was opened.
  [[nodiscard]] double waited() const { return opened_.seconds(); }

  /// What keeps the force away; kNone where nothing does, or it is about to grow.
  [[nodiscard]] ForceCut refusal() const noexcept;
  /// Whether a step of the trial had no force: it is to be repeated.
  [[nodiscard]] bool flawed() const noexcept { return flawed_; }
  /// Whether force comes back by arm() alone.
  [[nodiscard]] bool latched() const noexcept { return !armed_; }
  void force_off() noexcept { servo_->force_off(); }
  void arm() noexcept { servo_->arm(); }

  /// Whether the cursor is at the start, and nothing keeps the force away.
  [[nodiscard]] bool may_begin() const;
  /// @param guidance factor of what is felt. @param frame of the window, for the recording.
  void begin(double guidance, std::uint64_t frame);
  /// No more force. @param by_clock its time was up. @return what came of it.
  TrialOutcome end(bool by_clock, std::uint64_t frame);
  /// Of a trial that has ended: its recording and its steps. @throws Error (work failed).
  [[nodiscard]] std::string recording() const;
  [[nodiscard]] const std::vector<HandStep>& steps() const noexcept { return steps_; }

 private:
  PlannedTrial planned_;
  const StudyTask& task_;
  std::filesystem::path file_;
  double most_stiffness_;
  std::unique_ptr<StudyTrial> trial_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<ServoLoop> servo_;  // it uses the recorder
  std::vector<HandStep> steps_;       ///< from begin on
  std::uint64_t begin_ = 0, end_ = 0;
  std::optional<HandStep> newest_;
  Stopwatch opened_;
  bool begun_ = false, ended_ = false, armed_ = true, flawed_ = false;
};

}  // namespace palpate
