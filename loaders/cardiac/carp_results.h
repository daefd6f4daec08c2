/// Results of openCARP at the points of a mesh: .igb, a step at a time, and .dat.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// A .igb file: a header of 1024 bytes of text ("x:2502 t:101 type:float systeme:little_endian …"), then the
/// numbers of all points, one time step after the other. Only the header is read at once.
class IgbFile {
 public:
  /// @throws Error (bad input) naming the file: no such header, a number type that is not known, fewer bytes
  /// than the header promises, another count of numbers than `points`, times that do not rise.
  IgbFile(std::string file, std::size_t points);

  /// The array of a step: value = stored * facteur + zero. Named as the file without its ending.
  /// @throws Error (bad input) where the file cannot be read any more. @pre step < times().size().
  [[nodiscard]] DataArray read(std::size_t step) const;

  [[nodiscard]] const ArrayInfo& info() const noexcept { return info_; }
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }
  /// "ms", "mV" as the header states them, or empty.
  [[nodiscard]] const std::string& time_unit() const noexcept { return time_unit_; }
  [[nodiscard]] const std::string& unit() const noexcept { return unit_; }
  [[nodiscard]] const std::string& file() const noexcept { return file_; }

 private:
  std::string file_;
  ArrayInfo info_;
  std::vector<double> times_;
  std::string time_unit_, unit_;
  ScalarType stored_ = ScalarType::kFloat32;
  bool swapped_ = false;  ///< bytes of the other order
  double factor_ = 1.0, zero_ = 0.0;
};

/// A .dat file: a number a line for each point, or for each cell ("nan" is none). Named as the file without
/// its ending.
/// @throws Error (bad input) naming file and line where something else stands there or counts disagree.
[[nodiscard]] DataArray read_dat(const std::string& file, std::size_t points, std::size_t cells);

}  // namespace palpate
