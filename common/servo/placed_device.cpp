#include "common/servo/placed_device.h"

#include <algorithm>
#include <cmath>

#include "common/base/index.h"

namespace palpate {

PlacedDevice::PlacedDevice(LinkedDevice& device, const DeviceLimits& limits, const Placement& placement,
                           const Box& bounds) noexcept
    : device_(device),
      limits_(limits),
      bounds_(bounds),
      asked_(placement),
      placement_(placement),
      steered_(placement.middle) {}

void PlacedDevice::place(const Placement& placement) noexcept {
  if (placement == asked_) return;
  asked_ = placement;
  placements_.write(placement);
}

bool PlacedDevice::read(double now, DeviceSample& sample) noexcept {
  const bool moved = placements_.read(placement_);
  DeviceAtoms atoms;
  if (!device_.read_atoms(now, atoms)) {
    steered_at_ = -1.0;
    buttons_.store(0, std::memory_order_relaxed);
    return false;
  }
  if (atoms.has_valuators) return steer(now, atoms, sample);
  if (!atoms.has_position) return false;
  const Vec3 in_hand = placement_.on_surface(atoms.position);
  tips_.write(in_hand);
  if (moved) return false;
  sample = {atoms.time, placement_.middle + placement_.scale * (placement_.axes * in_hand),
            haptic_buttons(atoms.buttons), atoms.position};
  return true;
}

std::uint32_t PlacedDevice::haptic_buttons(std::uint32_t buttons) noexcept {
  buttons_.store(buttons, std::memory_order_relaxed);
  const bool acts = limits_.enabling_button != 0;
  return acts && elsewhere_.load(std::memory_order_relaxed) ? buttons & ~1U : buttons;
}

bool PlacedDevice::steer(double now, const DeviceAtoms& atoms, DeviceSample& sample) noexcept {
  const double dt = steered_at_ < 0.0 ? 0.0 : std::clamp(now - steered_at_, 0.0, kLongestStep);
  steered_at_ = now;
  Vec3 push{0.0};
  for (int a = 0; a < 3; ++a) {
    const double n = atoms.valuators[as_size(a)];
    push[a] = std::isfinite(n) ? n * std::abs(n) : 0.0;  // (1)
  }
  steered_ += placement_.axes * (kTopSpeed * dt * push);
  if (!bounds_.empty()) steered_ = glm::clamp(steered_, bounds_.lower, bounds_.upper);
  if (placement_.surface) {
    const Vec3 in_hand = (steered_ - placement_.middle) * placement_.axes / placement_.scale;
    steered_ = placement_.middle + placement_.scale * (placement_.axes * placement_.on_surface(in_hand));
  }
  // At rest it is no stale one; the hand itself stays at the middle of its device.
  sample = {now, steered_, haptic_buttons(atoms.buttons), Vec3{0.0}};
  return true;
}

void PlacedDevice::command(const Vec3& force) noexcept {
  Vec3 in_hand = force * placement_.axes;  // row vector times R is R^T times column
  if (placement_.surface) {
    const Vec3 n{*placement_.surface};
    in_hand -= glm::dot(n, in_hand) * n;
  }
  device_.command(in_hand / std::max(1.0, placement_.scale));  // (2)
}

}  // namespace palpate
