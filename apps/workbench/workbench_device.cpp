#include "apps/workbench/workbench_device.h"

#include <cmath>
#include <utility>

#include "common/base/error.h"
#include "common/cli/simulated_option.h"
#include "common/device/replay_device.h"
#include "common/device/workbench_option.h"

namespace palpate {

bool SampleClock::read(double now, DeviceSample& sample) noexcept {
  if (!device_.read(now, sample)) return false;
  const double age = now - sample.time;
  age_.store(age, std::memory_order_relaxed);
  if (sample.time != last_) {
    constexpr double kNanoseconds = 1e9;
    ages_.add(static_cast<std::int64_t>(kNanoseconds * age));
    last_ = sample.time;
  }
  return true;
}

WorkbenchDevice::WorkbenchDevice(const std::string& text, const WorkbenchGeometry& workbench,
                                 const Console& console) {
  if (text == "mouse" || text.starts_with("mouse:"))
    throw usage_error(
        "a mouse shows no force: try --device simulated, or feel effects in the explorers' windows");
  const DeviceText named = device_at_workbench(text, workbench);
  OpenedDevice opened =
      open_at_workbench(named, workbench, [&](const std::string& line) { console.note(line); });
  key_ = device_key(named);
  held_ = description_of(opened.enabling, named);
  held_by_itself_ = opened.enabling.button != DeviceLimits::kNoButton && !opened.enabling.link;
  DeviceLimits limits = opened.link->limits();
  limits.enabling_button = opened.enabling.sample_button();
  linked_ = std::make_unique<LinkedDevice>(std::move(opened.link), opened.enabling);
  limits.edge_stiffness = 0.0;
  constexpr double kSteered = 0.05;  // [m] half a side of the box in which a device of valuators steers
  placed_ =
      std::make_unique<PlacedDevice>(*linked_, limits, Placement{}, Box{Vec3{-kSteered}, Vec3{kSteered}});
  clock_ = std::make_unique<SampleClock>(*placed_);
}

WorkbenchDevice::WorkbenchDevice(const SimulatedDeviceOptions& simulated, Device* leader)
    : key_(device_key(simulated)) {
  if (leader == nullptr) {
    nobody_ = std::make_unique<ReplayDevice>(std::vector<DeviceSample>{});
    leader = nobody_.get();
  }
  simulated_ = std::make_unique<SimulatedDevice>(simulated, *leader);
  clock_ = std::make_unique<SampleClock>(*simulated_);
}

WorkbenchGeometry workbench_of(const std::filesystem::path& file) {
  return file.empty() ? WorkbenchGeometry{} : read_workbench(file);
}

}  // namespace palpate
