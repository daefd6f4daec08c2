#include "common/render/volume/voxels/volume_image.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/render/volume/voxels/brick_map.h"
#include "common/render/volume/voxels/coarse_image.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

template <typename T>
std::shared_ptr<const VolumeImage> image_of(std::vector<T> numbers, ScalarType type) {
  const int count = static_cast<int>(numbers.size());
  return make_volume_image(block_of({count, 1, 1}, Vec3(1.0), std::move(numbers), type), "s", "test");
}

TEST(VolumeImage, SharesNumbersThatTheGpuCanSample) {
  const DataSet bytes = block_of<std::uint8_t>({3, 1, 1}, Vec3(1.0), {0, 7, 255}, ScalarType::kUint8);
  const auto image = make_volume_image(bytes, "s", "test");
  EXPECT_EQ(image->type, ScalarType::kUint8);
  EXPECT_EQ(image->bytes.data(), bytes.arrays[0].bytes.data());
  EXPECT_EQ(image->lowest, 0.0);
  EXPECT_EQ(image->highest, 255.0);
  const DataSet floats = block_of<float>({2, 1, 1}, Vec3(1.0), {-1.5F, 2.5F}, ScalarType::kFloat32);
  EXPECT_EQ(make_volume_image(floats, "s", "test")->bytes.data(), floats.arrays[0].bytes.data());
}

TEST(VolumeImage, KeepsTheValuesOfSignedNumbers) {
  const auto shorts = image_of<std::int16_t>({-32768, -1, 0, 32767}, ScalarType::kInt16);
  EXPECT_EQ(shorts->type, ScalarType::kUint16);
  EXPECT_EQ(shorts->value(0), -32768.0);
  EXPECT_EQ(shorts->value(1), -1.0);
  EXPECT_EQ(shorts->value(3), 32767.0);
  EXPECT_EQ(shorts->lowest, -32768.0);
  const auto bytes = image_of<std::int8_t>({-128, 5, 127}, ScalarType::kInt8);
  EXPECT_EQ(bytes->type, ScalarType::kUint8);
  EXPECT_EQ(bytes->value(1), 5.0);
}

TEST(VolumeImage, SharesSignedNumbersAndGivesThemInOrder) {
  const DataSet block = block_of<std::int16_t>(
      {3, 3, 1}, Vec3(1.0), {-32768, -1024, -1, 0, 1, 40, 1000, 3071, 32767}, ScalarType::kInt16);
  const auto image = make_volume_image(block, "s", "test");
  EXPECT_EQ(image->bytes.data(), block.arrays[0].bytes.data());
  std::array<std::uint16_t, 4> some{};
  image->copy({{0, 0, 0}, {2, 2, 1}}, std::as_writable_bytes(std::span(some)).data());
  EXPECT_EQ(some, (std::array<std::uint16_t, 4>{0, 32768 - 1024, 32768, 32769}));
  const BrickRanges ranges = brick_ranges(*image);
  ASSERT_EQ(ranges.ranges.size(), 1U);
  EXPECT_EQ(ranges.ranges[0].lowest, 0.0F);
  EXPECT_EQ(ranges.ranges[0].highest, 65535.0F);

  const DataSet even =
      block_of<std::int16_t>({5, 5, 5}, Vec3(1.0), std::vector<std::int16_t>(125, -700), ScalarType::kInt16);
  const auto coarse = coarse_image(*make_volume_image(even, "s", "test"), 1);
  EXPECT_EQ(coarse->value(13), -700.0);
  EXPECT_EQ(coarse_image(*coarse, 1)->value(0), -700.0);
}

TEST(VolumeImage, ScalesWhatSinglePrecisionCannotHold) {
  const auto image = image_of<double>({-1e200, 0.0, 3e200}, ScalarType::kFloat64);
  EXPECT_EQ(image->type, ScalarType::kFloat32);
  EXPECT_NEAR(image->value(2) / 3e200, 1.0, 1e-7);
  EXPECT_NEAR(image->lowest / -1e200, 1.0, 1e-7);
  const auto tiny = image_of<float>({1e-38F, 3e-38F}, ScalarType::kFloat32);
  EXPECT_NEAR(tiny->value(1) / 3e-38, 1.0, 1e-6);
}

TEST(VolumeImage, ShowsNoValueWhereThereIsNone) {
  const float infinity = std::numeric_limits<float>::infinity();
  const auto image = image_of<float>({1.0F, infinity, std::nanf(""), 2.0F}, ScalarType::kFloat32);
  EXPECT_TRUE(std::isnan(image->number(1)));
  EXPECT_TRUE(std::isnan(image->number(2)));
  EXPECT_EQ(image->highest, 2.0);
  DataSet block = block_of<std::uint8_t>({3, 1, 1}, Vec3(1.0), {1, 2, 3}, ScalarType::kUint8);
  block.visible = {1, 1, 0};
  EXPECT_TRUE(std::isnan(make_volume_image(block, "s", "test")->number(2)));
  EXPECT_EQ(make_volume_image(block, "s", "test")->highest, 2.0);
  const auto none = image_of<float>({infinity}, ScalarType::kFloat32);
  EXPECT_GT(none->lowest, none->highest);
}

TEST(VolumeImage, TakesAComponent) {
  DataSet block = block_of<float>({4, 1, 1}, Vec3(1.0), {0.0F, 1.0F, 2.0F, 3.0F}, ScalarType::kFloat32);
  std::get<UniformTopology>(block.topology).points.x = 2;
  block.arrays[0].components = 2;
  block.arrays[0].tuples = 2;
  EXPECT_EQ(make_volume_image(block, "s", "test", 1)->value(1), 3.0);
  EXPECT_THROW((void)make_volume_image(block, "s", "test", 2), Error);
}

TEST(VolumeImage, IsOneStepThickAlongAnAxisOfOnePoint) {
  const auto image =
      make_volume_image(block_of<std::uint8_t>({3, 1, 2}, Vec3(2.0, 4.0, 1.0), std::vector<std::uint8_t>(6),
                                               ScalarType::kUint8),
                        "s", "test");
  EXPECT_EQ(image->bounds().size(), Vec3(4.0, 4.0, 1.0));
}

TEST(VolumeImage, RefusesWhatIsNoVolume) {
  const auto refusal = [](const DataSet& block, const std::string& array = "s") {
    try {
      (void)make_volume_image(block, array, "file");
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::kBadInput);
      return std::string(error.what());
    }
    return std::string("no error");
  };
  DataSet block =
      block_of<std::uint8_t>({2, 2, 2}, Vec3(1.0), std::vector<std::uint8_t>(8), ScalarType::kUint8);
  EXPECT_NE(refusal(block, "t").find("array t"), std::string::npos);
  auto& grid = std::get<UniformTopology>(block.topology);
  grid.axes[2] = grid.axes[1];
  EXPECT_NE(refusal(block).find("without volume"), std::string::npos);
  grid.axes[2] = Vec3(0.0, 0.0, 1.0);
  grid.points.x = 3;
  EXPECT_NE(refusal(block), "no error");
  block.topology = StructuredTopology{};
  EXPECT_NE(refusal(block).find("no grid along straight axes"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
