/// The bytes of an image on their way from its file: how many the header wants, how many were there, unpacked and
/// written. All loaders of images compare them here, so that none hands over a voxel that nobody read.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include "common/field/data_set.h"

namespace palpate {

struct VoxelCounts {
  std::uint64_t wanted = 0;               ///< by the header
  std::optional<std::uint64_t> found;     ///< in the file, as they are
  std::optional<std::uint64_t> unpacked;  ///< from packed ones
  std::optional<std::uint64_t> written;   ///< by a reader into memory that it was given
};
/// @throws Error (bad input) with `file` where one of them is smaller than the header wants.
void check_voxel_counts(const std::string& file, const VoxelCounts& counts);

/// A sentence where text of numbers ends within a word: it may be cut off there; else empty.
[[nodiscard]] std::string text_end_note(const std::string& file);

/// A sentence where the voxels are the last bytes of a file and `before` others stand before them: nothing tells that a
/// file is whole.
[[nodiscard]] std::string taken_from_end_note(std::uint64_t before);

/// Fills memory that a reader is given: no word of it (8 bytes) is what data hold but by a chance of 2^-64.
void fill_with_pattern(std::span<std::byte> memory) noexcept;
/// How many bytes were written into such memory before the first word that was not. Up to 3 bytes behind the last
/// word count as written.
[[nodiscard]] std::uint64_t written_bytes(std::span<const std::byte> memory) noexcept;

/// Turns numbers of `size` bytes that stand in the given byte order into this machine's.
void to_native(std::span<std::byte> numbers, std::size_t size, bool big_endian) noexcept;

/// Memory for the numbers of an image, filled with the pattern.
class VoxelMemory {
 public:
  /// @throws std::bad_alloc
  explicit VoxelMemory(std::uint64_t bytes);
  [[nodiscard]] std::span<std::byte> bytes() const noexcept { return {memory_.get(), size_}; }

  /// Hands over what was written, all of it. @throws Error (bad input) with `file` where some was not.
  [[nodiscard]] DataArray finish(const std::string& file, ScalarType type, int components) &&;

 private:
  std::shared_ptr<std::byte[]> memory_;
  std::size_t size_ = 0;
};

}  // namespace palpate
