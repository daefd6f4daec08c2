// Files that a lab writes by hand: the first byte chooses workbench.toml or a table of measurements. What is
// read is whole, and evaluates to numbers.
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "common/base/error.h"
#include "common/calibration/measurements.h"
#include "common/kinematics/workbench_file.h"
#include "tests/fuzz/memory_path.h"

using namespace palpate;

namespace {

void require(bool holds) {
  if (!holds) __builtin_trap();
}

void workbench(const std::string& file) {
  const WorkbenchGeometry bench = read_workbench(file);
  if (bench.tracker) (void)bench.tracker->corrected({Vec3{0.1, 0.2, 0.3}});
  if (bench.arm) {
    require(bench.arm->joint_count >= 0);
    const std::vector<double> readings(static_cast<std::size_t>(bench.arm->joint_count), 0.5);
    (void)bench.arm->forward(readings);
    (void)device_from_arm(bench);
  }
  for (const ScreenGeometry& screen : bench.screens) require(screen.pixels[0] >= 0 && screen.pixels[1] >= 0);
  for (const TunedDevice& each : bench.tuned) {
    require(each.stiffness > 0.0 && each.rate > 0.0);
    (void)section_text(each);
  }
  require(bench.interaction.gain > 0.0);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const test::MemoryPath file(data + 1, size - 1);
  try {
    switch (data[0] % 6) {
      case 0:
        workbench(file.path());
        break;
      case 1:
        for (const auto& row : read_tracker_measurements(file.path()).rows)
          require(std::abs(glm::length(row.reported.orientation) - 1.0) < 1e-9);
        break;
      case 2:
        for (const auto& row : read_marker_measurements(file.path()).rows)
          require(is_finite(row.pose.position));
        break;
      case 3:
        for (const auto& row : read_arm_measurements(file.path(), 3).rows)
          require(row.readings.size() == 3 && is_finite(row.point));
        break;
      case 4:
        (void)read_pivot_measurements(file.path());
        break;
      default:
        (void)read_sightings(file.path());
    }
  } catch (const Error&) {  // refused in one line
  }
  return 0;
}
