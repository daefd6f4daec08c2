// Lines through peaks: bundles that cross, in whatever order their peaks stand, are followed as if each were alone.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/index.h"
#include "common/field/tensor/peak_field.h"
#include "common/math/lattice.h"
#include "common/trace/tract/trace_tracts.h"
#include "common/trace/tract/tract_orientation.h"

namespace palpate {
namespace {

constexpr double kRadians = std::numbers::pi / 180.0;
constexpr int kSlots = 3;

/// A number that depends on the place alone and looks like any other.
std::uint32_t shuffled(const Vec3& x, std::uint32_t salt) {
  std::uint32_t h = salt;
  for (int axis = 0; axis < 3; ++axis)
    h = (h ^ static_cast<std::uint32_t>(static_cast<std::int64_t>(std::lround(64.0 * x[axis])))) *
        2654435761U;
  return h ^ (h >> 15U);
}

using Peaks = std::function<std::vector<Vec3>(const Vec3&)>;

/// Peaks in another order and with other signs in each voxel, gaps of zero and of NaN among them.
std::shared_ptr<const TensorField> peaks_field(const UniformTopology& voxels, const Peaks& peaks_at) {
  std::vector<float> tensors, all;
  for (int k = 0; k < voxels.points.z; ++k) {
    for (int j = 0; j < voxels.points.y; ++j) {
      for (int i = 0; i < voxels.points.x; ++i) {
        const Vec3 x = voxels.origin + voxels.axes * Vec3(i, j, k);
        std::vector<Vec3> peaks = peaks_at(x);
        Vec3 longest{0.0};
        for (const Vec3& peak : peaks)
          if (glm::length(peak) > glm::length(longest)) longest = peak;
        const Mat3 d =
            longest == Vec3{0.0} ? Mat3{NAN} : fibre_tensor(glm::normalize(longest), glm::length(longest));
        for (const double number : {d[0][0], d[1][0], d[2][0], d[1][1], d[2][1], d[2][2]})
          tensors.push_back(static_cast<float>(number));
        while (peaks.size() < kSlots) peaks.emplace_back(peaks.size() == 2 ? NAN : 0.0);
        for (std::uint32_t n = kSlots; n > 1; --n) std::swap(peaks[n - 1], peaks[shuffled(x, n) % n]);
        for (std::uint32_t n = 0; n < kSlots; ++n) {
          const double sign = (shuffled(x, n + 10) & 1U) != 0 ? 1.0 : -1.0;
          for (int axis = 0; axis < 3; ++axis) all.push_back(static_cast<float>(sign * peaks[n][axis]));
        }
      }
    }
  }
  DataSet image;
  image.topology = voxels;
  image.arrays = {make_array("D", Association::kPoint, 6, std::span<const float>(tensors)),
                  make_array("P", Association::kPoint, 3 * kSlots, std::span<const float>(all))};
  return make_tensor_field(image, {.array = "D", .peaks = "P"}, "peaks");
}

/// Voxels of 2 x 2 x 2.5 about zero, their axes turned.
UniformTopology turned_voxels() {
  const Vec3 a = glm::normalize(Vec3{2.0, 1.0, 0.5}), b = glm::normalize(glm::cross(a, Vec3{0.0, 0.3, 1.0}));
  const Mat3 axes{2.0 * a, 2.0 * b, 2.5 * glm::cross(a, b)};
  return {{25, 25, 21}, -(axes * Vec3{12.0, 12.0, 10.0}), axes};
}

double away_from_axis(const Vec3& x, const Vec3& unit) { return glm::length(x - glm::dot(x, unit) * unit); }

/// Two straight bundles of radius 8 through zero.
struct Crossing {
  double degrees;
  Vec3 first = glm::normalize(Vec3{1.0, 0.2, -0.1});
  Vec3 across = glm::normalize(glm::cross(Vec3{0.1, 0.3, 1.0}, first));

  [[nodiscard]] Vec3 second() const {
    return std::cos(degrees * kRadians) * first + std::sin(degrees * kRadians) * across;
  }
  /// Which of the two is longer changes from voxel to voxel.
  [[nodiscard]] Peaks peaks() const {
    return [*this](const Vec3& x) {
      std::vector<Vec3> peaks;
      const bool swap = (shuffled(x, 77) & 1U) != 0;
      if (away_from_axis(x, first) < 8.0) peaks.push_back((swap ? 0.6 : 0.8) * first);
      if (away_from_axis(x, second()) < 8.0) peaks.push_back((swap ? 0.8 : 0.6) * second());
      return peaks;
    };
  }
};

double line_length(std::span<const Vec3f> line) {
  double length = 0.0;
  for (std::size_t p = 1; p < line.size(); ++p) length += glm::distance(Vec3(line[p - 1]), Vec3(line[p]));
  return length;
}

/// The largest angle of a piece of a line with `unit` [degrees].
double degrees_from(std::span<const Vec3f> line, const Vec3& unit) {
  double most = 0.0;
  for (std::size_t p = 1; p < line.size(); ++p) {
    const Vec3 piece = Vec3(line[p]) - Vec3(line[p - 1]);
    if (glm::length(piece) < 0.05) continue;  // single precision
    most = std::max(most, std::asin(std::min(1.0, away_from_axis(glm::normalize(piece), unit))) / kRadians);
  }
  return most;
}

TEST(PeakLines, GoStraightThroughCrossings) {
  for (const double degrees : {60.0, 75.0, 90.0}) {
    const Crossing crossing{degrees};
    const auto field = peaks_field(turned_voxels(), crossing.peaks());
    for (const Vec3& way : {crossing.first, crossing.second()}) {
      const Vec3 side = glm::normalize(glm::cross(way, Vec3{0.3, 0.2, 1.0}));
      std::vector<Vec3> seeds;
      for (const double aside : {-4.0, -1.3, 0.0, 2.6, 4.0}) seeds.push_back(-18.0 * way + aside * side);
      for (const Integrator method : {Integrator::kEuler, Integrator::kRk4, Integrator::kDp54}) {
        const TractResult result = trace_tracts(*field, seeds, {.integrator = method});
        ASSERT_EQ(result.lines.line_count(), seeds.size()) << degrees;
        for (std::size_t l = 0; l < seeds.size(); ++l) {
          EXPECT_LT(degrees_from(result.lines.line(l), way), 0.01) << degrees << " degrees, seed " << l;
          EXPECT_GT(line_length(result.lines.line(l)), 36.0) << degrees << " degrees, seed " << l;
        }
        EXPECT_LT(result.error_max, 1e-4) << "straight lines have no error but rounding";
      }
    }
  }
}

TEST(PeakLines, OfCurvedBundlesKeepToThemWhereAnotherCrosses) {
  // Circles about z, through which a straight bundle goes along x.
  const auto peaks = [](const Vec3& x) {
    const double radius = std::hypot(x.x, x.y + 30.0);
    std::vector<Vec3> found;
    if (radius > 20.0 && radius < 40.0) found.push_back(0.7 / radius * Vec3{-(x.y + 30.0), x.x, 0.0});
    if (std::abs(x.x) < 8.0) found.emplace_back(0.0, 0.8, 0.0);
    return found;
  };
  const UniformTopology voxels{{31, 31, 9}, {-30.0, -30.0, -8.0}, Mat3{2.0}};
  const auto field = peaks_field(voxels, peaks);
  const double start = 0.9;
  const Vec3 seed{30.0 * std::sin(start), 30.0 * std::cos(start) - 30.0, 0.0};
  const TractResult result = trace_tracts(*field, std::span(&seed, 1), {.tolerance = 1e-6});
  ASSERT_EQ(result.lines.line_count(), 1U);
  double most = 0.0, least_x = 0.0;
  for (const Vec3f& x : result.lines.line(0)) {
    most = std::max(most, std::abs(std::hypot(double{x.x}, double{x.y} + 30.0) - 30.0));
    least_x = std::min(least_x, double{x.x});
  }
  // Trilinear directions of a circle bend a little less than it does: voxel^2 / 8 R at most, a way long.
  EXPECT_LT(most, 0.05);
  EXPECT_LT(least_x, -20.0) << "through the other bundle";
}

TEST(PeakLines, BeginAtTheLongestOrAtEveryPeak) {
  const Crossing crossing{90.0};
  const auto field = peaks_field(turned_voxels(), crossing.peaks());
  const Vec3 seed = field->voxels()->origin + field->voxels()->axes * Vec3{12.0, 12.0, 10.0};
  TractOptions options;
  const TractResult one = trace_tracts(*field, std::span(&seed, 1), options);
  ASSERT_EQ(one.lines.line_count(), 1U);
  const Vec3 longest = field->peaks()->longest(seed);
  EXPECT_LT(degrees_from(one.lines.line(0), glm::normalize(longest)), 0.01);
  options.every_peak = true;
  const TractResult all = trace_tracts(*field, std::span(&seed, 1), options);
  ASSERT_EQ(all.lines.line_count(), 2U);
  EXPECT_EQ(all.seeds, (std::vector<std::uint32_t>{0, 0}));
  double along_first = 0.0, along_second = 0.0;
  for (std::size_t l = 0; l < 2; ++l) {
    along_first += degrees_from(all.lines.line(l), crossing.first);
    along_second += degrees_from(all.lines.line(l), crossing.second());
  }
  EXPECT_NEAR(along_first, 90.0, 0.02);
  EXPECT_NEAR(along_second, 90.0, 0.02);
  // Seeds that lie outside, and where there is no peak.
  const std::vector<Vec3> lost{{1e3, 0.0, 0.0}, field->voxels()->origin};
  const TractResult none = trace_tracts(*field, lost, options);
  EXPECT_EQ(none.dropped.outside, 1U);
  EXPECT_EQ(none.dropped.bad_data, 1U);
}

TEST(PeakLines, EndWhereNoPeakIsNearTheirWay) {
  // From x = 0 on there are peaks of another bundle alone, from x = 20 on none at all.
  const auto peaks_to = [](double border, const Vec3& beyond) {
    return [border, beyond](const Vec3& x) {
      return x.x < border ? std::vector<Vec3>{{0.8, 0.0, 0.0}} : std::vector<Vec3>{beyond};
    };
  };
  const UniformTopology voxels{{31, 9, 9}, {-30.0, -8.0, -8.0}, Mat3{2.0}};
  const Vec3 seed{-20.0, 0.0, 0.0};
  const auto end_of = [&](const Vec3& beyond, double& reached) {
    const auto field = peaks_field(voxels, peaks_to(0.0, beyond));
    const TractResult result = trace_tracts(*field, std::span(&seed, 1), {.max_angle = 90.0});
    EXPECT_EQ(result.lines.line_count(), 1U);
    reached = double{result.lines.line(0).back().x};
    return result.ends.front()[1];
  };
  double reached = 0.0;
  for (const double degrees : {50.0, 60.0, 90.0}) {
    const Vec3 other{0.8 * std::cos(degrees * kRadians), 0.8 * std::sin(degrees * kRadians), 0.0};
    EXPECT_EQ(end_of(other, reached), End::kSharpTurn) << degrees;
    EXPECT_NEAR(reached, -1.0, 0.1) << "half way to the first voxel that has none";
  }
  EXPECT_EQ(end_of(Vec3{0.0}, reached), End::kBadData);
  EXPECT_NEAR(reached, -1.0, 0.1);
  // Nearer than 45 degrees it is followed.
  const Vec3 bent{0.8 * std::cos(40.0 * kRadians), 0.8 * std::sin(40.0 * kRadians), 0.0};
  EXPECT_EQ(end_of(bent, reached), End::kLeftDomain);
}

TEST(PeakLines, AreCheckedAgainstThePeakThatTheyFollow) {
  const Crossing crossing{60.0};
  const auto field = peaks_field(turned_voxels(), crossing.peaks());
  std::vector<Vec3> seeds;
  for (int n = -3; n <= 3; ++n) {
    seeds.push_back(-15.0 * crossing.first + Vec3{0.0, 0.0, 1.0 * n});
    seeds.push_back(-15.0 * crossing.second() + Vec3{0.0, 0.0, 1.0 * n});
  }
  const TractResult result = trace_tracts(*field, seeds, {});
  EXPECT_LT(fit_of_tracts(*field, result.lines, 1).angle, 0.1);
}

}  // namespace
}  // namespace palpate
