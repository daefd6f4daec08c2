/// A device under test, opened as the explorers open it: with its dead-man switch, its options and limits
/// from workbench.toml, and a clock on how old its samples are.
#pragma once

#include <atomic>
#include <filesystem>
#include <memory>
#include <string>

#include "common/cli/console.h"
#include "common/device/driver_library.h"
#include "common/device/simulated_device.h"
#include "common/kinematics/workbench_file.h"
#include "common/servo/linked_device.h"
#include "common/servo/placed_device.h"
#include "common/servo/time_histogram.h"

namespace palpate {

/// Keeps how old each new sample is when the servo takes it.
class SampleClock final : public Device {
 public:
  /// `device` outlives this.
  explicit SampleClock(Device& device) : device_(device) {}

  bool read(double now, DeviceSample& sample) noexcept override;
  void command(const Vec3& force) noexcept override { device_.command(force); }
  void emergency_stop() noexcept override { device_.emergency_stop(); }
  [[nodiscard]] const Bell* bell() const noexcept override { return device_.bell(); }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return device_.limits(); }

  /// Of the newest sample [s]; any thread.
  [[nodiscard]] double age() const noexcept { return age_.load(std::memory_order_relaxed); }
  /// Of all new samples. @pre the servo has ended.
  [[nodiscard]] const TimeHistogram& ages() const noexcept { return ages_; }

 private:
  Device& device_;
  TimeHistogram ages_;
  double last_ = -1.0;  ///< [s] time of the last sample
  std::atomic<double> age_{0.0};
};

class WorkbenchDevice {
 public:
  /// Opens a driver's device. @throws Error.
  WorkbenchDevice(const std::string& text, const WorkbenchGeometry& workbench, const Console& console);
  /// A simulated arm and hand at a path of the leader, or wandering about the middle.
  WorkbenchDevice(const SimulatedDeviceOptions& simulated, Device* leader);

  [[nodiscard]] SampleClock& device() noexcept { return *clock_; }
  /// What workbench.toml knows it by.
  [[nodiscard]] const std::string& key() const noexcept { return key_; }
  /// Null for a simulated one.
  [[nodiscard]] LinkedDevice* linked() noexcept { return linked_.get(); }
  /// Holding what gives it force, "while button 2 of falcon is held"; empty where nothing must be held.
  [[nodiscard]] const std::string& held() const noexcept { return held_; }
  /// Whether that is a button of the very device.
  [[nodiscard]] bool held_by_itself() const noexcept { return held_by_itself_; }

 private:
  std::string key_, held_;
  bool held_by_itself_ = false;
  std::unique_ptr<LinkedDevice> linked_;
  std::unique_ptr<PlacedDevice> placed_;
  std::unique_ptr<Device> nobody_;
  std::unique_ptr<SimulatedDevice> simulated_;
  std::unique_ptr<SampleClock> clock_;
};

/// The workbench of a file, or an empty one where no file is named. @throws Error (bad input).
[[nodiscard]] WorkbenchGeometry workbench_of(const std::filesystem::path& file);

}  // namespace palpate
