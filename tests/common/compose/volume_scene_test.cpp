// What is guessed of a volume from its values alone.
#include "common/compose/volume_scene.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/compose/label_volume.h"
#include "tests/common/render/volume/sample_volumes.h"

namespace palpate::test {
namespace {

/// PET over CT is spread over what tracers take up, and not over a voxel that says 1e20.
TEST(VolumeScene, FewFarValuesDoNotWidenAWindow) {
  const Index3 n(24, 22, 20);
  std::vector<float> numbers;
  for (int i = 0; i < n.x * n.y * n.z; ++i)
    numbers.push_back(static_cast<float>(8.0 * std::pow(i % 997 / 996.0, 3.0)));
  const auto window = [&] {
    return window_of_bulk(
        *make_volume_image(block_of(n, Vec3(1.0), numbers, ScalarType::kFloat32), "s", "test"), 1);
  };
  EXPECT_EQ(window(), (ValueWindow{.width = 8.0, .level = 4.0}));
  for (const float far : {1e5F, 1e20F, -1e30F}) {
    numbers[5] = far;
    numbers[77] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(window(), (ValueWindow{.width = 8.0, .level = 4.0})) << far;
  }
}

// Few of the voxels are looked at, but not down the same columns.
TEST(VolumeScene, LabelsAreSuspectedOfNoVolumeOfManyNumbers) {
  const Index3 n(64, 64, 128);
  std::vector<std::uint16_t> many, few;
  for (int k = 0; k < n.z; ++k)
    for (int j = 0; j < n.y; ++j)
      for (int i = 0; i < n.x; ++i) {
        many.push_back(static_cast<std::uint16_t>(i % 2 == 1 ? (64 * j + k) % 1000 : j % 2));
        few.push_back(static_cast<std::uint16_t>(j % 2));
      }
  const auto note = [&](std::vector<std::uint16_t> numbers) {
    return label_note(
        *make_volume_image(block_of(n, Vec3(1.0), std::move(numbers), ScalarType::kUint16), "s", "test"));
  };
  EXPECT_EQ(note(many), "");
  EXPECT_NE(note(few).find("are few, 2"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
