/// What the header of an MRtrix image says, held against the size of its data.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/field/data_set.h"
#include "common/field/tensor/gradient_table.h"

namespace palpate {

/// How an axis lies in the file.
struct MifAxis {
  std::uint64_t size = 1;
  int rank = 0;            ///< 0: its neighbours are next to one another
  bool backwards = false;  ///< its last voxel is stored first
};

/// The note of a header with gradients.
inline constexpr const char* kGradientsOfHeader = "gradients from dw_scheme, in RAS";

struct MifHeader {
  UniformTopology topology;        ///< RAS+ mm
  std::vector<MifAxis> axes;       ///< three of space, then perhaps one of volumes
  std::optional<ScalarType> type;  ///< as stored; none: single bits, the highest of a byte first
  bool big_endian = false;
  double offset = 0.0, scale = 1.0;        ///< value = offset + scale * number
  std::string data_file;                   ///< where the numbers stand: the file itself or another one
  std::uint64_t data_at = 0;               ///< the byte where they begin, unpacked
  bool packed = false;                     ///< the data file is gzip
  std::optional<GradientTable> gradients;  ///< of dw_scheme
  std::vector<std::string> notes;

  [[nodiscard]] std::uint64_t volumes() const noexcept { return axes.size() > 3 ? axes[3].size : 1; }
  [[nodiscard]] std::uint64_t voxels() const noexcept { return axes[0].size * axes[1].size * axes[2].size; }
  /// Of all numbers.
  [[nodiscard]] std::uint64_t data_bytes() const noexcept;
};

/// @throws Error (bad input) with `file`: keys that are missing or make no sense, an image larger than its
/// data.
[[nodiscard]] MifHeader read_mif_header(const std::string& file);

}  // namespace palpate
