/// What each image of DICOM files says of itself.
///
/// Symbols (PS3.3 C.7.6.2.1.1). S position of the first pixel, X and Y unit directions in which columns and
/// rows count, in the patient's LPS frame [mm]; d_i, d_j steps between columns and between rows [mm].
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/math/vec.h"

namespace palpate {

/// A diffusion weighting: b [s/mm^2], and the direction in LPS, of any length, zero where there is none (a trace
/// image).
struct DicomGradient {
  double weighting = 0.0;
  Vec3 direction{0.0};
};

/// How the numbers of a pixel become colours.
enum class DicomColors : std::uint8_t {
  kNone,     ///< one number a pixel
  kRgb,      ///< three
  kYbr,      ///< three: luminance and two differences of colour (PS3.3 C.7.6.3.1.2)
  kPalette,  ///< one, by a table
};
/// What stored numbers from `first` on stand for; those below and above have the first and last one.
struct DicomTable {
  int first = 0;
  std::vector<std::uint16_t> values;
};
/// Red, green and blue of the stored numbers from `first` on; those below and above have the first and last one.
struct DicomPalette {
  int first = 0;
  std::array<std::vector<std::uint8_t>, 3> parts;
};

/// A slice: an image, or a frame of an image that has several.
struct DicomFrame {
  std::string file;        ///< empty: missing, where gaps are allowed
  std::size_t number = 0;  ///< of the frame in its file
  std::string series;      ///< its UID
  std::string image;       ///< that of the image (SOP instance)
  std::string title;       ///< "301 T1 mprage"
  int columns = 0, rows = 0;
  /// Of a mosaic: slices side by side in the image, and which of them the frame is, counted row by row.
  int tiles_across = 1, tile = 0;
  Vec3 position{0.0};          ///< S
  Vec3 along_row{1, 0, 0};     ///< X
  Vec3 along_column{0, 1, 0};  ///< Y
  double column_step = 1.0, row_step = 1.0;
  /// By which volumes of one series follow each other: time, acquisition, echo, trigger, number.
  double temporal = 0.0, acquisition = 0.0, instance = 0.0;
  std::optional<double> echo, trigger;  ///< [ms] of the echo, and after the trigger (of a heart's beat)
  double thickness = 0.0;               ///< of the slice [mm]; 0: not stated
  std::optional<DicomGradient> gradient;
  std::string notes;     ///< about how it was understood; the same for all of a kind
  int bits = 16;         ///< a number takes: 8, 16 or 32
  int bits_stored = 16;  ///< of them belong to it, the highest at `high_bit`
  int high_bit = 15;
  bool is_signed = false;
  double slope = 1.0, intercept = 0.0;
  std::shared_ptr<const DicomTable> table;  ///< in the place of slope and intercept (Modality LUT Sequence)
  bool inverted = false;                    ///< MONOCHROME1: large numbers are dark
  DicomColors colors = DicomColors::kNone;
  bool planar = false;                          ///< colours plane by plane
  std::shared_ptr<const DicomPalette> palette;  ///< of kPalette
  std::optional<std::uint64_t> pixels_at;       ///< of all frames in the file; none: packed
  bool big_endian = false;
  std::string units;                            ///< of rescaled numbers: "Gy", "HU", or empty
  std::optional<std::array<double, 2>> window;  ///< rescaled numbers that are black and white

  [[nodiscard]] int samples() const noexcept {
    return colors == DicomColors::kRgb || colors == DicomColors::kYbr ? 3 : 1;
  }
  /// Of the image that the frame is, or is a tile of, as stored without packing.
  [[nodiscard]] std::uint64_t bytes() const noexcept {
    return static_cast<std::uint64_t>(columns) * static_cast<std::uint64_t>(rows) *
           static_cast<std::uint64_t>(tiles_across * tiles_across) *
           static_cast<std::uint64_t>(samples() * bits / 8);
  }
  /// Which pixel of that image its own i-th one is.
  [[nodiscard]] std::size_t stored_pixel(std::size_t i) const noexcept {
    if (tiles_across == 1) return i;
    const auto wide = static_cast<std::size_t>(columns), high = static_cast<std::size_t>(rows);
    const auto across = static_cast<std::size_t>(tiles_across), t = static_cast<std::size_t>(tile);
    return ((t / across) * high + i / wide) * wide * across + (t % across) * wide + i % wide;
  }
};

/// What a file holds, for finding out what a folder does.
struct DicomLabel {
  std::string series, title;        ///< empty where the file has no image
  std::vector<std::string> listed;  ///< of a DICOMDIR: the files that it lists, as they lie beside it
};
/// @throws Error (bad input) as DicomFile.
[[nodiscard]] DicomLabel read_dicom_label(const std::string& file);

/// @throws Error (bad input) naming the file: as DicomFile, as slices_of_mosaic(), colours of another kind, sizes that the pixels
/// do not have, or frames without a place in the patient.
[[nodiscard]] std::vector<DicomFrame> read_dicom_frames(const std::string& file);

}  // namespace palpate
