/// What the axes of a NRRD file are for, and where its samples lie.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include <teem/nrrd.h>

#include "common/field/data_set.h"

namespace palpate {

/// In place of the third axis of space of a single slice.
inline constexpr unsigned kNoNrrdAxis = ~0U;

/// How the axes are used: three for space (two of a single slice), one for the components of a tuple, or none, and one for time, or none.
struct NrrdAxes {
  std::optional<unsigned> components, time;
  std::array<unsigned, 3> space{};
  std::vector<std::string> notes;
};

/// Time is an axis of kind `time`, one along the fourth direction of a space of four, or the index of a Slicer
/// sequence. Where four axes have no directions, kinds, spacings or a last size of one tell which are of space.
/// @param as_components a time axis holds components, where there are no others.
/// @throws Error (bad input) where the axes are of other kinds, too many, or not told apart.
[[nodiscard]] NrrdAxes sort_nrrd_axes(const Nrrd& nrrd, bool as_components, const std::string& file);

struct NrrdPlace {
  UniformTopology topology;  ///< RAS+ where the header names a medical space
  bool anatomical = false;
  std::string length_unit;  ///< of places: mm of a patient's, else as stated, or empty
  Vec3 signs{1.0};          ///< by which coordinates of that space become RAS
  std::vector<std::string> notes;
};

/// By directions, spacings, or minima and maxima of the axes. Without centerings samples are in the middle of cells,
/// as Teem and ITK have it. Units of length become millimetres where the space is medical, or where axes differ in them.
/// @throws Error (bad input) where the axes span no volume, or have different units of which one is not known.
[[nodiscard]] NrrdPlace place_nrrd(const Nrrd& nrrd, const NrrdAxes& axes, const std::string& file);

/// One a sample along the time axis; none for a single state. @param notes of units and what is no time.
[[nodiscard]] std::vector<double> nrrd_times(const Nrrd& nrrd, const NrrdAxes& axes,
                                             std::vector<std::string>& notes);

/// The value of a key, or none.
[[nodiscard]] std::optional<std::string> nrrd_key(const Nrrd& nrrd, const std::string& key);

}  // namespace palpate
