/// The HD part of OpenHaptics as far as the link uses it, in our own words. Units mm, N.
#pragma once

#include <string>

namespace palpate {

/// What hdGetError() gives by value.
struct HdError {
  unsigned code = 0;  ///< 0: none
  int internal = 0;
  unsigned device = 0;
};

using HdCallback = unsigned (*)(void* user);  ///< 1: call it again in the next tick, 0: it is done

struct HdFunctions {
  static constexpr unsigned kNoDevice = 0xFFFFFFFF;
  static constexpr unsigned kDone = 0, kAgain = 1;
  // What is asked for and set.
  static constexpr unsigned kButtons = 0x2000, kPosition = 0x2050, kModel = 0x2501, kJointAngles = 0x2100,
                            kGimbalAngles = 0x2150, kCalibrationStyle = 0x2555, kNominalForce = 0x2603,
                            kNominalLastingForce = 0x2604, kForce = 0x2700, kForceOutput = 0x4000,
                            kForceClamping = 0x4001;
  static constexpr unsigned kCalibrated = 0x5000, kCalibrationUpdates = 0x5001;
  static constexpr unsigned short kMostImportant = 65535;

  unsigned (*init)(const char* name) = nullptr;  ///< null: the default device
  void (*disable_device)(unsigned device) = nullptr;
  void (*make_current)(unsigned device) = nullptr;
  void (*enable)(unsigned what) = nullptr;
  void (*disable)(unsigned what) = nullptr;
  void (*begin_frame)(unsigned device) = nullptr;
  void (*end_frame)(unsigned device) = nullptr;
  void (*get_doubles)(unsigned what, double* values) = nullptr;
  void (*get_integers)(unsigned what, int* values) = nullptr;
  const char* (*get_string)(unsigned what) = nullptr;
  void (*set_doubles)(unsigned what, const double* values) = nullptr;
  HdError (*error)() = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  unsigned long (*schedule)(HdCallback callback, void* user, unsigned short priority) = nullptr;
  void (*unschedule)(unsigned long handle) = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned style) = nullptr;
};

/// Opens the library by `file`, or by its usual name where that is empty, and finds its functions.
/// @throws Error (work failed) where there is none, or one lacks a function.
[[nodiscard]] HdFunctions open_hd_library(const std::string& file);

}  // namespace palpate
