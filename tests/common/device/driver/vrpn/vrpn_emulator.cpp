#include "tests/common/device/driver/vrpn/vrpn_emulator.h"

#include <cstring>

namespace palpate::test {
namespace {

using Bytes = VrpnEmulator::Bytes;

void add_int(Bytes& bytes, std::int64_t value) {
  for (int shift = 24; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>((value >> shift) & 0xFF));
}

void add_double(Bytes& bytes, double value) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &value, sizeof bits);
  for (int shift = 56; shift >= 0; shift -= 8)
    bytes.push_back(static_cast<std::uint8_t>((bits >> shift) & 0xFF));
}

std::int32_t int_at(const Bytes& bytes, std::size_t at) {
  std::int64_t value = 0;
  for (std::size_t i = at; i < at + 4; ++i) value = value * 256 + bytes[i];
  return static_cast<std::int32_t>(value >= 0x80000000LL ? value - 0x100000000LL : value);
}

double float_at(const Bytes& bytes, std::size_t at) {
  const auto bits = static_cast<std::uint32_t>(int_at(bytes, at));
  float value = 0.0F;
  std::memcpy(&value, &bits, sizeof value);
  return value;
}

}  // namespace

void VrpnEmulator::put(std::int32_t sender, std::int32_t type, const Bytes& payload) {
  add_int(said_, 24 + static_cast<std::int64_t>(payload.size()));
  const double stamp = time_ + clock_ahead, seconds = std::floor(stamp);
  add_int(said_, static_cast<std::int64_t>(seconds));
  add_int(said_, exact_stamps ? static_cast<std::int64_t>(1e6 * (stamp - seconds)) : 0);
  add_int(said_, sender);
  add_int(said_, type);
  add_int(said_, 77);
  said_.insert(said_.end(), payload.begin(), payload.end());
  for (std::size_t n = payload.size(); n % 8 != 0; ++n) said_.push_back(0xEE);
}

void VrpnEmulator::describe(std::int32_t kind, std::int32_t number, const std::string& name) {
  Bytes payload;
  add_int(payload, static_cast<std::int64_t>(name.size()) + 1);
  for (const char letter : name) payload.push_back(static_cast<std::uint8_t>(letter));
  payload.push_back(0);
  put(number, kind, payload);
}

void VrpnEmulator::connect(double now) {
  time_ = std::max(time_, now);
  posed_ = sent_channels_ = time_;
  connected_ = true;
  greeted_ = false;
  said_.clear();
  heard_.clear();
  senders_.assign(2000, "");
  types_.assign(2000, "");
  field_ = {};
  Bytes greeting(cookie.begin(), cookie.end());
  greeting.insert(greeting.end(), {' ', ' ', '0', 'x'});
  greeting.resize(24, 0x7F);
  say_raw(greeting);
  describe(-1, kOther, "Tracker9");
  if (names_device) describe(-1, kSender, device);
  describe(-2, kPosQuat, "vrpn_Tracker Pos_Quat");
  describe(-2, kChange, "vrpn_Button Change");
  describe(-2, kAnalog, "vrpn_Analog Channel");
  describe(-2, kPong, "vrpn_Base pong_message");
  describe(-2, kError, "vrpn_ForceDevice Force_Error");
  describe(-2, 6, "vrpn_Something Else");
  put(9999, -3, {'1', '2', '7', 0});  // where UDP would go
}

void VrpnEmulator::leave(double now) {
  live(now);
  connected_ = false;
  field_ = {};
  arm.push(Vec3{0.0});
}

void VrpnEmulator::press(unsigned button, bool down) {
  Bytes payload;
  add_int(payload, button);
  add_int(payload, down ? 1 : 0);
  put(kSender, kChange, payload);
}

void VrpnEmulator::pose(std::int32_t number, const Vec3& p) {
  Bytes payload;
  add_int(payload, number);
  add_int(payload, 0);
  for (int a = 0; a < 3; ++a) add_double(payload, nonsense ? std::nan("") : p[a]);
  for (const double q : {0.0, 0.0, 0.0, 1.0}) add_double(payload, q);
  put(kSender, kPosQuat, payload);
}

Vec3 VrpnEmulator::force_at(const Vec3& p) const {
  const Vec3 d = p - field_.origin;
  if (!(glm::length(d) < field_.radius)) return Vec3{0.0};
  Vec3 force = field_.force;
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) force[row] += field_.jacobian[row][column] * d[column];
  }
  return force;
}

void VrpnEmulator::live(double now) {
  constexpr double kLoop = 0.001;  // [s]
  while (time_ < now) {
    const double next = std::min(now, time_ + kLoop);
    if (connected_) arm.push(force_at(arm.position()));
    arm.advance(next);
    time_ = next;
    if (!connected_ || silent) continue;
    if (rate > 0.0 && time_ - posed_ >= 1.0 / rate) {
      posed_ += 1.0 / rate;
      pose(sensor + 1, {9.0, 9.0, 9.0});
      pose(sensor, arm.position());
    }
    if (analog_rate > 0.0 && time_ - sent_channels_ >= 1.0 / analog_rate) {
      sent_channels_ += 1.0 / analog_rate;
      Bytes payload;
      add_double(payload, static_cast<double>(channels.size()));
      for (const double value : channels) add_double(payload, value);
      put(kSender, kAnalog, payload);
    }
  }
}

void VrpnEmulator::advance(double now, Bytes& out) {
  live(now);
  if (connected_) out.insert(out.end(), said_.begin(), said_.end());
  said_.clear();
}

void VrpnEmulator::take(double now, const Bytes& bytes) {
  live(now);
  heard_.insert(heard_.end(), bytes.begin(), bytes.end());
  if (!greeted_) {
    if (heard_.size() < 24) return;
    if (std::memcmp(heard_.data(), "vrpn: ver. 07.", 14) != 0) strange = heard_;
    heard_.erase(heard_.begin(), heard_.begin() + 24);
    greeted_ = true;
  }
  while (heard_.size() >= 24) {
    const auto length = static_cast<std::size_t>(int_at(heard_, 0));
    const std::size_t whole = 24 + (length - 24 + 7) / 8 * 8;
    if (length < 24 || length > 4096) {
      strange = heard_;
      return;
    }
    if (heard_.size() < whole) return;
    const Bytes payload(heard_.begin() + 24, heard_.begin() + static_cast<std::ptrdiff_t>(length));
    const std::int32_t sender = int_at(heard_, 12), type = int_at(heard_, 16);
    heard_.erase(heard_.begin(), heard_.begin() + static_cast<std::ptrdiff_t>(whole));
    take_message(sender, type, payload);
  }
}

void VrpnEmulator::take_message(std::int32_t sender, std::int32_t type, const Bytes& payload) {
  if (type == -1 || type == -2) {
    const std::string name(payload.begin() + 4, payload.end() - 1);
    if (int_at(payload, 0) != static_cast<std::int32_t>(name.size()) + 1 || payload.back() != 0)
      strange = payload;
    (type == -1 ? senders_ : types_)[static_cast<std::size_t>(sender)] = name;
    return;
  }
  // What was not named before it is used cannot be understood.
  if (senders_[static_cast<std::size_t>(sender)] != device) {
    strange = payload;
    return;
  }
  const std::string& name = types_[static_cast<std::size_t>(type)];
  if (name == "vrpn_Base ping_message") {
    ++pings;
    if (answers && !silent) put(kSender, kPong, {});
  } else if (name == "vrpn_ForceDevice Force_Field" && payload.size() == 64) {
    ++fields;
    field_ = {};
    for (int a = 0; a < 3; ++a) {
      field_.origin[a] = float_at(payload, 4 * static_cast<std::size_t>(a));
      field_.force[a] = float_at(payload, 12 + 4 * static_cast<std::size_t>(a));
    }
    double norm = 0.0;
    for (std::size_t row = 0; row < 3; ++row) {
      for (std::size_t column = 0; column < 3; ++column) {
        const double value = float_at(payload, 24 + 4 * (3 * row + column));
        field_.jacobian[row][column] = value;
        norm += value * value;
      }
    }
    field_.radius = float_at(payload, 60);
    // Along some directions: no more than the cap, and never outwards.
    for (int n = 0; n < 100; ++n) {
      const Vec3 d = 0.99 * field_.radius *
                     Vec3{std::sin(1.1 * n) * std::cos(2.3 * n), std::sin(1.1 * n) * std::sin(2.3 * n),
                          std::cos(1.1 * n)};
      const Vec3 there = force_at(field_.origin + d);
      if (field_.radius > 0.0) largest_field = std::max(largest_field, glm::length(there));
      if (glm::dot(there - field_.force, d) > 1e-6 && field_.radius > 0.0) active_field = true;
    }
    stiffest = std::max(stiffest, std::sqrt(norm));
    arm.push(force_at(arm.position()));
  } else if (name != "vrpn_Base pong_message") {
    strange = payload;
  }
}

}  // namespace palpate::test
