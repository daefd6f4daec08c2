// Every button of bundles, pressed with the mouse: with an image, and where a tractogram is all that is open.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "common/field/analytic/tensor_examples.h"
#include "common/geometry/tractogram.h"
#include "common/load/read_tractogram.h"
#include "tests/e2e/dtmri_bundles.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

class BundleButtons : public BundlesWindow {
 protected:
  static std::vector<double> lengths(const WindowResult& result) {
    const Tractogram& lines = *result.view.tracts->bundle->lines;
    std::vector<double> all;
    for (std::size_t l = 0; l < lines.line_count(); ++l) {
      double length = 0.0;
      const auto line = lines.line(l);
      for (std::size_t p = 1; p < line.size(); ++p) length += glm::distance(line[p], line[p - 1]);
      all.push_back(length);
    }
    return all;
  }
};

/// Two straight tracts of 36 mm, one behind the other along x.
const std::string kTwo = "name=two|color=#ff8000|line=-38,0,0,-20,0,0,-2,0,0|line=2,0,0,20,0,0,38,0,0";

TEST_F(BundleButtons, PartLengthsCropAndDensityByTheMouse) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  // At x = -16, which the first one crosses.
  press("x", 0.3);
  choose("plane", "sagittal");
  press("Part all here");
  press("Save density");
  const WindowResult parted = open({"open", "--example", "helix", "--bundle", kTwo});
  ASSERT_EQ(bundles(parted).size(), 1U);
  EXPECT_NE(bundles(parted).front().find("|part=1,0,0,"), std::string::npos) << bundles(parted).front();
  ASSERT_EQ(shown(parted), 3U) << "the first tract is two now";
  const std::vector<double> parts = lengths(parted);
  EXPECT_NEAR(parts[0] + parts[1] + parts[2], 72.0, 1e-3) << "nothing is lost";
  EXPECT_NEAR(*std::ranges::max_element(parts), 36.0, 1e-3);
  EXPECT_TRUE(fs::exists(folder_.path("bundle_density.nii.gz")));

  // Only the whole one is longer than nine tenths of the longest.
  press("shortest", 0.9);
  press("Keep lengths");
  const WindowResult kept = open({"open", "--example", "helix", "--bundle", bundles(parted).front()});
  EXPECT_NE(bundles(kept).front().find("|length="), std::string::npos) << bundles(kept).front();
  ASSERT_EQ(shown(kept), 1U);
  EXPECT_NEAR(lengths(kept).front(), 36.0, 1e-3);

  // What lies in a ball of three voxels about a crosshair on the second tract.
  press("x", 0.8);
  press("Ball");
  press("Crop to region");
  const WindowResult cropped = open({"open", "--example", "helix", "--bundle", kTwo});
  EXPECT_NE(bundles(cropped).front().find("|crop=sphere:"), std::string::npos) << bundles(cropped).front();
  ASSERT_EQ(shown(cropped), 1U);
  const double edge = glm::length(cropped.view.tensors->image->axes[0]);
  EXPECT_NEAR(lengths(cropped).front(), 6.0 * edge, 0.8) << "the chord through the ball's centre";
}

TEST_F(BundleButtons, TractsAreHiddenByTheirLengthAndNothingIsDeleted) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  const std::string both = "name=two|color=#ff8000|line=-38,0,0,-20,0,0,-2,0,0|line=2,0,0,12,0,0";
  press("shown from", 0.5);
  const WindowResult longer = open({"open", "--example", "helix", "--bundle", both});
  EXPECT_EQ(shown(longer), 1U) << "36 mm, and not 10";
  EXPECT_EQ(longer.view.tracts->bundle->order.front(), 0U);
  EXPECT_EQ(bundles(longer).front(), both);
  press("shown to", 0.5);
  const WindowResult shorter = open({"open", "--example", "helix", "--bundle", both});
  ASSERT_EQ(shown(shorter), 1U);
  EXPECT_EQ(shorter.view.tracts->bundle->order.front(), 1U);
}

TEST_F(BundleButtons, TractsAreCutAndJoinedWhereTheyArePicked) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  const std::vector<std::string> arguments{"open", "--example", "helix", "--bundle", kTwo};
  const WindowResult first = open(arguments);
  ASSERT_EQ(shown(first), 2U);
  const Vec3 left = pixel_of(first, {-30.0, 0.0, 0.0}), right = pixel_of(first, {20.0, 0.0, 0.0});
  press("pick tracts");
  click(left.x, left.y);
  press("Cut tract");
  const WindowResult cut = open(arguments);
  ASSERT_EQ(shown(cut), 3U);
  std::vector<double> parts = lengths(cut);
  std::ranges::sort(parts);
  EXPECT_NEAR(parts[0], 8.0, 0.5) << "at the place that was picked";
  EXPECT_NEAR(parts[1], 28.0, 0.5);

  press("pick tracts");
  click(left.x, left.y);
  click(right.x, right.y);
  press("Join tracts");
  const WindowResult joined = open(arguments);
  ASSERT_EQ(shown(joined), 1U) << bundles(joined).front();
  EXPECT_NE(bundles(joined).front().find("|join="), std::string::npos) << bundles(joined).front();
  EXPECT_NEAR(lengths(joined).front(), 76.0, 0.01) << "from end to end, over the gap";

  press("pick tracts");
  click(left.x, left.y);
  click(right.x, right.y);
  press("Join tracts");
  key(kKeyZ, kModifierControl);
  EXPECT_EQ(shown(open(arguments)), 2U) << "undone";
}

TEST_F(BundleButtons, WhatAHandHasDrawnIsABundle) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  const std::vector<std::string> arguments{"open", "--example", "straight", "--mode", "anisotropy"};
  const WindowResult first = open(arguments);
  const CenterLine center = tensor_formula("straight")->center_lines().front();
  key('G');
  const Vec3 from = pixel_of(first, center.position(0.45));
  at({.kind = InputKind::kMove, .x = from.x, .y = from.y});
  at({.kind = InputKind::kPress, .x = from.x, .y = from.y});
  for (int n = 0; n <= 40; ++n) {
    const Vec3 x = pixel_of(first, center.position(0.45 + 0.0025 * n));
    at({.kind = InputKind::kMove, .x = x.x, .y = x.y});
  }
  at({.kind = InputKind::kRelease});
  next_ += 20;
  key('K');
  press("Drawn as bundle");
  key(kKeyS, kModifierControl);
  const WindowResult drawn = open(arguments);
  ASSERT_EQ(bundles(drawn).size(), 1U);
  EXPECT_NE(bundles(drawn).front().find("name=drawn|"), std::string::npos) << bundles(drawn).front();
  ASSERT_EQ(shown(drawn), 1U);
  EXPECT_GT(lengths(drawn).front(), 2.0) << "along the bundle [mm]";
  const WindowResult again = open({"open", "--session", folder_.path("a.palpate.toml")});
  EXPECT_EQ(bundles(again), bundles(drawn)) << "back with the session";
}

TEST_F(BundleButtons, OfATractogramAloneDoWhatTheyDoWithAnImage) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  (void)json({"tracts", "--example", "helix", "--bundle", kTwo, "--out", "two.trk"});
  const std::vector<std::string> alone{"open", folder_.path("two.trk")};
  press("Keep as bundle");
  press("sagittal", 0.3);
  press("plane");
  press("sagittal", 0.5, 1);  // of the list, behind the slice's own
  press("Part all here");
  press("Save bundle");
  press("Save density");
  key(kKeyS, kModifierControl);
  const WindowResult parted = open(alone);
  ASSERT_EQ(bundles(parted).size(), 1U);
  EXPECT_NE(bundles(parted).front().find("name=two|"), std::string::npos) << bundles(parted).front();
  ASSERT_EQ(shown(parted), 3U) << "the file's own tracts are shown as the bundle, and not beside it";
  EXPECT_EQ(read_tractogram(folder_.path("bundle.trx")).lines.line_count(), 3U);
  EXPECT_TRUE(fs::exists(folder_.path("bundle_density.nii.gz")));
  const WindowResult again = open({"open", "--session", folder_.path("a.palpate.toml")});
  EXPECT_EQ(bundles(again), bundles(parted));
  EXPECT_EQ(shown(again), 3U) << "all is back";
  EXPECT_EQ(again.view.tensors->slices, parted.view.tensors->slices) << "slices that were shown";
  EXPECT_EQ(again.view.tensors->position, parted.view.tensors->position);

  // And without a window.
  const auto edited = json({"tracts", "two.trk", "--bundle", "file=two.trk|part=1,0,0,-20|length=15,30",
                            "--out", "short.tck", "--density", "d.nii.gz"});
  EXPECT_EQ(edited["lengths"]["lines"], 2);
  EXPECT_EQ(edited["pieces"], 0) << "there is nothing that they are held against";
  EXPECT_TRUE(fs::exists(folder_.path("d.nii.gz")));
  const ProgramResult profiled = run({"tracts", "two.trk", "--bundle", "file=two.trk", "--profile", "p.csv"});
  EXPECT_EQ(profiled.exit_code, 2);
  EXPECT_NE(profiled.err.find("--profile-image"), std::string::npos) << profiled.err;
  const ProgramResult traced = run({"tracts", "two.trk", "--bundle", "seeds=fa:0.5|trace="});
  EXPECT_EQ(traced.exit_code, 2);
  EXPECT_NE(traced.err.find("no tensors"), std::string::npos) << traced.err;
}

TEST_F(BundleButtons, ASlabAboutTheOneSliceOfTheSceneLimitsItsTracts) {
  const auto picture = [&](const std::vector<std::string>& more) {
    std::vector<std::string> all{"render",  "--example", "helix",   "--seeds", "fa:0.6", "--camera",
                                 "0,0,0,1", "--size",    "300x300", "--out",   "p.png",  "--force"};
    all.insert(all.end(), more.begin(), more.end());
    const ProgramResult result = run(all);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    std::ifstream in(folder_.path("p.png"), std::ios::binary);
    return std::pair{std::string{std::istreambuf_iterator<char>(in), {}}, result.err};
  };
  const std::vector<std::string> one{"--slices", "-,-,0"};
  const auto with = [&](const char* slab) {
    std::vector<std::string> all = one;
    all.insert(all.end(), {"--tract-slab", slab});
    return picture(all).first.size();
  };
  const std::size_t whole = picture(one).first.size(), none = with("0"), thin = with("8");
  EXPECT_LT(none, thin) << "fewer lines make a smaller file";
  EXPECT_LT(thin, whole);
  EXPECT_NE(picture({"--tract-slab", "8"}).second.find("all tracts are drawn"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
