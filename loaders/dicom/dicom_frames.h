/// What each image of DICOM files says of itself.
///
/// Symbols (PS3.3 C.7.6.2.1.1). S position of the first pixel, X and Y unit directions in which columns and
/// rows count, in the patient's LPS frame [mm]; d_i, d_j steps between columns and between rows [mm].
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A diffusion weighting: b [s/mm^2], and the direction in LPS, zero where there is none (a trace image).
struct DicomGradient {
  double weighting = 0.0;
  Vec3 direction{0.0};
};

/// A slice: an image, or a frame of an image that has several.
struct DicomFrame {
  std::string file;
  std::size_t number = 0;  ///< of the frame in its file
  std::string series;      ///< its UID
  std::string title;       ///< "301 T1 mprage"
  int columns = 0, rows = 0;
  Vec3 position{0.0};          ///< S
  Vec3 along_row{1, 0, 0};     ///< X
  Vec3 along_column{0, 1, 0};  ///< Y
  double column_step = 1.0, row_step = 1.0;
  /// By which volumes of one series follow each other: time, acquisition, number.
  double temporal = 0.0, acquisition = 0.0, instance = 0.0;
  std::optional<DicomGradient> gradient;
  std::string notes;  ///< about how it was understood; the same for all of a kind
  int bits = 16;      ///< a number takes: 8, 16 or 32
  bool is_signed = false;
  double slope = 1.0, intercept = 0.0;
  bool inverted = false;  ///< MONOCHROME1: large numbers are dark
};

/// Series UID and title, for finding out what a folder holds; empty where the file has no image.
struct DicomLabel {
  std::string series, title;
};
/// @throws Error (bad input) as check_dicom(), or where GDCM cannot read it.
[[nodiscard]] DicomLabel read_dicom_label(const std::string& file);

/// @throws Error (bad input) naming the file: as check_dicom(), a mosaic, colours, sizes that the pixels do
/// not have, or no place in the patient.
[[nodiscard]] std::vector<DicomFrame> read_dicom_frames(const std::string& file);

}  // namespace palpate
