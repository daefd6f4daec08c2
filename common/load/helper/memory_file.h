/// Memory that two processes share: written once by one of them, sealed, then mapped read-only by the other.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "common/base/files/unique_fd.h"

namespace palpate {

/// An anonymous file in memory (memfd) that grows by appending and is sealed before it is handed over.
class MemoryFile {
 public:
  /// @throws std::system_error.
  MemoryFile();

  /// Appends `bytes` at the next multiple of kAlignment and returns its offset.
  /// @throws std::system_error where memory or the size limit of the process runs out.
  std::uint64_t append(std::span<const std::byte> bytes);

  /// Room for `bytes` bytes, zeros, that its owner writes in place: append() of it copies nothing. All owners let go of it
  /// before seal(). @throws std::system_error as append().
  [[nodiscard]] std::shared_ptr<std::byte> room(std::uint64_t bytes);

  /// After this nobody, the writer included, can change or shrink it. @throws std::system_error.
  void seal();

  [[nodiscard]] int fd() const noexcept { return fd_.get(); }

  /// Offsets are multiples of it: a cache line, and enough for every number type.
  static constexpr std::uint64_t kAlignment = 64;

 private:
  struct Room {
    std::weak_ptr<std::byte> bytes;
    std::uint64_t size, offset;
  };
  UniqueFd fd_;
  std::uint64_t size_ = 0;
  std::vector<Room> rooms_;
};

/// A read-only mapping of a sealed memory file.
class MappedMemory {
 public:
  /// @throws std::runtime_error where the file lacks a seal (its sender could shrink it under the reader, or
  /// change it after it was checked) or cannot be mapped.
  static std::shared_ptr<const MappedMemory> map(const UniqueFd& fd);
  ~MappedMemory();
  MappedMemory(const MappedMemory&) = delete;
  MappedMemory& operator=(const MappedMemory&) = delete;

  [[nodiscard]] std::span<const std::byte> bytes() const noexcept { return {data_, size_}; }

 private:
  MappedMemory(const std::byte* data, std::size_t size) : data_(data), size_(size) {}
  const std::byte* data_;
  std::size_t size_;
};

}  // namespace palpate
