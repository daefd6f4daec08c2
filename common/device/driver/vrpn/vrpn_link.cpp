#include "common/device/driver/vrpn/vrpn_link.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <span>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"

namespace palpate {
namespace {

// Our numbers for what we send.
constexpr std::int32_t kOurSender = 0, kOurPing = 0, kOurPong = 1, kOurField = 2;

constexpr double kServerPause = 0.25;     // [s] between two looks for a server
constexpr double kVrpnWriteTime = 0.010;  // [s]
constexpr double kFarthestPose = 50.0;    // [m] no room is larger
constexpr double kStalePose = 0.1;        // [s] trackers come 60 times a second
constexpr std::size_t kLongestName = 100;

std::optional<double> whole_number(const std::string& text, double most) noexcept {
  const auto value = number(text);
  return value && *value >= 0.0 && *value <= most && *value == std::floor(*value) ? value : std::nullopt;
}

DeviceLimits limits_of(const VrpnSettings& settings) {
  DeviceLimits limits;
  if (settings.force) limits = settings.arm.limits();
  limits.stale_after = kStalePose;
  return limits;
}

}  // namespace

std::optional<VrpnAddress> vrpn_address(std::string_view text) {
  const std::size_t at = text.find('@');
  if (at == 0 || at == std::string_view::npos || at > kLongestName) return std::nullopt;
  VrpnAddress address{.name = std::string(text.substr(0, at)), .host = {}};
  std::string_view rest = text.substr(at + 1);
  const bool bracketed = rest.starts_with('[');
  const std::size_t closing = bracketed ? rest.find(']') : 0;
  if (closing == std::string_view::npos) return std::nullopt;
  const std::size_t colon = rest.find(':', closing);
  if (colon != std::string_view::npos) {
    constexpr double kMostPort = 65535.0;
    const auto port = whole_number(std::string(rest.substr(colon + 1)), kMostPort);
    if (!port || *port == 0.0) return std::nullopt;
    address.port = static_cast<std::uint16_t>(*port);
    rest = rest.substr(0, colon);
  }
  if (bracketed && !rest.ends_with(']')) return std::nullopt;
  address.host = bracketed ? rest.substr(1, rest.size() - 2) : rest;
  return address.host.empty() ? std::nullopt : std::optional(address);
}

VrpnSettings::VrpnSettings() {
  arm.force_cap = 3.0;
  arm.reach = 0.2;
}

VrpnSettings vrpn_settings(const DriverOptions& options) {
  VrpnSettings settings;
  const auto positive = [](const std::string& name, const std::string& value) {
    const auto parsed = number(value);
    if (!parsed || !std::isfinite(*parsed) || !(*parsed > 0.0)) {
      throw usage_error("vrpn: " + name + " takes a number above 0, found '" + value + "'");
    }
    return *parsed;
  };
  for (const auto& [name, value] : options) {
    if (name == "at") {
      const auto address = vrpn_address(value);
      if (!address) throw usage_error("vrpn: NAME@HOST[:PORT] is expected, found '" + value + "'");
      settings.address = *address;
    } else if (name == "sensor") {
      constexpr double kMostSensor = 1000.0;
      const auto sensor = whole_number(value, kMostSensor);
      if (!sensor) throw usage_error("vrpn: sensor takes a number from 0 to 1000, found '" + value + "'");
      settings.sensor = static_cast<int>(*sensor);
    } else if (name == "stiffness") {
      settings.stiffest = positive(name, value);
    } else if (name == "radius") {
      settings.radius = positive(name, value);
    } else if (take_arm_option(settings.arm, "vrpn", name, value)) {
      settings.force = settings.force || name == "cap";
    } else {
      throw usage_error("the driver vrpn knows no option '" + name +
                        "'; known are NAME@HOST[:PORT], sensor, stiffness, radius, " +
                        std::string(kArmOptions));
    }
  }
  if (settings.address.name.empty()) {
    throw usage_error("the driver vrpn needs a device and a server: --device vrpn:NAME@HOST[:PORT]");
  }
  return settings;
}

std::string vrpn_help() {
  VrpnSettings defaults;
  return "NAME@HOST[:PORT]  a device of a VRPN server; the port is 3883\n"
         "sensor=N       of a tracker; default 0\n"
         "stiffness=N    largest of a force near the hand [N/m]; default 300\n"
         "radius=N       around the hand in which a force holds until the next comes [m]; default 0.01\n" +
         arm_help(defaults.arm, VrpnSettings::kAxes) + "without cap it is sent no force\n";
}

VrpnLink::VrpnLink(std::unique_ptr<StreamPlace> place, const VrpnSettings& settings)
    : place_(std::move(place)),
      settings_(settings),
      limits_(limits_of(settings)),
      names_(settings_.address.name),
      local_(settings.arm.force_cap, settings.stiffest, settings.radius) {
  // Before its server has said what it is, a device is taken for one whose pose moves a probe.
  atoms_.has_position = true;
}

VrpnLink::~VrpnLink() { close(); }

std::string VrpnLink::advice() const {
  const std::string server = place_->name();
  if (status_.phase == LinkPhase::kReady) {
    return settings_.force && rearm_.tripped()
               ? "the server or its device was at fault: let go of the switch, then hold it again"
               : "";
  }
  if (stream_ && greeted_) {
    return names_.has_device() ? "the VRPN server at " + server + " has " + settings_.address.name +
                                     ", which says nothing yet: move it, or switch it on"
                               : "the VRPN server at " + server + " has not named a device " +
                                     settings_.address.name + " yet";
  }
  if (status_.phase == LinkPhase::kRefused) {
    return "what answers at " + server + " is no VRPN server of version 7";
  }
  return "no VRPN server answers at " + server;
}

std::string VrpnLink::place() const {
  return stream_ ? "vrpn " + settings_.address.name + " at " + place_->name() : "";
}

bool VrpnLink::round() noexcept {
  if (!stream_) {
    search();
    return false;
  }
  speak();
  return stream_ && listen();
}

void VrpnLink::search() noexcept {
  try {
    StreamOpened opened = place_->open();
    if (opened.status == TransferStatus::kOk) stream_ = std::move(opened.stream);
  } catch (const std::exception&) {  // no memory: as if it did not answer
    stream_.reset();
  }
  if (!stream_) {
    status_.phase = LinkPhase::kAbsent;
    place_->sleep(kServerPause);
    return;
  }
  ++status_.opened;
  status_.phase = LinkPhase::kLoading;
  parser_.reset();
  names_.reset();
  local_.reset();
  clock_.reset();
  rearm_.trip();
  greeted_ = pressing_ = false;
  misses_ = 0;
  opened_at_ = heard_ = pinged_ = place_->now();
  posed_ = sent_field_ = 0.0;
  atoms_.buttons = 0;
  atoms_.has_position = atoms_.has_valuators = false;
  atoms_.valuators = {};
  poses_ = {};
  VrpnWriter writer(packed_);
  writer.cookie();
  if (!send(writer)) give_up();
}

/// After the cookie of the other side: our names, and whether it is there.
void VrpnLink::greet() noexcept {
  greeted_ = true;
  VrpnWriter writer(packed_);
  writer.description(kVrpnSenders, kOurSender, settings_.address.name);
  writer.description(kVrpnTypes, kOurPing, name_of(VrpnType::kPing));
  writer.description(kVrpnTypes, kOurPong, name_of(VrpnType::kPong));
  writer.description(kVrpnTypes, kOurField, name_of(VrpnType::kForceField));
  writer.empty(place_->now(), kOurSender, kOurPing);
  pinged_ = place_->now();
  if (!send(writer)) give_up();
}

void VrpnLink::speak() noexcept {
  const double now = place_->now();
  const double since = greeted_ ? heard_ : opened_at_;
  if (now - since > (greeted_ ? kSilence : kGreetTime)) return give_up();
  if (!greeted_) return;
  VrpnWriter writer(packed_);
  if (now - pinged_ >= kPingPause) {
    writer.empty(now, kOurSender, kOurPing);
    pinged_ = now;
  }
  if (settings_.force) {
    const bool ready = status_.phase == LinkPhase::kReady && atoms_.has_position && misses_ == 0 &&
                       now - posed_ <= kFreshPose;
    const Vec3 force = ordered();
    const Vec3 allowed = rearm_.allowed(is_finite(force) ? force : Vec3{0.0});
    const Vec3 shown = shown_.next(ready ? allowed : Vec3{0.0}, now);
    local_.add(atoms_.position, shown);
    const bool presses = shown != Vec3{0.0};
    // A force that ends does so at once; one that lasts is renewed no more often than it is worth.
    if ((presses && now - sent_field_ >= kFieldPause) || (!presses && pressing_)) {
      writer.force_field(now, kOurSender, kOurField, field());
      sent_field_ = now;
      pressing_ = presses;
    }
  }
  if (!writer.bytes().empty() && !send(writer)) give_up();
}

VrpnForceField VrpnLink::field() const noexcept {
  const LocalField::Model model = local_.model();
  const ArmFrame& frame = settings_.arm.frame;
  const Mat3 to_maker = glm::transpose(frame.device_from_maker);
  return {.origin = to_maker * model.origin + frame.middle,
          .force = to_maker * model.force,
          .jacobian = to_maker * model.stiffness * frame.device_from_maker,
          .radius = model.radius};
}

bool VrpnLink::listen() noexcept {
  const TransferResult got = stream_->read(received_, kReadTime);
  if (got.status == TransferStatus::kTimeout) return still();
  if (!got.ok()) {
    give_up();
    return false;
  }
  const double now = place_->now();
  heard_ = now;
  bool fresh = false;
  std::span<const std::uint8_t> bytes = std::span(received_).first(std::min(got.bytes, received_.size()));
  VrpnMessage message;
  for (;;) {
    const VrpnParser::Found found = parser_.push(bytes, message);
    if (found == VrpnParser::Found::kNothing) return still() || fresh;
    if (found == VrpnParser::Found::kNonsense) {
      status_.dropped += got.bytes;
      give_up();
      status_.phase = LinkPhase::kRefused;
      place_->sleep(kServerPause);
      return false;
    }
    if (found == VrpnParser::Found::kCookie) {
      greet();
    } else {
      fresh = take(message, now) || fresh;
    }
    if (!stream_) return false;
  }
}

bool VrpnLink::take(const VrpnMessage& message, double now) noexcept {
  if (message.type < 0) {
    names_.take(message);
    return false;
  }
  if (!names_.is_device(message.sender)) return false;
  bool news = false;
  switch (names_.type(message.type)) {
    case VrpnType::kPosQuat: {
      const auto pose = vrpn_pose(message.payload);
      if (!pose) ++status_.implausible;
      const bool station = pose && take_station(*pose, now);
      if (station) status_.phase = LinkPhase::kReady;
      if (!pose || pose->sensor != settings_.sensor) return station;
      news = take_pose(*pose, now);
      if (news) atoms_.time = clock_.local(message.time, now);
      break;
    }
    case VrpnType::kButtonChange:
    case VrpnType::kButtonStates: {
      const auto buttons = names_.type(message.type) == VrpnType::kButtonChange
                               ? vrpn_button_change(message.payload, atoms_.buttons)
                               : vrpn_button_states(message.payload);
      news = buttons.has_value();
      if (buttons) atoms_.buttons = *buttons;
      break;
    }
    case VrpnType::kAnalog:
      news = vrpn_channels(message.payload, atoms_.valuators).has_value();
      atoms_.has_valuators = atoms_.has_valuators || news;
      break;
    case VrpnType::kForceError:
      ++status_.faults;
      rearm_.trip();
      return false;
    case VrpnType::kPing: {
      VrpnWriter writer(packed_);
      writer.empty(now, kOurSender, kOurPong);
      if (!send(writer)) give_up();
      return false;
    }
    case VrpnType::kPong:
    case VrpnType::kForceField:
    case VrpnType::kOther:
      return false;
  }
  if (!news) return false;
  ++status_.rounds;
  status_.phase = LinkPhase::kReady;
  // A button that is pressed makes no pose younger.
  if (!atoms_.has_position) atoms_.time = now;
  return true;
}

/// What has no pose speaks only when it changes: it is as it was, while its server is heard of.
bool VrpnLink::still() noexcept {
  if (status_.phase != LinkPhase::kReady || atoms_.has_position) return false;
  atoms_.time = place_->now();
  if (atoms_.time - heard_ > kHush) {
    atoms_.buttons = 0;
    atoms_.valuators = {};
  }
  return true;
}

bool VrpnLink::take_station(const VrpnPose& pose, double now) noexcept {
  if (pose.sensor < 0 || as_size(pose.sensor) >= PoseAtoms::kStations) return false;
  PoseAtom& atom = poses_.stations[as_size(pose.sensor)];
  const bool held = pose.sensor == settings_.sensor;
  atom = {.time = now,
          .position = pose.position,
          .orientation = pose.orientation,
          .buttons = held ? atoms_.buttons : 0U,
          .station = static_cast<std::uint8_t>(pose.sensor + 1),
          .valid = true};
  return true;
}

bool VrpnLink::take_pose(const VrpnPose& pose, double now) noexcept {
  const Vec3 position = settings_.arm.frame.position(pose.position);
  const bool first = !atoms_.has_position;
  const bool near = glm::length(position) <= kFarthestPose;
  if (!near || (!first && !plausible_move(atoms_.position, position, now - posed_))) {
    ++status_.implausible;
    // A tracker may lose its sensor and find it elsewhere: after some such poses it begins anew there.
    if (++misses_ < kMostMisses || !near) return false;
    ++status_.faults;
    rearm_.trip();
  }
  misses_ = 0;
  posed_ = now;
  atoms_.has_position = true;
  atoms_.position = position;
  const bool station = !settings_.force && pose.sensor < static_cast<int>(PoseAtoms::kStations);
  atoms_.station = static_cast<std::uint8_t>(station ? pose.sensor + 1 : 0);
  return true;
}

bool VrpnLink::send(const VrpnWriter& writer) noexcept {
  return stream_ && !writer.overflowed() && stream_->write(writer.bytes(), kVrpnWriteTime).ok();
}

void VrpnLink::give_up() noexcept {
  ++status_.faults;
  close();
  status_.phase = LinkPhase::kAbsent;
}

void VrpnLink::close() noexcept {
  if (stream_ && pressing_) {
    VrpnWriter writer(packed_);
    local_.reset();
    writer.force_field(place_->now(), kOurSender, kOurField, field());
    (void)send(writer);
  }
  pressing_ = false;
  for (PoseAtom& atom : poses_.stations) {
    atom.valid = false;
    atom.buttons = 0;
  }
  stream_.reset();
}

}  // namespace palpate
