/// Tables of measurements: what a lab writes down, one row a measurement, as CSV with a header.
///
/// Metres, radians; orientations are unit quaternions (columns …qw, …qx, …qy, …qz), normalized when they are
/// read. Lines that start with '#' are remarks. Every reader refuses rows without finite numbers where it
/// needs them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "common/kinematics/tracker_correction.h"

namespace palpate {

/// Header: tx,ty,tz,tqw,tqx,tqy,tqz,mx,my,mz,mqw,mqx,mqy,mqz[,validation]
struct TrackerMeasurement {
  TrackerPose reported;     ///< t…: what the tracker says
  TrackerPose actual;       ///< m…: what an accurate instrument says, in the tracker's frame
  bool validation = false;  ///< 1: not used for the fit
};

inline constexpr std::size_t kMaxMarkers = 6;

/// Header: px,py,pz,qw,qx,qy,qz,v1x,v1y,v1z[,v2x,…,v6z]; a marker that was not seen has nan in its columns. A
/// coregistration has one marker: the sensor of the tracker, seen in the tracker's frame, p and q being the
/// arm's.
struct MarkerMeasurement {
  TrackerPose pose;
  std::array<std::optional<Vec3>, kMaxMarkers> markers{};  ///< in the frame of the other instrument
};

/// Header: x,y,z,j1,…,jn[,grid]
struct ArmMeasurement {
  Vec3 point{0.0};               ///< where the tip was put, in the frame of its grid [m]
  std::vector<double> readings;  ///< of the joints [rad]
  int grid = 0;                  ///< 0 is the frame that the arm is calibrated in
};

/// Header: px,py,pz,qw,qx,qy,qz
using PivotMeasurement = TrackerPose;

/// Header: px,py,pz,qw,qx,qy,qz,eye,ax,ay,az,bx,by,bz
struct SightingMeasurement {
  TrackerPose head;
  bool right = false;        ///< eye: 0 left, 1 right
  Vec3 near{0.0}, far{0.0};  ///< a, b: two points that the eye saw behind each other, in the tracker's frame
};

template <typename Row>
struct MeasurementTable {
  std::string source;  ///< the file, or what the measurements are
  std::vector<Row> rows;
};

/// @name Reading. @throws Error (bad input).
/// @{
[[nodiscard]] MeasurementTable<TrackerMeasurement> read_tracker_measurements(const std::string& file);
[[nodiscard]] MeasurementTable<MarkerMeasurement> read_marker_measurements(const std::string& file);
/// @param joints how many the arm has.
[[nodiscard]] MeasurementTable<ArmMeasurement> read_arm_measurements(const std::string& file, int joints);
[[nodiscard]] MeasurementTable<PivotMeasurement> read_pivot_measurements(const std::string& file);
[[nodiscard]] MeasurementTable<SightingMeasurement> read_sightings(const std::string& file);
/// @}

/// @name The same tables as text
/// @{
[[nodiscard]] std::string csv(const std::vector<TrackerMeasurement>& rows);
[[nodiscard]] std::string csv(const std::vector<MarkerMeasurement>& rows);
[[nodiscard]] std::string csv(const std::vector<ArmMeasurement>& rows);
[[nodiscard]] std::string csv(const std::vector<PivotMeasurement>& rows);
[[nodiscard]] std::string csv(const std::vector<SightingMeasurement>& rows);
/// @}

}  // namespace palpate
