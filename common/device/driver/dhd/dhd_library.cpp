#include "common/device/driver/dhd/dhd_library.h"

#include <algorithm>

#include "common/base/error.h"
#include "common/device/driver/vendor_library.h"

namespace palpate {
namespace {

constexpr std::array kDhdNames{"libdhd.so.3", "libdhd.so", "libdrd.so.3", "libdrd.so"};
constexpr const char* kDhdRemedy =
    "install Force Dimension's SDK, version 3 or newer, or name its library: --device dhd:library=FILE";
constexpr int kOldestDhd = 3;

// Forces and radii are those that open drivers use; the makers' sheets give no more than that for any.
constexpr std::array kDhdModels{
    DhdModel{33, "omega.3", 12.0, 0.075},        DhdModel{34, "omega.6", 12.0, 0.075},
    DhdModel{36, "omega.6, left", 12.0, 0.075},  DhdModel{35, "omega.7", 12.0, 0.075},
    DhdModel{37, "omega.7, left", 12.0, 0.075},  DhdModel{63, "delta.3", 20.0, 0.15},
    DhdModel{206, "sigma.3", 12.0, 0.075},       DhdModel{104, "sigma.7", 12.0, 0.075},
    DhdModel{105, "sigma.7, left", 12.0, 0.075}, DhdModel{203, "lambda.3", 12.0, 0.075},
    DhdModel{108, "lambda.7", 12.0, 0.075},      DhdModel{109, "lambda.7, left", 12.0, 0.075},
    DhdModel{60, "Novint Falcon", 8.0, 0.04}};

}  // namespace

DhdFunctions open_dhd_library(const std::string& file) {
  const VendorLibrary library(file, kDhdNames, kDhdRemedy);
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
  return dhd;
}

const DhdModel& dhd_model(int type) noexcept {
  const auto* const found = std::find_if(kDhdModels.begin(), kDhdModels.end(),
                                         [type](const DhdModel& each) { return each.type == type; });
  return found != kDhdModels.end() ? *found : kDhdModels.front();
}

}  // namespace palpate
