/// The diffusion weighting of DICOM images: the standard's attributes, and those of vendors before it.
///
///   standard   (0018,9087) b, (0018,9089) direction in LPS, (0018,9075) directionality
///   Siemens    (0019,100c) b, (0019,100e) direction in LPS           creator "SIEMENS MR HEADER"
///   Siemens    B_value, DiffusionGradientDirection in LPS             of the CSA header (dicom_mosaic.h), where these are not there
///   GE         (0043,1039) b, (0019,10bb..10bd) direction            creators "GEMS_PARM_01", "GEMS_ACQU_01"
///   Philips    (2001,1003) b, (2005,10b0..10b2) direction in LPS      creators "Philips Imaging DD 001",
///                                                                    "Philips MR Imaging DD 001"
///
/// b and the direction are each taken from the first of these that states it: newer scanners state b in the
/// standard's attribute and the direction in their own. Private elements lie in whichever block their creator
/// reserves; above it is the usual one.
///
/// GE's direction (x, y, z) is relative to the image: with X, Y the directions along rows and columns and
/// N = X x Y, it is x X + y Y - z N where phases are encoded along columns, and y X - x Y - z N along rows.
#pragma once

#include <optional>

#include "loaders/dicom/dicom_elements.h"
#include "loaders/dicom/dicom_frames.h"

namespace palpate {

/// @param frame its directions X and Y; what a reader should know goes into its notes.
[[nodiscard]] std::optional<DicomGradient> dicom_gradient(const DicomScope& scope, DicomFrame& frame);

}  // namespace palpate
