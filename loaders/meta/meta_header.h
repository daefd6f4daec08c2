/// The header of a MetaImage, held against the size of its file before anything is allocated.
///
/// Format: "MetaIO: medical image input/output", itk.org/Wiki/ITK/MetaIO/Documentation.
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "common/field/data_set.h"

namespace palpate {

struct MetaHeader {
  int axes = 0;  ///< 2 to 4; the fourth is time
  std::array<std::uint64_t, 4> size{1, 1, 1, 1};
  ScalarType type = ScalarType::kUint8;
  bool is_long = false;  ///< MET_LONG or MET_ULONG, of four bytes
  int channels = 1;
  bool binary = true;
  bool big_endian = false;
  bool compressed = false;
  std::uint64_t compressed_bytes = 0;  ///< 0: not stated
  std::int64_t skip = 0;               ///< bytes before the voxels; -1: they are the last of their file
  std::string data_file;               ///< empty: the voxels follow the header, or lie in `pieces`
  /// Files one after the other along the last axes: those of a list (ElementDataFile = LIST [D], each of D
  /// axes) or numbered ones (file%03d.raw FIRST LAST STEP).
  std::vector<std::string> pieces;
  std::uint64_t piece_count = 0;  ///< that the axes ask for; 0: the voxels are not in pieces
  std::uint64_t header_bytes = 0;
  std::string problem;  ///< what is wrong, or empty

  /// @name As stated, empty where they are not.
  /// @{
  std::vector<double> matrix;  ///< axes x axes, a row the direction of an axis
  std::vector<double> offset;
  std::vector<double> spacing;
  std::vector<double> element_size;
  bool spaced_by_size = false;  ///< the spacing is the size of the elements
  std::string orientation;      ///< "RAI"
  std::string units;            ///< "mm"
  bool intensity_function = false;
  /// @}

  /// Of one state. @pre problem is empty.
  [[nodiscard]] std::uint64_t voxels() const noexcept { return size[0] * size[1] * size[2]; }
  [[nodiscard]] std::uint64_t bytes_per_voxel() const noexcept {
    return byte_size(type) * static_cast<std::uint64_t>(channels);
  }
  /// Of all. @pre meta_size_problem() is empty.
  [[nodiscard]] std::uint64_t bytes() const noexcept { return voxels() * size[3] * bytes_per_voxel(); }
};

/// Reads the start of a file. Unknown fields are left out.
[[nodiscard]] MetaHeader read_meta_header(std::string_view head);

/// Why `available` bytes of voxels cannot hold what the header says, or empty.
[[nodiscard]] std::string meta_size_problem(const MetaHeader& header, std::uint64_t available);

}  // namespace palpate
