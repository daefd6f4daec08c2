#include "common/device/driver/falcon/falcon_link.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <exception>
#include <fstream>
#include <string_view>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/device_profile.h"
#include "common/device/driver/transport/usb_search.h"

namespace palpate {
namespace {

/// A number of the settings by its name.
struct NumberOption {
  std::string_view name;
  double& (*in)(FalconSettings&);
  std::string_view help;

  /// @throws Error (usage).
  void set(FalconSettings& settings, const std::string& value) const;
};

const std::array kNumbers{
    NumberOption{"gain", [](FalconSettings& s) -> double& { return s.gain; },
                 "counts of a motor per N m at the arm; default 3500"},
    NumberOption{"cap", [](FalconSettings& s) -> double& { return s.force_cap; },
                 "largest force [N]; default 8"},
    NumberOption{"thigh", [](FalconSettings& s) -> double& { return s.geometry.thigh; },
                 "geometry of the arm [m]"},
    NumberOption{"shin", [](FalconSettings& s) -> double& { return s.geometry.shin; }, "the same"},
    NumberOption{"shin_ends", [](FalconSettings& s) -> double& { return s.geometry.shin_ends; }, "the same"},
    NumberOption{"platform_u", [](FalconSettings& s) -> double& { return s.geometry.platform_u; },
                 "the same"},
    NumberOption{"platform_v", [](FalconSettings& s) -> double& { return s.geometry.platform_v; },
                 "the same"},
    NumberOption{"base_u", [](FalconSettings& s) -> double& { return s.geometry.base_u; }, "the same"},
    NumberOption{"base_v", [](FalconSettings& s) -> double& { return s.geometry.base_v; }, "the same"},
    NumberOption{"zero_angle", [](FalconSettings& s) -> double& { return s.zero_angle; },
                 "of the thighs at count 0 [rad]; default 0.6109"}};

constexpr std::string_view kFirmware = "firmware";

std::vector<std::uint8_t> read_image(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) {
    throw input_error(
        {.file = file, .found = "cannot be read", .expected = "the image of the Falcon's firmware"});
  }
  std::vector<std::uint8_t> image(FalconSettings::kMostFirmware + 1);
  in.read(reinterpret_cast<char*>(image.data()), static_cast<std::streamsize>(image.size()));
  image.resize(as_size(in.gcount()));
  if (image.size() < FalconSettings::kLeastFirmware || image.size() > FalconSettings::kMostFirmware) {
    throw input_error({.file = file,
                       .found = image.size() > FalconSettings::kMostFirmware
                                    ? "more than 65536 bytes"
                                    : std::to_string(image.size()) + " bytes",
                       .expected = "an image of 1 to 64 kB"});
  }
  return image;
}

const NumberOption& number_option(const std::string& name) {
  const auto* const option = std::find_if(kNumbers.begin(), kNumbers.end(),
                                          [&](const NumberOption& each) { return each.name == name; });
  if (option != kNumbers.end()) return *option;
  std::string known(kFirmware);
  for (const NumberOption& each : kNumbers) (known += ", ") += each.name;
  throw usage_error("the driver falcon knows no option '" + name + "'; known are " + known);
}

void NumberOption::set(FalconSettings& settings, const std::string& value) const {
  const auto parsed = number(value);
  if (!parsed) throw usage_error("falcon: " + std::string(name) + " takes a number, found '" + value + "'");
  in(settings) = *parsed;
  if (!settings.valid()) {
    throw usage_error("falcon: " + std::string(name) + "=" + value + " is out of bounds");
  }
}

constexpr UsbEndpoint kOut{.address = 0x02, .packet = 64};
constexpr UsbEndpoint kIn{.interface = 0, .address = 0x81, .packet = 64};

// Requests of the FTDI bridge, and their values.
constexpr std::uint8_t kVendorOut = 0x40;
constexpr std::uint8_t kReset = 0x00, kModem = 0x01, kFlow = 0x02, kBaud = 0x03, kData = 0x04,
                       kLatency = 0x09;
constexpr std::uint16_t kPurgeRx = 1, kPurgeTx = 2;
constexpr std::uint16_t kDtrLow = 0x0100, kDtrHigh = 0x0101, kRtsLow = 0x0200;
constexpr std::uint16_t kBaud9600 = 0x4138, kBaudLoader = 0x0015, kBaudRun = 0x0002;
constexpr std::uint16_t kEightBits = 0x0008, kNoFlow = 0;
constexpr std::uint16_t kLatencyLoader = 16, kLatencyRun = 1;  // [ms]

constexpr double kControlTime = 0.1;        // [s]
constexpr double kWriteTime = 0.020;        // [s]
constexpr double kFirmwarePause = 0.25;     // [s] after a series of tries without firmware
constexpr double kEchoTime = 0.1;           // [s] a chunk takes 5 ms at the loader's speed
constexpr int kProbes = 10;                 // commands that a running firmware would answer
constexpr std::size_t kChunk = 62;          // [bytes] of the image at a time
constexpr int kChunksARound = 8;            // each is echoed within the loader's latency of 16 ms
constexpr std::size_t kTransferBytes = 64;  // other sizes are known to misbehave on some stacks

// What the encoders can do between two answers. At 3 m/s, far above the velocity gate, the fastest of them
// does some 150 counts a millisecond.
constexpr double kCountsPerSecond = 150'000.0;
constexpr double kCountsAnyway = 250.0;

// Half of the largest command is assumed to be what a motor stands for any time, and seconds what it takes to
// grow warm: nobody has published either.
constexpr double kLastingCommand = 2048.0, kHeatingTime = 2.0;

constexpr Vec3 kSeed{0.0, 0.0, 0.11};  // [m] where the search for the position starts after homing
constexpr double kStale = 0.020;       // [s]
constexpr int kCentre = 2;             // the button under the thumb, which a hand at rest holds down

DeviceLimits limits_of(const FalconSettings& settings) {
  DeviceLimits limits = safe_limits(find_profile("falcon"));
  limits.force_cap = std::min(limits.force_cap, settings.force_cap);
  limits.stale_after = kStale;
  limits.enabling_button = kCentre;
  return limits;
}

}  // namespace

FalconSettings falcon_settings(const DriverOptions& options) {
  FalconSettings settings;
  for (const auto& [name, value] : options) {
    if (name == kFirmware) {
      settings.firmware = read_image(value);
    } else {
      number_option(name).set(settings, value);
    }
  }
  return settings;
}

std::string falcon_help() {
  std::string text = "firmware=FILE  image of the firmware, loaded after power on\n";
  constexpr std::size_t kColumn = 15;
  for (const NumberOption& each : kNumbers) {
    std::string name = std::string(each.name) + "=N";
    name.resize(std::max(kColumn, name.size() + 1), ' ');
    (text += name).append(each.help) += '\n';
  }
  return text;
}

bool FalconSettings::valid() const noexcept {
  const auto positive = [](double x) { return std::isfinite(x) && x > 0.0; };
  return geometry.valid() && positive(gain) && std::isfinite(zero_angle) && positive(count_angle) &&
         positive(force_cap) && force_cap <= kMostForceCap &&
         (firmware.empty() || (firmware.size() >= kLeastFirmware && firmware.size() <= kMostFirmware));
}

FalconLink::FalconLink(UsbTransport& transport, FalconSettings settings)
    : transport_(transport),
      settings_(std::move(settings)),
      arm_(settings_.geometry),
      limits_(limits_of(settings_)),
      heat_(kLastingCommand, kFalconLargestCommand, kHeatingTime) {
  atoms_.has_position = true;
}

FalconLink::~FalconLink() { close(); }

bool FalconLink::round() noexcept {
  switch (stage_) {
    case Stage::kSearch:
      search();
      return false;
    case Stage::kProbe:
      probe();
      return false;
    case Stage::kLoad:
      load();
      return false;
    case Stage::kUpload:
      upload();
      return false;
    case Stage::kRun:
      return exchange();
  }
  return false;
}

std::string FalconLink::advice() const {
  switch (status_.phase) {
    case LinkPhase::kAbsent:
      return "no Falcon is plugged in; it needs its own power supply, too";
    case LinkPhase::kRefused:
      return refusal_advice("the Falcon", refused_);
    case LinkPhase::kNeedsFirmware:
      return settings_.firmware.empty()
                 ? "the Falcon has no firmware yet; name its file, which comes with the maker's software: "
                   "--device falcon:firmware=FILE"
                 : "the Falcon did not take the firmware; plug it in directly, without a hub, and check its "
                   "power supply";
    case LinkPhase::kLoading:
      return "the firmware is being loaded";
    case LinkPhase::kNeedsHoming:
      return "pull the grip out as far as it goes, then push it in";
    case LinkPhase::kReady:
      if (!guarded_) {
        return "palpate-guardian cannot be started: keep the Falcon's switch at hand, its force may stay where "
               "this program is killed";
      }
      break;
  }
  return {};
}

std::string FalconLink::place() const { return path_.empty() ? path_ : "usb " + path_; }

void FalconLink::search() noexcept {
  UsbFound found = look_for(transport_, "falcon", false, status_);
  refused_ = found.refused;
  if (!found.connection) return;
  connection_ = std::move(found.connection);
  path_ = std::move(found.device.path);
  uploads_in_a_row_ = 0;
  stage_ = Stage::kProbe;
}

void FalconLink::probe() noexcept {
  if (!set_running_speed()) return give_up();
  for (int n = 0; n < kProbes; ++n) {
    if (ask({}) || ask({})) {  // the first one may fall into what was left of another packet
      uploads_in_a_row_ = 0;
      misses_ = 0;
      guarded_ = leave_last_word();
      status_.phase = LinkPhase::kNeedsHoming;
      stage_ = Stage::kRun;
      return;
    }
    if (!connection_) return;
  }
  stage_ = Stage::kLoad;
}

bool FalconLink::leave_last_word() noexcept {
  try {
    return connection_ && connection_->leave_last_word(kOut, encode({.lights = kFalconRed}));
  } catch (const std::exception&) {  // no memory
    return false;
  }
}

void FalconLink::load() noexcept {
  if (settings_.firmware.empty() || uploads_in_a_row_ >= kMostUploads) {
    status_.phase = LinkPhase::kNeedsFirmware;
    uploads_in_a_row_ = 0;
    transport_.sleep(kFirmwarePause);
    stage_ = Stage::kProbe;  // another program may have loaded it
    return;
  }
  status_.phase = LinkPhase::kLoading;
  ++status_.uploads;
  ++uploads_in_a_row_;
  // That a try fails is usual: the next one may not.
  if (!greet_loader()) return;
  uploaded_ = 0;
  stage_ = Stage::kUpload;
}

bool FalconLink::control(std::uint8_t request, std::uint16_t value) noexcept {
  if (!connection_) return false;
  const TransferResult done = connection_->control(
      {.request_type = kVendorOut, .request = request, .value = value}, {}, kControlTime);
  if (done.status == TransferStatus::kGone) give_up();
  return done.ok();
}

bool FalconLink::set_running_speed() noexcept {
  parser_.reset();
  return control(kReset, kPurgeRx) && control(kReset, kPurgeTx) && control(kLatency, kLatencyRun) &&
         control(kBaud, kBaudRun) && control(kReset, kPurgeRx) && control(kReset, kPurgeTx);
}

bool FalconLink::greet_loader() noexcept {
  constexpr std::array<std::uint8_t, 3> kHello{0x0A, 0x43, 0x0D};
  constexpr std::array<std::uint8_t, 4> kHelloBack{0x0A, 0x44, 0x2C, 0x0D};
  constexpr std::array<std::uint8_t, 1> kReadyFor{0x41};
  if (!control(kReset, kPurgeRx) || !control(kReset, kPurgeTx) || !control(kLatency, kLatencyLoader) ||
      !control(kBaud, kBaud9600) || !control(kData, kEightBits) || !control(kFlow, kNoFlow) ||
      !control(kModem, kRtsLow) || !control(kModem, kDtrLow) || !control(kModem, kDtrHigh)) {
    return false;
  }
  if (!connection_->write(kOut, kHello, kEchoTime).ok() || !expect(kHelloBack, kEchoTime)) return false;
  if (!control(kModem, kDtrLow) || !control(kBaud, kBaudLoader)) return false;

  // It is ready for the image when it raises CTS; where it never does, the echo still tells.
  std::array<std::uint8_t, kTransferBytes> transfer{};
  for (const double until = transport_.now() + kEchoTime; transport_.now() < until;) {
    const TransferResult got = connection_->read(kIn, transfer, kAnswerTime);
    const FtdiRead read = strip_ftdi_status(std::span(transfer).first(got.bytes));
    if (read.has_status && (read.modem & kFtdiClearToSend) != 0) break;
    if (got.status != TransferStatus::kOk && got.status != TransferStatus::kTimeout) return false;
  }
  return connection_->write(kOut, kReadyFor, kEchoTime).ok() && expect(kReadyFor, kEchoTime);
}

/// A part of the image, so that a round stays short.
void FalconLink::upload() noexcept {
  for (int n = 0; n < kChunksARound; ++n) {
    const auto left = std::span<const std::uint8_t>(settings_.firmware).subspan(uploaded_);
    const auto chunk = left.first(std::min(kChunk, left.size()));
    const TransferResult sent = connection_->write(kOut, chunk, kEchoTime);
    if (sent.status == TransferStatus::kGone) return give_up();
    if (!sent.ok() || sent.bytes != chunk.size() || !expect(chunk, kEchoTime)) {
      if (connection_) stage_ = Stage::kLoad;
      return;
    }
    uploaded_ += chunk.size();
    if (uploaded_ == settings_.firmware.size()) {
      stage_ = Stage::kProbe;
      return;
    }
  }
}

/// Whether `wanted` comes in time; what comes before its first byte does not count.
bool FalconLink::expect(std::span<const std::uint8_t> wanted, double seconds) noexcept {
  std::array<std::uint8_t, kTransferBytes> transfer{};
  std::size_t matched = 0;
  for (const double until = transport_.now() + seconds; transport_.now() < until;) {
    const TransferResult got = connection_->read(kIn, transfer, until - transport_.now());
    if (got.status == TransferStatus::kGone) {
      give_up();
      return false;
    }
    const FtdiRead read = strip_ftdi_status(std::span(transfer).first(got.bytes));
    for (std::size_t i = 0; i < read.bytes && matched < wanted.size(); ++i) {
      if (transfer[i] == wanted[matched]) {
        ++matched;
      } else if (matched > 0) {
        return false;
      }
    }
    if (matched == wanted.size()) return true;
    if (!got.ok() && got.status != TransferStatus::kTimeout) return false;
  }
  return false;
}

std::optional<FalconReply> FalconLink::ask(const FalconCommand& command) noexcept {
  if (!connection_) return std::nullopt;
  const FalconPacket packet = encode(command);
  const TransferResult sent = connection_->write(kOut, packet, kWriteTime);
  if (sent.status == TransferStatus::kGone) {
    give_up();
    return std::nullopt;
  }
  // Answers of earlier commands may come late: the newest one counts.
  std::optional<FalconReply> newest;
  std::array<std::uint8_t, kTransferBytes> transfer{};
  for (const double until = transport_.now() + kAnswerTime; !newest && transport_.now() < until;) {
    const TransferResult got = connection_->read(kIn, transfer, until - transport_.now());
    if (got.status == TransferStatus::kGone) {
      give_up();
      return std::nullopt;
    }
    const FtdiRead read = strip_ftdi_status(std::span(transfer).first(got.bytes));
    for (std::size_t i = 0; i < read.bytes; ++i) {
      if (const auto reply = parser_.push(transfer[i])) newest = reply;
    }
    if (!got.ok() && got.status != TransferStatus::kTimeout)
      break;  // a fault of the bus: the caller counts it
  }
  status_.dropped += parser_.dropped() - dropped_before_;
  dropped_before_ = parser_.dropped();
  if (newest) {
    ++status_.rounds;
  } else {
    ++status_.lost;
  }
  return newest;
}

bool FalconLink::exchange() noexcept {
  const Vec3 force = ordered();
  const bool ready = status_.phase == LinkPhase::kReady;
  FalconCommand command{.lights = ready ? kFalconGreen : kFalconRed};
  command.motors = motors_for(ready && misses_ == 0 ? force : Vec3{0.0});
  const std::optional<FalconReply> reply = ask(command);
  if (!connection_) return false;
  if (reply && take(*reply)) return true;
  if (reply && status_.phase == LinkPhase::kNeedsHoming) {
    misses_ = 0;
    return false;
  }
  if (++misses_ >= kMostMisses) give_up();
  return false;
}

FalconCounts FalconLink::motors_for(const Vec3& force) noexcept {
  const double now = transport_.now();
  const auto commands_for = [this](const Vec3& asked) {
    return asked == Vec3{0.0} ? FalconCounts{} : motor_commands(delta_torques(rates_, asked), settings_.gain);
  };
  const auto plain = [](const FalconCounts& counts) {
    return std::array<double, 3>{1.0 * counts[0], 1.0 * counts[1], 1.0 * counts[2]};
  };
  const Vec3 wanted = force_within(force, limits_.force_cap);
  const Vec3 held = shown_.next(heat_.factor(plain(commands_for(wanted))) * wanted, now);
  const FalconCounts counts = commands_for(held);
  heat_.add(plain(counts), std::min(now - commanded_, 1.0));
  commanded_ = now;
  return counts;
}

bool FalconLink::take(const FalconReply& reply) noexcept {
  const double now = transport_.now();
  if (reply.homed != kFalconAllHomed) {
    // It has lost its zero, or has none yet: positions mean nothing, and the zero will jump.
    if (status_.phase == LinkPhase::kReady) {
      ++status_.faults;
      send_zeros();
    }
    status_.phase = LinkPhase::kNeedsHoming;
    return false;
  }
  const bool fresh = status_.phase != LinkPhase::kReady;
  if (!fresh && !plausible(reply, now)) {
    ++status_.implausible;
    return false;
  }
  const DeltaForward found = arm_.forward(angles_of(reply.encoders), fresh ? kSeed : position_);
  if (!found.converged) {
    ++status_.implausible;
    return false;
  }
  status_.phase = LinkPhase::kReady;
  counts_ = reply.encoders;
  position_ = found.position;
  rates_ = found.rates;
  answered_ = now;
  misses_ = 0;
  atoms_.time = now;
  atoms_.position = position_ - FalconSettings::kMiddle;
  atoms_.buttons = reply.buttons;
  return true;
}

bool FalconLink::plausible(const FalconReply& reply, double now) const noexcept {
  const double most = kCountsAnyway + kCountsPerSecond * (now - answered_);
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(reply.encoders[i] - counts_[i]) > most) return false;
  }
  return true;
}

Vec3 FalconLink::angles_of(const FalconCounts& counts) const noexcept {
  return Vec3{settings_.zero_angle} +
         settings_.count_angle * Vec3{1.0 * counts[0], 1.0 * counts[1], 1.0 * counts[2]};
}

void FalconLink::send_zeros() noexcept {
  const FalconPacket packet = encode({.lights = kFalconRed});
  for (int n = 0; connection_ && n < kLastZeros; ++n) {
    if (connection_->write(kOut, packet, kWriteTime).status == TransferStatus::kGone) break;
  }
}

/// Something is wrong with the device: leaves it without force and looks for it again.
void FalconLink::give_up() noexcept {
  ++status_.faults;
  close();
  status_.phase = LinkPhase::kAbsent;
}

void FalconLink::close() noexcept {
  if (connection_ && stage_ == Stage::kRun) send_zeros();
  connection_.reset();
  path_.clear();
  parser_.reset();
  misses_ = 0;
  stage_ = Stage::kSearch;
}

}  // namespace palpate
