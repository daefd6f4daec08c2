/// The device in a participant's hand: a mouse, a simulated hand that follows it, or a real one.
#pragma once

#include <memory>
#include <string>

#include "common/device/mouse_device.h"
#include "common/device/simulated_device.h"
#include "common/hand/probe_options.h"
#include "common/render/camera.h"
#include "common/servo/placed_device.h"

namespace palpate {

class HandDevice {
 public:
  explicit HandDevice(const ProbeSessionOptions& touch);

  [[nodiscard]] Device& get();
  [[nodiscard]] bool by_mouse() const noexcept { return placed_ == nullptr; }
  /// The middle of the device is at the middle of the picture, its axes are those of the view.
  void place(const Camera& camera);
  void grab(double time, const Vec3& x) { mouse_.grab(time, x, 0); }
  void move(double time, const Vec3& x, bool button) { mouse_.move(time, x, button ? 1U : 0U); }
  void let_go();
  /// What its user should do now; empty: nothing.
  [[nodiscard]] std::string advice() const { return linked_ ? linked_->advice() : std::string(); }

 private:
  MouseDevice mouse_;
  std::unique_ptr<SimulatedDevice> simulated_;
  std::unique_ptr<LinkedDevice> linked_;
  std::unique_ptr<PlacedDevice> placed_;
};

}  // namespace palpate
