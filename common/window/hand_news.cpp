#include "common/window/hand_news.h"

namespace palpate {

void HandNews::follow(const ProbeReadout& hand, bool through_surfaces, PanelState& state) {
  if (hand.popped != popped_) {
    if (hand.popped > popped_)
      state.say(through_surfaces ? "popped through to the other side" : "popped over to the next line");
    popped_ = hand.popped;
  }
  if (hand.fault != fault_) {
    fault_ = hand.fault;
    // Why a file was not opened stays to be read.
    if (state.error_of_job && !state.error.empty()) {
      state.say(fault_);
    } else {
      state.fail(fault_);
    }
  }
  if (const std::uint64_t stalls = hand.servo.statistics.stalls; stalls != stalls_) {
    if (stalls > stalls_) state.add("the machine was busy: the servo stood still for a moment");
    stalls_ = stalls;
  }
  if (hand.device != device_) {
    device_ = hand.device;
    state.say(device_.empty() ? "the device is ready" : device_);
  }
}

}  // namespace palpate
