/// A trial as it happened: run by a simulated participant, and played back from its recording.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/servo/recording.h"
#include "common/study/participant_model.h"
#include "common/study/task.h"

namespace palpate {

/// How a trial ended.
struct TrialOutcome {
  double seconds = 0.0;              ///< from the beginning to the space bar, or to the end of the time
  double error = 0.0;                ///< [mm]
  bool reached = false;              ///< whether the goal was met
  bool timed_out = false;            ///< it ended by itself
  std::uint64_t begin = 0, end = 0;  ///< steps: the first one of the trial, and the one after its last
};

/// What happens while it goes on, as text of the recording.
inline constexpr std::string_view kBeginEvent = "begin", kDoneEvent = "space", kTimeEvent = "timeout";

struct TrialRun {
  TrialOutcome outcome;
  std::string recording;        ///< text (servo/recording.h)
  std::vector<HandStep> steps;  ///< of the trial
};

/// Which trial a chain belongs to, as recordings have it: "trial advection2d 7 ANISO 1".
struct ChainWords {
  std::string task;
  int stimulus = 0;
  bool guided = false;
  double guidance = 1.0;
};
[[nodiscard]] std::string chain_text(const ChainWords& words);
/// @throws Error (bad input) for words that say no chain.
[[nodiscard]] ChainWords chain_words(const std::string& text);

/// The chain that pulls the hand to the start of a trial before it begins.
[[nodiscard]] std::unique_ptr<ProxyChain> start_chain(const Vec3& start);
inline constexpr std::string_view kStartChain = "start";  ///< in recordings: the start of the next trial

/// Runs the trial on a simulated arm of the reference's class, a step a millisecond.
/// @param header of the recording; null: none is made.
[[nodiscard]] TrialRun simulate_trial(StudyTrial& trial, const StudyTaskInfo& info, const ChainWords& words,
                                      const ParticipantTraits& traits, const RandomStream& random,
                                      const RecordingHeader* header);

/// Plays a recording of this trial back.
struct TrialReplay {
  TrialOutcome outcome;
  std::string verdict;     ///< verdict_text()
  bool identical = false;  ///< all proxies and forces, as far as recorded
};
[[nodiscard]] TrialReplay replay_trial(StudyTrial& trial, Recording recording);

}  // namespace palpate
