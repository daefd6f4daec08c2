#include "common/servo/linked_device.h"

#include <utility>

#include "common/base/check.h"
#include "common/servo/real_time.h"
#include "common/servo/safety_stage.h"

namespace palpate {
namespace {

constexpr int kLinkPriority = 80;  // the servo's: each needs the other's newest

double now_seconds() noexcept { return 1e-9 * static_cast<double>(monotonic_ns()); }

}  // namespace

std::uint32_t with_switch(std::uint32_t buttons, const DeviceAtoms* heard, int button, double now) noexcept {
  const DeviceLimits asked{.enabling_button = button};
  const bool held = heard != nullptr && is_enabled(asked, heard->buttons, now - heard->time);
  constexpr std::uint32_t kBit = 1U << static_cast<unsigned>(EnablingSwitch::kOtherBit);
  return held ? buttons | kBit : buttons & ~kBit;
}

LinkedDevice::LinkedDevice(std::shared_ptr<DriverLink> link, const EnablingSwitch& enabling,
                           const std::optional<DeviceLimits>& asked)
    : link_(std::move(link)) {
  PALPATE_CHECK(link_ != nullptr);
  if (asked) link_->restrain(*asked);
  limits_ = link_->limits();
  tracks_ = link_->poses() != nullptr;
  if (enabling.link) {
    switch_ = std::make_unique<LinkedDevice>(enabling.link);
    switch_button_ = enabling.button;
    limits_.enabling_button = enabling.sample_button();
  }
  link_->obey(this);
  thread_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
}

LinkedDevice::~LinkedDevice() {
  thread_.request_stop();
  thread_.join();
  link_->obey(nullptr);
  (void)link_->round();
}

Vec3 LinkedDevice::newest() noexcept {
  (void)orders_.read(order_);
  const double now = now_seconds();
  if (order_.sample != answered_) {
    constexpr double kNanoseconds = 1e9;
    constexpr std::uint64_t kShare = 100;  // a copy of all bins each time would cost more than all else
    delays_.add(static_cast<std::int64_t>(kNanoseconds * (now - order_.sample)));
    answered_ = order_.sample;
    if (delays_.count() % kShare == 0) delays_out_.write(delays_);
  }
  const bool fresh = now - order_.time <= kFreshFor && !stopped_.load(std::memory_order_acquire);
  if (!fresh || order_.force == Vec3{0.0} || !end_.may_show()) return Vec3{0.0};
  showed_.store(true);
  return order_.force;
}

void LinkedDevice::work(const std::stop_token& stop) {
  ForceEnd::leave_signals_to_others();
  request_real_time_priority(kLinkPriority);
  LinkPhase reported = LinkPhase::kAbsent;
  double reported_at = 0.0;
  const double begun = now_seconds();
  while (!stop.stop_requested()) {
    if (link_->round()) {
      atoms_.write(link_->atoms());
      if (const PoseAtoms* const poses = link_->poses()) poses_.write(*poses);
      bell_.ring(monotonic_ns());
    }
    const bool showed = showed_.exchange(false);
    if (!showed) end_.rested();
    const double now = now_seconds();
    // For people: when something has changed, and now and then. Whoever looks at it is not waited for.
    constexpr double kPause = 0.1;  // [s]
    const LinkStatus& status = link_->status();
    if (status.phase == reported && now - reported_at < kPause) continue;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock) continue;
    reported = status.phase;
    reported_at = now;
    status_ = status;
    // Words allocate. While there is force the device is well, and what was said before holds.
    if (showed) continue;
    // What is there needs a moment to be found.
    const bool had_its_chance = status.phase != LinkPhase::kAbsent || now - begun > kChance;
    advice_ = had_its_chance ? link_->advice() : std::string();
  }
}

bool LinkedDevice::read_atoms(double now, DeviceAtoms& atoms) noexcept {
  if (atoms_.read(newest_)) seen_ = true;
  if (!seen_ || now - newest_.time > kKept) return false;
  atoms = newest_;
  if (switch_) {
    DeviceAtoms heard;
    const bool any = switch_->read_atoms(now, heard);
    atoms.buttons = with_switch(atoms.buttons, any ? &heard : nullptr, switch_button_, now);
  }
  return true;
}

void LinkedDevice::read_poses(double now, PoseAtoms& poses) noexcept {
  (void)poses_.read(newest_poses_);
  poses = newest_poses_;
  for (PoseAtom& pose : poses.stations) {
    if (now - pose.time <= kPosesKept) continue;
    pose.valid = false;
    pose.buttons = 0;
  }
}

bool LinkedDevice::read(double now, DeviceSample& sample) noexcept {
  DeviceAtoms atoms;
  if (!read_atoms(now, atoms) || !atoms.has_position) return false;
  sample = {atoms.time, atoms.position, atoms.buttons};
  return true;
}

void LinkedDevice::command(const Vec3& force) noexcept {
  stopped_.store(false, std::memory_order_release);
  orders_.write({force, now_seconds(), newest_.time});
}

LinkStatus LinkedDevice::status() const {
  const std::lock_guard lock(mutex_);
  return status_;
}

std::string LinkedDevice::advice() const {
  {
    const std::lock_guard lock(mutex_);
    if (!advice_.empty() || !switch_) return advice_;
  }
  return switch_->advice();
}

}  // namespace palpate
