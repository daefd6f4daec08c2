/// A linked device in the workspace: a position laid over it, or valuators that steer through it.
///
/// A device with a position is laid over the workspace by a Placement. Where that changes while the hand is
/// on the device, the hand is let go for a step and taken anew: nothing is pulled along, the force grows from
/// zero.
///
/// Where its motions are enlarged by the placement, s > 1, a force would be stiffer in the hand by as much
/// than it is in the workspace, where its stiffness was chosen; so the hand gets
///
///   F_D = R^T F_W / max(1, s),                                                                       (2)
///
/// a stiffness of dF_D/dx_D = K where s > 1 and s K below it: never more than K, and never more force. (2) and
/// the plane of a placement do not change from one force to the next and lengthen none, so what kept to a cap
/// and a slew limit before keeps to them after. Whether the hand is within its reach, and how fast it is, the
/// safety stage sees by DeviceSample::hand.
///
/// A device of valuators (a SpaceMouse) moves the probe at a speed in proportion to how far each is pushed,
/// in the axes of the placement, and stays where it is when the cap is let go:
///
///   v = v_max n |n|^(p - 1),  n the push in [-1, 1] per axis,  p = 2: slow near rest, fast at the end (1)
#pragma once

#include <atomic>
#include <cstdint>
#include <optional>

#include "common/base/triple_buffer.h"
#include "common/device/device.h"
#include "common/math/vec.h"
#include "common/servo/linked_device.h"

namespace palpate {

// How a device in the hand lies over the workspace: where its middle is, which way it faces, and the plane
// that it moves on alone, where there is one.

/// x_W = middle + scale axes P(x_D),   P(x) = x - (n.x - d) n, or x where there is no plane. The axes are
/// those of the view, so that right, up and towards the user are the same for the hand and the eye.
struct Placement {
  Vec3 middle{0.0};    ///< [m] in W
  Mat3 axes{1.0};      ///< columns: right, up, towards the user, in W; orthonormal
  double scale = 1.0;  ///< metres of W for one of the hand, > 0
  /// (n, d): n.x_D = d [m], |n| = 1. Forces across it have nothing to act on: P^T F is what the hand gets.
  std::optional<Vec4> surface;

  /// P.
  [[nodiscard]] Vec3 on_surface(const Vec3& x) const noexcept {
    if (!surface) return x;
    const Vec3 n{*surface};
    return x - (glm::dot(n, x) - surface->w) * n;
  }

  bool operator==(const Placement&) const = default;
};

class PlacedDevice final : public Device {
 public:
  static constexpr double kTopSpeed = 0.15;     ///< v_max of (1) [m/s]
  static constexpr double kLongestStep = 0.05;  ///< [s] a longer pause moves no further

  /// `device` outlives this. @param limits with the reach of the device in D and no push at its border
  /// (edge_stiffness 0), which would be given in D and felt in W.
  PlacedDevice(LinkedDevice& device, const DeviceLimits& limits, const Placement& placement,
               const Box& bounds) noexcept;

  /// Window thread, wait-free.
  void place(const Placement& placement) noexcept;
  /// Whether the first button works something else than what is felt: samples have it up meanwhile. Not where
  /// it is the dead-man switch, which is looked at in every sample. Any thread.
  void engage(bool elsewhere) noexcept { elsewhere_.store(elsewhere, std::memory_order_relaxed); }
  /// The buttons as they are on the device. Any thread.
  [[nodiscard]] std::uint32_t buttons() const noexcept { return buttons_.load(std::memory_order_relaxed); }

  /// Where the hand is on the plane of the placement, where there is one [m, frame D]: the same to the eye
  /// however the view is turned. Window thread. False where it has not moved since, or steers by valuators.
  [[nodiscard]] bool tip(Vec3& in_hand) noexcept { return tips_.read(in_hand); }

  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& force) noexcept override;
  void emergency_stop() noexcept override { device_.emergency_stop(); }
  [[nodiscard]] const Bell* bell() const noexcept override { return device_.bell(); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }

 private:
  [[nodiscard]] std::uint32_t haptic_buttons(std::uint32_t buttons) noexcept;
  bool steer(double now, const DeviceAtoms& atoms, DeviceSample& sample) noexcept;

  LinkedDevice& device_;
  DeviceLimits limits_;
  Box bounds_;       ///< [m] in which valuators steer
  Placement asked_;  ///< window thread
  TripleBuffer<Placement> placements_;
  TripleBuffer<Vec3> tips_;
  std::atomic<bool> elsewhere_{false};
  std::atomic<std::uint32_t> buttons_{0};

  Placement placement_;  ///< servo thread, as all below
  Vec3 steered_{0.0};
  double steered_at_ = -1.0;  ///< [s] negative: not yet
};

}  // namespace palpate
