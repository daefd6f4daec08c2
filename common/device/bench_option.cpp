#include "common/device/bench_option.h"

#include <algorithm>
#include <array>
#include <memory>
#include <string_view>
#include <utility>

#include "common/base/index.h"
#include "common/base/text.h"
#include "common/device/calibrated_link.h"

namespace palpate {

DeviceText device_at_bench(const std::string& text, const WorkbenchGeometry& bench) {
  DeviceText device = parse_device(text);
  if (!device.button && device.enable.empty()) {
    device.button = bench.interaction.enabling_button;
    device.enable = bench.interaction.enabling_device;
  }
  device.options = with_device_options(bench.device_options, device_key(device), device.options);
  return device;
}

std::string device_key(const DeviceText& device) {
  constexpr std::array<std::string_view, 5> kTelling{"serial", "name", "device", "port", "at"};
  for (const auto& [name, value] : device.options) {
    if (std::find(kTelling.begin(), kTelling.end(), name) != kTelling.end()) return device.name + ":" + value;
  }
  return device.name;
}

OpenedDevice open_at_bench(const DeviceText& device, const WorkbenchGeometry& bench,
                           const std::function<void(const std::string&)>& note) {
  OpenedDevice opened = open_device(device);
  LinkCalibration calibration{.tracker = bench.tracker, .tip = bench.stylus, .arm = bench.arm};
  if (bench.arm) {
    calibration.device_from_arm = device_from_arm(bench);
    const int joints = opened.link->atoms().joint_count, asked = bench.arm->joint_count;
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
