/// Landmarks and frames of haptic grids, and poses of planes, as words of options and recordings.
///
///   frame   data | world | plane:nx,ny,nz,d | axes:x,y,z,x,y,z
///   marks   x:12.5/y:30/z:7/plane:nx,ny,nz,d        planes across the grid's first, second and third axis
///   poses   nx,ny,nz,d/…   the plane n.x = d;   through:x,y,z,x,y,z,x,y,z   that through three points;
///           x,y,z,qx,qy,qz,qw   centre and unit quaternion
///
/// Data coordinates. Numbers read back to the same bits.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>

#include "common/haptics/constraint/grid_axis_settings.h"
#include "common/haptics/constraint/plane_widget_settings.h"

namespace palpate {

[[nodiscard]] std::string text_of(const GridFrame& frame);
[[nodiscard]] std::string text_of(const GridMarks& marks);   ///< empty where there are none
[[nodiscard]] std::string text_of(const PlanePoses& poses);  ///< likewise; centres and quaternions

/// @name What is wrong, in a few words; nothing where the value has been read.
/// @{
[[nodiscard]] std::optional<std::string> read_text(std::string_view text, GridFrame& frame);
[[nodiscard]] std::optional<std::string> read_text(std::string_view text, GridMarks& marks);
[[nodiscard]] std::optional<std::string> read_text(std::string_view text, PlanePoses& poses);
/// @}

/// The pose of the plane n.x = d whose centre is its point nearest to `near`. @pre n is not zero.
[[nodiscard]] PlanePose pose_of_plane(const Vec3& n, double d, const Vec3& near);
/// The pose of the plane through three points, its centre in the middle of them and its normal to the side
/// from which they run anticlockwise; nothing where they are on one line.
[[nodiscard]] std::optional<PlanePose> pose_through(const std::array<Vec3, 3>& points);
/// n and d of a pose.
[[nodiscard]] Vec4 plane_of_pose(const PlanePose& pose);

}  // namespace palpate
