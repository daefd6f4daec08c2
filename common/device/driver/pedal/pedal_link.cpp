#include "common/device/driver/pedal/pedal_link.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "common/device/driver/transport/usb_search.h"

namespace palpate {
namespace {

constexpr std::uint32_t kLeft = 1, kMiddle = 2, kRight = 4, kAll = 7;

std::optional<std::uint32_t> of_keyboard(std::span<const std::uint8_t> report) noexcept {
  constexpr std::size_t kLength = 8, kKeys = 2;
  constexpr std::uint8_t kFirstKey = 0x04, kKeyB = 0x05, kKeyC = 0x06;  // below: rollover and other errors
  if (report.size() != kLength || report[1] != 0) return std::nullopt;
  std::uint32_t pedals = report[0] != 0 ? kLeft : 0;
  for (const std::uint8_t key : report.subspan(kKeys)) {
    if (key == 0) continue;
    if (key < kFirstKey) return std::nullopt;
    pedals |= key == kKeyB ? kMiddle : key == kKeyC ? kRight : kLeft;
  }
  return pedals;
}

constexpr std::string_view kPedal = "pedal";
constexpr double kAnswerTime = 0.010;    // [s] that GET_REPORT may take
constexpr double kSetUpTime = 0.1;       // [s]
constexpr std::size_t kPedalBytes = 64;  // [bytes]

// HID, class requests to the interface.
constexpr std::uint8_t kOutToInterface = 0x21, kInFromInterface = 0xA1, kGetReport = 0x01, kSetIdle = 0x0A;
constexpr std::uint16_t kInputReport = 0x0100;

PedalFormat format_of(UsbId id) noexcept {
  constexpr UsbId kXk3{0x05f3, 0x042c}, kVec{0x05f3, 0x00ff};
  if (id == kXk3) return PedalFormat::kXKeys;
  return id == kVec ? PedalFormat::kInfinity : PedalFormat::kKeyboard;
}

}  // namespace

std::optional<std::uint32_t> pedals_of(PedalFormat format, std::span<const std::uint8_t> report) noexcept {
  switch (format) {
    case PedalFormat::kXKeys: {
      if (report.size() < 3 || report[0] != 0 || report[1] != 1) return std::nullopt;
      const std::uint32_t pedals = static_cast<std::uint32_t>(report[2]) >> 1U;
      return (report[2] & 1U) == 0 && pedals <= kAll ? std::optional(pedals) : std::nullopt;
    }
    case PedalFormat::kInfinity:
      return report.size() == 2 && report[0] <= kAll && report[1] == 0
                 ? std::optional<std::uint32_t>(report[0])
                 : std::nullopt;
    case PedalFormat::kKeyboard:
      return of_keyboard(report);
  }
  return std::nullopt;
}

std::string PedalLink::place() const { return path_.empty() ? path_ : "usb " + path_; }

std::string PedalLink::advice() const {
  if (status_.phase == LinkPhase::kAbsent) return "no foot switch is plugged in";
  if (status_.phase != LinkPhase::kRefused) return {};
  if (connection_) {
    return "the foot switch neither repeats its reports nor answers: it cannot guard a hand; plug it in "
           "directly, without a hub, or take another one";
  }
  return refusal_advice("the foot switch", refused_);
}

bool PedalLink::round() noexcept {
  if (!connection_) {
    search();
    return false;
  }
  if (listen()) return true;
  if (!connection_) return release();
  const double silence = transport_.now() - heard_;
  if (silence > kDumb) status_.phase = LinkPhase::kRefused;
  return silence > kSilence && atoms_.buttons != 0 && release();
}

bool PedalLink::listen() noexcept {
  std::array<std::uint8_t, kPedalBytes> report{};
  const auto fails = [this](TransferStatus status) {
    // That a pedal refuses to be asked is no fault, as long as it speaks by itself.
    if (!given_up(status, kMostMisses, misses_)) return false;
    ++status_.faults;
    connection_.reset();
    return true;
  };
  const TransferResult said = connection_->read(reports_, report, kAskAfter);
  if (said.ok()) return hear(std::span(report).first(std::min(said.bytes, report.size())));
  if (fails(said.status)) return false;
  const TransferResult answer = connection_->ask({.request_type = kInFromInterface,
                                                  .request = kGetReport,
                                                  .value = kInputReport,
                                                  .index = reports_.interface},
                                                 report, kAnswerTime);
  if (answer.ok()) return hear(std::span(report).first(std::min(answer.bytes, report.size())));
  if (answer.status == TransferStatus::kGone) (void)fails(answer.status);
  ++status_.lost;
  return false;
}

bool PedalLink::hear(std::span<const std::uint8_t> report) noexcept {
  misses_ = 0;
  const std::optional<std::uint32_t> pedals = pedals_of(format_, report);
  if (!pedals) {
    status_.dropped += report.size();
    return release();
  }
  ++status_.rounds;
  status_.phase = LinkPhase::kReady;
  seen_released_ = seen_released_ || *pedals == 0;
  heard_ = transport_.now();
  atoms_.time = heard_;
  atoms_.buttons = seen_released_ ? *pedals : 0;
  return true;
}

bool PedalLink::release() noexcept {
  if (!connection_) {
    path_.clear();
    status_.phase = LinkPhase::kAbsent;
  }
  atoms_.time = transport_.now();
  atoms_.buttons = 0;
  return true;
}

void PedalLink::search() noexcept {
  UsbFound found = look_for(transport_, kPedal, true, status_);
  refused_ = found.refused;
  if (!found.connection) return;
  connection_ = std::move(found.connection);
  reports_ = found.endpoint;
  format_ = format_of(found.device.id);
  path_ = std::move(found.device.path);
  misses_ = 0;
  seen_released_ = false;
  heard_ = transport_.now();
  // A pedal that refuses is asked instead.
  (void)connection_->control({.request_type = kOutToInterface,
                              .request = kSetIdle,
                              .value = static_cast<std::uint16_t>(kRepeatUnits << 8U),
                              .index = reports_.interface},
                             {}, kSetUpTime);
}

}  // namespace palpate
