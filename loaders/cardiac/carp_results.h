/// Results of openCARP at the points of a mesh: .igb, a step at a time, and .dat.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/vector_choice.h"

namespace palpate {

/// A .igb file, packed with gzip or not, whatever its name says: a header of 1024 bytes of text, or of several times as many up to a form feed ("x:2502 t:101 type:float
/// systeme:little_endian …"), then the numbers of all points or of all cells, one time step after the other.
/// Only the header is read at once. Types as openCARP's IGB library has them: long has 8 bytes, vec3f 3
/// numbers a point, vec4f 4, complex 2, rgba 4. Of a run that was cut off the whole steps are there, and
/// notes() say so.
class IgbFile {
 public:
  /// @throws Error (bad input) naming the file: no such header, a number type that is not known, less than
  /// one step, another count of numbers than points or cells, times that do not rise.
  IgbFile(std::string file, std::size_t points, std::size_t cells);

  /// The array of a step: value = stored * facteur + zero. Named as the file without its ending.
  /// @throws Error (bad input) where the file cannot be read any more. @pre step < times().size().
  [[nodiscard]] DataArray read(std::size_t step) const;

  [[nodiscard]] const ArrayInfo& info() const noexcept { return info_; }
  void set_name(std::string name) { info_.name = std::move(name); }
  [[nodiscard]] const std::vector<double>& times() const noexcept { return times_; }
  /// "ms", "mV" as the header states them, or empty.
  [[nodiscard]] const std::string& time_unit() const noexcept { return time_unit_; }
  [[nodiscard]] const std::string& unit() const noexcept { return unit_; }
  /// States the times in another unit, where both are known: s, ms, us. @return whether they are.
  bool state_times_in(const std::string& unit);
  [[nodiscard]] const std::string& file() const noexcept { return file_; }
  /// What is to be said: steps that are promised and not there, bytes that are not promised, times and byte orders
  /// that are stated wrongly.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

 private:
  /// The numbers of a step as they stand.
  [[nodiscard]] DataArray read_stored(std::size_t step, bool swapped) const;
  /// A note where the numbers of the first step make sense in the other byte order alone.
  void doubt_byte_order(const std::string& stated);
  /// Steps that are there of those promised, with a note where these differ.
  [[nodiscard]] std::uint64_t whole_steps(std::uint64_t promised, std::uint64_t step_bytes);

  std::string file_;
  ArrayInfo info_;
  std::vector<double> times_;
  std::vector<std::string> notes_;
  std::string time_unit_, unit_;
  ScalarType stored_ = ScalarType::kFloat32;
  bool swapped_ = false;    ///< bytes of the other order
  std::size_t header_ = 0;  ///< [bytes]
  double factor_ = 1.0, zero_ = 0.0;
};

/// The steps of several results on one axis of time.
struct SharedTimes {
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::vector<double> times;                    ///< all that any of them has, rising
  std::vector<std::vector<std::size_t>> steps;  ///< of each result at each time: its step, or kNone
};
/// Times that differ by less than 1e-6 of the shortest interval are one. A result of one step holds at all
/// times, where others have several.
[[nodiscard]] SharedTimes shared_times(const std::vector<IgbFile>& results);

/// A .dat file: a number a line for each point, or for each cell ("nan" is none, and so is -1 among numbers that are not
/// below 0); or rows "node time", of which the first time of a node is taken; nodes count from 0, or from 1 where one is
/// the count of points. Named as the file without its ending.
/// @param notes gets what is to be said of such a table.
/// @throws Error (bad input) naming file and line where something else stands there or counts disagree.
[[nodiscard]] DataArray read_dat(const std::string& file, std::size_t points, std::size_t cells,
                                 std::vector<std::string>& notes);

}  // namespace palpate
