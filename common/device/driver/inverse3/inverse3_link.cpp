#include "common/device/driver/inverse3/inverse3_link.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr double kServicePause = 0.25;        // [s] between two looks for the service
constexpr double kServiceConnectTime = 0.15;  // [s] and as much for the handshake
constexpr double kVersionTime = 0.1;          // [s]
constexpr double kMeetingTime = 0.5;          // [s] within which a service says what it has
constexpr double kMeetingRound = 0.05;        // [s] of that in one round
constexpr double kServiceSendTime = 0.010;    // [s]
constexpr int kMostServiceMessages = 8;       // that are taken in one round, whoever sends them
constexpr double kFarthestTip = 1.0;          // [m] it reaches a third of that

constexpr std::string_view kInverse3Options = "host, port, device, spelling";

}  // namespace

Inverse3Settings::Inverse3Settings() {
  arm.frame.device_from_maker = *axes_from_text(kAxes);
  arm.frame.middle = {0.0, -0.12, 0.15};
  arm.force_cap = 5.0;
  arm.reach = 0.1;
}

Inverse3Settings inverse3_settings(const DriverOptions& options) {
  Inverse3Settings settings;
  for (const auto& [name, value] : options) {
    if (name == "host") {
      if (value.empty()) throw usage_error("inverse3: host takes a name or an address");
      settings.service.host = value;
    } else if (name == "port") {
      const auto port = number(value);
      constexpr double kMost = 65535.0;
      if (!port || !(*port >= 1.0 && *port <= kMost) || *port != std::floor(*port)) {
        throw usage_error("inverse3: port takes a number from 1 to 65535, found '" + value + "'");
      }
      settings.service.port = static_cast<std::uint16_t>(*port);
    } else if (name == "device") {
      if (!HaplyId::from(value)) {
        throw usage_error("inverse3: device takes a name such as 049D, found '" + value + "'");
      }
      settings.device = value;
    } else if (name == "spelling") {
      if (value != "values" && value != "vector") {
        throw usage_error("inverse3: spelling is values or vector, found '" + value + "'");
      }
      settings.spelling = value == "values" ? HaplySpelling::kValues : HaplySpelling::kVector;
    } else if (!take_arm_option(settings.arm, "inverse3", name, value)) {
      throw usage_error("the driver inverse3 knows no option '" + name + "'; known are " +
                        std::string(kInverse3Options) + ", " + std::string(kArmOptions));
    }
  }
  return settings;
}

std::string inverse3_help() {
  const Inverse3Settings defaults;
  return "host=NAME      where Haply's service runs; default localhost\n"
         "port=N         of that service; default 10001\n"
         "device=NAME    of several devices this one, such as 049D\n"
         "spelling=WORD  of a force in a command, values (up to version 3.4) or vector; default: by its "
         "version\n" +
         arm_help(defaults.arm, Inverse3Settings::kAxes);
}

Inverse3Link::Inverse3Link(WebTransport& transport, const Inverse3Settings& settings)
    : transport_(transport), settings_(settings), limits_(settings.arm.limits()) {
  atoms_.has_position = true;
  // The thread that renews the force finds its memory there.
  constexpr std::size_t kLongestSent = 512, kLongestHeard = 64U << 10U;
  sent_.reserve(kLongestSent);
  heard_.reserve(kLongestHeard);
}

Inverse3Link::~Inverse3Link() { close(); }

std::string Inverse3Link::advice() const {
  if (status_.phase == LinkPhase::kNeedsHoming) {
    return powered_
               ? "the Inverse3 is not calibrated: put its arm as its manual says, until its light is steady"
               : "plug in the power supply of the Inverse3";
  }
  if (status_.phase == LinkPhase::kReady && !grip_ && !forced_) {
    return "the Inverse3 has no grip, whose button gives it force: name another switch, such as enable=pedal";
  }
  if (status_.phase == LinkPhase::kReady || status_.phase == LinkPhase::kLoading) return {};
  const std::string at = settings_.service.host + ":" + std::to_string(settings_.service.port);
  if (alone_) {
    return "Haply's service at " + at + " has no " +
           (settings_.device.empty() ? "Inverse3" : "Inverse3 named " + settings_.device) +
           ": plug it in, and switch it on";
  }
  return "Haply's service does not answer at " + at +
         ": install it from its maker, and start it (systemctl start haply-inverse-service)";
}

std::string Inverse3Link::place() const {
  return device_ ? "inverse3 " + std::string(device_->view()) + " at " + settings_.service.host : "";
}

bool Inverse3Link::round() noexcept {
  if (!connection_) {
    search();
    return false;
  }
  if (!device_) {
    meet();
    return false;
  }
  transport_.sleep(round_ + kPeriod - transport_.now());
  round_ = transport_.now();
  return exchange();
}

void Inverse3Link::search() noexcept {
  WebOpened opened = transport_.open(settings_.service, kServiceConnectTime);
  if (opened.status != TransferStatus::kOk) {
    alone_ = false;
    status_.phase = LinkPhase::kAbsent;
    transport_.sleep(kServicePause);
    return;
  }
  connection_ = std::move(opened.connection);
  ++status_.opened;
  status_.phase = LinkPhase::kLoading;
  meeting_ = transport_.now();
  under_way_ = misses_ = 0;
  ended_ = false;
  spelling_ = HaplySpelling::kVector;
  if (settings_.spelling) {
    spelling_ = *settings_.spelling;
    return;
  }
  const auto version =
      transport_.get({settings_.service.host, Inverse3Settings::kVersionPort}, "/3.0/version", kVersionTime);
  if (version) spelling_ = haply_spelling(*version).value_or(spelling_);
}

/// The service says by itself what it has.
void Inverse3Link::meet() noexcept {
  const TransferStatus got = connection_->receive(heard_, kMeetingRound);
  HaplyState state;
  if (got == TransferStatus::kOk && read_haply_state(heard_, settings_.device, state) && state.device) {
    device_ = state.device;
    alone_ = false;
    calibrated_ = powered_ = true;
    grip_ = forced_ = false;
    learn(state);
    return;
  }
  const bool none = got == TransferStatus::kOk;
  const bool waits = got == TransferStatus::kTimeout && transport_.now() - meeting_ < kMeetingTime;
  if (waits) return;
  close();
  alone_ = none;
  status_.phase = LinkPhase::kAbsent;
  transport_.sleep(kServicePause);
}

bool Inverse3Link::exchange() noexcept {
  const Vec3 force = ordered();
  const bool ready = status_.phase == LinkPhase::kReady && misses_ == 0;
  const bool sent = send(ready ? force : Vec3{0.0});
  HaplyState state;
  const bool heard = sent && hear(state);
  const double now = transport_.now();
  if (!sent || ended_) {
    give_up();
    return false;
  }
  if (!heard) ++status_.lost;
  forced_ = forced_ || (ready && force != Vec3{0.0});
  if (heard && take(state, now)) {
    if (!calibrated_ || !powered_) {
      // What it says of its position means nothing.
      if (status_.phase == LinkPhase::kReady) ++status_.faults;
      status_.phase = LinkPhase::kNeedsHoming;
      misses_ = 0;
      return false;
    }
    status_.phase = LinkPhase::kReady;
    ++status_.rounds;
    misses_ = 0;
    return true;
  }
  if (++misses_ >= kMostMisses) give_up();
  return false;
}

bool Inverse3Link::send(const Vec3& force) noexcept {
  const Vec3 held = shown_.next(force, transport_.now());
  try {
    write_haply_force(sent_, *device_, settings_.arm.frame.force_for_maker(held), spelling_);
  } catch (const std::exception&) {  // no memory
    return false;
  }
  ++under_way_;
  return connection_->send(sent_, kServiceSendTime) == TransferStatus::kOk;
}

bool Inverse3Link::hear(HaplyState& state) noexcept {
  bool any = false;
  const double until = transport_.now() + kAnswerTime;
  for (int n = 0;; ++n) {
    // Once every command has its state nothing should be left: what is there is taken, too, so that no state
    // grows old in a queue, and a service that goes on talking is none.
    const double left = under_way_ > 0 ? std::max(0.0, until - transport_.now()) : 0.0;
    const TransferStatus got = connection_->receive(heard_, left);
    if (got == TransferStatus::kTimeout) break;
    if (got != TransferStatus::kOk || n == kMostServiceMessages) {
      ended_ = true;
      return false;
    }
    HaplyState next;
    if (!read_haply_state(heard_, settings_.device, next)) {
      status_.dropped += heard_.size();
      continue;
    }
    under_way_ = std::max(0, under_way_ - 1);
    state = next;
    any = true;
  }
  return any;
}

void Inverse3Link::learn(const HaplyState& state) noexcept {
  calibrated_ = state.calibrated.value_or(calibrated_);
  powered_ = state.powered.value_or(powered_);
  grip_ = grip_ || state.grip;
}

bool Inverse3Link::take(const HaplyState& state, double now) noexcept {
  const bool same = state.device && state.device->view() == device_->view();
  if (same) learn(state);
  if (!same || !state.position) {
    ++status_.implausible;
    return false;
  }
  const Vec3 position = settings_.arm.frame.position(*state.position);
  const bool first = status_.phase != LinkPhase::kReady;
  const bool near = glm::length(position) < kFarthestTip;
  if (!near || (!first && !plausible_move(atoms_.position, position, now - atoms_.time))) {
    ++status_.implausible;
    return false;
  }
  atoms_.time = now;
  atoms_.position = position;
  atoms_.buttons = state.buttons;
  return true;
}

void Inverse3Link::give_up() noexcept {
  ++status_.faults;
  close();
  status_.phase = LinkPhase::kAbsent;
}

void Inverse3Link::close() noexcept {
  if (connection_ && device_) (void)send(Vec3{0.0});
  connection_.reset();
  device_.reset();
  under_way_ = misses_ = 0;
  ended_ = false;
}

}  // namespace palpate
