// Rectilinear volumes of uneven steps look as the same field on an even grid that has all their points.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "common/render/slice/slice_raster.h"
#include "common/render/volume/volume_picture.h"
#include "common/render/volume/voxels/value_gradient.h"
#include "tests/common/render/lens/sample_lenses.h"

namespace palpate::test {
namespace {

constexpr int kSize = 64;
constexpr double kLevel = 1.0 / 255.0;
using Lines = std::array<std::vector<double>, 3>;

/// One field on both grids.
struct Pair {
  std::shared_ptr<const VolumeImage> uneven, even;
};

/// @param lines whole numbers that rise or fall. @param value at a point of them. The even grid has a point at each whole
/// number, with the values that are trilinear between those.
Pair pair_of(const Lines& lines, const std::function<double(const Index3&)>& value) {
  Index3 coarse{0}, fine{0};
  UniformTopology grid;
  for (int a = 0; a < 3; ++a) {
    const std::vector<double>& x = lines[static_cast<std::size_t>(a)];
    const double length = x.back() - x.front();
    coarse[a] = static_cast<int>(x.size());
    fine[a] = static_cast<int>(std::abs(length)) + 1;
    grid.origin[a] = x.front();
    grid.axes[a] = Vec3{0.0};
    grid.axes[a][a] = length < 0.0 ? -1.0 : 1.0;
  }
  grid.points = fine;
  std::vector<float> values, between;
  for (int k = 0; k < coarse.z; ++k) {
    for (int j = 0; j < coarse.y; ++j) {
      for (int i = 0; i < coarse.x; ++i) values.push_back(static_cast<float>(value({i, j, k})));
    }
  }
  DataSet block = block_of(coarse, Vec3(1.0), std::move(values), ScalarType::kFloat32);
  const DataArray& known = block.arrays.front();
  block.topology = RectilinearTopology{lines};
  const auto at = [&](const Index3& p) {
    Index3 low{0};
    Vec3 part{0.0};
    for (int a = 0; a < 3; ++a) {
      const std::vector<double>& x = lines[static_cast<std::size_t>(a)];
      const double place = grid.origin[a] + p[a] * grid.axes[a][a];
      while (low[a] + 2 < coarse[a] &&
             (place - x[static_cast<std::size_t>(low[a]) + 1]) * grid.axes[a][a] >= 0.0)
        ++low[a];
      const double from = x[static_cast<std::size_t>(low[a])], to = x[static_cast<std::size_t>(low[a]) + 1];
      part[a] = (place - from) / (to - from);
    }
    double sum = 0.0;
    for (unsigned corner = 0; corner < 8; ++corner) {
      double weight = 1.0;
      std::size_t index = 0, row = 1;
      for (int a = 0; a < 3; ++a) {
        const bool far = (corner >> static_cast<unsigned>(a) & 1U) != 0;
        weight *= far ? part[a] : 1.0 - part[a];
        index += row * static_cast<std::size_t>(low[a] + (far ? 1 : 0));
        row *= static_cast<std::size_t>(coarse[a]);
      }
      if (weight > 0.0) sum += weight * known.at(index);
    }
    return sum;
  };
  for (int k = 0; k < fine.z; ++k) {
    for (int j = 0; j < fine.y; ++j) {
      for (int i = 0; i < fine.x; ++i) between.push_back(static_cast<float>(at({i, j, k})));
    }
  }
  DataSet even = block_of(fine, Vec3(1.0), std::move(between), ScalarType::kFloat32);
  even.topology = grid;
  return {make_volume_image(block, "s", "test"), make_volume_image(even, "s", "test")};
}

double waves(const Index3& p) {
  return 0.5 + 0.5 * std::cos(0.9 * p.x) * std::cos(1.1 * p.y + 0.4) * std::cos(0.7 * p.z);
}

const Lines kLines{
    std::vector<double>{0, 1, 2, 4, 8, 9, 16, 24}, {0, 5, 6, 7, 14, 20}, {0, 3, 4, 12, 13, 18}};

VolumeView view_of(const std::shared_ptr<const VolumeImage>& image) {
  VolumeView view;
  view.image = image;
  view.transfer = layered(0.0, 1.0);
  view.opacity_length = 1.0;
  view.shading = false;
  view.samples_per_voxel = 8.0;
  return view;
}

class UnevenPictures : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    uneven_ = std::make_unique<VolumePicture>(kSize, kSize);
    even_ = std::make_unique<VolumePicture>(kSize, kSize, VolumePicture::Context::kCurrent);
  }
  static void TearDownTestSuite() {
    even_.reset();
    uneven_.reset();
  }

  /// @param change what is done to the views of both.
  static void expect_same(
      const Pair& pair, const std::string& what,
      const std::function<void(VolumeView&)>& change = [](VolumeView&) {}, double most = kLevel) {
    VolumeView uneven = view_of(pair.uneven), even = view_of(pair.even);
    change(uneven);
    change(even);
    for (const Projection projection : {Projection::kPerspective, Projection::kOrthographic}) {
      const Camera camera = camera_of(even, {.azimuth = 35.0, .elevation = 25.0}, projection);
      const FloatImage wanted = even_->draw(even, camera);
      EXPECT_GT(*std::max_element(wanted.rgba.begin(), wanted.rgba.end()), 0.1F) << what;
      EXPECT_LE(worst_difference(uneven_->draw(uneven, camera), wanted), most) << what;
    }
  }

  static inline std::unique_ptr<VolumePicture> uneven_, even_;
};

TEST_F(UnevenPictures, LookAsTheSameFieldOnAnEvenGrid) {
  ASSERT_NE(pair_of(kLines, waves).uneven->lines, nullptr);
  expect_same(pair_of(kLines, waves), "all axes");
  for (std::size_t a = 0; a < 3; ++a) {
    Lines one{std::vector<double>{0, 4, 8, 12, 16}, {0, 4, 8, 12, 16}, {0, 4, 8, 12, 16}};
    one[a] = kLines[a];
    expect_same(pair_of(one, waves), "axis " + std::to_string(a));
  }
}

TEST_F(UnevenPictures, LookAsTheSameFieldAlongAxesThatFallAndOfOneCell) {
  Lines falling = kLines;
  std::reverse(falling[0].begin(), falling[0].end());
  std::reverse(falling[2].begin(), falling[2].end());
  expect_same(pair_of(falling, waves), "falling");
  for (std::size_t a = 0; a < 3; ++a) {
    Lines thin = kLines;
    thin[a] = {0, 7};
    expect_same(pair_of(thin, waves), "one cell along axis " + std::to_string(a));
  }
}

TEST_F(UnevenPictures, LookAsTheSameFieldWhereStepsAreAThousandTimesOthers) {
  const Lines far{std::vector<double>{0, 500, 501, 502, 1502}, {0, 100, 900, 1500}, {0, 2, 4}};
  expect_same(pair_of(far, waves), "1 : 1000", [](VolumeView& view) {
    view.opacity_length = 2.0;
    view.samples_per_voxel = 8.0;
  });
}

TEST_F(UnevenPictures, ShowNothingInCellsWithoutAValueAndAllElse) {
  const auto holed = [](const Index3& p) {
    return p == Index3(3, 2, 2) ? std::numeric_limits<double>::quiet_NaN() : waves(p);
  };
  expect_same(
      pair_of(kLines, holed), "a hole", [](VolumeView& view) { view.samples_per_voxel = 32.0; },
      3.0 * kLevel);
  // What lies behind the hole is seen to its wall: a lone sheet of one cell beside it.
  const auto sheet = [](const Index3& p) {
    return p.x < 4 ? std::numeric_limits<double>::quiet_NaN() : p.x == 4 ? 1.0 : 0.0;
  };
  expect_same(
      pair_of(kLines, sheet), "beside a hole",
      [](VolumeView& view) { view.samples_per_voxel = 64.0, view.opacity_length = 0.5; }, 3.0 * kLevel);
}

TEST_F(UnevenPictures, LookTheSameInBricksCutByPlanesAndThroughLenses) {
  const Pair pair = pair_of(kLines, waves);
  expect_same(pair, "bricks", [](VolumeView& view) { view.storage.brick_cells = 8; });
  expect_same(pair, "no leaps", [](VolumeView& view) { view.skip_empty = false; });
  expect_same(pair, "a plane with its values", [](VolumeView& view) {
    CuttingPlane cut;
    cut.kept.outward = glm::normalize(Vec3(0.3, -0.8, 0.5));
    cut.kept.offset = glm::dot(cut.kept.outward, Vec3(11.5, 9.7, 8.2));
    view.cuts = {cut};
    view.planes.shown = true;
  });
  expect_same(pair, "a lens", [](VolumeView& view) {
    Lens lens;
    lens.shape = lenses().front().lens.shape;
    lens.shape.quadric->center = Vec3(12, 10, 9);
    lens.shape.quadric->unit_from_data = Mat3(1.0 / 6.0);
    lens.transfer = ColorTransfer({{0.0, {1.0F, 0.2F, 0.1F}, 0.05}, {1.0, {0.1F, 0.4F, 1.0F}, 0.3}});
    lens.shading = false;
    lens.samples_per_voxel = 8.0;
    view.lenses = {lens};
  });
}

// Light, lines and regions go by differences of a voxel to either side, and coarser voxels are means of two: both are others
// on other grids.
TEST_F(UnevenPictures, LookAlikeInEveryOtherWay) {
  const Pair pair = pair_of(kLines, waves);
  const auto with_colors = [](const std::shared_ptr<const VolumeImage>& image) {
    auto colored = std::make_shared<VolumeImage>(*image);
    colored->colors = std::make_shared<std::vector<std::array<std::uint8_t, 4>>>(
        image->point_count(), std::array<std::uint8_t, 4>{200, 90, 30, 0});
    return std::shared_ptr<const VolumeImage>(std::move(colored));
  };
  const auto ball = [](double radius) {
    Lens lens;
    lens.shape = lenses().front().lens.shape;
    lens.shape.quadric->center = Vec3(12, 10, 9);
    lens.shape.quadric->unit_from_data = Mat3(1.0 / radius);
    return lens;
  };
  struct Way {
    std::string name;
    double most;  ///< by which pictures may differ, of all light
    std::function<void(VolumeView&)> change;
  };
  const std::vector<Way> ways{
      {"light", 0.1, [](VolumeView& view) { view.shading = true; }},
      {"shadows", 0.1, [](VolumeView& view) { view.shading = view.shadows = true; }},
      {"lines", 0.4, [](VolumeView& view) { view.illustrated = true; }},
      {"regions", 0.5,
       [](VolumeView& view) {
         view.regions = spread(boundary_regions(), PlaceRange{{0.0, 0.0}, {1.0, 0.3}});
       }},
      {"colours", 0.01,
       [&](VolumeView& view) {
         view.image = with_colors(view.image);
         view.colored = true;
       }},
      {"a lens that enlarges", 0.01,
       [&](VolumeView& view) {
         view.lenses = {ball(6.0)};
         view.lenses.front().magnification = 2.0;
       }},
      {"a context alone", 0.1,
       [&](VolumeView& view) {
         view.lenses = {ball(8.0)};
         view.context = {.viewport = 0.5, .level = 0};
       }},
      {"a context alone, coarser, with values that go over", 0.8,
       [&](VolumeView& view) {
         view.lenses = {ball(8.0)};
         view.lenses.front().transition = 0.5;
         view.context = {.viewport = 0.5, .level = 1};
       }},
      {"another field", 0.01,
       [&](VolumeView& view) {
         view.fields = {{view.image, "other"}};
         view.lenses = {ball(6.0)};
         view.lenses.front().field = 1;
         view.lenses.front().transfer = layered(0.0, 1.0);
       }},
  };
  const VolumeView plain = view_of(pair.even);
  const Camera camera = camera_of(plain, {.azimuth = 35.0, .elevation = 25.0});
  for (const Way& way : ways) {
    VolumeView uneven = view_of(pair.uneven), even = plain;
    way.change(uneven);
    way.change(even);
    const FloatImage wanted = even_->draw(even, camera), drawn = uneven_->draw(uneven, camera);
    double off = 0.0, all = 0.0;
    for (std::size_t i = 0; i < wanted.rgba.size(); ++i) {
      off += std::abs(static_cast<double>(drawn.rgba[i] - wanted.rgba[i]));
      all += static_cast<double>(wanted.rgba[i]);
    }
    EXPECT_GT(all, 10.0) << way.name;
    EXPECT_LT(off, way.most * all) << way.name;
  }
}

TEST(UnevenImage, ProbesAndSlicesReadTheValuesAtTheirPlaces) {
  const Pair pair = pair_of(kLines, waves);
  for (int n = 0; n < 200; ++n) {
    const Vec3 x(24.0 * std::fmod(0.618 * n, 1.0), 20.0 * std::fmod(0.755 * n, 1.0),
                 18.0 * std::fmod(0.57 * n, 1.0));
    EXPECT_NEAR(pair.uneven->value_at(x), pair.even->value_at(x), 1e-6);
  }
  EXPECT_LT(glm::distance(pair.uneven->grid_point({8, 14, 12}), Vec3(4, 4, 3)), 1e-12);
  EXPECT_NEAR(pair.uneven->way_along({2, 0, 0}, {1, 0, 0}, 1.0), 2.0, 1e-12);
  EXPECT_NEAR(pair.uneven->way_along({16, 0, 0}, {-1, 0, 0}, 2.0), 8.0, 1e-12);
  SliceView slice;
  slice.window = {1.0, 0.5};
  VolumeView view = view_of(pair.even);
  Camera camera = camera_of(view, {.azimuth = 20.0, .elevation = 50.0}, Projection::kOrthographic);
  for (const double slab : {0.0, 4.0}) {
    slice.slab = slab;
    slice.image = pair.even;
    const Image wanted = slice_raster(slice, camera, 96, 80, 1);
    slice.image = pair.uneven;
    const Image drawn = slice_raster(slice, camera, 96, 80, 1);
    ASSERT_EQ(drawn.rgba.size(), wanted.rgba.size());
    int worst = 0, seen = 0;
    for (std::size_t i = 0; i < wanted.rgba.size(); ++i) {
      worst = std::max(worst, std::abs(int{drawn.rgba[i]} - int{wanted.rgba[i]}));
      seen += wanted.rgba[i] > 100 ? 1 : 0;
    }
    EXPECT_LE(worst, slab > 0.0 ? 2 : 1) << slab;
    EXPECT_GT(seen, 1000);
  }
}

TEST(UnevenImage, GradientsAreThoseInSpace) {
  // x + 2 y + 4 z, whatever the steps.
  const Pair pair = pair_of(kLines, [](const Index3& p) {
    return kLines[0][static_cast<std::size_t>(p.x)] + 2.0 * kLines[1][static_cast<std::size_t>(p.y)] +
           4.0 * kLines[2][static_cast<std::size_t>(p.z)];
  });
  EXPECT_NEAR(highest_gradient(*pair.uneven, 1), std::sqrt(21.0), 1e-5);
}

}  // namespace
}  // namespace palpate::test
