#include "common/experiment/hand_device.h"

namespace palpate {

HandDevice::HandDevice(const ProbeSessionOptions& touch) : mouse_(touch.limits) {
  if (touch.simulated) {
    SimulatedDeviceOptions simulated = *touch.simulated;
    simulated.limits = touch.limits;
    simulated.wander.reset();
    simulated_ = std::make_unique<SimulatedDevice>(simulated, mouse_);
  }
  if (!touch.link) return;
  linked_ = std::make_unique<LinkedDevice>(touch.link, touch.enabling, touch.limits);
  placed_ = std::make_unique<PlacedDevice>(*linked_, touch.limits, Placement{}, Box{Vec3{-1.0}, Vec3{1.0}});
}

Device& HandDevice::get() {
  if (placed_) return *placed_;
  return simulated_ ? static_cast<Device&>(*simulated_) : mouse_;
}

void HandDevice::place(const Camera& camera) {
  if (placed_) placed_->place({.middle = camera.focal_point, .axes = camera.axes});
}

void HandDevice::let_go() {
  if (mouse_.grabbed()) mouse_.let_go();
}

}  // namespace palpate
