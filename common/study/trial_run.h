/// A trial as it happened: run by a simulated participant, and played back from its recording.
#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/servo/recording.h"
#include "common/study/participant_model.h"
#include "common/study/task.h"

namespace palpate {

/// What makes a trial tell nothing about its condition: steps of it, counted.
struct TrialFlaws {
  std::uint64_t lost = 0;    ///< that the recording lacks
  std::uint64_t faults = 0;  ///< with a fault (ForceCut)
  std::uint64_t cut = 0;  ///< without force: no hand, out of reach, enabling button released, after a stall
  std::uint64_t off = 0;  ///< with the force switched off

  [[nodiscard]] bool any() const noexcept { return lost + faults + cut + off > 0; }
};
/// Whether there was no force in a step where there should be. @param at number of the step in its trial, from 0: at
/// first it grows from zero (ForceCut::kStart), which is no flaw; later it does so after the servo stood still.
[[nodiscard]] bool tells_nothing(const HandStep& step, std::size_t at) noexcept;
[[nodiscard]] TrialFlaws flaws_of(const std::vector<HandStep>& steps, std::uint64_t lost) noexcept;

/// How a trial ended.
struct TrialOutcome {
  double seconds = 0.0;              ///< from the beginning to the space bar, or to the end of the time
  double error = 0.0;                ///< [mm]
  bool reached = false;              ///< whether the goal was met
  bool timed_out = false;            ///< it ended by itself
  std::uint64_t begin = 0, end = 0;  ///< steps: the first one of the trial, and the one after its last
  TrialFlaws flaws;
};

/// What happens while it goes on, as text of the recording.
inline constexpr std::string_view kBeginEvent = "begin", kDoneEvent = "space", kTimeEvent = "timeout";

struct TrialRun {
  TrialOutcome outcome;
  std::string recording;        ///< text (servo/recording.h)
  std::vector<HandStep> steps;  ///< of the trial
};

/// Which trial a chain belongs to, as recordings have it: "trial advection2d 7 ANISO 1 inf".
struct ChainSpec {
  std::string task;
  int stimulus = 0;
  bool guided = false;
  double guidance = 1.0;
  double most_stiffness = HUGE_VAL;  ///< [N/m] which the device bears: no chain is stiffer

  bool operator==(const ChainSpec&) const = default;
};
[[nodiscard]] std::string chain_text(const ChainSpec& spec);
/// @throws Error (bad input) for words that say no chain.
[[nodiscard]] ChainSpec chain_spec(const std::string& text);

/// The chain that pulls the hand to the start of a trial before it begins, as recordings have it: "start inf".
[[nodiscard]] std::string start_text(double most_stiffness);
/// The chain of that text, of either kind. @throws Error (bad input) likewise.
[[nodiscard]] std::unique_ptr<ProxyChain> chain_of(const StudyTrial& trial, const std::string& text);

/// Runs the trial on a simulated arm of the reference's class, a step a millisecond.
/// @param header of the recording; null: none is made.
[[nodiscard]] TrialRun simulate_trial(StudyTrial& trial, const StudyTaskInfo& info, const ChainSpec& spec,
                                      const ParticipantTraits& traits, const RandomStream& random,
                                      const RecordingHeader* header);

/// Plays a recording of this trial back. @throws Error (bad input) where it has no trial, or none to its end.
struct TrialReplay {
  TrialOutcome outcome;
  ChainSpec spec;          ///< of the chain in use during the trial
  std::string verdict;     ///< verdict_text()
  bool identical = false;  ///< all proxies and forces, as far as recorded
};
[[nodiscard]] TrialReplay replay_trial(StudyTrial& trial, Recording recording);

}  // namespace palpate
