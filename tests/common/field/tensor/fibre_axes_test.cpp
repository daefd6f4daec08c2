// Directions without a sign, as those of muscle fibres, interpolated as outer products (Ikits 2006,
// sec. 8.2).
#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/tensor/diffusion_measures.h"
#include "common/field/tensor/tensor_field.h"
#include "common/math/symmetric3.h"

namespace palpate {
namespace {

/// A fibre that turns through a wall from +60 to -60 degrees along z, and leans out of it a little along x.
Vec3 fibre(const Vec3& x) {
  const double helix = (60.0 - 120.0 * x.z) * std::acos(-1.0) / 180.0;
  return glm::normalize(Vec3{std::cos(helix), std::sin(helix), 0.2 * std::sin(3.0 * x.x)});
}

enum class Signs { kAsTheyAre, kAtRandom };

Mat3 axes_of(int n) {
  return Mat3{Vec3{1.0, 0.0, 0.0}, Vec3{0.1, 1.0, 0.0}, Vec3{0.0, 0.05, 1.0}} / double(n - 1);
}

/// A sheared box of tetrahedra, `n` points a side, with a fibre at each point.
DataSet wall(int n, Signs signs, Association association = Association::kPoint) {
  DataSet image;
  const Mat3 axes = axes_of(n);
  std::vector<double> positions;
  for (int k = 0; k < n; ++k) {
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) {
        const Vec3 x = axes * Vec3(i, j, k);
        positions.insert(positions.end(), {x.x, x.y, x.z});
      }
    }
  }
  image.topology = StructuredTopology{
      Index3{n}, make_array("points", Association::kPoint, 3, std::span<const double>(positions))};
  std::mt19937_64 random(7);
  std::vector<double> values;
  const int count = association == Association::kPoint ? n : n - 1;
  const double middle = association == Association::kPoint ? 0.0 : 0.5;
  for (int k = 0; k < count; ++k) {
    for (int j = 0; j < count; ++j) {
      for (int i = 0; i < count; ++i) {
        Vec3 f = fibre(axes * (Vec3(i, j, k) + middle)) * 1e200;  // lengths mean nothing
        if (signs == Signs::kAtRandom && random() % 2 == 0) f = -f;
        values.insert(values.end(), {f.x, f.y, f.z});
      }
    }
  }
  image.arrays.push_back(make_array("fibre", association, 3, std::span<const double>(values)));
  return image;
}

std::shared_ptr<const TensorField> field_of(const DataSet& image) {
  return make_tensor_field(
      image, {.array = "fibre", .order = TensorOrder::kAxis, .association = image.arrays[0].association},
      "wall");
}

/// The largest angle between interpolated and true fibre inside the wall [rad].
double worst_angle(const TensorField& field) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> inside(0.25, 0.75);
  CellHint hint;
  double worst = 0.0;
  for (int s = 0; s < 2000; ++s) {
    const Vec3 x{inside(random), inside(random), inside(random)};
    const TensorSample sample = field.sample(x, hint);
    EXPECT_EQ(sample.status, SampleStatus::kOk);
    const Vec3 found = symmetric_eigen(sample.value).vectors[0];
    worst = std::max(worst, glm::length(glm::cross(found, fibre(x))));
  }
  return worst;
}

TEST(FibreAxes, SignsOfTheInputChangeNoBit) {
  for (const Association on : {Association::kPoint, Association::kCell}) {
    const auto plain = field_of(wall(7, Signs::kAsTheyAre, on));
    const auto flipped = field_of(wall(7, Signs::kAtRandom, on));
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> inside(0.05, 0.95);
    CellHint a, b;
    for (int s = 0; s < 500; ++s) {
      const Vec3 x{inside(random), inside(random), inside(random)};
      EXPECT_EQ(plain->sample(x, a).value, flipped->sample(x, b).value);
    }
  }
}

TEST(FibreAxes, TheDirectionIsOfSecondOrder) {
  const double coarse = worst_angle(*field_of(wall(9, Signs::kAtRandom)));
  const double middle = worst_angle(*field_of(wall(17, Signs::kAtRandom)));
  const double fine = worst_angle(*field_of(wall(33, Signs::kAtRandom)));
  EXPECT_LT(fine, 0.5 * std::acos(-1.0) / 180.0);
  EXPECT_GT(std::log2(coarse / middle), 1.7);
  EXPECT_GT(std::log2(middle / fine), 1.7);
}

TEST(FibreAxes, CellsAreBroughtToThePoints) {
  // Inside, the mean of the cells around a point is of second order too.
  const double coarse = worst_angle(*field_of(wall(17, Signs::kAtRandom, Association::kCell)));
  const double fine = worst_angle(*field_of(wall(33, Signs::kAtRandom, Association::kCell)));
  EXPECT_GT(std::log2(coarse / fine), 1.7);
}

// Between two perpendicular fibres no direction stands out, and the gap of the eigenvalues says so.
TEST(FibreAxes, TheGapClosesWhereNoDirectionStandsOut) {
  DataSet image;
  image.topology = UniformTopology{Index3{2}, Vec3{0.0}, Mat3{1.0}};
  std::vector<double> values;
  for (int p = 0; p < 8; ++p) values.insert(values.end(), {p < 4 ? 1.0 : 0.0, p < 4 ? 0.0 : -1.0, 0.0});
  image.arrays.push_back(make_array("fibre", Association::kPoint, 3, std::span<const double>(values)));
  const auto field = field_of(image);
  CellHint hint;
  for (const double z : {0.0, 0.25, 0.5, 0.75, 1.0}) {
    const TensorSample sample = field->sample({0.5, 0.5, z}, hint);
    ASSERT_EQ(sample.status, SampleStatus::kOk);
    EXPECT_NEAR(anisotropy(symmetric_eigenvalues(sample.value)).linear, std::abs(1.0 - 2.0 * z), 1e-12);
  }
}

/// A wall of 5 points a side without a direction at those within `reach` of its middle.
DataSet holed(int reach) {
  DataSet image = wall(5, Signs::kAsTheyAre);
  std::vector<double> values;
  for (std::size_t p = 0; p < image.arrays[0].tuples; ++p) {
    const auto n = static_cast<int>(p);
    const bool hole =
        std::abs(n % 5 - 2) <= reach && std::abs(n / 5 % 5 - 2) <= reach && std::abs(n / 25 - 2) <= reach;
    for (int c = 0; c < 3; ++c) values.push_back(hole ? 0.0 : image.arrays[0].at(p, c));
  }
  image.arrays[0] = make_array("fibre", Association::kPoint, 3, std::span<const double>(values));
  return image;
}

TEST(FibreAxes, AMissingDirectionIsTheMeanOfThoseAround) {
  const auto field = field_of(holed(0));
  const Vec3 middle = axes_of(5) * Vec3{2.0};
  CellHint hint;
  const TensorSample sample = field->sample(middle, hint);
  ASSERT_EQ(sample.status, SampleStatus::kOk);
  const Vec3 axis = symmetric_eigen(sample.value).vectors[0];
  EXPECT_GT(std::abs(glm::dot(axis, fibre(middle))), std::cos(0.1));
  EXPECT_EQ(field->notes().bad_values, 0U);
  const auto& lines = field->notes().lines;
  EXPECT_EQ(
      std::count(lines.begin(), lines.end(), "1 point without a direction has the mean of the points around"),
      1);
}

TEST(FibreAxes, AHoleHasNoDirection) {
  const auto field = field_of(holed(1));
  CellHint hint;
  EXPECT_EQ(field->sample(axes_of(5) * Vec3{2.0}, hint).status, SampleStatus::kBadData);
  EXPECT_GT(field->notes().bad_values, 0U);
}

}  // namespace
}  // namespace palpate
