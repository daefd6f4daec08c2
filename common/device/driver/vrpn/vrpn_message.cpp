#include "common/device/driver/vrpn/vrpn_message.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr std::string_view kCookieText = "vrpn: ver. 07.38";  // what follows its last '.' may differ
constexpr std::string_view kCookieStart = "vrpn: ver. 07.";
constexpr std::size_t kVrpnAlign = 8;
constexpr std::size_t kMostStates = 256;    // buttons that a message may have
constexpr std::size_t kMostChannels = 128;  // VRPN's own limit

constexpr std::array<std::string_view, 9> kTypeNames{"",
                                                     "vrpn_Tracker Pos_Quat",
                                                     "vrpn_Button Change",
                                                     "vrpn_Button States",
                                                     "vrpn_Analog Channel",
                                                     "vrpn_ForceDevice Force_Error",
                                                     "vrpn_ForceDevice Force_Field",
                                                     "vrpn_Base ping_message",
                                                     "vrpn_Base pong_message"};

std::uint32_t big_u32(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  std::uint32_t value = 0;
  for (std::size_t i = 0; i < 4; ++i) value = (value << 8U) | bytes[at + i];
  return value;
}

std::int32_t big_i32(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  return std::bit_cast<std::int32_t>(big_u32(bytes, at));
}

double big_double(std::span<const std::uint8_t> bytes, std::size_t at) noexcept {
  const std::uint64_t high = big_u32(bytes, at), low = big_u32(bytes, at + 4);
  return std::bit_cast<double>((high << 32U) | low);
}

void put_u32(std::span<std::uint8_t> bytes, std::size_t at, std::uint32_t value) noexcept {
  for (std::size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<std::uint8_t>(value >> (24U - 8U * i));
}

constexpr std::size_t aligned(std::size_t bytes) noexcept {
  return (bytes + kVrpnAlign - 1) / kVrpnAlign * kVrpnAlign;
}

}  // namespace

std::string_view name_of(VrpnType type) noexcept { return kTypeNames[as_size(type)]; }

VrpnParser::Found VrpnParser::push(std::span<const std::uint8_t>& bytes, VrpnMessage& message) noexcept {
  while (!broken_) {
    if (size_ + skipped_ == wanted_) {
      // Something is whole.
      if (!greeted_) {
        greeted_ = true;
        const auto same =
            std::equal(kCookieStart.begin(), kCookieStart.end(), kept_.begin(),
                       [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
        size_ = 0;
        wanted_ = kVrpnHeader;
        broken_ = !same;
        return same ? Found::kCookie : Found::kNonsense;
      }
      if (in_body_) {
        const bool kept = payload_ <= kVrpnKept;
        message.sender = big_i32(kept_, 12);
        message.type = big_i32(kept_, 16);
        message.time = big_i32(kept_, 4) + 1e-6 * big_i32(kept_, 8);
        message.payload = std::span<const std::uint8_t>(kept_).subspan(kVrpnHeader, kept ? payload_ : 0);
        size_ = skipped_ = 0;
        wanted_ = kVrpnHeader;
        in_body_ = false;
        return Found::kMessage;
      }
      if (take_header() == Found::kNonsense) return Found::kNonsense;
      continue;
    }
    if (bytes.empty()) return Found::kNothing;
    const std::size_t missing = wanted_ - size_ - skipped_;
    const std::size_t taken = std::min(missing, bytes.size());
    const std::size_t room = std::min(taken, kept_.size() - size_);
    std::copy_n(bytes.begin(), room, kept_.begin() + static_cast<std::ptrdiff_t>(size_));
    size_ += room;
    skipped_ += taken - room;
    bytes = bytes.subspan(taken);
  }
  return Found::kNonsense;
}

VrpnParser::Found VrpnParser::take_header() noexcept {
  const std::size_t length = big_u32(kept_, 0);
  if (length < kVrpnHeader || length > kVrpnLongest) {
    broken_ = true;
    return Found::kNonsense;
  }
  payload_ = length - kVrpnHeader;
  wanted_ = kVrpnHeader + aligned(payload_);
  in_body_ = true;
  return Found::kNothing;
}

void VrpnNames::take(const VrpnMessage& message) noexcept {
  if (message.type != kVrpnSenders && message.type != kVrpnTypes) return;
  // A name, with its length in front and a zero at its end, both counted.
  if (message.payload.size() < 5 || message.sender < 0) return;
  const auto number = as_size(message.sender);
  const std::size_t letters = big_u32(message.payload, 0);
  if (number >= kMost || letters != message.payload.size() - 4) return;
  const auto named = [&](std::string_view name) {
    const auto text = message.payload.subspan(4, letters - 1);
    return std::equal(name.begin(), name.end(), text.begin(), text.end(),
                      [](char a, std::uint8_t b) { return static_cast<std::uint8_t>(a) == b; });
  };
  if (message.type == kVrpnSenders) {
    senders_[number] = named(device_);
    has_device_ = has_device_ || senders_[number];
    return;
  }
  types_[number] = VrpnType::kOther;
  for (std::size_t i = 1; i < kTypeNames.size(); ++i) {
    if (named(kTypeNames[i])) types_[number] = static_cast<VrpnType>(i);
  }
}

std::optional<VrpnPose> vrpn_pose(std::span<const std::uint8_t> payload) noexcept {
  constexpr std::size_t kPoseBytes = 64;
  if (payload.size() != kPoseBytes) return std::nullopt;
  VrpnPose pose{.sensor = big_i32(payload, 0)};
  for (int a = 0; a < 3; ++a) pose.position[a] = big_double(payload, 8 + 8 * as_size(a));
  const double x = big_double(payload, 32), y = big_double(payload, 40), z = big_double(payload, 48),
               w = big_double(payload, 56);
  const double length = std::sqrt(x * x + y * y + z * z + w * w);
  constexpr double kUnitWithin = 0.1;  // a quaternion that is not nearly of unit length is none
  if (!is_finite(pose.position) || !(std::abs(length - 1.0) <= kUnitWithin)) return std::nullopt;
  pose.orientation = Quat{w, x, y, z} / length;
  return pose;
}

std::optional<std::uint32_t> vrpn_button_change(std::span<const std::uint8_t> payload,
                                                std::uint32_t buttons) noexcept {
  if (payload.size() != 8) return std::nullopt;
  const std::uint32_t button = big_u32(payload, 0), state = big_u32(payload, 4);
  if (state > 1) return std::nullopt;
  if (button >= 32) return buttons;
  const std::uint32_t bit = 1U << button;
  return state == 1 ? buttons | bit : buttons & ~bit;
}

std::optional<std::uint32_t> vrpn_button_states(std::span<const std::uint8_t> payload) noexcept {
  if (payload.size() < 4) return std::nullopt;
  const std::size_t count = big_u32(payload, 0);
  if (count > kMostStates || payload.size() != 4 + 4 * count) return std::nullopt;
  std::uint32_t buttons = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t state = big_u32(payload, 4 + 4 * i);
    if (state > 1) return std::nullopt;
    if (i < 32) buttons |= state << i;
  }
  return buttons;
}

std::optional<std::size_t> vrpn_channels(std::span<const std::uint8_t> payload,
                                         std::span<double> values) noexcept {
  if (payload.size() < 8) return std::nullopt;
  const double stated = big_double(payload, 0);
  if (!(stated >= 0.0 && stated <= static_cast<double>(kMostChannels)) || stated != std::floor(stated)) {
    return std::nullopt;
  }
  const auto count = floor_size(stated);
  if (payload.size() != 8 + 8 * count) return std::nullopt;
  const std::size_t read = std::min(count, values.size());
  for (std::size_t i = 0; i < read; ++i) {
    const double value = big_double(payload, 8 + 8 * i);
    if (!std::isfinite(value)) return std::nullopt;
    values[i] = std::clamp(value, -1.0, 1.0);
  }
  return read;
}

void VrpnWriter::cookie() noexcept {
  if (memory_.size() - size_ < kVrpnCookie) {
    overflowed_ = true;
    return;
  }
  const auto place = memory_.subspan(size_, kVrpnCookie);
  std::fill(place.begin(), place.end(), std::uint8_t{0});
  std::copy(kCookieText.begin(), kCookieText.end(), place.begin());
  // Two blanks, and that nothing is to be logged.
  place[kCookieText.size()] = place[kCookieText.size() + 1] = ' ';
  place[kCookieText.size() + 2] = '0';
  size_ += kVrpnCookie;
}

void VrpnWriter::description(std::int32_t kind, std::int32_t number, std::string_view name) noexcept {
  std::array<std::uint8_t, kVrpnKept> payload{};
  if (name.size() + 5 > payload.size()) {
    overflowed_ = true;
    return;
  }
  put_u32(payload, 0, static_cast<std::uint32_t>(name.size() + 1));
  std::copy(name.begin(), name.end(), payload.begin() + 4);
  message(0.0, number, kind, std::span<const std::uint8_t>(payload).first(name.size() + 5));
}

void VrpnWriter::force_field(double time, std::int32_t sender, std::int32_t type,
                             const VrpnForceField& field) noexcept {
  std::array<std::uint8_t, 64> payload{};
  std::size_t at = 0;
  const auto put = [&](double value) {
    put_u32(payload, at, std::bit_cast<std::uint32_t>(static_cast<float>(value)));
    at += 4;
  };
  for (int a = 0; a < 3; ++a) put(field.origin[a]);
  for (int a = 0; a < 3; ++a) put(field.force[a]);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) put(field.jacobian[column][row]);
  }
  put(field.radius);
  message(time, sender, type, payload);
}

void VrpnWriter::message(double time, std::int32_t sender, std::int32_t type,
                         std::span<const std::uint8_t> payload) noexcept {
  const std::size_t whole = kVrpnHeader + aligned(payload.size());
  if (memory_.size() - size_ < whole) {
    overflowed_ = true;
    return;
  }
  const auto place = memory_.subspan(size_, whole);
  std::fill(place.begin(), place.end(), std::uint8_t{0});
  constexpr double kMillion = 1e6;
  const double seconds = std::floor(std::max(0.0, time));
  put_u32(place, 0, static_cast<std::uint32_t>(kVrpnHeader + payload.size()));
  put_u32(place, 4, static_cast<std::uint32_t>(seconds));
  put_u32(place, 8, static_cast<std::uint32_t>(kMillion * (std::max(0.0, time) - seconds)));
  put_u32(place, 12, std::bit_cast<std::uint32_t>(sender));
  put_u32(place, 16, std::bit_cast<std::uint32_t>(type));
  put_u32(place, 20, number_++);
  std::copy(payload.begin(), payload.end(), place.begin() + static_cast<std::ptrdiff_t>(kVrpnHeader));
  size_ += whole;
}

}  // namespace palpate
