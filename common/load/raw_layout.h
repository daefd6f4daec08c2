/// How voxels without a header lie in their file: what `--raw-size` and its like say, or a sidecar.
#pragma once

#include <cstdint>
#include <string>

#include "common/field/data_set.h"

namespace palpate {

/// Voxels in a file, the first axis fastest.
struct RawLayout {
  Index3 size{0};  ///< voxels along each axis
  ScalarType type = ScalarType::kUint8;
  bool big_endian = false;
  Vec3 spacing{1.0};       ///< from one voxel to the next along each axis, data units
  Vec3 origin{0.0};        ///< centre of the first voxel, data units
  std::uint64_t skip = 0;  ///< bytes before the first voxel
};

/// The same as text, in the grammar of the command line; what is empty is left to RawLayout.
struct RawSpec {
  std::string size;     ///< "256x256x178", needed
  std::string type;     ///< "uint16", needed
  std::string endian;   ///< "little" or "big"
  std::string spacing;  ///< "0.5,0.5,1"
  std::string origin;   ///< "0,0,0"
  std::string skip;     ///< "1024"

  [[nodiscard]] bool empty() const noexcept {
    return size.empty() && type.empty() && endian.empty() && spacing.empty() && origin.empty() &&
           skip.empty();
  }
};

/// @throws Error (usage) that names the word as an option of the command line (`--raw-size`).
[[nodiscard]] RawLayout parse_raw_layout(const RawSpec& spec);

/// Bytes of the voxels; 2^64 - 1 where they would be more than any file has.
[[nodiscard]] std::uint64_t byte_count(const RawLayout& layout) noexcept;

/// What a file's name says in the manner of public collections ("tooth_103x94x161_uint8.raw"): size and type,
/// both empty where it says nothing.
[[nodiscard]] RawSpec raw_spec_of_name(const std::string& name);

}  // namespace palpate
