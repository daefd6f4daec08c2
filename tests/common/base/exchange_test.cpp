// What two threads exchange without waiting for each other: Ring and TripleBuffer. Run under ThreadSanitizer
// too, which would see a race on the values.

#include <array>
#include <cstdint>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/ring.h"
#include "common/base/triple_buffer.h"

namespace palpate::test {
namespace {

/// Several words that all say the same: a torn value shows.
struct Wide {
  std::array<std::uint64_t, 9> words{};

  static Wide of(std::uint64_t number) {
    Wide wide;
    wide.words.fill(number);
    return wide;
  }
  [[nodiscard]] bool whole() const {
    for (const auto word : words) {
      if (word != words[0]) return false;
    }
    return true;
  }
};

TEST(Ring, KeepsOrderAndCountsWhatItHadNoRoomFor) {
  Ring<int> ring(3);
  ASSERT_EQ(ring.capacity(), 4U);
  for (int i = 0; i < 4; ++i) EXPECT_TRUE(ring.push(i));
  EXPECT_FALSE(ring.push(4));
  EXPECT_FALSE(ring.push(5));
  EXPECT_EQ(ring.dropped(), 2U);
  int value = -1;
  for (int i = 0; i < 4; ++i) {
    ASSERT_TRUE(ring.pop(value));
    EXPECT_EQ(value, i);
  }
  EXPECT_FALSE(ring.pop(value));
  EXPECT_EQ(value, 3) << "untouched where the ring is empty";
  EXPECT_TRUE(ring.push(6));
  EXPECT_TRUE(ring.pop(value));
  EXPECT_EQ(value, 6);
}

TEST(Ring, DeliversEveryItemOnceInOrderBetweenTwoThreads) {
  constexpr std::uint64_t kItems = 200'000;
  Ring<Wide> ring(64);
  std::jthread producer([&ring] {
    for (std::uint64_t i = 1; i <= kItems;) {
      if (ring.push(Wide::of(i))) {
        ++i;
      } else {
        std::this_thread::yield();
      }
    }
  });
  Wide item;
  for (std::uint64_t expected = 1; expected <= kItems;) {
    if (!ring.pop(item)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(item.whole());
    ASSERT_EQ(item.words[0], expected++);
  }
  EXPECT_FALSE(ring.pop(item));
}

TEST(TripleBuffer, HandsOverTheLatestValueOnce) {
  TripleBuffer<int> buffer;
  int value = 7;
  EXPECT_FALSE(buffer.read(value));
  EXPECT_EQ(value, 7);
  for (int i = 1; i <= 5; ++i) buffer.write(i);
  EXPECT_TRUE(buffer.read(value));
  EXPECT_EQ(value, 5);
  EXPECT_FALSE(buffer.read(value));
  buffer.write(6);
  EXPECT_TRUE(buffer.read(value));
  EXPECT_EQ(value, 6);
}

TEST(TripleBuffer, NeverTearsNorGoesBackBetweenTwoThreads) {
  constexpr std::uint64_t kWrites = 200'000;
  TripleBuffer<Wide> buffer;
  std::jthread writer([&buffer] {
    for (std::uint64_t i = 1; i <= kWrites; ++i) {
      buffer.write(Wide::of(i));
      if (i % 64 == 0) std::this_thread::yield();
    }
  });
  std::uint64_t last = 0;
  Wide value;
  while (last < kWrites) {
    if (!buffer.read(value)) {
      std::this_thread::yield();
      continue;
    }
    ASSERT_TRUE(value.whole());
    ASSERT_GT(value.words[0], last);
    last = value.words[0];
  }
}

}  // namespace
}  // namespace palpate::test
