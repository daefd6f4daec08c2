/// Pictures of a tracker's distortion (Ikits 2006, sec. 4.2.6, figures 4.6 to 4.8), drawn off-screen.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "common/calibration/measurements.h"
#include "common/kinematics/tracker_correction.h"
#include "common/render/scene_view.h"
#include "lab/page/section.h"

namespace palpate {

struct DistortionPicture {
  std::string file;  ///< "distortion_lines.png"
  SceneView view;
};

/// @name The three of them. Metres, in the tracker's frame, the transmitter as a box at the origin.
/// @{
/// Illuminated streamlines of the polynomial of the position error, from random seeds in the plane z = 0 of
/// the transmitter, or where measurements are nearest to it; coloured by the size of the error, which opacity
/// follows: what is weak does not hide what is strong.
[[nodiscard]] DistortionPicture position_error_lines(const std::vector<TrackerMeasurement>& rows,
                                                     const VectorPolynomial& error, std::uint64_t seed);
/// Arrows along the axis of each orientation error in a slice of the measurements across z, their length by
/// the logarithm of its angle.
[[nodiscard]] DistortionPicture orientation_error_icons(const std::vector<TrackerMeasurement>& rows);
/// Arrows along what metal adds to the field of the transmitter's coil along x, as the readings tell it. A
/// tracker that reads the pose (p_t, R_t) has seen R_t^T M(p_t), M the dipole of its three coils; at the
/// true pose (p, R) that is a field R R_t^T M(p_t), and
///   D = R R_t^T M(p_t) - M(p)
/// is the distortion (synthetic_tracker.h has M). Its first column is drawn, in the same slice; relative to
/// the undistorted one, whose fall with the cube of the distance would hide it.
[[nodiscard]] DistortionPicture field_distortion_icons(const std::vector<TrackerMeasurement>& rows);
/// @}

/// Draws them as PNGs.
/// @param program, command_line for the files' texts. @throws Error (work failed) without OpenGL.
[[nodiscard]] std::vector<ReportPlot> drawn_pictures(const std::vector<DistortionPicture>& pictures,
                                                     const std::string& program,
                                                     const std::string& command_line);

/// Writes them into the folder, which is made.
/// @throws Error (usage) for a file that is there and not to be replaced, (work failed).
void write_pictures(const std::vector<ReportPlot>& drawn, const std::filesystem::path& folder, bool replace);

/// What is seen in them, for a report; that they could not be drawn, where they were not.
/// @param trouble why not; empty where they were.
[[nodiscard]] ReportSection distortion_section(std::vector<ReportPlot> drawn, const std::string& trouble);

}  // namespace palpate
