/// What a session of the hand is made with: modes, device, workbench, and what is recorded or replayed.
#pragma once

#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/device/device_limits.h"
#include "common/device/driver_link.h"
#include "common/device/probe_path.h"
#include "common/device/simulated_device.h"
#include "common/device/tracked_hands.h"
#include "common/geometry/annotation.h"
#include "common/hand/drawn/drawn_lines.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/hand/touch_choice.h"
#include "common/kinematics/workbench_file.h"
#include "common/servo/linked_device.h"
#include "common/servo/servo_loop.h"

namespace palpate {

struct ProbeSessionOptions {
  std::vector<HapticMode> modes;  ///< empty: no touch at all
  TouchChoice choice;             ///< at the start
  FixtureStore fixtures;          ///< that have been read
  DeviceLimits limits;
  double workspace_scale = 0.0;             ///< [m] per data unit; 0: the default
  double servo_rate = ServoOptions{}.rate;  ///< [Hz]
  int threads = 0;
  /// Moves the probe in place of the mouse, from the moment when a field is there; none: the mouse.
  std::vector<PathRow> path;
  /// Tracked hands in place of the mouse, by the workbench that they are at; none: the mouse.
  std::vector<TrackedHands> hands;
  /// The same, live: a tracker whose stations `workbench` names. Null: none.
  std::shared_ptr<LinkedDevice> tracker;
  WorkbenchGeometry workbench;
  /// A simulated arm and hand that follow mouse or path, and wander about the field while neither leads;
  /// none: the probe is where mouse or path are. Its limits and path are not looked at.
  std::optional<SimulatedDeviceOptions> simulated;
  /// A real device, laid over the field as the view shows it; in place of mouse, path and simulation. None:
  /// null.
  std::shared_ptr<DriverLink> link;
  /// Where frame D of that device is in the tracker's frame of an immersive workbench: its tip is where the
  /// data is then, whichever way the view is. None: it is laid over the view.
  std::optional<Rigid> workbench_from_device;
  /// What the device bears, as tuning found it [N/m]: the chain gets no more.
  double most_stiffness = HUGE_VAL;
  /// Its dead-man switch; `limits` name its sample_button().
  EnablingSwitch enabling;
  /// Where the run is recorded; empty: nowhere. Its header says what `recorded` holds.
  std::filesystem::path record;
  bool overwrite = false;
  RecordingHeader recorded;
  /// Where the seconds before a fault are saved (fault_recorder.h); empty: nowhere. With the same header.
  std::filesystem::path fault_folder;
  std::optional<Recording> replay;
  std::vector<Annotation> notes;                     ///< annotations that are there at the start
  std::shared_ptr<const DrawnLines::Entries> lines;  ///< kept lines, likewise; null: none
};

}  // namespace palpate
