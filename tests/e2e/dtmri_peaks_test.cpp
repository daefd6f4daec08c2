// An image of several directions a voxel, by the mouse: a line from each where a click put the crosshair, and the hand, which
// follows the direction nearest to its way.

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "common/render/probe_view.h"
#include "tests/e2e/dtmri_bundles.h"

namespace palpate::test {
namespace {

constexpr int kSide = 21, kNumbers = 9;
constexpr double kVoxel = 2.0;
const Vec3 kStraight{1.0, 0.0, 0.0}, kSlanted{0.5, 0.8660254037844386, 0.0};  // 60 degrees apart

/// Three directions a voxel, the third none; which of the others is longer, and which comes first, changes from voxel to voxel.
std::string crossing() {
  std::string text =
      "mrtrix image\ndim: 21,21,21,9\nvox: 2,2,2,1\nlayout: +0,+1,+2,+3\ndatatype: Float32LE\n"
      "transform: 1,0,0,-20\ntransform: 0,1,0,-20\ntransform: 0,0,1,-20\nfile: . 300\nEND\n";
  constexpr std::size_t kData = 300;
  text.resize(kData, '\0');
  for (int number = 0; number < kNumbers; ++number) {
    for (int v = 0; v < kSide * kSide * kSide; ++v) {
      const bool swapped = v % 3 == 0, longer = v % 2 == 0;
      const double sign = v % 5 < 2 ? -1.0 : 1.0;  // which has no meaning
      const int slot = number / 3;
      float value = 0.0F;
      if (slot < 2) {
        const bool first = (slot == 0) != swapped;
        value = static_cast<float>(sign * (first == longer ? 0.8 : 0.6) *
                                   (first ? kStraight : kSlanted)[number % 3]);
      }
      char bytes[sizeof(float)];
      std::memcpy(bytes, &value, sizeof value);
      text.append(bytes, sizeof value);
    }
  }
  return text;
}

class DtmriPeaks : public BundlesWindow {
 protected:
  void SetUp() override {
    BundlesWindow::SetUp();
    if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
    folder_.write("crossing.mif", crossing());
  }
  [[nodiscard]] std::vector<std::string> arguments(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> all{"open",    folder_.path("crossing.mif"), "--slices", "-,-,0", "--camera",
                                 "0,90,0,1"};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  /// Degrees between a piece of a line and `unit`, whatever their signs.
  static double degrees(const Vec3& piece, const Vec3& unit) {
    return std::acos(std::min(1.0, std::abs(glm::dot(glm::normalize(piece), unit)))) * 180.0 / M_PI;
  }
};

TEST_F(DtmriPeaks, ALineStartsAlongEachWhereAClickWas) {
  const WindowResult first = open(arguments());
  const Vec3 place{6.0, -8.0, 0.0}, pixel = pixel_of(first, place);
  const auto traced = [&](bool every) {
    click(pixel.x, pixel.y);
    if (every) press("from every peak");
    press("Trace");
    return open(arguments());
  };
  const WindowResult longest = traced(false), every = traced(true);
  EXPECT_LT(glm::distance(every.view.tensors->position, place), kVoxel)
      << "the crosshair is where the click was";
  EXPECT_FALSE(longest.document.tracts.seeds.starts_with("peaks:")) << longest.document.tracts.seeds;
  EXPECT_TRUE(every.document.tracts.seeds.starts_with("peaks:")) << every.document.tracts.seeds;
  ASSERT_GT(shown(longest), 0U);
  EXPECT_EQ(shown(every), 2 * shown(longest));
  std::size_t along_first = 0, along_second = 0;
  const Tractogram& lines = *every.view.tracts->bundle->lines;
  for (std::size_t l = 0; l < lines.line_count(); ++l) {
    const auto line = lines.line(l);
    const Vec3 way = Vec3(line.back()) - Vec3(line.front());
    along_first += degrees(way, kStraight) < 0.5 ? 1U : 0U;
    along_second += degrees(way, kSlanted) < 0.5 ? 1U : 0U;
  }
  EXPECT_EQ(along_first, shown(longest));
  EXPECT_EQ(along_second, shown(longest));
}

TEST_F(DtmriPeaks, TheHandFollowsTheOneNearestToItsWay) {
  const WindowResult first = open(arguments({"--mode", "anisotropy"}));
  // Each bundle in turn, through the same place, three degrees beside it.
  for (const Vec3& bundle : {kStraight, kSlanted}) {
    const Vec3 aside{-bundle.y, bundle.x, 0.0}, way = glm::normalize(bundle + 0.05 * aside);
    constexpr int kSteps = 60;
    constexpr double kLength = 16.0;  // mm
    const Vec3 from = pixel_of(first, -0.5 * kLength * way);
    key('G');
    at({.kind = InputKind::kMove, .x = from.x, .y = from.y});
    at({.kind = InputKind::kPress, .x = from.x, .y = from.y});
    for (int n = 0; n <= kSteps; ++n) {
      const Vec3 x = pixel_of(first, (static_cast<double>(n) / kSteps - 0.5) * kLength * way);
      at({.kind = InputKind::kMove, .x = x.x, .y = x.y});
    }
    at({.kind = InputKind::kRelease});
    next_ += 20;
    key('K');
    const WindowResult drawn = open(arguments({"--mode", "anisotropy", "--glyphs", "ellipsoid"}));
    ASSERT_TRUE(drawn.view.probe && drawn.view.probe->drawn_lines) << drawn.message;
    ASSERT_EQ(drawn.view.probe->drawn_lines->size(), 1U) << drawn.message;
    const Line& line = *drawn.view.probe->drawn_lines->front().line;
    const Vec3 drawn_way = line.points.back().position - line.points.front().position;
    EXPECT_GT(glm::length(drawn_way), 0.5 * kLength);
    EXPECT_LT(degrees(drawn_way, bundle), 4.0) << drawn_way.x << " " << drawn_way.y << " " << drawn_way.z;
  }
}

}  // namespace
}  // namespace palpate::test
