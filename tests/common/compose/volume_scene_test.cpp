// What is guessed of a volume from its values alone.
#include "common/compose/volume_scene.h"

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/compose/label_volume.h"
#include "common/compose/volume_fields.h"
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

// Both are found by going through all voxels.
TEST(VolumeScene, WindowsAndLensesOfOtherFieldsAreFoundWhereTheyAreAskedFor) {
  const Index3 n(9, 8, 7);
  std::vector<std::uint8_t> numbers;
  for (int i = 0; i < n.x * n.y * n.z; ++i) numbers.push_back(static_cast<std::uint8_t>(i % 200));
  VolumeView view;
  view.image = make_volume_image(block_of(n, Vec3(1.0), numbers, ScalarType::kUint8), "s", "test");
  view.fields = {volume_field(view.image, "other")};
  EXPECT_FALSE(view.fields[0].window.made());
  const VolumeView copy = view;
  EXPECT_EQ(copy.fields[0].window.get(), (ValueWindow{.width = 199.0, .level = 99.5}));
  EXPECT_TRUE(view.fields[0].window.made());

  const std::vector<Late<Lens>> lenses = lens_appearances(view, "", 1);
  ASSERT_EQ(lenses.size(), 2U);
  for (std::size_t field = 0; field < 2; ++field) {
    EXPECT_FALSE(lenses[field].made());
    EXPECT_EQ(lenses[field].get().field, field);
  }
  EXPECT_EQ(lenses[0].get().transfer, default_focus_transfer(*view.image, 1));
  EXPECT_EQ(lenses[1].get().transfer, default_color_transfer(*view.image, 1));
  EXPECT_TRUE(lens_appearances(view, "mr", 1)[0].made()) << "words may be refused";
  EXPECT_THROW((void)lens_appearances(view, "no such", 1), Error);
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
