#include "tests/common/device/driver/falcon/falcon_emulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;
constexpr double kLongestMove = 5e-4;  // [s] of the integration
constexpr double kImageEnd = 0.05;     // [s] of silence after which an image is complete

// The arm [m], measured.
constexpr double kThigh = 0.06, kShin = 0.1025, kEnds = 2 * 0.01125;
constexpr double kPlatformU = 0.01443, kPlatformV = -0.025, kBaseU = 0.04, kBaseV = -0.02309;
constexpr std::array<double, 3> kDirections{105.0 * kDegree, -15.0 * kDegree, -135.0 * kDegree};
constexpr double kCountAngle = 360.0 / (4.0 * 320.0) * (14.25 / 110.0) * kDegree;
constexpr double kZeroAngle = 35.0 * kDegree;
constexpr double kOut = 60.0 * kDegree,
                 kInside = 12.0 * kDegree;  // thigh angles of the homing gesture's ends

}  // namespace

FalconEmulator::FalconEmulator(const EmulatedFalcon& settings)
    : settings_(settings), random_(settings.seed), x_(settings.start) {
  running_ = settings.loaded;
  homed_ = settings.homed ? 7 : 0;
  for (int& offset : offset_) offset = static_cast<int>(random_() % 3000) - 1500;
  (void)legs_at(x_, legs_);
}

void FalconEmulator::restart() {
  running_ = false;
  greeted_ = uploading_ = false;
  image_.clear();
  motors_ = {};
  lose_zero();
}

void FalconEmulator::lose_zero() {
  homed_ = 0;
  was_out_ = {};
  gesture_ = 0.0;
}

UsbDevice FalconEmulator::description() const {
  return {.id = {0x0403, 0xcb48},
          .path = {},
          .endpoints = {{.interface = 0, .address = 0x02, .packet = 64},
                        {.interface = 0, .address = 0x81, .packet = 64}}};
}

/// The thigh of each leg by bisection: between the direction of the joint and the opposite one the distance
/// of elbow and joint only grows.
bool FalconEmulator::legs_at(const Vec3& x, std::array<Leg, 3>& legs) const {
  for (std::size_t i = 0; i < 3; ++i) {
    const double c = std::cos(kDirections[i]), s = std::sin(kDirections[i]);
    const double u = c * x.x + s * x.y - kBaseU, v = -s * x.x + c * x.y - kBaseV, w = x.z;
    const double across = kShin * kShin - (v + kPlatformV) * (v + kPlatformV);
    if (!(across > 0.0)) return false;
    const double reach = kEnds + std::sqrt(across);
    const double ju = u + kPlatformU;
    const double toward = std::atan2(w, ju), apart = std::hypot(ju, w);
    if (!(apart < kThigh + reach) || !(apart > std::abs(kThigh - reach))) return false;
    double low = toward - std::numbers::pi, high = toward;
    const auto gap = [&](double theta) {
      const double du = ju - kThigh * std::cos(theta), dw = w - kThigh * std::sin(theta);
      return du * du + dw * dw - reach * reach;
    };
    // The last angle is near: its neighbourhood first, by halves from there.
    constexpr double kNear = 0.02;
    const double before = legs[i].angle;
    if (before - kNear > low && gap(before - kNear) > 0.0) low = before - kNear;
    if (before + kNear < high && gap(before + kNear) < 0.0) high = before + kNear;
    while (high - low > 1e-9) {
      const double middle = 0.5 * (low + high);
      (gap(middle) > 0.0 ? low : high) = middle;
    }
    const double theta = 0.5 * (low + high);
    const double du = ju - kThigh * std::cos(theta), dw = w - kThigh * std::sin(theta);
    // Implicitly: dg = 2 du dU + 2 dw dW - 2 L dL + (dg/dtheta) dtheta = 0.
    const double by_theta = 2.0 * kThigh * (du * std::sin(theta) - dw * std::cos(theta));
    const double by_v = 2.0 * reach * (v + kPlatformV) / std::sqrt(across);
    const Vec3 leg = Vec3{2.0 * du, by_v, 2.0 * dw} / -by_theta;
    legs[i] = {theta, {c * leg.x - s * leg.y, s * leg.x + c * leg.y, leg.z}};
  }
  return true;
}

std::array<int, 3> FalconEmulator::counts() const {
  std::array<int, 3> counts{};
  for (std::size_t i = 0; i < 3; ++i) {
    const int true_count = static_cast<int>(std::lround((legs_[i].angle - kZeroAngle) / kCountAngle));
    counts[i] = true_count + slipped_[i] + ((homed_ >> i) & 1 ? 0 : offset_[i]);
  }
  return counts;
}

void FalconEmulator::move(double dt) {
  Vec3 wanted = target_;
  double stiffness = settings_.hand, damping = settings_.damping;
  if (homing_ && homed_ != 7 && home_by_itself_) {
    // Firmly out for half a second, then in.
    gesture_ += dt;
    const double cycle = std::fmod(gesture_, 1.2);
    wanted = {0.0, 0.0, cycle < 0.6 ? 0.168 : 0.092};
    stiffness = 800.0;
    damping += 20.0;
  }
  motor_force_ = Vec3{0.0};
  if (running_) {
    for (std::size_t i = 0; i < 3; ++i) motor_force_ += legs_[i].rate * (-motors_[i] / settings_.gain);
  }
  largest_force_ = std::max(largest_force_, glm::length(motor_force_));
  for (int a = 0; a < 3; ++a) {
    const double driving = motor_force_[a] + stiffness * (wanted[a] - x_[a]) - damping * v_[a];
    // Friction stops what it can stop within the step, and slows down the rest.
    const double free = v_[a] + dt * driving / settings_.mass;
    const double rubbed = dt * settings_.friction / settings_.mass;
    v_[a] = std::abs(free) <= rubbed ? 0.0 : free - std::copysign(rubbed, free);
  }
  const Vec3 next = x_ + dt * v_;
  std::array<Leg, 3> legs = legs_;
  if (!legs_at(next, legs)) {  // an end stop, soft enough to slide along
    constexpr double kGiven = 1e-3;
    v_ = Vec3{0.0};
    x_ += kGiven * (kMiddle - x_);
    (void)legs_at(x_, legs_);
    return;
  }
  x_ = next;
  legs_ = legs;
  for (std::size_t i = 0; i < 3; ++i) {
    if (!homing_) continue;
    if (legs_[i].angle > kOut) was_out_[i] = true;
    if (was_out_[i] && legs_[i].angle < kInside) homed_ |= 1 << i;
  }
}

void FalconEmulator::advance(double now) {
  while (time_ < now) {
    const double next = to_device_.empty() ? now : std::clamp(to_device_.front().time, time_, now);
    while (time_ < next) {
      const double dt = std::min(kLongestMove, next - time_);
      move(dt);
      time_ = dt < kLongestMove ? next : time_ + dt;
    }
    while (!to_device_.empty() && to_device_.front().time <= time_) {
      const std::uint8_t byte = to_device_.front().value;
      to_device_.pop_front();
      take(time_, byte);
    }
    if (uploading_ && !image_.empty() && time_ - last_image_byte_ > kImageEnd) {
      uploading_ = false;
      running_ = true;
    }
  }
}

double FalconEmulator::byte_time() const {
  const double baud = divisor_ == 0x0002 ? 1.5e6 : divisor_ == 0x0015 ? 3e6 / 21.0 : 9600.0;
  return 10.0 / baud;
}

TransferStatus FalconEmulator::control(double now, const UsbControl& setup, std::span<const std::uint8_t>) {
  advance(now);
  if (setup.request_type != 0x40) return TransferStatus::kStall;
  controls_.emplace_back(setup.request, setup.value);
  switch (setup.request) {
    case 0x00:
      if (setup.value != 2) to_host_.clear();
      if (setup.value != 1) to_device_.clear();
      return TransferStatus::kOk;
    case 0x01:
      if ((setup.value & 0x0100) != 0) {
        const bool high = (setup.value & 0x01) != 0;
        if (high && !dtr_) dtr_pulsed_ = true;
        dtr_ = high;
      }
      if ((setup.value & 0x0200) != 0) rts_ = (setup.value & 0x02) != 0;
      return TransferStatus::kOk;
    case 0x03:
      divisor_ = setup.value;
      return TransferStatus::kOk;
    case 0x09:
      latency_ = setup.value;
      next_flush_ = now + 1e-3 * latency_;
      return TransferStatus::kOk;
    case 0x02:
    case 0x04:
      return TransferStatus::kOk;
    default:
      return TransferStatus::kStall;
  }
}

void FalconEmulator::write(double now, std::uint8_t endpoint, std::span<const std::uint8_t> data) {
  advance(now);
  if (endpoint != 0x02) return;
  double at = to_device_.empty() ? now : std::max(now, to_device_.back().time);
  for (const std::uint8_t byte : data) to_device_.push_back({at += byte_time(), byte});
}

std::size_t FalconEmulator::read(double now, std::uint8_t endpoint, std::span<std::uint8_t> data) {
  // Between two flushes nothing can be seen of it.
  if (now < next_flush_) return 0;
  advance(now);
  if (endpoint != 0x81 || data.size() < 64) return 0;
  next_flush_ = now + 1e-3 * latency_;
  const bool cts = settings_.raises_cts && divisor_ == 0x0015 && greeted_;
  data[0] = cts ? 0x11 : 0x01;
  data[1] = 0x60;
  std::size_t bytes = 2;
  std::uint64_t waiting = 0;
  for (const Byte& byte : to_host_) waiting += byte.value == '<' ? 1 : 0;
  if (running_) most_waiting_ = std::max(most_waiting_, waiting);
  while (bytes < 64 && !to_host_.empty() && to_host_.front().time <= now) {
    data[bytes++] = to_host_.front().value;
    to_host_.pop_front();
  }
  return bytes;
}

void FalconEmulator::say(double now, std::uint8_t byte) {
  const double from = to_host_.empty() ? now : std::max(now, to_host_.back().time);
  to_host_.push_back({from + byte_time(), byte});
}

void FalconEmulator::take(double now, std::uint8_t byte) {
  if (running_ && divisor_ == 0x0002) {
    take_packet(now, byte);
  } else if (!running_) {
    take_loader(now, byte);
  }
}

void FalconEmulator::take_loader(double now, std::uint8_t byte) {
  if (divisor_ == 0x4138) {
    if (settings_.deaf_loader || !dtr_pulsed_ || !dtr_ || rts_) return;
    hello_.push_back(byte);
    if (hello_.size() > 3) hello_.erase(hello_.begin());
    if (hello_ == std::vector<std::uint8_t>{0x0A, 0x43, 0x0D}) {
      greeted_ = true;
      uploading_ = false;
      image_.clear();
      if (random_() % 2 == 0) say(now, 0x00);
      for (const std::uint8_t answer : {0x0A, 0x44, 0x2C, 0x0D}) say(now, answer);
    }
    return;
  }
  if (divisor_ != 0x0015 || dtr_ || !greeted_) return;
  if (!uploading_) {
    if (byte != 0x41) return;
    say(now, 0x41);
    uploading_ = true;
    image_.clear();
    last_image_byte_ = now;
    return;
  }
  image_.push_back(byte);
  last_image_byte_ = now;
  if (settings_.failing_uploads > 0 && image_.size() == 700) {
    --settings_.failing_uploads;
    greeted_ = uploading_ = false;
    image_.clear();
    say(now, static_cast<std::uint8_t>(byte ^ 0x20U));
    return;
  }
  say(now, byte);
}

void FalconEmulator::take_packet(double now, std::uint8_t byte) {
  if (byte == 0x3C) packet_.clear();
  packet_.push_back(byte);
  if (packet_.size() > 16) packet_.erase(packet_.begin());
  if (packet_.size() != 16 || packet_.front() != 0x3C || packet_.back() != 0x3E) return;
  ++commands_;
  for (std::size_t i = 0; i < 3; ++i) {
    int value = 0;
    for (std::size_t n = 4; n-- > 0;) value = value * 16 + (packet_[1 + 4 * i + n] - 0x41);
    motors_[i] = value >= 0x8000 ? value - 0x10000 : value;
    largest_motor_ = std::max(largest_motor_, std::abs(motors_[i]));
  }
  const unsigned flags = packet_[13] - 0x41U;
  homing_ = (flags & 1U) != 0;
  lights_ = flags & 14U;
  if (!homing_) homed_ = 0;
  if (homed_ != 7 && (motors_[0] != 0 || motors_[1] != 0 || motors_[2] != 0)) pushed_unhomed_ = true;
  packet_.clear();

  say(now, 0x3C);
  for (const int count : counts()) {
    unsigned bits = static_cast<unsigned>(count) & 0xFFFFU;
    for (int n = 0; n < 4; ++n, bits >>= 4) say(now, static_cast<std::uint8_t>(0x41 + (bits & 15U)));
  }
  say(now, static_cast<std::uint8_t>(0x41 + (buttons_ & 15U) + (static_cast<unsigned>(homed_) << 4U)));
  say(now, 0x41);
  say(now, 0x3E);
}

}  // namespace palpate::test
