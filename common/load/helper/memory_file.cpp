#include "common/load/helper/memory_file.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <stdexcept>
#include <system_error>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

#include "common/base/index.h"

namespace palpate {
namespace {

constexpr int kSeals = F_SEAL_SHRINK | F_SEAL_GROW | F_SEAL_WRITE;

[[noreturn]] void fail(const char* what) { throw std::system_error(errno, std::generic_category(), what); }

}  // namespace

MemoryFile::MemoryFile() : fd_(::memfd_create("palpate", MFD_CLOEXEC | MFD_ALLOW_SEALING)) {
  if (!fd_) fail("memfd_create");
}

std::shared_ptr<std::byte> MemoryFile::room(std::uint64_t bytes) {
  static const auto page = static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  const std::uint64_t offset = (size_ + page - 1) / page * page, end = offset + bytes;
  if (::ftruncate(fd_.get(), static_cast<off_t>(end)) != 0) fail("ftruncate");
  if (bytes == 0) return nullptr;
  void* data =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_SHARED, fd_.get(), static_cast<off_t>(offset));
  if (data == MAP_FAILED) fail("mmap");
  std::shared_ptr<std::byte> room(static_cast<std::byte*>(data),
                                  [bytes](std::byte* at) { ::munmap(at, bytes); });
  size_ = end;
  rooms_.push_back({room, bytes, offset});
  return room;
}

std::uint64_t MemoryFile::append(std::span<const std::byte> bytes) {
  for (const Room& room : rooms_) {
    const auto first = room.bytes.lock();
    if (first && bytes.data() == first.get() && bytes.size() <= room.size) return room.offset;
  }
  const std::uint64_t offset = (size_ + kAlignment - 1) / kAlignment * kAlignment;
  // A gap that is never written reads as zeros; an empty array still needs the file to reach its offset.
  if (bytes.empty() && offset != size_ && ::ftruncate(fd_.get(), static_cast<off_t>(offset)) != 0) {
    fail("ftruncate");
  }
  std::uint64_t written = 0;
  while (written < bytes.size()) {
    // Linux writes at most 2^31 - 4096 bytes at a time.
    const std::size_t part = std::min<std::size_t>(bytes.size() - written, std::size_t{1} << 30);
    const ssize_t done =
        ::pwrite(fd_.get(), bytes.data() + written, part, static_cast<off_t>(offset + written));
    if (done < 0 && errno == EINTR) continue;
    if (done <= 0) fail("write to shared memory");
    written += static_cast<std::uint64_t>(done);
  }
  size_ = offset + bytes.size();
  return offset;
}

void MemoryFile::seal() {
  if (::fcntl(fd_.get(), F_ADD_SEALS, kSeals | F_SEAL_SEAL) != 0) fail("F_ADD_SEALS");
}

std::shared_ptr<const MappedMemory> MappedMemory::map(const UniqueFd& fd) {
  const int seals = ::fcntl(fd.get(), F_GET_SEALS);
  if (seals < 0 || (seals & kSeals) != kSeals) throw std::runtime_error("shared memory is not sealed");
  struct stat status {};
  if (::fstat(fd.get(), &status) != 0 || status.st_size < 0)
    throw std::runtime_error("shared memory has no size");
  const auto size = as_size(status.st_size);
  if (size == 0) return std::shared_ptr<const MappedMemory>(new MappedMemory(nullptr, 0));
  void* data = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, fd.get(), 0);
  if (data == MAP_FAILED) throw std::runtime_error("shared memory cannot be mapped");
  return std::shared_ptr<const MappedMemory>(new MappedMemory(static_cast<const std::byte*>(data), size));
}

MappedMemory::~MappedMemory() {
  if (data_ != nullptr) ::munmap(const_cast<std::byte*>(data_), size_);
}

}  // namespace palpate
