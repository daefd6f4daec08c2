/// workbench.toml: the geometry of one workbench. Calibrations write its sections, explorers read them.
///
/// Metres, radians, rotations as unit quaternions [w, x, y, z]; every section and, where it says so, every
/// key may be missing.
///
///   [tracker]          # distortion: tracker_correction.h
///   degree = 4         # with center, scale, position, orientation: the polynomials
///   position = [[x, y, z], …]      # coefficients, as tracker_correction.h orders them; orientation likewise
///   table_count = [12, 10, 5]      # the table, with table_lower, table_spacing, table_position and
///                                  # table_orientation
///
///   [apparatus]        # where an optical instrument stands: x_optical = rotation x_tracker + translation
///   markers = [[x, y, z], …]       # with rotation, translation; in the sensor's frame; nan: not measured
///
///   [arm]              # dhh_chain.h
///   rows = [[d, a, alpha, beta, gamma, joint], …]      # joint from 1; 0: the row has none
///   free = ["d a alpha gamma", …]  # optional: what a full calibration estimates of each row
///
///   [coregistration]   # x_tracker = rotation x_arm + translation
///   sensor = [x, y, z]             # with rotation, translation; of the tracker, in the arm's end frame
///
///   [stylus]
///   tip = [x, y, z]                # in the sensor's frame
///
///   [eyes]
///   left = [x, y, z]               # and right, in the head sensor's frame; one may be missing
///
///   [screen]           # or [[screen]] for each of several; written by hand
///   lower_left = [x, y, z]         # lower_right, upper_left: its corners in the tracker's frame
///   name = "front"                 # optional, for --screen
///   pixels = [1920, 1080]          # optional: across and up; a window then shows the part that it covers
///   position = [0, 0]              # optional: of its upper left pixel on the desktop; default [0, 0]
///   stereo = "rows"                # optional: how it shows two eyes, as --stereo
///
///   [head]             # what follows the head before the screens; written by hand, as all below
///   source = "hands"               # optional: as --head, "replay:FILE.csv" or the head of --device hands,
///                                  # or of a tracker: head_station
///   resting_eye = [x, y, z]        # optional: between the eyes while the tracker does not see the head, in
///                                  # its frame; default: 0.6 m before the middle of the first screen
///   sensor_latency = 0.004         # optional [s]: from a motion to the time that the tracker gives it
///   display_latency = 0.008        # optional [s]: from a finished picture to its light
///   latency = 0.05                 # optional [s]: from that time to that light; default: measured
///   predict = true                 # optional: shows where the head will be then, not where it was
///   velocity_window = 0.05         # optional [s]: pose_prediction.h
///   freeze = 0.25                  # optional [s]: a head that is not seen stays where it was for so long,
///   glide = 0.75                   # optional [s]: and then comes to resting_eye in so long
///
///   [interaction]      # how hands work with the data; written by hand, no calibration makes it
///   technique = "immersive"        # tracked hands; "desktop", the default: a mouse
///   middle = [x, y, z]             # immersive: where the middle of the data is, in the tracker's frame
///   rotation = [w, x, y, z]        # optional: turns the tracker's axes into those of the data
///   gain = 2.0                     # optional: metres of the workspace for a metre of the hand, > 0
///   stylus_station = 1             # optional: the tracker's station, from 1, that is the stylus; 1
///   hand_station = 2               # optional: that of the other hand; none
///   head_station = 3               # optional: that of the head; none
///   enabling_button = 2            # optional: the dead-man switch of a device that shows force; "none"
///   enabling_device = "pedal"      # optional: the driver of another device that has this button
///   tip_offset = [x, y, z]         # optional [m]: from the tip in the hand to its picture, in the tracker's
///                                  # frame; of a device that is laid over the view: right, up, to the user
///   arm_rotation = [w, x, y, z]    # optional: turns frame 0 of [arm] into right, up and towards the user
///   arm_middle = [x, y, z]         # optional [m]: the middle of the arm's workspace in frame 0; default:
///                                  # where its end is with all readings zero
///   surface = "screen"             # optional: the hand moves on the screen alone, or on a plane n.x = d,
///                                  # [nx, ny, nz, d]. Of tracked hands: on the first screen, or a plane of
///                                  # the tracker's frame. Of a mouse, or a device that is laid over the
///                                  # view: on the plane through the middle of the view, or one of right, up
///                                  # and to the user, d [m] of the workspace from there
///   pick = "ray"                   # optional: how hands pick what they do not touch: along a ray, the
///                                  # default, or through an "aperture" about the tip, from the eye
///   aperture = 0.01                # optional [m]: its radius
///
///   [device.NAME], [tuned.NAME]    # of a device in the hand: workbench_devices.h
///
/// Other sections belong to others and are left alone.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/screen.h"
#include "common/kinematics/dhh_chain.h"
#include "common/kinematics/tracker_correction.h"
#include "common/kinematics/workbench_devices.h"

namespace palpate {

struct ApparatusGeometry {
  Rigid optical_from_tracker;
  std::vector<Vec3> markers;
};
struct CoregistrationGeometry {
  Rigid tracker_from_arm;
  Vec3 sensor{0.0};
};
struct EyesGeometry {
  std::optional<Vec3> left, right;
};
/// A screen, and what it shows.
struct ScreenGeometry {
  Screen corners;                     ///< [m] in the tracker's frame
  std::string name;                   ///< may be empty
  std::array<int, 2> pixels{0, 0};    ///< across and up; 0: not known
  std::array<int, 2> position{0, 0};  ///< of its upper left corner on the desktop [screen coordinates]
  StereoMode stereo = StereoMode::kNone;
};

/// What follows the head, and how late it is. Seconds.
struct HeadGeometry {
  std::string source;               ///< as --head; empty: nothing
  std::optional<Vec3> resting_eye;  ///< [m] in the tracker's frame
  double sensor_latency = 0.0, display_latency = 0.0;
  std::optional<double> latency;
  bool predict = true;
  double velocity_window = 0.05;
  double freeze = 0.25, glide = 0.75;

  static constexpr double kLongest = 10.0;  ///< of each of them
};

/// How hands work with the data: with x of the tracker, the probe is at m + gain R (x - middle) in the
/// workspace, m the middle of the data.
struct InteractionGeometry {
  bool immersive = false;
  Vec3 middle{0.0};                   ///< [m] in the tracker's frame
  Quat rotation{1.0, 0.0, 0.0, 0.0};  ///< R
  double gain = 1.0;
  std::optional<int> enabling_button;     ///< kNoButton, or below kButtons; nothing: not named
  std::string enabling_device;            ///< empty: the device itself
  Vec3 tip_offset{0.0};                   ///< [m] from the tip to its picture
  Quat arm_rotation{1.0, 0.0, 0.0, 0.0};  ///< takes axes of frame 0 of the arm to those of frame D
  std::optional<Vec3> arm_middle;         ///< [m] in frame 0
  /// The plane that the hand moves on alone: (n, d), n.x = d, |n| = 1 [m]; of tracked hands in the tracker's
  /// frame, of others in that of a Placement (device/placement.h).
  std::optional<Vec4> surface;

  static constexpr int kNoButton = -1, kButtons = 32;   ///< as of DeviceLimits
  static constexpr int kNoStation = 0, kStations = 16;  ///< as of PoseAtoms

  /// What is picked from afar: along a ray, or through a ring of this radius about the tip [m].
  bool through_aperture = false;
  double aperture = 0.01;

  /// Of a tracker, from 1, all different.
  int stylus_station = 1, hand_station = kNoStation, head_station = kNoStation;
};

struct WorkbenchGeometry {
  std::optional<TrackerCorrection> tracker;
  std::optional<ApparatusGeometry> apparatus;
  std::optional<DhhChain> arm;
  std::optional<CoregistrationGeometry> coregistration;
  std::optional<Vec3> stylus;
  std::optional<EyesGeometry> eyes;
  std::vector<ScreenGeometry> screens;  ///< in the order of the file
  HeadGeometry head;
  InteractionGeometry interaction;
  std::vector<DeviceOptions> device_options;
  std::vector<TunedDevice> tuned;
};

/// Where frame 0 of the arm lies in frame D of the device (device/atoms.h): x_D = R (x - middle).
/// @pre geometry.arm.
[[nodiscard]] Rigid device_from_arm(const WorkbenchGeometry& geometry);

/// @throws Error (bad input) naming the line of what is not TOML, unknown, missing, or of a wrong kind or
/// size.
[[nodiscard]] WorkbenchGeometry read_workbench(const std::filesystem::path& path);

}  // namespace palpate
