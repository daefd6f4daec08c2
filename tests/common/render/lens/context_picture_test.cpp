// Pictures whose context is drawn by itself, smaller or from coarser voxels, against pictures drawn in one
// go.

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/volume/volume_picture.h"
#include "tests/common/render/lens/sample_lenses.h"
#include "tests/support/reference_ray.h"

namespace palpate::test {
namespace {

constexpr int kWidth = 90, kHeight = 66;  // no multiples of what is saved
constexpr double kAlmostAll = 0.9999;     // as many pixels, in almost the same places

double rms_difference(const FloatImage& a, const FloatImage& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgba.size(); ++i) {
    const double off = static_cast<double>(a.rgba[i]) - static_cast<double>(b.rgba[i]);
    sum += off * off;
  }
  return std::sqrt(sum / static_cast<double>(a.rgba.size()));
}

VolumeView with_context(VolumeView view, double viewport, int level = 0) {
  view.context.viewport = viewport;
  view.context.level = level;
  view.context.table_entries = view.table_entries;
  return view;
}

class ContextPicture : public testing::Test {
 protected:
  VolumePicture whole_{kWidth, kHeight}, split_{kWidth, kHeight};

  // Worst difference of a picture whose context is drawn by itself with as many pixels.
  void expect_same(const VolumeView& view, const Camera& camera, const std::string& what,
                   const std::vector<float>& depth = {}) {
    const FloatImage expected = whole_.draw(view, camera, depth);
    const FloatImage drawn = split_.draw(with_context(view, kAlmostAll), camera, depth);
    EXPECT_LE(worst_difference(drawn, expected), 2.0 / 255.0) << what;
    EXPECT_GT(split_.cost().context_bytes, 0U) << what;
  }
};

TEST_F(ContextPicture, OfAsManyPixelsChangesNothing) {
  std::vector<std::pair<std::string, VolumeView>> views;
  for (const auto& [name, lens] : lenses()) {
    VolumeView view = plain_view();
    view.lenses = {lens};
    views.emplace_back(name, view);
    view.lenses[0].cut = true;
    views.emplace_back(name + ", cut away", view);
  }
  VolumeView two = plain_view();
  two.lenses = {lenses()[0].lens, lenses()[2].lens};
  views.emplace_back("two lenses", two);
  two.lenses[1] = Lens{make_sphere({-0.5, 0.6, -0.6}, 0.3)};  // apart: with context between
  views.emplace_back("two lenses apart", two);
  two.shading = true;
  views.emplace_back("under light", two);
  two.cuts = {{.kept = {glm::normalize(Vec3(1.0, 2.0, -0.5)), 0.1}}};
  views.emplace_back("cut by a plane", two);
  VolumeView enlarged = plain_view();
  enlarged.lenses = {lenses()[0].lens};
  enlarged.lenses[0].magnification = 2.0;
  views.emplace_back("magnified", enlarged);
  for (const auto& [name, view] : views) {
    for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic})
      expect_same(view, camera_of(view, {.azimuth = 25.0, .elevation = 15.0}, projection), name);
    Camera inside = camera_of(view);
    inside.focal_point = Vec3(0.05, 0.05, 0.0);
    inside.view_height = 0.1;
    expect_same(view, inside, name + ", from inside");
  }
}

// Values, not colours, go over from the coarser voxels to those of the lens.
TEST(Transition, AgreesWithTheReferenceForEveryShape) {
  constexpr int kSize = 56;
  constexpr double kSamples = 40.0, kBound = 2.0 / 255.0;
  VolumePicture picture(kSize, kSize);
  VolumeView view = with_context(plain_view(), 1.0, 2);
  view.transfer = focus_colors();
  view.samples_per_voxel = 8.0;  // of coarse ones
  std::vector<NamedLens> all = lenses();
  all.push_back({"screen", all[0].lens});
  all.back().lens.shape = {};
  all.back().lens.screen = ScreenCircle{.x = 0.05, .y = 0.0, .radius = 0.25};
  for (NamedLens& one : all) {
    view.lenses = {one.lens};
    view.lenses[0].transfer.reset();
    const Camera camera = camera_of(view);
    const FloatImage hard = picture.draw(view, camera);
    view.lenses[0].transition = 0.6;
    if (!has_transition(view.lenses[0])) {
      EXPECT_EQ(one.name, "half-space");
      continue;
    }
    const FloatImage soft = picture.draw(view, camera);
    EXPECT_GT(worst_difference(soft, hard), 0.02) << one.name << " does not blend";
    const Comparison result = compare(soft, ReferenceRay(view, camera, kSize, kSize, kSamples), kBound);
    EXPECT_LE(result.worst, kBound) << one.name << ": " << result.beyond_bound << " pixels";
    EXPECT_LE(result.exempt, kSize * kSize / 200) << one.name;
  }
}

// Without coarser voxels there is nothing to go over into.
TEST(Transition, ChangesNothingWhereVoxelsAreTheSame) {
  VolumePicture picture(kWidth, kHeight);
  VolumeView view = with_context(plain_view(), 0.5);
  view.lenses = {lenses()[0].lens};
  const Camera camera = camera_of(view);
  const FloatImage hard = picture.draw(view, camera);
  view.lenses[0].transition = 1.0;
  EXPECT_EQ(worst_difference(picture.draw(view, camera), hard), 0.0);
}

TEST_F(ContextPicture, EndsAtOpaqueThings) {
  VolumeView view = plain_view();
  view.lenses = {lenses()[0].lens};
  const Camera camera = camera_of(view);
  std::vector<float> depth;
  for (int i = 0; i < kWidth * kHeight; ++i)
    depth.push_back(i % kWidth < 30 ? 0.1F : i % kWidth < 60 ? 0.5F : 1.0F);
  expect_same(view, camera, "three depths", depth);
  // Smaller, nothing of what lies behind the nearest thing, before which there is nothing, is drawn over it.
  const FloatImage whole = whole_.draw(view, camera, depth);
  const FloatImage small = split_.draw(with_context(view, 0.3), camera, depth);
  for (int y = 0; y < kHeight; ++y) {
    for (int x = 0; x < 30; ++x) {
      ASSERT_EQ(whole.at(x, y)[3], 0.0);
      EXPECT_EQ(small.at(x, y)[3], 0.0) << x << ' ' << y;
    }
  }
}

// What is red stays where the lens is, up to the pixel.
TEST_F(ContextPicture, DoesNotFrayAtTheBordersOfLenses) {
  const ColorTransfer red({{0.0, {1.0F, 0.0F, 0.0F}, 0.4}, {1.0, {1.0F, 0.0F, 0.0F}, 0.4}});
  const ColorTransfer blue({{0.0, {0.0F, 0.0F, 1.0F}, 0.004}, {1.0, {0.0F, 0.0F, 1.0F}, 0.004}});
  for (const auto& [name, lens] : lenses()) {
    VolumeView view = plain_view();
    view.transfer = blue;
    view.lenses = {lens};
    view.lenses[0].transfer = red;
    const Camera camera = camera_of(view);
    const FloatImage whole = whole_.draw(view, camera);
    const FloatImage small = split_.draw(with_context(view, 0.2), camera);
    int with_red = 0, without_red = 0;
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const Rgba expected = whole.at(x, y), drawn = small.at(x, y);
        EXPECT_EQ(drawn[0] > 0.0, expected[0] > 0.0) << name << ' ' << x << ' ' << y;
        ++(expected[0] > 0.0 ? with_red : without_red);
      }
    }
    EXPECT_GT(std::min(with_red, without_red), 300) << name;
  }
}

TEST_F(ContextPicture, ComesCloserWithItsPixelsAndVoxels) {
  VolumeView view = plain_view();
  view.lenses = {lenses()[0].lens};
  const Camera camera = camera_of(view);
  const FloatImage whole = whole_.draw(view, camera);
  const auto error = [&](double viewport, int level) {
    return rms_difference(split_.draw(with_context(view, viewport, level), camera), whole);
  };
  const double quarter = error(0.25, 0), half = error(0.5, 0);
  EXPECT_GT(quarter, 1.5 * half);
  EXPECT_LT(half, 0.02);
  const double coarser = error(kAlmostAll, 2), coarse = error(kAlmostAll, 1);
  EXPECT_GT(coarser, 1.5 * coarse);
  EXPECT_GT(coarse, 0.0);
}

// Where a lens holds all that is seen, it is as fine as ever.
TEST_F(ContextPicture, LeavesLensesAsTheyAre) {
  VolumeView view = plain_view();
  view.lenses = {lenses()[0].lens};
  view.lenses[0].shape = make_sphere({0.0, 0.0, 0.0}, 10.0);
  const Camera camera = camera_of(view);
  EXPECT_LT(worst_difference(split_.draw(with_context(view, 0.25, 3), camera), whole_.draw(view, camera)),
            1.0 / 255.0);
}

TEST_F(ContextPicture, IsMadeOnlyWhereThereAreLenses) {
  const VolumeView none = with_context(plain_view(), 0.5, 1);
  (void)split_.draw(none, camera_of(none));
  EXPECT_EQ(split_.cost().context_bytes, 0U);
}

}  // namespace
}  // namespace palpate::test
