#include "common/render/color/color_map.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/support/lab_color.h"

namespace palpate {
namespace {

double lightness(const Rgb& color) { return test::lab_from_srgb(Vec3(color)).x; }
double difference(const Rgb& a, const Rgb& b) {
  return glm::distance(test::lab_from_srgb(Vec3(a)), test::lab_from_srgb(Vec3(b)));
}

// Known values of CIELAB under D65: white, mid grey (#777777, L* = 50.03) and the sRGB primaries.
TEST(Lab, GivesTheKnownCoordinatesOfReferenceColours) {
  EXPECT_LT(glm::distance(test::lab_from_srgb(Vec3(1.0)), Vec3(100.0, 0.0, 0.0)), 0.01);
  EXPECT_NEAR(test::lab_from_srgb(Vec3(119.0 / 255.0)).x, 50.03, 0.01);
  EXPECT_LT(glm::distance(test::lab_from_srgb({1.0, 0.0, 0.0}), Vec3(53.24, 80.09, 67.20)), 0.02);
  EXPECT_LT(glm::distance(test::lab_from_srgb({0.0, 1.0, 0.0}), Vec3(87.74, -86.18, 83.18)), 0.02);
  EXPECT_LT(glm::distance(test::lab_from_srgb({0.0, 0.0, 1.0}), Vec3(32.30, 79.19, -107.86)), 0.02);
}

TEST(Lab, IsUndoneByItsInverse) {
  for (double r = 0.0; r <= 1.0; r += 0.25) {
    for (double g = 0.0; g <= 1.0; g += 0.25) {
      for (double b = 0.0; b <= 1.0; b += 0.25) {
        const Vec3 rgb{r, g, b};
        // The published matrices are rounded to seven digits.
        EXPECT_LT(glm::distance(srgb_from_lab(test::lab_from_srgb(rgb)), rgb), 1e-5);
      }
    }
  }
}

class SequentialMap : public ::testing::TestWithParam<ColorMap> {};

TEST_P(SequentialMap, LightnessRisesAllTheWay) {
  const auto& table = color_table(GetParam());
  for (std::size_t i = 1; i < table.size(); ++i) ASSERT_GT(lightness(table[i]), lightness(table[i - 1])) << i;
  EXPECT_GT(lightness(table.back()) - lightness(table.front()), 50.0);
}

// A colour out of gamut would be clipped, and the steps around it would not be even.
TEST_P(SequentialMap, NeighboursAreEquallyFarApart) {
  const auto& table = color_table(GetParam());
  const double mean = [&] {
    double sum = 0.0;
    for (std::size_t i = 1; i < table.size(); ++i) sum += difference(table[i], table[i - 1]);
    return sum / static_cast<double>(table.size() - 1);
  }();
  for (std::size_t i = 1; i < table.size(); ++i)
    ASSERT_NEAR(difference(table[i], table[i - 1]), mean, 0.02 * mean) << i;
}

INSTANTIATE_TEST_SUITE_P(ColorMap, SequentialMap, ::testing::Values(ColorMap::kSequential, ColorMap::kHeat));

// Forces are read off against dark and light backgrounds alike: yellow is the least, red the most.
TEST(TensionMap, FallsEvenlyFromYellowToRed) {
  const auto& table = color_table(ColorMap::kTension);
  const double mean = [&] {
    double sum = 0.0;
    for (std::size_t i = 1; i < table.size(); ++i) sum += difference(table[i], table[i - 1]);
    return sum / static_cast<double>(table.size() - 1);
  }();
  for (std::size_t i = 1; i < table.size(); ++i) {
    ASSERT_LT(lightness(table[i]), lightness(table[i - 1])) << i;
    ASSERT_NEAR(difference(table[i], table[i - 1]), mean, 0.02 * mean) << i;
  }
  EXPECT_GT(std::min(table.front().r, table.front().g), table.front().b + 0.5F);
  EXPECT_GT(table.back().r, std::max(table.back().g, table.back().b) + 0.5F);
}

TEST(DivergingMap, IsSymmetricalInLightnessAndBrightInTheMiddle) {
  const auto& table = color_table(ColorMap::kDiverging);
  const std::size_t n = table.size();
  for (std::size_t i = 0; i < n / 2; ++i) {
    ASSERT_NEAR(lightness(table[i]), lightness(table[n - 1 - i]), 3.0) << i;
    if (i > 0) {
      ASSERT_GT(lightness(table[i]), lightness(table[i - 1])) << i;
      ASSERT_LT(lightness(table[n - i]), lightness(table[n - 1 - i])) << i;
    }
  }
  const Vec3 middle = test::lab_from_srgb(Vec3(map_color(ColorMap::kDiverging, 0.5)));
  EXPECT_LT(std::hypot(middle.y, middle.z), 5.0);  // nearly grey
  EXPECT_GT(table.front().b, table.front().r);     // blue below, red above
  EXPECT_GT(table.back().r, table.back().b);
}

TEST(CategoricalMap, ColoursAreFarApart) {
  for (int a = 0; a < kCategoryCount; ++a) {
    for (int b = 0; b < a; ++b) {
      EXPECT_GT(difference(map_color(ColorMap::kCategorical, (a + 0.5) / kCategoryCount),
                           map_color(ColorMap::kCategorical, (b + 0.5) / kCategoryCount)),
                20.0);
    }
  }
}

TEST(ColorMap, ValuesBeyondTheEndsAndNanHaveColours) {
  for (int i = 0; i < kColorMapCount; ++i) {
    const auto map = static_cast<ColorMap>(i);
    EXPECT_EQ(map_color(map, -5.0), color_table(map).front());
    EXPECT_EQ(map_color(map, 7.0), color_table(map).back());
    const Rgb nan = map_color(map, std::nan(""));
    EXPECT_EQ(nan.r, nan.g);
    EXPECT_EQ(nan.g, nan.b);
  }
}

}  // namespace
}  // namespace palpate
