/// The servo of a session, its recorder, and the recording that is played back in place of a hand.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "common/hand/mode/haptic_mode.h"
#include "common/hand/probe_options.h"
#include "common/hand/probe_readout.h"

namespace palpate {

class ProbeServo {
 public:
  /// Makes the recorders that `options` ask for. @throws Error where the recording cannot be written.
  explicit ProbeServo(const ProbeSessionOptions& options);

  /// Whether it runs, and whether that is a replay.
  [[nodiscard]] bool running() const noexcept { return servo_ != nullptr; }
  [[nodiscard]] bool replaying() const noexcept { return replay_ != nullptr; }

  /// Starts with a device, which outlives it; a chain that comes later takes the place of the first.
  void follow(const std::function<Device&()>& device, std::unique_ptr<ProxyChain> chain,
              const std::string& description);
  void set_settings(const ChainSettings& settings) { servo_->set_settings(settings); }
  /// Plays `recording`. @param build makes its chains of their descriptions.
  void play(Recording recording, const std::function<HapticChain(const std::string&)>& build);

  /// No force until arm().
  void force_off() noexcept;
  void arm() noexcept;

  /// Takes what the servo has published since. @pre running().
  void read(ProbeReadout& readout);
  [[nodiscard]] bool pop_step(HandStep& step) noexcept { return servo_->pop_step(step); }

  /// A line of text for the recording, where there is one.
  void record_event(std::uint64_t frame, const std::string& text);
  /// Events of the replayed recording whose time has come, oldest first.
  [[nodiscard]] std::vector<std::string> due_events();
  /// Of a replay: the chains and isovalues that it has put in place up to a step, in their order.
  void changes_until(std::uint64_t step, const std::function<void(const HapticChain&)>& chain,
                     const std::function<void(const Isovalues&)>& isovalues);
  /// Of a replay: it has steps left.
  [[nodiscard]] bool playing() const noexcept { return replay_ != nullptr && !state_.replay_done; }
  /// How the replay compares, one sentence; empty while none has ended.
  [[nodiscard]] std::string replay_verdict() const;

  /// Ends servo and recordings. @throws Error (work failed) where the disk refused something.
  void finish(ProbeReadout& readout);

 private:
  ServoOptions options_;
  std::unique_ptr<Recorder> recorder_;
  std::unique_ptr<FaultRecorder> faults_;
  std::size_t next_event_ = 0, next_change_ = 0;  ///< of the replay
  std::vector<HapticChain> replay_chains_;        ///< what is drawn of its chains, in order
  std::unique_ptr<ReplaySource> replay_;
  ServoState state_;                  ///< that was read last
  std::unique_ptr<ServoLoop> servo_;  // last: its thread uses the above
};

}  // namespace palpate
