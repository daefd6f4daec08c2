#include "common/device/driver/openhaptics/hd_link.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/error.h"
#include "common/base/files/shared_library.h"

namespace palpate {
namespace {

constexpr std::array kHdNames{"libHD.so", "libHD.so.3.4", "libHD.so.3.0"};
constexpr const char* kHdRemedy =
    "install OpenHaptics and the driver of the device from 3D Systems, or name the library: --device "
    "openhaptics:library=FILE";

constexpr double kMillimetre = 1e-3;     // [m]
constexpr double kHdRefusedPause = 0.5;  // [s] between two tries to open a device
constexpr double kHdPoll = 0.0002;       // [s] between two looks for a callback
constexpr double kHdEndTime = 0.020;     // [s] that the last callback has
constexpr double kHdHeatingTime = 2.0;   // [s] nobody has published it
constexpr double kHdFarthest = 2.0;      // [m] none of them reaches so far
/// Whatever it throws, what comes next is done.
void try_to(const auto& call) noexcept {
  try {
    call();
  } catch (...) {
    return;
  }
}

constexpr unsigned kHdWarm = 0x0200, kHdTooFast = 0x0203, kHdDeviceFault = 0x0300, kHdLost = 0x0302;

}  // namespace

HdFunctions open_hd_library(const std::string& file) {
  const SharedLibrary library(file, kHdNames, kHdRemedy);
  HdFunctions hd;
  library.require(hd.init, "hdInitDevice");
  library.require(hd.disable_device, "hdDisableDevice");
  library.require(hd.make_current, "hdMakeCurrentDevice");
  library.require(hd.enable, "hdEnable");
  library.require(hd.disable, "hdDisable");
  library.require(hd.begin_frame, "hdBeginFrame");
  library.require(hd.end_frame, "hdEndFrame");
  library.require(hd.get_doubles, "hdGetDoublev");
  library.require(hd.get_integers, "hdGetIntegerv");
  library.require(hd.get_string, "hdGetString");
  library.require(hd.set_doubles, "hdSetDoublev");
  library.require(hd.error, "hdGetError");
  library.require(hd.start_scheduler, "hdStartScheduler");
  library.require(hd.stop_scheduler, "hdStopScheduler");
  library.require(hd.schedule, "hdScheduleAsynchronous");
  library.require(hd.unschedule, "hdUnschedule");
  library.require(hd.check_calibration, "hdCheckCalibration");
  library.require(hd.update_calibration, "hdUpdateCalibration");
  return hd;
}

HdSettings::HdSettings() {
  arm.force_cap = 3.3;
  arm.reach = 0.08;
}

HdSettings hd_settings(const DriverOptions& options) {
  HdSettings settings;
  for (const auto& [name, value] : options) {
    if (name == "library") {
      settings.file = value;
    } else if (name == "name") {
      settings.name = value;
    } else if (!take_arm_option(settings.arm, "openhaptics", name, value)) {
      throw usage_error("the driver openhaptics knows no option '" + name + "'; known are library, name, " +
                        std::string(kArmOptions));
    }
  }
  return settings;
}

std::string hd_help() {
  const HdSettings defaults;
  return "library=FILE   OpenHaptics' library; default: libHD.so of the system\n"
         "name=NAME      of several devices this one, as its driver's set-up calls it\n" +
         arm_help(defaults.arm, HdSettings::kAxes);
}

HdLink::HdLink(const HdFunctions& hd, LinkClock& clock, const HdSettings& settings)
    : hd_(hd), clock_(clock), settings_(settings), limits_(settings.arm.limits()) {
  atoms_.has_position = true;
  atoms_.joint_count = DeviceAtoms::kJoints;
}

HdLink::~HdLink() { close(); }

std::string HdLink::advice() const {
  switch (status_.phase) {
    case LinkPhase::kAbsent:
      return "no device of 3D Systems answers; plug it in, and set it up with its own software first";
    case LinkPhase::kRefused: {
      constexpr std::array kDigits{'0', '1', '2', '3', '4', '5', '6', '7',
                                   '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
      std::string code;
      for (unsigned shift = 16; shift > 0;) code += kDigits[(refused_ >> (shift -= 4)) & 15U];
      return "the device of 3D Systems cannot be opened (its library's error 0x" + code +
             "); end other programs that use it";
    }
    case LinkPhase::kNeedsHoming:
      return "put the stylus into its inkwell, or the arm into its rest position";
    case LinkPhase::kReady:
      if (!rearm_.tripped()) break;
      return std::string(error_ == kHdWarm      ? "its motors are too warm: wait a minute"
                         : error_ == kHdTooFast ? "it was moved too fast"
                                                : "it took its force away") +
             "; let go of the switch, then hold it again";
    case LinkPhase::kNeedsFirmware:
    case LinkPhase::kLoading:
      break;
  }
  return {};
}

std::string HdLink::place() const {
  return device_ == HdFunctions::kNoDevice ? "" : "hd " + std::to_string(device_) + " " + model_;
}

bool HdLink::round() noexcept {
  try {
    return work();
  } catch (...) {
    give_up();
    clock_.sleep(kHdRefusedPause);  // a library that throws is not asked again at once
    return false;
  }
}

bool HdLink::work() {
  if (device_ == HdFunctions::kNoDevice) {
    search();
    return false;
  }
  if (ended_.load(std::memory_order_acquire)) {  // a callback threw
    give_up();
    return false;
  }
  ready_.store(status_.phase == LinkPhase::kReady && misses_ == 0, std::memory_order_release);
  heard_.store(clock_.now(), std::memory_order_release);
  Frame frame;
  const double until = clock_.now() + kAnswerTime;
  bool come = frames_.read(frame);
  while (!come && clock_.now() < until) {
    clock_.sleep(kHdPoll);
    come = frames_.read(frame);
  }
  if (!come) ++status_.lost;
  if (come && take_frame(frame)) return true;
  if (come && status_.phase == LinkPhase::kNeedsHoming) {
    misses_ = 0;
    return false;
  }
  if (device_ != HdFunctions::kNoDevice && ++misses_ >= kMostMisses) give_up();
  return false;
}

void HdLink::search() {
  const unsigned device = hd_.init(settings_.name.empty() ? nullptr : settings_.name.c_str());
  const HdError error = hd_.error();
  if (device == HdFunctions::kNoDevice || error.code != 0) {
    refused_ = error.code;
    // What is not there is a fault of the line to it; anything else is there and refuses.
    const bool absent = error.code == 0 || error.code == kHdLost || error.code == kHdDeviceFault;
    status_.phase = absent ? LinkPhase::kAbsent : LinkPhase::kRefused;
    if (device != HdFunctions::kNoDevice) hd_.disable_device(device);
    clock_.sleep(kHdRefusedPause);
    return;
  }
  device_ = device;
  hd_.make_current(device_);
  ++status_.opened;
  const char* const model = hd_.get_string(HdFunctions::kModel);
  model_ = model != nullptr ? model : "";

  // What its maker allows bounds what is asked for, and what its motors stand for any time.
  double most = 0.0, lasting = 0.0;
  hd_.get_doubles(HdFunctions::kNominalForce, &most);
  hd_.get_doubles(HdFunctions::kNominalLastingForce, &lasting);
  cap_ = settings_.arm.force_cap;
  if (most > 0.0) cap_ = std::min(cap_, most);
  heat_ = MotorHeat(lasting > 0.0 ? std::min(lasting, cap_) : cap_, cap_, kHdHeatingTime);

  misses_ = 0;
  errors_ = 0;
  rearm_.trip();
  frame_ = {};
  ready_ = false;
  while (frames_.read(frame_)) {
  }
  frame_ = {};
  ending_ = false;
  ended_ = false;
  status_.phase = LinkPhase::kNeedsHoming;
  hd_.enable(HdFunctions::kForceOutput);
  hd_.enable(HdFunctions::kForceClamping);
  hd_.start_scheduler();
  handle_ = hd_.schedule(&HdLink::called, this, HdFunctions::kMostImportant);
  if (hd_.error().code != 0) give_up();
}

unsigned HdLink::called(void* link) noexcept {
  auto* const self = static_cast<HdLink*>(link);
  try {
    return self->tick();
  } catch (...) {
    // Whatever it was, the force that was set last is not to stay.
    try_to([self] {
      constexpr std::array<double, 3> kZero{};
      self->hd_.set_doubles(HdFunctions::kForce, kZero.data());
      self->hd_.end_frame(self->device_);
    });
    self->ended_.store(true, std::memory_order_release);
    return HdFunctions::kDone;
  }
}

unsigned HdLink::tick() {
  const double now = clock_.now();
  const bool ending = ending_.load(std::memory_order_acquire);
  hd_.begin_frame(device_);
  std::array<double, 3> x{};
  int buttons = 0;
  hd_.get_doubles(HdFunctions::kPosition, x.data());
  static_assert(DeviceAtoms::kJoints == 6);
  hd_.get_doubles(HdFunctions::kJointAngles, frame_.joints.data());
  hd_.get_doubles(HdFunctions::kGimbalAngles, frame_.joints.data() + 3);
  hd_.get_integers(HdFunctions::kButtons, &buttons);
  unsigned calibration = hd_.check_calibration();
  if (calibration == HdFunctions::kCalibrationUpdates) {
    int style = 0;
    hd_.get_integers(HdFunctions::kCalibrationStyle, &style);
    hd_.update_calibration(static_cast<unsigned>(style));
    calibration = hd_.check_calibration();
  }
  const bool fresh = now - heard_.load(std::memory_order_acquire) <= kFreshFor && !ending &&
                     frame_.error == 0 && ready_.load(std::memory_order_acquire);
  const Vec3 asked = ordered();
  const Vec3 allowed = rearm_.allowed(is_finite(asked) ? asked : Vec3{0.0});
  const Vec3 wanted = force_within(fresh ? allowed : Vec3{0.0}, cap_);
  const Vec3 force = shown_.next(heat_.factor({wanted.x, wanted.y, wanted.z}) * wanted, now);
  heat_.add({force.x, force.y, force.z}, std::min(now - frame_.time, 1.0));
  const Vec3 f = settings_.arm.frame.force_for_maker(force);
  const std::array<double, 3> sent{f.x, f.y, f.z};
  hd_.set_doubles(HdFunctions::kForce, sent.data());
  hd_.end_frame(device_);

  // An error of this frame takes the force away from the next one on, and for as long as there are new ones.
  frame_.error = hd_.error().code;
  if (frame_.error != 0) ++frame_.errors;
  frame_.time = now;
  frame_.position = kMillimetre * Vec3{x[0], x[1], x[2]};
  frame_.buttons = static_cast<std::uint32_t>(buttons);
  frame_.calibration = calibration;
  frames_.write(frame_);
  if (!ending) return HdFunctions::kAgain;
  ended_.store(true, std::memory_order_release);
  return HdFunctions::kDone;
}

bool HdLink::take_frame(const Frame& frame) noexcept {
  if (frame.errors != errors_) {
    errors_ = frame.errors;
    if (frame.error != 0) error_ = frame.error;
    ++status_.faults;
    rearm_.trip();
    if (frame.error >= kHdDeviceFault) return false;  // the line to it, or the device itself
  }
  if (frame.calibration != HdFunctions::kCalibrated) {
    if (status_.phase == LinkPhase::kReady) ++status_.faults;
    status_.phase = LinkPhase::kNeedsHoming;
    rearm_.trip();
    return false;
  }
  const Vec3 position = settings_.arm.frame.position(frame.position);
  const bool first = status_.phase != LinkPhase::kReady;
  const bool whole = std::all_of(frame.joints.begin(), frame.joints.end(),
                                 [](double angle) { return std::isfinite(angle); });
  const bool near = whole && is_finite(position) && glm::length(position) < kHdFarthest;
  if (!near || (!first && !plausible_move(atoms_.position, position, frame.time - atoms_.time))) {
    ++status_.implausible;
    return false;
  }
  status_.phase = LinkPhase::kReady;
  ++status_.rounds;
  misses_ = 0;
  atoms_.time = frame.time;
  atoms_.position = position;
  atoms_.joints = frame.joints;
  atoms_.buttons = frame.buttons;
  return true;
}

void HdLink::give_up() noexcept {
  ++status_.faults;
  close();
  status_.phase = LinkPhase::kAbsent;
}

void HdLink::close() noexcept {
  if (device_ == HdFunctions::kNoDevice) return;
  // The last callback sets a force of zero; one that does not come is not waited for.
  ending_.store(true, std::memory_order_release);
  for (const double until = clock_.now() + kHdEndTime;
       !ended_.load(std::memory_order_acquire) && clock_.now() < until;) {
    clock_.sleep(kHdPoll);
  }
  try_to([this] { hd_.disable(HdFunctions::kForceOutput); });
  try_to([this] { hd_.unschedule(handle_); });
  try_to([this] { hd_.stop_scheduler(); });
  try_to([this] { hd_.disable_device(device_); });
  device_ = HdFunctions::kNoDevice;
  model_.clear();
}

}  // namespace palpate
