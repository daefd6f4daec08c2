#include "common/servo/replay_source.h"

#include <algorithm>
#include <utility>

#include "common/base/check.h"
#include "common/base/text.h"

namespace palpate {

ReplaySource::ReplaySource(Recording recording, const ChainMaker& make_chain)
    : recording_(std::move(recording)), stepper_(nullptr, recording_.header.limits) {
  chains_.reserve(recording_.chains.size());
  for (const std::string& description : recording_.chains) chains_.push_back(make_chain(description));
}

HandStep ReplaySource::step() noexcept {
  PALPATE_ASSERT(!done());
  const RecordedStep& recorded = recording_.steps[next_++];
  apply_changes_before(recorded.number);
  HandStep step = stepper_.step(recorded.input);
  step.number = recorded.number;
  hash_.add(step);
  verdict_.steps = hash_.steps();
  compare();
  if (!done()) {
    const double pause = recording_.steps[next_].input.time - recorded.input.time;
    if (pause > 0.0) due_ += std::min(pause, kLongestPause);  // false for NaN
  }
  return step;
}

void ReplaySource::apply_changes_before(std::uint64_t number) noexcept {
  for (; next_change_ < recording_.changes.size() && recording_.changes[next_change_].step <= number;
       ++next_change_) {
    const Change& change = recording_.changes[next_change_].change;
    if (const auto* chain = std::get_if<ChainChange>(&change)) {
      chains_[chain->chain] = stepper_.exchange_chain(std::move(chains_[chain->chain]));
    } else if (const auto* settings = std::get_if<ChainSettings>(&change)) {
      stepper_.apply(*settings);
    } else {
      stepper_.apply(std::get<HandSwitch>(change));
    }
  }
}

void ReplaySource::compare() noexcept {
  for (; next_hash_ < recording_.hashes.size() && recording_.hashes[next_hash_].steps <= hash_.steps();
       ++next_hash_) {
    const HashMark& mark = recording_.hashes[next_hash_];
    if (verdict_.differs != 0) continue;
    if (mark.steps == hash_.steps() && mark.hash == hash_.value()) {
      verdict_.same = mark.steps;
    } else {
      verdict_.differs = mark.steps;
    }
  }
}

std::string verdict_text(const ReplayVerdict& verdict, const Recording& recording) {
  std::string text;
  if (verdict.differs != 0) {
    text = "differs from the recording, first between steps " + std::to_string(verdict.same) + " and " +
           std::to_string(verdict.differs - 1);
  } else if (verdict.same == 0) {
    text = "nothing compared: the recording holds no sum of its first " +
           counted(recording.steps.size(), "step");
  } else {
    text = "identical: " + std::to_string(verdict.same) + " of " + counted(recording.steps.size(), "step");
  }
  if (recording.lost > 0) {
    text += "; the recording lacks " + std::to_string(recording.lost) +
            " entries that the disk was too slow for, so it cannot be repeated exactly";
  }
  if (!recording.ended) text += "; the recording was cut off";
  return text;
}

}  // namespace palpate
