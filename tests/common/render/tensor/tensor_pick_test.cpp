#include <limits>

#include <gtest/gtest.h>

#include "common/render/tensor/tensor_view.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

constexpr int kWidth = 300, kHeight = 200;

TensorView sample_view() {
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  const Mat3 axes{Vec3{0.1, 0.02, 0.0}, Vec3{-0.02, 0.1, 0.0}, Vec3{0.0, 0.01, -0.1}};
  const auto image = sampled_tensors(centred_lattice({20, 18, 16}, axes), [&](const Vec3& x) {
    return x.x > 0.4 ? Mat3(nothing) : linear_tensor(glm::normalize(x + Vec3(3.0, 0.0, 0.0)));
  });
  return {.image = image, .position = image->position({9.0, 8.0, 7.0})};
}

TEST(PickSlice, FindsThePointThatWasDrawnThere) {
  const TensorView view = sample_view();
  for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
    const Camera camera = make_camera(view.image->bounds(), {}, 1.5, projection);
    int found = 0;
    for (const Vec3& g :
         {Vec3{9.0, 3.2, 11.4}, Vec3{4.2, 8.0, 12.7}, Vec3{5.3, 3.1, 7.0}, Vec3{9.0, 12.0, 2.0}}) {
      const Vec3 p = project(camera, view.image->position(g), kWidth, kHeight);
      const auto pick = pick_slice(view, camera, kWidth, kHeight, p.x, p.y);
      ASSERT_TRUE(pick);
      const Vec3 again = project(camera, pick->position, kWidth, kHeight);
      EXPECT_NEAR(again.x, p.x, 1e-6);
      EXPECT_NEAR(again.y, p.y, 1e-6);
      // Another slice may lie in front, never behind.
      EXPECT_LE(again.z, p.z + 1e-9);
      if (std::abs(again.z - p.z) > 1e-9) continue;
      ++found;
      EXPECT_EQ(pick->voxel, Index3(glm::round(g)));
      EXPECT_EQ(pick->tensor, view.image->field->voxel(pick->voxel).value);
    }
    EXPECT_GE(found, 2);
  }
}

TEST(PickSlice, SlicesAreOpenWhereThereIsNoTensorAndOutside) {
  TensorView view = sample_view();
  view.slices = {false, false, true};
  const Camera camera = make_camera(view.image->bounds(), {.azimuth = 0.0, .elevation = 90.0}, 1.5);
  const auto at = [&](const Vec3& g) {
    const Vec3 p = project(camera, view.image->position(g), kWidth, kHeight);
    return pick_slice(view, camera, kWidth, kHeight, p.x, p.y);
  };
  ASSERT_TRUE(at({5.0, 5.0, 7.0}));
  EXPECT_EQ(at({5.0, 5.0, 7.0})->axis, 2);
  EXPECT_FALSE(at({18.0, 9.0, 7.0}));  // no tensor
  EXPECT_FALSE(at({5.0, 40.0, 7.0}));  // outside
  view.slices = {false, false, false};
  EXPECT_FALSE(at({5.0, 5.0, 7.0}));
}

}  // namespace
}  // namespace palpate::test
