#include "common/hand/probe_servo.h"

#include <utility>
#include <variant>

#include "common/hand/mode/chain_description.h"

namespace palpate {

ProbeServo::ProbeServo(const ProbeSessionOptions& options) : options_{.rate = options.servo_rate} {
  if (options.modes.empty()) return;
  RecordingHeader header = options.recorded;
  header.limits = options.limits;
  if (!options.record.empty())
    recorder_ = std::make_unique<Recorder>(options.record, header, options.overwrite);
  if (!options.fault_folder.empty() && !options.replay)
    faults_ = std::make_unique<FaultRecorder>(options.fault_folder, header, options.servo_rate);
}

void ProbeServo::follow(const std::function<Device&()>& device, std::unique_ptr<ProxyChain> chain,
                        const std::string& description) {
  if (servo_) {
    servo_->swap_chain(std::move(chain), description);
    return;
  }
  servo_ = std::make_unique<ServoLoop>(device(), std::move(chain), description, options_, recorder_.get(),
                                       faults_.get());
}

void ProbeServo::play(Recording recording, const std::function<HapticChain(const std::string&)>& build) {
  replay_ = std::make_unique<ReplaySource>(std::move(recording), [&](const std::string& description) {
    HapticChain made = build(description);
    std::unique_ptr<ProxyChain> chain = std::move(made.chain);
    replay_chains_.push_back(std::move(made));
    return chain;
  });
  servo_ = std::make_unique<ServoLoop>(*replay_, options_);
}

void ProbeServo::force_off() noexcept {
  if (servo_) servo_->force_off();
}

void ProbeServo::arm() noexcept {
  if (servo_) servo_->arm();
}

void ProbeServo::read(ProbeReadout& readout) {
  servo_->collect_retired();
  servo_->read(state_);
  readout.servo = state_;
  if (faults_) readout.fault = faults_->news().value_or(readout.fault);
}

void ProbeServo::record_event(std::uint64_t frame, const std::string& text) {
  if (recorder_ && servo_) recorder_->event(servo_->next_step(), frame, text);
}

std::vector<std::string> ProbeServo::due_events() {
  std::vector<std::string> due;
  if (!replay_) return due;
  const std::vector<RecordedEvent>& events = replay_->recording().events;
  const bool all = state_.replay_done;
  for (; next_event_ < events.size() && (all || events[next_event_].step <= state_.hand.number);
       ++next_event_) {
    due.push_back(events[next_event_].text);
  }
  return due;
}

void ProbeServo::changes_until(std::uint64_t step, const std::function<void(const HapticChain&)>& chain,
                               const std::function<void(const Isovalues&)>& isovalues) {
  if (!replay_) return;
  const std::vector<RecordedChange>& changes = replay_->recording().changes;
  for (; next_change_ < changes.size() && changes[next_change_].step <= step; ++next_change_) {
    if (const auto* change = std::get_if<ChainChange>(&changes[next_change_].change)) {
      chain(replay_chains_[change->chain]);
      const std::string& description = replay_->recording().chains[change->chain];
      isovalues(parse_chain(description).settings.isosurface.isovalues);
    } else if (const auto* settings = std::get_if<ChainSettings>(&changes[next_change_].change)) {
      isovalues(settings->isosurface.isovalues);
    }
  }
}

std::string ProbeServo::replay_verdict() const {
  if (!replay_ || !state_.replay_done) return {};
  return verdict_text(state_.replay, replay_->recording());
}

void ProbeServo::finish(ProbeReadout& readout) {
  if (servo_ && servo_->read(state_)) readout.servo = state_;
  servo_.reset();
  if (faults_) {
    faults_->finish();
    readout.fault = faults_->news().value_or(readout.fault);
  }
  if (recorder_) recorder_->finish();
}

}  // namespace palpate
