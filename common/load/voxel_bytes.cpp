#include "common/load/voxel_bytes.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/base/text.h"
#include "common/load/find_format.h"

namespace palpate {
namespace {

constexpr std::size_t kWord = sizeof(std::uint64_t), kHalf = sizeof(std::uint32_t);

std::uint64_t pattern(std::size_t word) noexcept {
  std::uint64_t x = (word + 1) * 0x9E3779B97F4A7C15U;  // the first step of splitmix64
  return x ^ (x >> 29U);
}

/// Calls `use(offset, bytes, pattern)` for each word and for the half word behind the last one, until it says no.
template <typename Use>
void for_each_word(std::size_t size, const Use& use) {
  std::size_t at = 0;
  for (; at + kWord <= size; at += kWord) {
    if (!use(at, kWord, pattern(at / kWord))) return;
  }
  if (at + kHalf <= size) (void)use(at, kHalf, pattern(at / kWord));
}

}  // namespace

void check_voxel_counts(const std::string& file, const VoxelCounts& counts) {
  const std::string wanted = std::to_string(counts.wanted) + " by the header";
  const std::string remedy = "the file may be cut off, or its header wrong";
  const auto bytes = [](std::uint64_t count) { return std::to_string(count) + " bytes of voxels"; };
  if (counts.found && *counts.found < counts.wanted)
    throw input_error({file, "voxels", "has " + bytes(*counts.found), wanted, remedy});
  if (counts.unpacked && *counts.unpacked < counts.wanted)
    throw input_error(
        {file, "voxels", "only " + bytes(*counts.unpacked) + " can be unpacked", wanted, remedy});
  if (counts.written && *counts.written < counts.wanted)
    throw input_error({file, "voxels", "only " + bytes(*counts.written) + " could be read", wanted, remedy});
}

std::string text_end_note(const std::string& file) {
  const std::string last = read_head(file, 0, 1).tail;
  const bool open = !last.empty() && trimmed(last) == last;
  return open ? "its last number ends with the file, without a line end: it may be cut off there" : "";
}

std::string taken_from_end_note(std::uint64_t before) {
  return "the header takes the last bytes of the file for voxels, behind " + counted(before, "other byte") +
         ": if the file is cut off, every voxel is wrong, and nothing tells";
}

void fill_with_pattern(std::span<std::byte> memory) noexcept {
  for_each_word(memory.size(), [&](std::size_t at, std::size_t bytes, std::uint64_t word) {
    std::memcpy(memory.data() + at, &word, bytes);
    return true;
  });
}

std::uint64_t written_bytes(std::span<const std::byte> memory) noexcept {
  std::size_t written = memory.size();
  for_each_word(memory.size(), [&](std::size_t at, std::size_t bytes, std::uint64_t word) {
    const bool there = std::memcmp(memory.data() + at, &word, bytes) != 0;
    if (!there) written = at;
    return there;
  });
  return written;
}

void to_native(std::span<std::byte> numbers, std::size_t size, bool big_endian) noexcept {
  if (size < 2 || big_endian == (std::endian::native == std::endian::big)) return;
  for (std::size_t at = 0; at + size <= numbers.size(); at += size)
    std::reverse(numbers.begin() + static_cast<std::ptrdiff_t>(at),
                 numbers.begin() + static_cast<std::ptrdiff_t>(at + size));
}

VoxelMemory::VoxelMemory(std::uint64_t bytes)
    : memory_(std::make_shared_for_overwrite<std::byte[]>(bytes)), size_(bytes) {
  fill_with_pattern(this->bytes());
}

DataArray VoxelMemory::finish(const std::string& file, ScalarType type, int components) && {
  check_voxel_counts(file, {.wanted = size_, .written = written_bytes(bytes())});
  DataArray array;
  array.type = type;
  array.components = components;
  array.tuples = size_ / (byte_size(type) * as_size(components));
  array.bytes = bytes();
  array.owner = std::move(memory_);
  return array;
}

}  // namespace palpate
