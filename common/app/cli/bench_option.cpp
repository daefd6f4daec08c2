#include "common/app/cli/bench_option.h"

namespace palpate {

DeviceText device_at_bench(const std::string& text, const WorkbenchGeometry& bench) {
  DeviceText device = parse_device(text);
  if (!device.button && device.enable.empty()) {
    device.button = bench.interaction.enabling_button;
    device.enable = bench.interaction.enabling_device;
  }
  device.options = with_device_options(bench.device_options, device.name, device.options);
  return device;
}

}  // namespace palpate
