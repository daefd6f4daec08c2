#include "common/field/array_type.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"

namespace palpate {
namespace {

TEST(InType, RoundsWholeNumbersAndCountsThem) {
  const std::vector<double> values{-3.0, 0.5, -0.5, 2.4, 127.0};
  const TypedArray typed = in_type(values, ScalarType::kInt8);
  EXPECT_EQ(typed.rounded, 3U);
  const std::vector<double> wanted{-3.0, 1.0, -1.0, 2.0, 127.0};
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(typed.array.at(i), wanted[i]);
}

TEST(InType, KeepsWhatFractionsHold) {
  const std::vector<double> values{0.1, 0.25, std::nan(""), std::numeric_limits<double>::infinity()};
  const TypedArray single = in_type(values, ScalarType::kFloat32);
  EXPECT_EQ(single.rounded, 1U);  // 0.1
  EXPECT_TRUE(std::isnan(single.array.at(2)));
  EXPECT_TRUE(std::isinf(single.array.at(3)));
  EXPECT_EQ(in_type(values, ScalarType::kFloat64).rounded, 0U);
}

TEST(ClampedTo, CountsWhatATypeDoesNotHold) {
  const std::vector<double> values{-300.0, 0.5, 12.0, 128.0, std::nan(""), HUGE_VAL};
  const ClampedArray taken = clamped_to(
      make_array("ct", Association::kPoint, 1, std::span<const double>(values)), ScalarType::kInt8);
  EXPECT_EQ(taken.array.name, "ct");
  EXPECT_EQ(taken.clamped, 3U);
  EXPECT_EQ(taken.rounded, 1U);
  EXPECT_EQ(taken.missing, 1U);
  const std::vector<double> wanted{-128.0, 1.0, 12.0, 127.0, 0.0, 127.0};
  for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_EQ(taken.array.at(i), wanted[i]) << i;
}

// The ends of every type, and the next number beyond them that a double has.
TEST(InType, RefusesWhatATypeDoesNotReach) {
  const auto check = [](ScalarType type, double lowest, double beyond_lowest, double highest, double beyond) {
    EXPECT_TRUE(reaches(type, lowest)) << name_of(type);
    EXPECT_TRUE(reaches(type, highest)) << name_of(type);
    for (const double bad : {beyond_lowest, beyond, std::nan(""), HUGE_VAL}) {
      EXPECT_FALSE(reaches(type, bad)) << name_of(type) << " " << bad;
      EXPECT_THROW((void)in_type(std::span(&bad, 1), type), Error);
    }
  };
  check(ScalarType::kInt8, -128.4, -128.5, 127.4, 127.5);
  check(ScalarType::kUint8, -0.4, -0.5, 255.4, 255.5);
  check(ScalarType::kInt16, -32768.0, -32769.0, 32767.0, 32768.0);
  check(ScalarType::kUint16, 0.0, -1.0, 65535.0, 65536.0);
  check(ScalarType::kInt32, -0x1p31, -0x1p31 - 1.0, 0x1p31 - 1.0, 0x1p31);
  check(ScalarType::kUint32, 0.0, -1.0, 0x1p32 - 1.0, 0x1p32);
  check(ScalarType::kInt64, -0x1p63, -0x1p63 - 2048.0, 0x1p63 - 1024.0, 0x1p63);
  check(ScalarType::kUint64, 0.0, -1.0, 0x1p64 - 2048.0, 0x1p64);
  EXPECT_TRUE(reaches(ScalarType::kFloat32, 3e38));
  EXPECT_FALSE(reaches(ScalarType::kFloat32, 1e39));
}

// Parcels of many numbers and masks are labels; a ramp, and what is measured, are not.
TEST(LooksLikeLabels, TellsPartsFromMeasurements) {
  const Index3 n{60, 20, 20};
  const auto volume = [&](auto f) {
    std::vector<double> values;
    for (int z = 0; z < n.z; ++z)
      for (int y = 0; y < n.y; ++y)
        for (int x = 0; x < n.x; ++x) values.push_back(f(x, y, z));
    return in_type(values, ScalarType::kInt32).array;
  };
  EXPECT_TRUE(looks_like_labels(volume([](int x, int, int) { return x > 30 ? 1 : 0; }), n));
  EXPECT_TRUE(looks_like_labels(
      volume([](int x, int y, int z) { return 1000 + x / 12 + 5 * (y / 4) + 25 * (z / 4); }), n));
  EXPECT_FALSE(looks_like_labels(volume([](int x, int y, int z) { return 7 * x + 11 * y + 13 * z; }), n));
  const std::vector<double> mask{0.0, 1.0};
  EXPECT_FALSE(looks_like_labels(in_type(mask, ScalarType::kFloat32).array, {2, 1, 1}));
}

}  // namespace
}  // namespace palpate
