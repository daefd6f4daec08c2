/// Series of slices as lattices: pure arithmetic on what the images say.
///
/// Symbols. S_k position of slice k; N = X x Y normal of all of them; z_k = N.S_k. The lattice has the axes
/// d_j X, d_i Y and (S_last - S_first) / (slices - 1) in LPS, which are turned into RAS+ at the end.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/gradient_table.h"
#include "loaders/dicom/dicom_frames.h"

namespace palpate {

struct DicomSeries {
  UniformTopology topology;  ///< RAS+ mm
  /// frames[v * points.z + k]: slice k of volume v.
  std::vector<DicomFrame> frames;
  std::size_t volumes = 1;
  std::vector<double> times;               ///< one a volume, of several: what `times_are` says
  std::string times_are;                   ///< in words
  std::optional<GradientTable> gradients;  ///< of the volumes, in RAS+; none where no image states b-values
  std::vector<std::string> notes;
};

/// Sorts the frames of one series. Up to three images of another kind, a localizer, are left out and named. @pre not
/// empty.
/// @param allow_gaps slices may be missing: their frames have no file. Diffusion gradients are left aside then.
/// @throws Error (bad input) naming a file: images of different sizes, orientations or steps; missing or
/// doubled slices; slices that are not evenly spaced; different gradients within a volume.
[[nodiscard]] DicomSeries sort_dicom_series(std::vector<DicomFrame> frames, bool allow_gaps = false);

}  // namespace palpate
