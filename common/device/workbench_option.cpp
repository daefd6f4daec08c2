#include "common/device/workbench_option.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/calibrated_link.h"

namespace palpate {

DeviceText device_at_workbench(const std::string& text, const WorkbenchGeometry& workbench) {
  DeviceText device = parse_device(text);
  if (!device.button && device.enable.empty()) {
    device.button = workbench.interaction.enabling_button;
    device.enable = workbench.interaction.enabling_device;
  }
  device.options = with_device_options(workbench.device_options, device_key(device), device.options);
  return device;
}

std::string device_key(const DeviceText& device) {
  constexpr std::array<std::string_view, 5> kTelling{"serial", "name", "device", "port", "at"};
  for (const auto& [name, value] : device.options) {
    if (std::find(kTelling.begin(), kTelling.end(), name) != kTelling.end()) return device.name + ":" + value;
  }
  return device.name;
}

OpenedDevice open_at_workbench(const DeviceText& device, const WorkbenchGeometry& workbench,
                               const std::function<void(const std::string&)>& note) {
  OpenedDevice opened = open_device(device);
  LinkCalibration calibration{.tracker = workbench.tracker, .tip = workbench.stylus, .arm = workbench.arm};
  if (workbench.arm) {
    calibration.device_from_arm = device_from_arm(workbench);
    const int joints = opened.link->atoms().joint_count, asked = workbench.arm->joint_count;
    const bool arm = opened.link->poses() == nullptr && opened.link->atoms().has_position;
    if (arm && joints != asked) {
      note("[arm] is of " + counted(as_size(asked), "joint") + ", and " + device.name +
           (joints == 0 ? " tells none" : " tells " + std::to_string(joints)) +
           ": its own positions are used");
    }
  }
  if (CalibratedLink::concerns(*opened.link, calibration))
    opened.link = std::make_unique<CalibratedLink>(std::move(opened.link), std::move(calibration));
  return opened;
}

bool is_same_device(const std::string& text, const std::string& opened) {
  const DeviceText one = parse_device(text), other = parse_device(opened);
  return one.name == other.name && (one.options.empty() || one.options == other.options);
}

}  // namespace palpate
