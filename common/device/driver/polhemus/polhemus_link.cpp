#include "common/device/driver/polhemus/polhemus_link.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <string_view>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/driver/transport/usb_search.h"
#include "common/math/units.h"

namespace palpate {
namespace {

/// Whether a hand can have come from one to the other.
bool follows(const PoseAtom& from, const PoseAtom& to) noexcept {
  const double dt = std::max(to.time - from.time, 0.0);
  const double turned = angle_of(to.orientation * glm::conjugate(from.orientation));
  return glm::distance(from.position, to.position) <=
             TrackerStations::kLeap + TrackerStations::kMostSpeed * dt &&
         turned <= TrackerStations::kTurnedLeap + TrackerStations::kMostTurn * dt;
}

constexpr double kMetresPerInch = 0.0254;
constexpr double kListenTime = 0.010;  // [s] that one round waits for data
constexpr double kDrainTime = 0.050;   // [s] without a byte: it is silent
constexpr double kSendTime = 0.060;    // [s] that a command may take
constexpr int kMostDrains = 40;        // reads until it counts as never falling silent
constexpr int kMostDumb = 2;           // set-ups without an answer until the user is told
constexpr std::size_t kReadBytes = 512;
// What a serial line carries of each station, with a start and a stop bit.
constexpr double kSlowStations = 4.0, kBitsAByte = 10.0, kFastrakBytes = 34.0, kLibertyBytes = 52.0;
constexpr double kSlowest = 0.09;  // [s] who reads poses takes older ones for lost

// The button last: bytes that were lost within a record make it none.
constexpr std::array kLibertyOrder{LibertyItem::kTime,       LibertyItem::kFrame,
                                   LibertyItem::kDistortion, LibertyItem::kPositionExtended,
                                   LibertyItem::kQuaternion, LibertyItem::kButton};
constexpr std::string_view kLibertyOrderText = "O*,8,9,11,3,7,10\r";
constexpr std::string_view kStationsQuery =
    "\x15"
    "0\r";

std::string hemisphere_text(const Vec3& zenith) {
  return short_number(zenith.x) + "," + short_number(zenith.y) + "," + short_number(zenith.z) + "\r";
}

}  // namespace

TrackerStations::TrackerStations() noexcept {
  std::uint8_t number = 0;
  for (PoseAtom& pose : poses_.stations) pose.station = ++number;
}

bool TrackerStations::take(double now, const Report& report) noexcept {
  if (report.station < 1 || report.station > static_cast<int>(PoseAtoms::kStations)) return false;
  const auto index = as_size(report.station - 1);
  PoseAtom& pose = poses_.stations[index];
  Doubtful& doubtful = doubtful_[index];
  if (!report.good) {
    pose.valid = false;
    pose.buttons = 0;
    doubtful.waits = false;
    return true;
  }
  const PoseAtom said{.time = now,
                      .position = report.position,
                      .orientation = report.orientation,
                      .buttons = report.button ? 1U : 0U,
                      .station = pose.station,
                      .valid = true};
  // The first one after a while has none to be compared with, and is as likely to be damaged.
  const bool expected = pose.valid && now - pose.time <= gap_ && follows(pose, said);
  const bool confirmed = doubtful.waits && now - doubtful.pose.time <= gap_ && follows(doubtful.pose, said);
  doubtful = {said, !expected && !confirmed};
  if (doubtful.waits) return false;
  pose = said;
  return true;
}

bool TrackerStations::expire(double now) noexcept {
  bool any = false;
  for (PoseAtom& pose : poses_.stations) {
    if (!pose.valid || now - pose.time <= silence_) continue;
    pose.valid = false;
    pose.buttons = 0;
    any = true;
  }
  return any;
}

void TrackerStations::lose_all() noexcept {
  for (PoseAtom& pose : poses_.stations) {
    pose.valid = false;
    pose.buttons = 0;
  }
  doubtful_ = {};
}

void TrackerStations::set_pace(double seconds) noexcept {
  constexpr double kUneven = 1.6, kTwoMissed = 3.2;
  gap_ = std::max(kGap, kUneven * seconds);
  silence_ = std::max(kSilence, kTwoMissed * seconds);
}

std::uint32_t TrackerStations::buttons() const noexcept {
  std::uint32_t buttons = 0;
  for (const PoseAtom& pose : poses_.stations) {
    if (pose.buttons != 0) buttons |= 1U << (pose.station - 1U);
  }
  return buttons;
}

PolhemusLink::PolhemusLink(std::unique_ptr<PolhemusPort> port, const PolhemusSettings& settings)
    : port_(std::move(port)), settings_(settings), parser_(LibertyParser(kLibertyOrder)) {
  if (settings_.port.empty()) return;
  const double bytes = settings_.family == PolhemusFamily::kFastrak ? kFastrakBytes : kLibertyBytes;
  pace_ = kSlowStations * kBitsAByte * bytes / settings_.baud;
  stations_.set_pace(pace_);
}

PolhemusLink::~PolhemusLink() {
  if (opened_.commands) (void)send(opened_.family == PolhemusFamily::kFastrak ? "c" : "P");
}

std::string PolhemusLink::advice() const {
  if (!opened_.commands) {
    if (refused_ == TransferStatus::kOk) {
      return settings_.port.empty() ? "no Polhemus tracker is plugged in, switched on and loaded"
                                    : "there is no serial line " + settings_.port;
    }
    if (!settings_.port.empty() && refused_ != TransferStatus::kBusy) {
      return settings_.port + " cannot be opened (" + std::string(name_of(refused_)) +
             (refused_ == TransferStatus::kDenied ? "); you must be in its group, mostly dialout" : ")");
    }
    return refusal_advice("the tracker", refused_);
  }
  if (status_.phase == LinkPhase::kRefused) {
    if (no_sensor_) return "the tracker says that no sensor is plugged into it, or switched on";
    return settings_.port.empty()
               ? "the tracker does not answer; switch it off and on again"
               : "nothing that makes sense comes from " + settings_.port +
                     "; check the cable, the tracker's switches for its rate (baud=), and model=";
  }
  if (pace_ > kSlowest) {
    return std::to_string(settings_.baud) + " baud carry a station of four " +
           std::to_string(std::lround(1.0 / pace_)) +
           " times a second, too slow for a hand: set the tracker's switches to more, and baud=";
  }
  if (poor_station_ != 0) {
    return "station " + std::to_string(poor_station_) + " reports '" + poor_code_ +
           "': it is too far away, or near metal";
  }
  return {};
}

bool PolhemusLink::round() noexcept {
  switch (stage_) {
    case Stage::kSearch:
      search();
      return false;
    case Stage::kSilence:
      drain();
      return !opened_.commands;
    case Stage::kSetUp:
      set_up();
      return !opened_.commands;
    case Stage::kRun:
      return listen();
  }
  return false;
}

void PolhemusLink::search() noexcept {
  opened_ = port_->open();
  refused_ = opened_.refused;
  if (!opened_.commands) {
    status_.phase = refused_ == TransferStatus::kOk ? LinkPhase::kAbsent : LinkPhase::kRefused;
    port_->await(kLookPause);
    return;
  }
  ++status_.opened;
  dumb_set_ups_ = 0;
  status_.phase = LinkPhase::kLoading;
  begin_set_up();
}

/// It may be in the middle of anything: it is told to be silent, in a way that ends a command that was half
/// given, and heard out.
void PolhemusLink::begin_set_up() noexcept {
  if (opened_.family == PolhemusFamily::kFastrak) {
    parser_.emplace<FastrakParser>();
  } else {
    parser_.emplace<LibertyParser>(kLibertyOrder);
  }
  dropped_before_ = status_.dropped;
  misses_ = drains_ = 0;
  spoke_ = lost_ = false;
  poor_station_ = 0;
  const bool sent = opened_.family == PolhemusFamily::kFastrak ? send("\r") && send("c")
                                                               : send("\r") && send("F0\r") && send("P");
  stage_ = Stage::kSilence;
  if (!sent && lost_) (void)close();
}

void PolhemusLink::drain() noexcept {
  std::array<std::uint8_t, kReadBytes> rest{};
  for (ByteStream* const stream : {opened_.data.get(), opened_.commands.get()}) {
    if (stream == nullptr) continue;
    const TransferResult got = stream->read(rest, kDrainTime);
    if (got.ok() && ++drains_ < kMostDrains) return;
    if (!got.ok() && is_lost(got)) {
      (void)close();
      return;
    }
  }
  stage_ = Stage::kSetUp;
}

void PolhemusLink::set_up() noexcept {
  bool sent = true;
  const std::string zenith = hemisphere_text(settings_.hemisphere);
  if (opened_.family == PolhemusFamily::kFastrak) {
    sent = send("U") && send("f") && send("e1,0\r");
    for (const char station : {'1', '2', '3', '4'}) {
      const std::string number(1, station);
      std::string hemisphere = "H" + number, order = "O" + number;
      (hemisphere += ',') += zenith;
      order += ",2,11,16,0\r";
      sent = sent && send(hemisphere) && send(order);
    }
    sent = sent && send("C");
  } else {
    sent = send("U0\r") && send("F1\r") && send(kLibertyOrderText) && send("H*," + zenith) &&
           send(kStationsQuery) && send("C\r");
  }
  heard_ = port_->now();
  stage_ = Stage::kRun;
  if (!sent && lost_) (void)close();
}

bool PolhemusLink::listen() noexcept {
  std::array<std::uint8_t, kReadBytes> bytes{};
  ByteStream& stream = opened_.data ? *opened_.data : *opened_.commands;
  const TransferResult got = stream.read(bytes, kListenTime);
  const double now = port_->now();
  bool fresh = false;
  if (got.ok()) {
    misses_ = 0;
    for (const std::uint8_t byte : std::span(bytes).first(std::min(got.bytes, bytes.size()))) {
      const auto news = std::visit([byte](auto& parser) { return parser.push(byte); }, parser_);
      if (news) fresh = take(*news, now) || fresh;
    }
    status_.dropped = dropped_before_ + std::visit([](auto& parser) { return parser.dropped(); }, parser_);
  } else if (is_lost(got)) {
    return close();
  }
  fresh = stations_.expire(now) || fresh;
  if (fresh) publish(now);
  if (now - heard_ > (spoke_ ? kSilence : kPatience)) {
    if (spoke_) {
      ++status_.faults;
      dumb_set_ups_ = 0;
      status_.phase = LinkPhase::kLoading;
    } else if (++dumb_set_ups_ >= kMostDumb) {
      status_.phase = LinkPhase::kRefused;
    }
    begin_set_up();
  }
  return fresh;
}

bool PolhemusLink::take(const PolhemusNews& news, double now) noexcept {
  if (const auto* const map = std::get_if<PolhemusStations>(&news)) {
    no_sensor_ = (map->detected & map->active) == 0;
    return false;
  }
  const PolhemusRecord& record = std::get<PolhemusRecord>(news);
  heard_ = now;
  spoke_ = true;
  no_sensor_ = false;
  status_.phase = LinkPhase::kReady;
  ++status_.rounds;
  const bool good = record.error == ' ';
  if (!good) {
    poor_station_ = record.station;
    poor_code_ = record.error;
  } else if (poor_station_ == record.station) {
    poor_station_ = 0;
  }
  if (stations_.take(now, {.station = record.station,
                           .good = good,
                           .position = kMetresPerInch * record.position,
                           .orientation = record.orientation,
                           .button = record.button}))
    return true;
  ++status_.implausible;
  return false;
}

/// @return that its stations are out of sight is new.
bool PolhemusLink::close() noexcept {
  ++status_.faults;
  opened_ = {};
  refused_ = TransferStatus::kOk;
  status_.phase = LinkPhase::kAbsent;
  stage_ = Stage::kSearch;
  stations_.lose_all();
  publish(port_->now());
  return true;
}

bool PolhemusLink::send(std::string_view command) noexcept {
  const auto* const bytes = reinterpret_cast<const std::uint8_t*>(command.data());
  const TransferResult sent = opened_.commands->write({bytes, command.size()}, kSendTime);
  lost_ = !sent.ok() && is_lost(sent);
  return sent.ok();
}

bool PolhemusLink::is_lost(const TransferResult& result) noexcept {
  return given_up(result.status, kMostMisses, misses_);
}

void PolhemusLink::publish(double now) noexcept {
  atoms_.time = now;
  atoms_.buttons = stations_.buttons();
}

}  // namespace palpate
