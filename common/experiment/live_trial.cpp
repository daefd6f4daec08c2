#include "common/experiment/live_trial.h"

#include <chrono>
#include <thread>
#include <utility>

#include "common/experiment/screen_texts.h"

namespace palpate {

LiveTrial::LiveTrial(const PlannedTrial& planned, const StudyTask& task, Device& device,
                     const RecordingHeader& header, std::filesystem::path file,
                     const ProbeSessionOptions& touch)
    : planned_(planned),
      task_(task),
      file_(std::move(file)),
      most_stiffness_(touch.most_stiffness),
      trial_(task.open(planned.stimulus)) {
  trial_->begin();
  recorder_ = std::make_unique<Recorder>(file_, header, true);
  const std::string words = start_text(most_stiffness_);
  servo_ = std::make_unique<ServoLoop>(device, chain_of(*trial_, words), words,
                                       ServoOptions{.rate = touch.servo_rate}, recorder_.get());
}

LiveTrial::~LiveTrial() {
  servo_.reset();
  recorder_.reset();
  std::error_code ignored;
  std::filesystem::remove(file_, ignored);
}

void LiveTrial::follow() {
  if (!servo_) return;
  servo_->collect_retired();
  if (ServoState state; servo_->read(state)) armed_ = state.armed;
  constexpr auto kPatience = std::chrono::milliseconds(1);
  constexpr int kTries = 500;
  for (int tries = 0; tries < kTries; ++tries) {
    HandStep step;
    bool last = false;
    while (servo_->pop_step(step)) {
      newest_ = step;
      if (begun_ && step.number >= begin_ && (!ended_ || step.number < end_)) {
        flawed_ = flawed_ || tells_nothing(step, steps_.size());
        trial_->follow(step);
        steps_.push_back(step);
      }
      last = ended_ && step.number + 1 >= end_;
    }
    if (!ended_ || last) return;
    std::this_thread::sleep_for(kPatience);  // the last step is still on its way
  }
}

double LiveTrial::seconds() const { return steps_.empty() ? 0.0 : steps_.back().time - steps_.front().time; }

ForceCut LiveTrial::refusal() const noexcept {
  if (!newest_ || newest_->cut == ForceCut::kStart || newest_->cut == ForceCut::kJump) return ForceCut::kNone;
  return newest_->cut;
}

bool LiveTrial::may_begin() const {
  if (!newest_ || !newest_->present || latched() || refusal() != ForceCut::kNone) return false;
  Vec3 off = newest_->probe - trial_->start();
  if (info().flat) off.z = 0.0;
  return glm::length(off) <= kAtStart;
}

void LiveTrial::begin(double guidance, std::uint64_t frame) {
  const std::string text =
      chain_text({info().name, planned_.stimulus, planned_.guided, guidance, most_stiffness_});
  servo_->swap_chain(chain_of(*trial_, text), text);
  begin_ = servo_->next_step();
  recorder_->event(begin_, frame, kBeginEvent);
  begun_ = true;
}

TrialOutcome LiveTrial::end(bool by_clock, std::uint64_t frame) {
  end_ = servo_->next_step();
  recorder_->event(end_, frame, by_clock ? kTimeEvent : kDoneEvent);
  ended_ = true;
  follow();
  servo_.reset();
  recorder_->finish();
  TrialOutcome outcome{.timed_out = by_clock, .begin = begin_, .end = end_};
  if (steps_.size() == end_ - begin_ && !steps_.empty()) {
    outcome.seconds = seconds();
    outcome.error = trial_->error();
    outcome.reached = trial_->reached();
    outcome.flaws = flaws_of(steps_, recorder_->lost());
    return outcome;
  }
  // A picture took so long that steps were dropped on their way here: the recording has them all.
  const std::unique_ptr<StudyTrial> again = task_.open(planned_.stimulus);
  return replay_trial(*again, read_recording(file_.string())).outcome;
}

std::string LiveTrial::recording() const { return read_whole(file_); }

}  // namespace palpate
