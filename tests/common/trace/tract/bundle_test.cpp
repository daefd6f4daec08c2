// Density and profile of bundles against dense sampling and closed forms.

#include "common/trace/tract/bundle.h"

#include <cmath>
#include <limits>
#include <random>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "common/base/index.h"

namespace palpate::test {
namespace {

void add_line(Tractogram& lines, const std::vector<Vec3>& points) {
  for (const Vec3& x : points) lines.points.emplace_back(x);
  lines.starts.push_back(lines.points.size());
}

const TractogramImage kOblique{
    {7, 9, 5}, Mat3{Vec3{1.2, 0.3, 0.0}, Vec3{-0.4, 1.6, 0.2}, Vec3{0.1, 0.0, 2.5}}, {-3.0, 10.0, 4.0}};

std::size_t index_in(const TractogramImage& image, int i, int j, int k) {
  return as_size(i) + as_size(image.voxels.x) * (as_size(j) + as_size(image.voxels.y) * as_size(k));
}

TEST(BundleDensity, CountsEveryVoxelThatALinePassesOnce) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-0.2, 1.2);
  for (int round = 0; round < 200; ++round) {
    Tractogram lines;
    std::vector<Vec3> corners;  // in voxels
    for (int p = 0; p < 4; ++p)
      corners.push_back(Vec3(part(random), part(random), part(random)) * Vec3(kOblique.voxels) - 0.5);
    std::vector<Vec3> points;
    for (const Vec3& x : corners) points.push_back(kOblique.origin + kOblique.axes * x);
    add_line(lines, points);
    const BundleDensity density = bundle_density(lines, kOblique);
    // Every voxel that samples fall well into is counted; every one that is counted has samples close by.
    std::set<std::size_t> surely, perhaps;
    bool left = false;
    for (std::size_t p = 1; p < corners.size(); ++p) {
      for (int s = 0; s <= 4000; ++s) {
        const Vec3 x = glm::mix(corners[p - 1], corners[p], s / 4000.0);
        const auto add = [&](const Vec3& at, std::set<std::size_t>& to) {
          const Vec3 voxel = glm::floor(at + 0.5);
          const bool inside = voxel.x >= 0 && voxel.y >= 0 && voxel.z >= 0 && voxel.x < kOblique.voxels.x &&
                              voxel.y < kOblique.voxels.y && voxel.z < kOblique.voxels.z;
          if (inside)
            to.insert(index_in(kOblique, static_cast<int>(voxel.x), static_cast<int>(voxel.y),
                               static_cast<int>(voxel.z)));
          else if (&to == &surely)
            left = true;
        };
        const Vec3 within = glm::abs(x + 0.5 - glm::floor(x + 0.5) - 0.5);
        const double reach = std::max({within.x, within.y, within.z});
        if (reach < 0.5 - 1e-4) add(x, surely);
        for (const double i : {-2e-3, 2e-3})
          for (const double j : {-2e-3, 2e-3})
            for (const double k : {-2e-3, 2e-3}) add(x + Vec3(i, j, k), perhaps);
      }
    }
    std::size_t counted = 0;
    for (std::size_t v = 0; v < density.lines.size(); ++v) {
      EXPECT_TRUE(density.lines[v] == 0.0F || density.lines[v] == 1.0F);
      if (surely.contains(v)) {
        EXPECT_EQ(density.lines[v], 1.0F) << round << " " << v;
      }
      if (density.lines[v] > 0.0F) {
        ++counted;
        EXPECT_TRUE(perhaps.contains(v)) << round << " " << v;
      }
    }
    EXPECT_EQ(density.voxels, counted);
    EXPECT_NEAR(density.volume, static_cast<double>(counted) * std::abs(glm::determinant(kOblique.axes)),
                1e-9);
    EXPECT_EQ(density.outside, left ? 1U : 0U) << round;
  }
}

TEST(BundleDensity, LinesAddUpAndPlacesWithoutMeasureCostNothing) {
  const double huge = std::numeric_limits<float>::max();
  Tractogram lines;
  add_line(lines, {kOblique.origin});
  add_line(lines, {kOblique.origin, kOblique.origin, kOblique.origin});
  add_line(lines, {{NAN, 0.0, 0.0}, {1.0, INFINITY, 0.0}});
  add_line(lines, {{-huge, -huge, -huge}, {huge, huge, huge}});
  add_line(lines, {});
  const BundleDensity density = bundle_density(lines, kOblique);
  EXPECT_EQ(density.lines[0], 2.0F);
  EXPECT_EQ(density.outside, 2U);
}

/// Arcs beside each other in the half space z > 0, of which every other one is stored from its other end.
Tractogram arcs(bool turn) {
  Tractogram lines;
  for (int line = 0; line < 40; ++line) {
    std::vector<Vec3> points;
    const int count = 30 + line;
    for (int p = 0; p <= count; ++p) {
      const double angle = 3.14159265358979 * p / count;
      points.emplace_back(-10.0 * std::cos(angle), 0.1 * line, (6.0 + 0.05 * line) * std::sin(angle));
    }
    if (turn && line % 2 == 1) std::reverse(points.begin(), points.end());
    add_line(lines, points);
  }
  return lines;
}

TEST(BundleProfile, IsTheSameFromWhicheverEndLinesAreStored) {
  const auto value = [](const Vec3& x) { return 2.0 * x.x + 0.5 * x.z; };
  const BundleProfile plain = bundle_profile(arcs(false), 25, value),
                      turned = bundle_profile(arcs(true), 25, value);
  EXPECT_EQ(plain.turned, 0U);
  EXPECT_EQ(turned.turned, 20U);
  EXPECT_EQ(turned.lines, 40U);
  ASSERT_EQ(turned.nodes.size(), 25U);
  EXPECT_NEAR(turned.nodes.front().place.x, -10.0, 1e-5) << "from the left";
  for (std::size_t n = 0; n < 25; ++n) {
    EXPECT_NEAR(plain.nodes[n].mean, turned.nodes[n].mean, 1e-5);
    EXPECT_NEAR(plain.nodes[n].mean, value(plain.nodes[n].place), 1e-9) << "linear values";
    EXPECT_NEAR(plain.nodes[n].deviation, turned.nodes[n].deviation, 1e-5);
    EXPECT_LE(plain.nodes[n].lower, plain.nodes[n].median);
    EXPECT_LE(plain.nodes[n].median, plain.nodes[n].upper);
  }
}

TEST(BundleProfile, NodesAreSpreadByLengthAndStatisticsAreThoseOfTheirValues) {
  Tractogram lines;
  add_line(lines, {{0, 0, 0}, {0.1, 0, 0}, {0.2, 0, 0}, {4, 0, 0}});
  add_line(lines, {{4, 1, 0}, {0, 1, 0}});
  add_line(lines, {{0, 2, 0}, {4, 2, 0}});
  add_line(lines, {{1, 1, 1}});
  add_line(lines, {{1, 1, 1}, {1, 1, 1}});
  add_line(lines, {{1, 1, 1}, {NAN, 1, 1}});
  const BundleProfile profile =
      bundle_profile(lines, 5, [](const Vec3& x) { return x.y == 2.0 && x.x > 3.5 ? NAN : x.x + x.y * x.y; });
  EXPECT_EQ(profile.lines, 3U);
  EXPECT_EQ(profile.left_out, 3U);
  ASSERT_EQ(profile.nodes.size(), 5U);
  for (std::size_t n = 0; n < 5; ++n) EXPECT_NEAR(profile.nodes[n].place.x, static_cast<double>(n), 1e-6);
  // Values 1, 2, 5 at the second node.
  EXPECT_NEAR(profile.nodes[1].mean, 8.0 / 3.0, 1e-6);
  EXPECT_NEAR(profile.nodes[1].deviation, std::sqrt(13.0 / 3.0), 1e-6);
  EXPECT_NEAR(profile.nodes[1].median, 2.0, 1e-6);
  EXPECT_EQ(profile.nodes[4].lines, 2U);
  EXPECT_EQ(profile.nodes[4].valueless, 1U);
  const BundleProfile none = bundle_profile(Tractogram{}, 5, [](const Vec3&) { return 0.0; });
  EXPECT_TRUE(none.nodes.empty());
}

}  // namespace
}  // namespace palpate::test
