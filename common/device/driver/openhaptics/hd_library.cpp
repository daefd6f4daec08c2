#include "common/device/driver/openhaptics/hd_library.h"

#include <array>

#include "common/device/driver/vendor_library.h"

namespace palpate {
namespace {

constexpr std::array kHdNames{"libHD.so", "libHD.so.3.4", "libHD.so.3.0"};
constexpr const char* kHdRemedy =
    "install OpenHaptics and the driver of the device from 3D Systems, or name the library: --device "
    "openhaptics:library=FILE";

}  // namespace

HdFunctions open_hd_library(const std::string& file) {
  const VendorLibrary library(file, kHdNames, kHdRemedy);
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

}  // namespace palpate
