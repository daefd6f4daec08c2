#include "common/device/driver/dhd/dhd_link.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/base/files/shared_library.h"
#include "common/base/text.h"

namespace palpate {
namespace {

constexpr std::array kDhdNames{"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};
constexpr const char* kDhdRemedy =
    "install Force Dimension's SDK, version 3 or newer, or name its library: --device dhd:library=FILE";
constexpr int kOldestDhd = 3;

// Forces and radii are those that open drivers use; the makers' sheets give no more than that for any.
constexpr std::array kDhdModels{DhdModel{33, "omega.3", 12.0, 0.075},
                                DhdModel{34, "omega.6", 12.0, 0.075},
                                DhdModel{36, "omega.6, left", 12.0, 0.075},
                                DhdModel{35, "omega.7", 12.0, 0.075, true},
                                DhdModel{37, "omega.7, left", 12.0, 0.075, true},
                                DhdModel{63, "delta.3", 20.0, 0.15},
                                DhdModel{206, "sigma.3", 12.0, 0.075},
                                DhdModel{104, "sigma.7", 12.0, 0.075, true},
                                DhdModel{105, "sigma.7, left", 12.0, 0.075, true},
                                DhdModel{203, "lambda.3", 12.0, 0.075},
                                DhdModel{108, "lambda.7", 12.0, 0.075, true},
                                DhdModel{109, "lambda.7, left", 12.0, 0.075, true},
                                DhdModel{60, "Novint Falcon", 8.0, 0.04}};

// Places in the status of a device.
constexpr std::size_t kDhdPower = 0, kDhdReset = 3, kDhdForce = 5, kDhdError = 9, kDhdForceOff = 14;
constexpr int kOffByButton = 1;

constexpr double kDhdLookPause = 0.1;      // [s] between two looks for a device
constexpr double kDhdRefusedPause = 0.25;  // [s]
constexpr double kDhdStatusPause = 0.05;   // [s] between two looks at its status
constexpr int kUnsetSerial = 0;

}  // namespace

DhdFunctions open_dhd_library(const std::string& file) {
  const SharedLibrary library(file, kDhdNames, kDhdRemedy);
  DhdFunctions dhd;
  library.require(dhd.version, "dhdGetSDKVersion");
  int major = 0, minor = 0, release = 0, revision = 0;
  dhd.version(&major, &minor, &release, &revision);
  if (major < kOldestDhd) {
    throw work_error(library.file() + " is version " + std::to_string(major) + "." + std::to_string(minor) +
                     "; " + kDhdRemedy);
  }
  library.require(dhd.device_count, "dhdGetDeviceCount");
  library.require(dhd.open, "dhdOpen");
  library.require(dhd.open_serial, "dhdOpenSerial");
  library.require(dhd.close, "dhdClose");
  library.require(dhd.system_type, "dhdGetSystemType");
  library.require(dhd.system_name, "dhdGetSystemName");
  library.require(dhd.status, "dhdGetStatus");
  library.require(dhd.position, "dhdGetPosition");
  library.require(dhd.buttons, "dhdGetButtonMask");
  library.require(dhd.enable_force, "dhdEnableForce");
  library.require(dhd.set_force, "dhdSetForce");
  library.require(dhd.max_force, "dhdGetMaxForce");
  library.require(dhd.last_error, "dhdErrorGetLastStr");
  library.want(dhd.enable_expert, "dhdEnableExpertMode");
  library.want(dhd.set_watchdog, "dhdSetWatchdog");
  library.want(dhd.emulate_button, "dhdEmulateButton");
  return dhd;
}

const DhdModel& dhd_model(int type) noexcept {
  const auto* const found = std::find_if(kDhdModels.begin(), kDhdModels.end(),
                                         [type](const DhdModel& each) { return each.type == type; });
  return found != kDhdModels.end() ? *found : kDhdModels.front();
}

DhdSettings::DhdSettings() {
  arm.frame.device_from_maker = *axes_from_text(kAxes);
  arm.force_cap = 8.0;
  arm.reach = 0.075;
}

DhdSettings dhd_settings(const DriverOptions& options) {
  DhdSettings settings;
  for (const auto& [name, value] : options) {
    if (name == "library") {
      settings.file = value;
    } else if (name == "serial") {
      const auto parsed = number(value);
      constexpr double kMost = 65535.0;
      if (!parsed || !(*parsed > 0.0 && *parsed <= kMost) || *parsed != std::floor(*parsed)) {
        throw usage_error("dhd: serial takes a number from 1 to 65535, found '" + value + "'");
      }
      settings.serial = static_cast<int>(*parsed);
    } else if (!take_arm_option(settings.arm, "dhd", name, value)) {
      throw usage_error("the driver dhd knows no option '" + name + "'; known are library, serial, " +
                        std::string(kArmOptions));
    }
  }
  return settings;
}

std::string dhd_help() {
  const DhdSettings defaults;
  return "library=FILE   Force Dimension's library; default: libdhd.so of the system\n"
         "serial=N       of several devices the one with this serial number\n" +
         arm_help(defaults.arm, DhdSettings::kAxes);
}

DhdLink::DhdLink(const DhdFunctions& dhd, LinkClock& clock, const DhdSettings& settings)
    : dhd_(dhd), clock_(clock), settings_(settings), limits_(settings.arm.limits()) {
  atoms_.has_position = true;
}

DhdLink::~DhdLink() { close(); }

std::string DhdLink::advice() const {
  switch (status_.phase) {
    case LinkPhase::kAbsent:
      return "no device of Force Dimension is plugged in";
    case LinkPhase::kRefused: {
      const char* const said = dhd_.last_error();
      return "the device of Force Dimension cannot be opened (" + std::string(said != nullptr ? said : "") +
             "); end other programs that use it, and give yourself access to it";
    }
    case LinkPhase::kNeedsHoming:
      return state_[kDhdPower] == 0
                 ? "switch the device on: it has no power"
                 : "the device has no zero yet: move it as its manual says, until its light is "
                   "steady";
    case LinkPhase::kReady:
      if (off_ && state_[kDhdForceOff] == kOffByButton)
        return "its force is switched off: press its force button";
      if (off_ || rearm_.tripped())
        return "it switched its force off: let go of the switch, then hold it again";
      if (no_button_)
        return "its library makes no button of its gripper: name another switch, such as enable=pedal";
      break;
    case LinkPhase::kNeedsFirmware:
    case LinkPhase::kLoading:
      break;
  }
  return {};
}

std::string DhdLink::place() const { return open_ ? "dhd " + std::to_string(int{id_}) + " " + name_ : ""; }

bool DhdLink::round() noexcept {
  try {
    return work();
  } catch (...) {
    give_up();
    clock_.sleep(kDhdLookPause);  // a library that throws is not asked again at once
    return false;
  }
}

bool DhdLink::work() {
  if (!open_) {
    search();
    return false;
  }
  clock_.sleep(round_ + kPeriod - clock_.now());
  round_ = clock_.now();
  return exchange();
}

void DhdLink::search() {
  if (dhd_.device_count() <= 0) {
    status_.phase = LinkPhase::kAbsent;
    clock_.sleep(kDhdLookPause);
    return;
  }
  const int id = settings_.serial != kUnsetSerial ? dhd_.open_serial(settings_.serial) : dhd_.open();
  if (id < 0) {
    status_.phase = LinkPhase::kRefused;
    clock_.sleep(kDhdRefusedPause);
    return;
  }
  open_ = true;
  id_ = static_cast<char>(id);
  ++status_.opened;
  const DhdModel& model = dhd_model(dhd_.system_type(id_));
  name_ = model.name;
  cap_ = std::min(settings_.arm.force_cap, model.force);
  if (const double most = dhd_.max_force(id_); most > 0.0) cap_ = std::min(cap_, most);
  if (dhd_.enable_expert != nullptr && dhd_.set_watchdog != nullptr && dhd_.enable_expert() >= 0) {
    (void)dhd_.set_watchdog(kWatchdog, id_);  // a device without one says so: the link's own rules remain
  }
  no_button_ = model.gripper && (dhd_.emulate_button == nullptr || dhd_.emulate_button(1, id_) < 0);
  status_.phase = LinkPhase::kNeedsHoming;
  misses_ = 0;
  looked_ = -1.0;
  state_ = {};
  off_ = false;
  rearm_.trip();
  if (!show(Vec3{0.0}) || dhd_.enable_force(1, id_) < 0) give_up();
}

bool DhdLink::look() {
  DhdFunctions::Status state{};
  if (dhd_.status(state.data(), id_) < 0) return false;
  looked_ = clock_.now();
  state_ = state;
  return state[kDhdError] == 0;
}

bool DhdLink::exchange() {
  bool sound = true;
  const Vec3 force = ordered();
  if (looked_ < 0.0 || clock_.now() - looked_ > kDhdStatusPause) sound = look();
  const bool usable = state_[kDhdPower] != 0 && state_[kDhdReset] != 0;
  const bool was_ready = status_.phase == LinkPhase::kReady;
  if (sound && !usable) {
    // Without its zero it does not know where it is.
    if (was_ready) ++status_.faults;
    status_.phase = LinkPhase::kNeedsHoming;
    rearm_.trip();
    misses_ = 0;
    if (!show(Vec3{0.0})) give_up();
    return false;
  }
  const bool off = was_ready && state_[kDhdForce] == 0;
  if (off) {
    if (!off_) ++status_.faults;
    rearm_.trip();
    // Nothing is asked for: it may have its force again, but for a button that is the user's own.
    if (force == Vec3{0.0} && state_[kDhdForceOff] != kOffByButton) {
      (void)dhd_.enable_force(1, id_);
      looked_ = -1.0;
    }
  }
  off_ = off;
  const bool ready = was_ready && sound && misses_ == 0 && !off;
  const Vec3 allowed = rearm_.allowed(is_finite(force) ? force : Vec3{0.0});
  sound = show(ready ? allowed : Vec3{0.0}) && sound;
  const double now = clock_.now();
  if (sound && take_sample(now)) {
    status_.phase = LinkPhase::kReady;
    ++status_.rounds;
    misses_ = 0;
    return true;
  }
  if (++misses_ >= kMostMisses) give_up();
  return false;
}

bool DhdLink::take_sample(double now) {
  Vec3 x{0.0};
  // Where it repeats an earlier position, because not enough time has passed, that is no fault.
  if (dhd_.position(&x.x, &x.y, &x.z, id_) < 0) {
    ++status_.lost;
    return false;
  }
  const Vec3 position = settings_.arm.frame.position(x);
  const bool first = status_.phase != LinkPhase::kReady;
  constexpr double kFarthest = 1.0;  // [m] none of them reaches so far
  const bool makes_sense = first ? is_finite(position) && glm::length(position) < kFarthest
                                 : plausible_move(atoms_.position, position, now - atoms_.time) &&
                                       glm::length(position) < kFarthest;
  if (!makes_sense) {
    ++status_.implausible;
    return false;
  }
  atoms_.time = now;
  atoms_.position = position;
  atoms_.buttons = dhd_.buttons(id_);
  return true;
}

bool DhdLink::show(const Vec3& force) {
  const Vec3 f = settings_.arm.frame.force_for_maker(shown_.next(force_within(force, cap_), clock_.now()));
  return dhd_.set_force(f.x, f.y, f.z, id_) >= 0;
}

void DhdLink::give_up() noexcept {
  ++status_.faults;
  close();
  status_.phase = LinkPhase::kAbsent;
}

void DhdLink::close() noexcept {
  if (!open_) return;
  // Whatever one of them throws, the next is done.
  const auto try_to = [](const auto& call) {
    try {
      call();
    } catch (...) {
      return;
    }
  };
  for (int n = 0; n < kLastZeros; ++n) try_to([this] { (void)show(Vec3{0.0}); });
  try_to([this] { (void)dhd_.enable_force(0, id_); });
  try_to([this] { (void)dhd_.close(id_); });
  open_ = false;
  name_.clear();
}

}  // namespace palpate
