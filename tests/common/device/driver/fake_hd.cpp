// The library itself.

#include "tests/common/device/driver/fake_hd.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <mutex>
#include <string_view>
#include <thread>

namespace palpate::test {

/// As the library gives it, by value.
struct FakeHdError {
  unsigned code;
  int internal;
  unsigned device;
};

}  // namespace palpate::test

namespace {

using palpate::Vec3;
using palpate::test::FakeHd;
using palpate::test::FakeHdError;

using Callback = unsigned (*)(void*);

struct Scheduled {
  Callback callback = nullptr;
  void* user = nullptr;
};

void tick(double now);

FakeHd& fake() {
  static FakeHd the_fake = [] {
    FakeHd made;
    made.tick = &tick;
    return made;
  }();
  return the_fake;
}

Scheduled& scheduled() {
  static Scheduled the_callback;
  return the_callback;
}

/// Of what the scheduler and the program both touch.
std::mutex& lock() {
  static std::mutex the_lock;
  return the_lock;
}

/// It stays where it is, by itself.
bool rests = false;

void tick(double now) {
  const std::lock_guard guard(lock());
  FakeHd& hd = fake();
  if (hd.by_itself && !rests) hd.arm.set_target(palpate::test::wandering(now));
  hd.arm.advance(now);
  if (!hd.running || hd.hung || !hd.plugged) {
    // The device's own electronics notice that nobody speaks to them.
    hd.arm.push(Vec3{0.0});
    return;
  }
  ++hd.ticks;
  Scheduled& work = scheduled();
  if (work.callback != nullptr && work.callback(work.user) == 0) work.callback = nullptr;
}

/// Turns of the base, of the thigh against the horizontal and of the shin against the thigh with the tip at
/// `p` (frame D), by the law of cosines.
std::array<double, 3> angles_at(const Vec3& p) {
  using palpate::test::kFakeRest, palpate::test::kFakeShin, palpate::test::kFakeThigh;
  const double forward = p.z + kFakeRest, side = p.x, up = p.y;
  const double out = std::hypot(forward, side), reach2 = out * out + up * up;
  const double elbow =
      std::acos((reach2 - kFakeThigh * kFakeThigh - kFakeShin * kFakeShin) / (2.0 * kFakeThigh * kFakeShin));
  const double lift =
      std::atan2(up, out) + std::atan2(kFakeShin * std::sin(elbow), kFakeThigh + kFakeShin * std::cos(elbow));
  return {std::atan2(side, forward), lift, -elbow};
}

Vec3 tip_of(const std::array<double, 3>& angles) {
  using palpate::test::kFakeRest, palpate::test::kFakeShin, palpate::test::kFakeThigh;
  const double shin = angles[1] + angles[2];
  const double out = kFakeThigh * std::cos(angles[1]) + kFakeShin * std::cos(shin);
  const double up = kFakeThigh * std::sin(angles[1]) + kFakeShin * std::sin(shin);
  return {out * std::sin(angles[0]), up, out * std::cos(angles[0]) - kFakeRest};
}

std::array<double, 3> encoders() {
  std::array<double, 3> angles = angles_at(fake().arm.position());
  for (std::size_t i = 0; i < 3; ++i) angles[i] -= fake().encoders_off[i];
  return angles;
}

std::jthread& scheduler() {
  static std::jthread thread;
  return thread;
}

constexpr unsigned kHandle = 3;

}  // namespace

#define PALPATE_FAKE_API extern "C" [[gnu::visibility("default")]]

PALPATE_FAKE_API FakeHd* palpate_fake_hd();
FakeHd* palpate_fake_hd() { return &fake(); }

PALPATE_FAKE_API unsigned hdInitDevice(const char* name);
unsigned hdInitDevice(const char* name) {
  FakeHd& hd = fake();
  const std::string_view named = name != nullptr ? name : "Right arm";
  // An arm that was put together anew, in a hand that rests.
  if (named == "Worn arm") {
    rests = true;
    hd.encoders_off = {0.06, -0.05, 0.08};
    hd.arm.put({0.03, -0.02, 0.04});
    hd.arm.set_target({0.03, -0.02, 0.04});
  }
  const bool other = named != "Right arm" && named != "Worn arm";
  if (!hd.plugged || other) hd.error = 0x0302;
  if (hd.busy) hd.error = 0x0301;
  if (other || !hd.plugged || hd.busy) return 0xFFFFFFFF;
  hd.error = 0;
  ++hd.opened;
  return kHandle;
}

PALPATE_FAKE_API void hdDisableDevice(unsigned device);
void hdDisableDevice(unsigned device) {
  if (device != kHandle) return;
  ++fake().closed;
  fake().force_output = false;
  fake().arm.push(Vec3{0.0});
}

PALPATE_FAKE_API void hdMakeCurrentDevice(unsigned device);
void hdMakeCurrentDevice(unsigned /*device*/) {}

PALPATE_FAKE_API void hdEnable(unsigned what);
void hdEnable(unsigned what) {
  if (what == 0x4000) fake().force_output = true;
}

PALPATE_FAKE_API void hdDisable(unsigned what);
void hdDisable(unsigned what) {
  if (what != 0x4000) return;
  fake().force_output = false;
  fake().arm.push(Vec3{0.0});
}

PALPATE_FAKE_API void hdBeginFrame(unsigned device);
void hdBeginFrame(unsigned device) { fake().in_frame = device == kHandle; }

PALPATE_FAKE_API void hdEndFrame(unsigned device);
void hdEndFrame(unsigned /*device*/) { fake().in_frame = false; }

PALPATE_FAKE_API void hdGetDoublev(unsigned what, double* values);
void hdGetDoublev(unsigned what, double* values) {
  FakeHd& hd = fake();
  if (what == 0x2050) {
    hd.out_of_frame = hd.out_of_frame || !hd.in_frame;
    if (hd.throwing_calls > 0) {
      --hd.throwing_calls;
      throw 42;
    }
    const Vec3 p = hd.encoders_off == std::array<double, 3>{} ? hd.arm.position() : tip_of(encoders());
    values[0] = hd.nonsense ? std::nan("") : 1000.0 * p.x;
    values[1] = 1000.0 * p.y;
    values[2] = 1000.0 * p.z;
  } else if (what == 0x2100) {
    hd.out_of_frame = hd.out_of_frame || !hd.in_frame;
    const std::array<double, 3> angles = encoders();
    std::copy(angles.begin(), angles.end(), values);
  } else if (what == 0x2150) {
    values[0] = values[1] = values[2] = 0.0;
  } else if (what == 0x2603) {
    values[0] = hd.most;
  } else if (what == 0x2604) {
    values[0] = hd.lasting;
  }
}

PALPATE_FAKE_API void hdGetIntegerv(unsigned what, int* values);
void hdGetIntegerv(unsigned what, int* values) {
  if (what == 0x2000) values[0] = fake().buttons;
  if (what == 0x2555) values[0] = 2;
}

PALPATE_FAKE_API const char* hdGetString(unsigned what);
const char* hdGetString(unsigned what) { return what == 0x2501 ? "PHANTOM Omni" : ""; }

PALPATE_FAKE_API void hdSetDoublev(unsigned what, const double* values);
void hdSetDoublev(unsigned what, const double* values) {
  if (what != 0x2700) return;
  FakeHd& hd = fake();
  hd.out_of_frame = hd.out_of_frame || !hd.in_frame;
  hd.last = {values[0], values[1], values[2]};
  hd.wire.told(hd.arm.time(), hd.last);
  hd.arm.push(hd.force_output && hd.calibrated ? hd.last : Vec3{0.0});
}

PALPATE_FAKE_API FakeHdError hdGetError();
FakeHdError hdGetError() { return {fake().error, 0, kHandle}; }

PALPATE_FAKE_API void hdStartScheduler();
void hdStartScheduler() {
  fake().running = true;
  if (!fake().by_itself) return;
  scheduler() = std::jthread([](const std::stop_token& stop) {
    const auto start = std::chrono::steady_clock::now();
    while (!stop.stop_requested()) {
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
      tick(std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
    }
  });
}

PALPATE_FAKE_API void hdStopScheduler();
void hdStopScheduler() {
  fake().running = false;
  scheduler() = {};
}

PALPATE_FAKE_API unsigned long hdScheduleAsynchronous(Callback callback, void* user, unsigned short priority);
unsigned long hdScheduleAsynchronous(Callback callback, void* user, unsigned short /*priority*/) {
  const std::lock_guard guard(lock());
  scheduled() = {callback, user};
  return 7;
}

PALPATE_FAKE_API void hdUnschedule(unsigned long handle);
void hdUnschedule(unsigned long handle) {
  const std::lock_guard guard(lock());
  if (handle == 7) scheduled() = {};
}

PALPATE_FAKE_API unsigned hdCheckCalibration();
unsigned hdCheckCalibration() {
  const FakeHd& hd = fake();
  return hd.calibrated ? 0x5000U : hd.updates_calibration ? 0x5001U : 0x5002U;
}

PALPATE_FAKE_API void hdUpdateCalibration(unsigned style);
void hdUpdateCalibration(unsigned style) {
  if (style == 2 && fake().updates_calibration) fake().calibrated = true;
}
