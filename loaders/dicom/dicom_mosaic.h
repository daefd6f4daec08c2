/// Mosaics of Siemens: the slices of a volume side by side in one image, from its first row on.
///
/// What the standard's attributes do not say of them stands in a private header, CSA, of which both versions are read:
/// which way slices follow each other, and how many there are. Image Position is where the first pixel of one image as
/// wide as the mosaic would lie about the middle of the slice:
///   S = P + d_j X (C - c) / 2 + d_i Y (R - r) / 2                                              (1)
/// with C, R pixels of the mosaic, c, r of a slice, d_j, d_i their steps along X and Y.
/// Sources: NiBabel, "Siemens format DICOM with CSA header" and "DICOM orientation: mosaic".
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "loaders/dicom/dicom_elements.h"
#include "loaders/dicom/dicom_frames.h"

namespace palpate {

/// The words of a tag of a CSA header; none where it is not there, or the bytes are none.
[[nodiscard]] std::vector<std::string> csa_words(std::string_view header, std::string_view tag);

/// The CSA header of the image; empty where there is none.
[[nodiscard]] std::string_view csa_header(const DicomScope& scope);

/// The slices of a mosaic, one frame each.
/// @param image the mosaic, placed as its attributes say.
/// @throws Error (bad input) naming the file: no number of slices, normal or distance, or sizes that they do not fit.
[[nodiscard]] std::vector<DicomFrame> slices_of_mosaic(const DicomScope& scope, const DicomFrame& image);

}  // namespace palpate
