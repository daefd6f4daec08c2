#include "common/device/driver/spacemouse/spacemouse_link.h"

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/device/driver/transport/usb_search.h"

namespace palpate {
namespace {

constexpr std::uint8_t kPushReport = 1, kTurnReport = 2, kButtonReport = 3;
constexpr std::size_t kThreeNumbers = 7, kSixNumbers = 13;

void take_numbers(std::span<const std::uint8_t> bytes, std::span<std::int16_t> numbers) noexcept {
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    numbers[i] = static_cast<std::int16_t>(bytes[2 * i] | (bytes[2 * i + 1] << 8U));
  }
}

constexpr std::string_view kSpaceMouse = "spacemouse";
constexpr std::string_view kAxisLetters = "xyzabc";
constexpr double kReportTime = 0.010;       // [s] that one round waits for a report
constexpr double kLightTime = 0.1;          // [s]
constexpr std::size_t kLongestReport = 64;  // [bytes]

// HID: SET_REPORT of the output report 4, one byte.
constexpr std::uint8_t kClassToInterface = 0x21, kSetReport = 0x09, kLightReport = 4;
constexpr std::uint16_t kOutputReport = 0x0200;

}  // namespace

SpaceMouseNews take_report(std::span<const std::uint8_t> report, SpaceMouseState& state) noexcept {
  if (report.empty()) return SpaceMouseNews::kNothing;
  const std::span<std::int16_t> raw(state.raw);
  switch (report[0]) {
    case kPushReport:
      if (report.size() < kThreeNumbers) return SpaceMouseNews::kNothing;
      take_numbers(report.subspan(1), report.size() >= kSixNumbers ? raw : raw.first(3));
      return SpaceMouseNews::kAxes;
    case kTurnReport:
      if (report.size() < kThreeNumbers) return SpaceMouseNews::kNothing;
      take_numbers(report.subspan(1), raw.last(3));
      return SpaceMouseNews::kAxes;
    case kButtonReport:
      if (report.size() < 2) return SpaceMouseNews::kNothing;
      state.buttons = 0;
      for (std::size_t i = 0; i < std::min<std::size_t>(report.size() - 1, 4); ++i) {
        state.buttons |= static_cast<std::uint32_t>(report[1 + i]) << (8 * i);
      }
      return SpaceMouseNews::kButtons;
    default:
      return SpaceMouseNews::kNothing;
  }
}

std::array<double, DeviceAtoms::kValuators> valuators_of(
    const SpaceMouseState& state, const std::array<double, DeviceAtoms::kValuators>& signs) noexcept {
  const auto part = [&](std::size_t i) {
    const int raw = state.raw[i];
    return std::abs(raw) <= kSpaceMouseRest ? 0.0 : std::clamp(raw / kSpaceMouseFull, -1.0, 1.0);
  };
  // The device's y points towards the user, its z down.
  return {signs[0] * part(0), -signs[1] * part(2), signs[2] * part(1),
          signs[3] * part(3), -signs[4] * part(5), signs[5] * part(4)};
}

SpaceMouseSettings spacemouse_settings(const DriverOptions& options) {
  SpaceMouseSettings settings;
  for (const auto& [name, value] : options) {
    if (name != "invert") {
      throw usage_error("the driver spacemouse knows no option '" + name + "'; known is invert");
    }
    for (const char letter : value) {
      const std::size_t axis = kAxisLetters.find(letter);
      if (axis == std::string_view::npos) {
        throw usage_error("spacemouse: invert takes letters of xyzabc, found '" + value + "'");
      }
      settings.signs[axis] = -1.0;
    }
  }
  return settings;
}

std::string spacemouse_help() {
  return "invert=LETTERS  of xyz, pushes right, up and towards you, and abc, turns about these\n";
}

SpaceMouseLink::SpaceMouseLink(UsbTransport& transport, const SpaceMouseSettings& settings)
    : transport_(transport), settings_(settings) {
  atoms_.has_valuators = true;
}

SpaceMouseLink::~SpaceMouseLink() { close(); }

std::string SpaceMouseLink::advice() const {
  if (status_.phase == LinkPhase::kAbsent) return "no SpaceMouse is plugged in";
  if (status_.phase != LinkPhase::kRefused) return {};
  if (refused_ == TransferStatus::kBusy)
    return "another program, spacenavd perhaps, has the SpaceMouse; end it";
  return refusal_advice("the SpaceMouse", refused_);
}

std::string SpaceMouseLink::place() const { return path_.empty() ? path_ : "usb " + path_; }

bool SpaceMouseLink::round() noexcept {
  if (!connection_) {
    search();
    return false;
  }
  std::array<std::uint8_t, kLongestReport> report{};
  const TransferResult got = connection_->read(reports_, report, kReportTime);
  const double now = transport_.now();
  if (given_up(got.status, kMostMisses, misses_)) {
    ++status_.faults;
    close();
    publish(now);
    return true;  // that it is at rest now
  }
  if (got.ok()) {
    misses_ = 0;
    const SpaceMouseNews news =
        take_report(std::span(report).first(std::min(got.bytes, report.size())), state_);
    if (news == SpaceMouseNews::kAxes) heard_ = now;
    if (news == SpaceMouseNews::kNothing) {
      status_.dropped += got.bytes;
    } else {
      ++status_.rounds;
    }
  }
  if (now - heard_ > kSilence) state_.raw = {};
  publish(now);
  return true;
}

void SpaceMouseLink::publish(double now) noexcept {
  atoms_.time = now;
  atoms_.buttons = state_.buttons;
  atoms_.valuators = valuators_of(state_, settings_.signs);
}

void SpaceMouseLink::search() noexcept {
  UsbFound found = look_for(transport_, kSpaceMouse, true, status_);
  refused_ = found.refused;
  if (!found.connection) return;
  connection_ = std::move(found.connection);
  reports_ = found.endpoint;
  path_ = std::move(found.device.path);
  misses_ = 0;
  status_.phase = LinkPhase::kReady;
  light(true);
}

/// That it has none, or does not answer, is no fault.
void SpaceMouseLink::light(bool on) noexcept {
  const std::array<std::uint8_t, 2> data{kLightReport, static_cast<std::uint8_t>(on ? 1 : 0)};
  (void)connection_->control({.request_type = kClassToInterface,
                              .request = kSetReport,
                              .value = static_cast<std::uint16_t>(kOutputReport | kLightReport),
                              .index = reports_.interface},
                             data, kLightTime);
}

void SpaceMouseLink::close() noexcept {
  if (connection_) light(false);
  connection_.reset();
  path_.clear();
  state_ = {};
  status_.phase = LinkPhase::kAbsent;
}

}  // namespace palpate
