// The noise of a volume against noise that was put in, and against images that have none.
#include "common/field/noise_field.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"

namespace palpate::test {
namespace {

using Formula = std::function<double(const Vec3& x)>;  // x in [0, 1]^3

std::shared_ptr<const ScalarField> volume(const Index3& points, const std::vector<double>& values,
                                          const Mat3& axes = Mat3{1.0}) {
  DataSet block;
  block.topology = UniformTopology{.points = points, .origin = Vec3{3.0, -2.0, 7.0}, .axes = axes};
  block.arrays = {make_array("s", Association::kPoint, 1, std::span<const double>(values))};
  return make_scalar_field({block}, {"s"}, "test");
}

/// @param sigma of the normal noise that is added, at x.
std::vector<double> noisy(const Index3& n, const Formula& value, const Formula& sigma) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::vector<double> values;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const Vec3 x{(i + 0.5) / n.x, (j + 0.5) / n.y, (k + 0.5) / n.z};
        values.push_back(value(x) + sigma(x) * normal(random));
      }
    }
  }
  return values;
}

double ball(const Vec3& x) { return glm::distance(x, Vec3{0.5}) < 0.35 ? 1.0 : 0.0; }
/// The same as an instrument with a blur of a voxel and a half shows it on 64 points.
double blurred_ball(const Vec3& x) {
  return 0.5 * std::erfc((glm::distance(x, Vec3{0.5}) - 0.35) * 64.0 / (1.5 * std::sqrt(2.0)));
}
Formula constant(double value) {
  return [value](const Vec3&) { return value; };
}

/// Noise at the place x of [0, 1]^3, by the range of the values.
double noise_at(const ScalarField& field, const ScalarField& noise, const Vec3& x) {
  const Box& box = field.bounds();
  CellHint hint;
  const ScalarSample sample = noise.sample(box.lower + x * box.size(), hint);
  EXPECT_EQ(sample.status, SampleStatus::kOk) << x.x << ' ' << x.y << ' ' << x.z;
  return sample.value * (field.highest() - field.lowest());
}

const std::vector<Vec3> kPlaces{{0.5, 0.5, 0.5}, {0.15, 0.5, 0.5},  {0.5, 0.85, 0.5}, {0.3, 0.3, 0.3},
                                {0.1, 0.1, 0.1}, {0.95, 0.5, 0.05}, {0.0, 1.0, 0.5},  {0.7, 0.7, 0.7}};

TEST(NoiseField, TellsTheNoiseThatWasPutIn) {
  const Index3 n{64};
  for (const double sigma : {0.01, 0.03, 0.1}) {
    const auto field = volume(n, noisy(n, blurred_ball, constant(sigma)));
    const auto noise = make_noise_field(*field);
    for (const Vec3& x : kPlaces)
      EXPECT_NEAR(noise_at(*field, *noise, x), sigma, 0.4 * sigma) << x.x << ' ' << x.y << ' ' << x.z;
    double sum = 0.0, squares = 0.0;
    const auto& nodes = std::get<std::span<const float>>(noise->values().values);
    for (const float value : nodes) sum += value, squares += static_cast<double>(value) * value;
    const auto count = static_cast<double>(nodes.size());
    const double mean = sum / count, range = field->highest() - field->lowest();
    EXPECT_NEAR(mean * range, sigma, 0.05 * sigma);
    EXPECT_LT(std::sqrt(squares / count - mean * mean), 0.2 * mean) << "its scatter";
  }
}

TEST(NoiseField, TellsWhereItIs) {
  const Index3 n{64};
  const auto field = volume(n, noisy(n, blurred_ball, [](const Vec3& x) { return x.x < 0.5 ? 0.02 : 0.08; }));
  const auto noise = make_noise_field(*field);
  for (const double y : {0.1, 0.5, 0.8}) {
    EXPECT_NEAR(noise_at(*field, *noise, {0.35, y, 0.4}), 0.02, 0.004);
    EXPECT_NEAR(noise_at(*field, *noise, {0.65, y, 0.4}), 0.08, 0.016);
  }
}

// Neither slopes nor edges nor the rim of the image are noise.
TEST(NoiseField, IsNearlyNoneWhereThereIsNone) {
  const Index3 n{64};
  const Formula slope = [](const Vec3& x) { return x.x * x.y - 3.0 * x.z * x.y + x.x; };
  const Formula waves = [](const Vec3& x) { return std::sin(12.0 * x.x) * std::cos(9.0 * x.y + 5.0 * x.z); };
  const Formula step = [](const Vec3& x) { return x.y + 0.1 * x.z < 0.52 ? 0.0 : 1.0; };
  struct Case {
    const char* name;
    Formula value;
    double most;
  };
  for (const Case& each : {Case{"slope", slope, 1e-12}, Case{"waves", waves, 1e-4}, Case{"step", step, 1e-12},
                           Case{"blurred ball", blurred_ball, 2e-3}, Case{"ball", ball, 0.05}}) {
    const auto field = volume(n, noisy(n, each.value, constant(0.0)));
    const auto noise = make_noise_field(*field);
    EXPECT_LE(noise->highest(), each.most) << each.name;
  }
}

// Turned, anisotropic, scaled by powers of two, offset, in other types and by any number of threads.
TEST(NoiseField, DependsOnTheValuesAlone) {
  const Index3 n{21, 30, 17};
  const std::vector<double> values = noisy(n, blurred_ball, constant(0.05));
  const auto field = volume(n, values);
  const auto noise = make_noise_field(*field, 1);
  const auto same = [&](const ScalarField& other, int threads) {
    const auto found = make_noise_field(other, threads);
    const auto& a = std::get<std::span<const float>>(noise->values().values);
    const auto& b = std::get<std::span<const float>>(found->values().values);
    return std::equal(a.begin(), a.end(), b.begin(), b.end());
  };
  EXPECT_TRUE(same(*field, 4));
  std::vector<double> scaled;
  for (const double value : values) scaled.push_back(std::ldexp(value, 700));
  EXPECT_TRUE(same(*volume(n, scaled), 0)) << "values near the end of what a double holds";
  const double c = std::cos(0.4), s = std::sin(0.4);
  const auto turned = volume(n, values, Mat3{Vec3{c, s, 0.0}, Vec3{-s, c, 0.0}, Vec3{0.0, 0.0, 1000.0}});
  EXPECT_TRUE(same(*turned, 0));
  // It covers its field to the rim, wherever that lies.
  CellHint hint;
  for (const auto& each : {field, turned}) {
    const auto found = make_noise_field(*each);
    const BoxGrid& grid = *each->box_grid();
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 x;
      for (int a = 0; a < 3; ++a) x[a] = grid.coordinate(a, (corner >> a & 1) != 0 ? n[a] - 1 : 0);
      EXPECT_EQ(found->sample(each->frame().data_from_local(x), hint).status, SampleStatus::kOk) << corner;
    }
  }
}

TEST(NoiseField, StaysNumbersForAnyData) {
  const Index3 n{20};
  std::vector<double> holes = noisy(n, blurred_ball, constant(0.05));
  for (std::size_t i = 0; i < holes.size() / 2; ++i) holes[i] = i % 3 == 0 ? NAN : HUGE_VAL;
  const auto field = volume(n, holes);
  const auto noise = make_noise_field(*field);
  EXPECT_EQ(noise_at(*field, *noise, {0.5, 0.5, 0.1}), 0.0) << "nothing finite to judge by";
  EXPECT_NEAR(noise_at(*field, *noise, {0.5, 0.5, 0.9}), 0.05, 0.01);
  for (const Index3& flat : {Index3{2, 2, 2}, Index3{2, 64, 64}, Index3{3, 3, 3}, Index3{2, 2, 50}}) {
    const auto count = static_cast<std::size_t>(flat.x) * static_cast<std::size_t>(flat.y) *
                       static_cast<std::size_t>(flat.z);
    for (const double value : {0.0, 1.0}) {
      const auto thin =
          volume(flat, value > 0.0 ? noisy(flat, ball, constant(0.2)) : std::vector<double>(count));
      const auto found = make_noise_field(*thin);
      EXPECT_TRUE(found->lowest() >= 0.0 && found->highest() < 1.0)
          << flat.x << ' ' << flat.y << ' ' << flat.z;
    }
  }
  // Of a sheet the differences within it tell.
  const Index3 sheet{2, 64, 64};
  const auto thin = volume(sheet, noisy(sheet, constant(0.0), constant(1.0)));
  EXPECT_NEAR(noise_at(*thin, *make_noise_field(*thin), Vec3{0.5}), 1.0, 0.5);
  EXPECT_EQ(make_noise_field(*make_scalar_field(sphere_scalar())), nullptr) << "a formula has no voxels";
}

TEST(NoiseField, OfARectilinearGridIsThatOfItsPoints) {
  const Index3 n{40, 9, 23};
  const std::vector<double> values = noisy(n, constant(0.0), constant(1.0));
  DataSet block;
  RectilinearTopology topology;
  for (int a = 0; a < 3; ++a) {
    for (int i = 0; i < n[a]; ++i)
      topology.coordinates[static_cast<std::size_t>(a)].push_back(i * (1.0 + 0.1 * i));
  }
  block.topology = topology;
  block.arrays = {make_array("s", Association::kPoint, 1, std::span<const double>(values))};
  const auto field = make_scalar_field({block}, {"s"}, "test");
  const auto noise = make_noise_field(*field), uniform = make_noise_field(*volume(n, values));
  ASSERT_TRUE(noise && uniform);
  const auto& a = std::get<std::span<const float>>(noise->values().values);
  const auto& b = std::get<std::span<const float>>(uniform->values().values);
  EXPECT_TRUE(std::equal(a.begin(), a.end(), b.begin(), b.end()));
  EXPECT_EQ(noise->bounds().upper, field->bounds().upper);
}

}  // namespace
}  // namespace palpate::test
