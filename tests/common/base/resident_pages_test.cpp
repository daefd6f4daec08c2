#include <cstdint>
#include <vector>

#include <gtest/gtest.h>
#include <sys/mman.h>
#include <unistd.h>

#include "common/base/memory.h"

namespace palpate {
namespace {

constexpr std::size_t kBytes = std::size_t{64} << 20U;

/// Pages of [memory, memory + kBytes) that are there.
std::size_t resident(void* memory) {
  const auto page = static_cast<std::size_t>(sysconf(_SC_PAGESIZE));
  std::vector<unsigned char> there(kBytes / page);
  if (mincore(memory, kBytes, there.data()) != 0) return 0;
  std::size_t count = 0;
  for (const unsigned char each : there) count += each & 1U;
  return count * page;
}

TEST(ResidentPages, AreThereBeforeTheFirstWriteAndZero) {
  void* memory = mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  ASSERT_NE(memory, MAP_FAILED);
#ifdef MADV_POPULATE_WRITE
  if (madvise(memory, 1, MADV_POPULATE_WRITE) == 0) {
    make_resident(memory, kBytes, 2);
    EXPECT_GT(resident(memory), kBytes / 2);  // pieces at either end may be left
  }
#endif
  const auto* bytes = static_cast<const std::uint8_t*>(memory);
  for (std::size_t i = 0; i < kBytes; i += 4096) ASSERT_EQ(bytes[i], 0U);
  munmap(memory, kBytes);
}

TEST(ResidentPages, KeepWhatIsInThemAndTakeAnyPiece) {
  std::vector<std::uint8_t> bytes(kBytes + 77);
  for (std::size_t i = 0; i < bytes.size(); i += 1021) bytes[i] = static_cast<std::uint8_t>(i);
  make_resident(bytes.data() + 13, bytes.size() - 13, 2);
  make_resident(bytes.data(), 5, 2);
  make_resident(nullptr, 0, 0);
  for (std::size_t i = 0; i < bytes.size(); i += 1021) ASSERT_EQ(bytes[i], static_cast<std::uint8_t>(i));
}

}  // namespace
}  // namespace palpate
