// The library itself. PALPATE_FAKE_OLD makes one of an old version, PALPATE_FAKE_PARTIAL one that lacks a
// function.

#include "tests/common/device/driver/fake_dhd.h"

#include <chrono>

namespace palpate::test {
namespace {

FakeDhd& fake() {
  static FakeDhd the_fake;
  return the_fake;
}

double time_now() {
  if (fake().now) return fake().now();
  static const auto start = std::chrono::steady_clock::now();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

/// Lives up to now; -1 where a call fails, 1 where it repeats itself, else 0.
int call(char id) {
  FakeDhd& dhd = fake();
  const double now = time_now();
  // The firmware's watchdog.
  constexpr double kEighth = 1.25e-4;  // [s]
  if (dhd.open && dhd.force_on && dhd.watchdog > 0 && now - dhd.last_time > kEighth * dhd.watchdog) {
    constexpr int kWatchdog = 3;
    dhd.arm.advance(dhd.last_time + kEighth * dhd.watchdog);
    dhd.switch_force_off(kWatchdog);
  }
  if (dhd.wanders) dhd.arm.set_target(wandering(now));
  dhd.arm.advance(now);
  if (!dhd.open || id != 0 || !dhd.plugged) return -1;
  if (dhd.failing_calls > 0) {
    --dhd.failing_calls;
    return -1;
  }
  if (dhd.throwing_calls > 0) {
    --dhd.throwing_calls;
    throw 42;
  }
  if (dhd.repeated_calls > 0) {
    --dhd.repeated_calls;
    return 1;
  }
  return 0;
}

int open_it() {
  FakeDhd& dhd = fake();
  if (!dhd.plugged || dhd.busy || dhd.open) return -1;
  dhd.open = true;
  dhd.force_on = false;
  dhd.force_off_cause = 0;
  dhd.watchdog = 0;
  dhd.last_time = time_now();
  ++dhd.opened;
  return 0;
}

}  // namespace
}  // namespace palpate::test

using palpate::Vec3;
using palpate::test::call;
using palpate::test::fake;

#define PALPATE_FAKE_API extern "C" [[gnu::visibility("default")]]

PALPATE_FAKE_API palpate::test::FakeDhd* palpate_fake_dhd();
palpate::test::FakeDhd* palpate_fake_dhd() { return &fake(); }

PALPATE_FAKE_API void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision);
void dhdGetSDKVersion(int* major, int* minor, int* release, int* revision) {
#ifdef PALPATE_FAKE_OLD
  *major = 2;
#else
  *major = 3;
#endif
  *minor = 17;
  *release = 5;
  *revision = 0;
}

PALPATE_FAKE_API int dhdGetDeviceCount();
int dhdGetDeviceCount() { return fake().plugged ? 1 : 0; }

PALPATE_FAKE_API int dhdOpen();
int dhdOpen() { return palpate::test::open_it(); }

PALPATE_FAKE_API int dhdOpenSerial(int serial);
int dhdOpenSerial(int serial) { return serial == 4711 ? palpate::test::open_it() : -1; }

PALPATE_FAKE_API int dhdClose(char id);
int dhdClose(char id) {
  fake().throwing_calls = 0;
  (void)call(id);
  fake().switch_force_off(0);
  fake().open = false;
  ++fake().closed;
  return 0;
}

PALPATE_FAKE_API int dhdGetSystemType(char id);
int dhdGetSystemType(char /*id*/) { return fake().type; }

PALPATE_FAKE_API const char* dhdGetSystemName(char id);
const char* dhdGetSystemName(char /*id*/) { return "fake"; }

PALPATE_FAKE_API int dhdGetStatus(int* status, char id);
int dhdGetStatus(int* status, char id) {
  const int done = call(id);
  if (done < 0) return done;
  const auto& dhd = fake();
  for (int i = 0; i < 17; ++i) status[i] = 0;
  status[0] = dhd.powered ? 1 : 0;
  status[1] = status[2] = 1;
  status[3] = dhd.has_zero ? 1 : 0;
  status[5] = dhd.force_on ? 1 : 0;
  status[9] = dhd.broken ? 1 : 0;
  status[14] = dhd.force_off_cause;
  return done;
}

PALPATE_FAKE_API int dhdGetPosition(double* x, double* y, double* z, char id);
int dhdGetPosition(double* x, double* y, double* z, char id) {
  const int done = call(id);
  if (done < 0) return done;
  // x towards the user, y right, z up.
  const Vec3& p = fake().arm.position();
  *x = fake().nonsense ? std::nan("") : p.z;
  *y = p.x;
  *z = p.y;
  return done;
}

PALPATE_FAKE_API unsigned dhdGetButtonMask(char id);
unsigned dhdGetButtonMask(char /*id*/) {
  const auto& dhd = fake();
  return dhd.buttons | (dhd.gripper_is_button && dhd.closed_gripper ? 1U : 0U);
}

PALPATE_FAKE_API int dhdEmulateButton(unsigned char on, char id);
int dhdEmulateButton(unsigned char on, char id) {
  const int done = call(id);
  if (done >= 0) fake().gripper_is_button = on != 0;
  return done;
}

PALPATE_FAKE_API int dhdEnableForce(unsigned char on, char id);
int dhdEnableForce(unsigned char on, char id) {
  const int done = call(id);
  if (done < 0) return done;
  fake().force_on = on != 0;
  fake().force_off_cause = on != 0 ? 0 : 4;
  if (on == 0) fake().arm.push(Vec3{0.0});
  return done;
}

#ifndef PALPATE_FAKE_PARTIAL
PALPATE_FAKE_API int dhdSetForce(double x, double y, double z, char id);
int dhdSetForce(double x, double y, double z, char id) {
  const int done = call(id);
  if (done < 0) return done;
  auto& dhd = fake();
  ++dhd.commands;
  dhd.last = {y, z, x};
  dhd.last_time = dhd.arm.time();
  dhd.wire.told(dhd.last_time, dhd.last);
  if (dhd.force_on && !dhd.deaf) dhd.arm.push(dhd.last);
  return done;
}
#endif

PALPATE_FAKE_API double dhdGetMaxForce(char id);
double dhdGetMaxForce(char /*id*/) { return fake().max_force; }

PALPATE_FAKE_API const char* dhdErrorGetLastStr();
const char* dhdErrorGetLastStr() { return "device in use"; }

PALPATE_FAKE_API int dhdEnableExpertMode();
int dhdEnableExpertMode() { return fake().has_watchdog ? 0 : -1; }

PALPATE_FAKE_API int dhdSetWatchdog(unsigned char eighths, char id);
int dhdSetWatchdog(unsigned char eighths, char id) {
  fake().watchdog = eighths;
  return call(id);
}
