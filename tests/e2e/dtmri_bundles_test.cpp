// Bundles of tracts by the mouse and without a window: kept, picked, edited, undone, measured, saved, and back with the
// session; the corpus callosum and both cortico-spinal tracts of a whole head.

#include "tests/e2e/dtmri_bundles.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <string>
#include <vector>

#include "common/geometry/tractogram.h"
#include "common/load/read_tractogram.h"
#include "tests/e2e/program.h"
#include "tests/support/project_folders.h"
#include "tests/support/shared_data.h"

namespace palpate::test {
namespace {

namespace fs = std::filesystem;

class DtmriBundles : public BundlesWindow {};

TEST_F(DtmriBundles, AreEditedMeasuredAndWrittenWithoutAWindow) {
  const std::string traced = "seeds=fa:0.6|trace=";
  const auto lines = [&](const std::string& text) {
    return json({"tracts", "--example", "helix", "--bundle", text})["lengths"]["lines"].get<std::size_t>();
  };
  const std::size_t all = lines(traced);
  ASSERT_GT(all, 10U);
  EXPECT_EQ(lines(traced + "|delete=1,2,3"), all - 3);
  EXPECT_EQ(lines(traced + "|keep=box:-1000,-1000,-1000,1000,1000,1000"), all);
  EXPECT_EQ(lines(traced + "|line=0,0,0,10,0,0"), all + 1);

  (void)json({"tracts", "--example", "helix", "--bundle", "name=one|" + traced, "--bundle",
              "name=two|line=0,0,0,10,0,0|resample=1", "--out", "both.trx", "--profile", "p.csv", "--density",
              "d.nii.gz", "--bundle-mask", "m.nii.gz"});
  const Tractogram both = read_tractogram(folder_.path("both.trx")).lines;
  ASSERT_EQ(both.line_count(), all + 1);
  for (const char* name : {"group one", "group two"}) {
    const auto column = std::ranges::find(both.of_lines, name, &Tractogram::Column::name);
    ASSERT_NE(column, both.of_lines.end()) << name;
    EXPECT_EQ(column->values.front() != 0.0F, std::string(name) == "group one");
    EXPECT_EQ(column->values.back() != 0.0F, std::string(name) == "group two");
  }
  EXPECT_TRUE(fs::exists(folder_.path("p.csv")) && fs::exists(folder_.path("d.nii.gz")) &&
              fs::exists(folder_.path("m.nii.gz")));
  // A tractogram alone, on the image that its header places.
  const Json alone = json({"tracts", "both.trx", "--out", "alone.trk", "--density", "alone.nii.gz"});
  EXPECT_EQ(alone["lengths"]["lines"].get<std::size_t>(), all + 1);
  const auto image = read_tractogram(folder_.path("alone.trk")).lines.image;
  ASSERT_TRUE(image && both.image);
  EXPECT_EQ(image->voxels, both.image->voxels);
  EXPECT_EQ(json({"info", "alone.nii.gz"})["blocks"][0]["size"],
            json({"info", "d.nii.gz"})["blocks"][0]["size"]);
  EXPECT_EQ(run({"tracts", "both.trx", "--tracts", "both.trx"}).exit_code, 2);
  EXPECT_EQ(run({"tracts", "--example", "helix"}).exit_code, 2);
  const ProgramResult none = run({"tracts", "--example", "helix", "--bundle", traced + "|length=1e6,2e6"});
  EXPECT_EQ(none.exit_code, 1);
  EXPECT_NE(none.err.find("no tract is left"), std::string::npos) << none.err;
  EXPECT_EQ(run({"tracts", "--example", "helix", "--bundle", traced, "--tracts", "both.trx"}).exit_code, 2);
  EXPECT_EQ(run({"tracts", "--example", "helix", "--bundle", "smooth=no"}).exit_code, 2);
}

TEST_F(DtmriBundles, AreKeptPickedCutUndoneAndBackWithTheSession) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  press("Keep as bundle");
  press("Smooth");
  press("Resample");
  key(kKeyZ, kModifierControl);
  press("Cut nearest");
  choose("profile of", "fa");
  press("Save bundle");
  press("Save bundle");
  press("Save mask");
  press("Save profile");
  key(kKeyS, kModifierControl);
  const WindowResult first = open({"open", "--example", "helix", "--seeds", "fa:0.6"});
  ASSERT_EQ(bundles(first).size(), 1U);
  const std::string text = bundles(first).front();
  EXPECT_NE(text.find("seeds=fa:0.6|trace=|smooth="), std::string::npos) << text;
  EXPECT_EQ(text.find("resample"), std::string::npos) << "undone: " << text;
  EXPECT_NE(text.find("|cut="), std::string::npos) << text;
  EXPECT_TRUE(first.document.tracts.seeds.empty()) << "the next Trace leaves the bundle";
  const Tractogram saved = read_tractogram(folder_.path("bundle.trx")).lines;
  EXPECT_EQ(saved.line_count(), shown(first));
  EXPECT_TRUE(fs::exists(folder_.path("bundle-2.trx"))) << "nothing is overwritten";
  EXPECT_TRUE(fs::exists(folder_.path("bundle_mask.nii.gz")));
  EXPECT_TRUE(fs::exists(folder_.path("bundle_fa.csv")));

  // The line under the middle of the picture, by the mouse.
  const WindowResult again = open({"open", "--session", folder_.path("a.palpate.toml")});
  EXPECT_EQ(bundles(again), bundles(first));
  EXPECT_EQ(again.document.tract_appearance.bundle_profile, "fa");
  ASSERT_EQ(shown(again), shown(first));
  EXPECT_EQ(again.view.tracts->bundle->lines->points, first.view.tracts->bundle->lines->points)
      << "traced and edited anew, to the last bit";

  const auto line = again.view.tracts->bundle->lines->line(shown(again) / 2);
  const Vec3 place = pixel_of(again, Vec3(line[line.size() / 2]));
  press("pick tracts");
  click(place.x, place.y);
  press("Delete tract");
  key(kKeyS, kModifierControl);
  const WindowResult deleted = open({"open", "--session", folder_.path("a.palpate.toml")});
  EXPECT_NE(bundles(deleted).front().find("|delete="), std::string::npos) << bundles(deleted).front();
  EXPECT_EQ(shown(deleted), shown(again) - 1);
}

TEST_F(DtmriBundles, DroppedTractsJoinTheImageAndASetOpensAsOne) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  PALPATE_NEED_DATA(head, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  const std::string stem = head.string().substr(0, head.string().size() - std::string(".nii.gz").size());
  (void)json({"trace", "--example", "helix", "--seeds", "fa:0.6", "--out", "one.trk"});
  (void)json({"tracts", "--example", "helix", "--tracts", "one.trk", "--out", "two.tck"});
  (void)json({"trace", head.string(), "--seeds", "sphere:-22,15,23,9", "--out", "left.trk"});
  const auto drop = [&](std::vector<fs::path> files) {
    at({.kind = InputKind::kDrop, .files = std::move(files)});
    next_ += 6;
  };
  drop({folder_.path("one.trk")});
  drop({folder_.path("two.tck")});
  const WindowResult beside = open({"open", "--example", "helix"});
  EXPECT_EQ(beside.document.tract_appearance.file, folder_.path("one.trk"));
  ASSERT_EQ(bundles(beside).size(), 1U) << "the second one does not take the place of the first";
  EXPECT_NE(bundles(beside).front().find("name=two|"), std::string::npos) << bundles(beside).front();
  const std::size_t one = read_tractogram(folder_.path("one.trk")).lines.line_count();
  EXPECT_EQ(shown(beside), 2 * one);

  drop({folder_.path("left.trk"), stem + ".bvec", head, stem + ".bval"});
  const WindowResult set = open({"open", "--example", "helix"});
  ASSERT_EQ(set.document.input.files, std::vector<fs::path>{head});
  EXPECT_EQ(set.document.tract_appearance.file, folder_.path("left.trk"));
  EXPECT_EQ(shown(set), read_tractogram(folder_.path("left.trk")).lines.line_count());
  EXPECT_TRUE(set.view.tensors && set.view.tensors->image->field)
      << "fitted with the table that came with it";

  const WindowResult alone = open({"open", folder_.path("left.trk")});
  EXPECT_EQ(shown(alone), shown(set)) << "tracts open alone";
}

/// As a neuroanatomist would, mouse only. PALPATE_WRITE_PAGES makes the pictures of docs/guide/dtmri.md.
TEST_F(DtmriBundles, OfAWholeHeadAreDrawnCleanedProfiledAndSaved) {
  if (!window_available()) GTEST_SKIP() << "no display: run under xvfb-run";
  PALPATE_NEED_DATA(shared, "dtmri/brain-dwi/3000_DTI_PA-ortho_cl.nii.gz");
  // By its name alone, as the pictures are to show it.
  const fs::path head = shared.filename(), table = head.stem().stem();
  for (const char* ending : {".nii.gz", ".bval", ".bvec"})
    fs::create_symlink(shared.parent_path() / (table.string() + ending),
                       folder_.path(table.string() + ending));
  const std::string session = folder_.path("a.palpate.toml");
  const auto show = [&](const std::string& step, int notches) {
    if (std::getenv("PALPATE_WRITE_PAGES") == nullptr) return;
    const int width = std::exchange(width_, 1200), height = std::exchange(height_, 800);
    // Bundles alone in the scene, and their part of the panel.
    for (int slice = 0; slice < 3; ++slice) press("##shown", 0.5, slice);
    for (const char* part : {"TENSORS", "UNDERLAY", "TRACTS", "SLICES", "ANISOTROPY AS A VOLUME"})
      press(part);
    for (int i = 0; i < notches; ++i) {
      at({.kind = InputKind::kMove, .x = 100.0, .y = 500.0});
      at({.kind = InputKind::kWheel, .x = 0.0, .y = -1.0});
    }
    at({.kind = InputKind::kMove, .x = 900.0, .y = 790.0});  // no hint over the picture
    (void)open({"open", "--session", session},
               source_folder() / "docs" / "guide" / ("dtmri_" + step + ".png"));
    width_ = width;
    height_ = height;
  };
  // Places on the sliders: from the first to the last voxel.
  const auto cross = [&](double x, double y, double z) {
    press("sagittal", (x + 117.6) / 237.0);
    press("coronal", (y + 102.5) / 237.0);
    press("axial", (z + 37.0) / 117.0);
  };
  const auto trace_and_keep = [&] {
    press("Trace");
    press("Keep as bundle");
  };
  key(kKeyS);
  key(kKeyS);
  // The corpus callosum where it bends, in its middle and in front, as one; then a tract on either side.
  cross(0.0, -8.0, 27.0);
  press("Trace");
  key(kKeyS, kModifierControl);
  const WindowResult traced = open({"open", head.string()});
  EXPECT_GT(shown(traced), 50U);
  EXPECT_EQ(traced.document.panes.layout, "4");
  show("traced", 0);
  press("Keep as bundle");
  for (const Vec3& place : {Vec3(0.0, 20.0, 40.0), Vec3(0.0, 57.0, 31.0)}) {
    cross(place.x, place.y, place.z);
    trace_and_keep();
  }
  for (const char* other : {"2 bundle 2", "2 bundle 3"}) {
    choose("with", other);
    press("Join bundles");
  }
  cross(-22.0, 15.0, 23.0);
  trace_and_keep();
  cross(22.7, 18.0, 23.0);
  trace_and_keep();
  key(kKeyS, kModifierControl);
  const WindowResult drawn = open({"open", "--session", session});
  ASSERT_EQ(bundles(drawn).size(), 3U);
  const std::size_t all = shown(drawn);
  EXPECT_GT(all, 100U);
  show("bundles", 2);

  // The corpus callosum reaches far into both halves. A tract beside it goes through a ball high up, and does not cross
  // the middle.
  const auto plane = [&](double x, const char* role, const char* side) {
    cross(x, 16.0, 46.0);
    choose("new region", role);
    press("Beyond plane");
    if (std::string(side) != "right") choose("side 2", side);
  };
  const auto clean = [&](const char* one) {
    choose("edit", one);
    press("Clean by regions");
    press("Remove 2");
    press("Remove 1");
  };
  plane(10.0, "include", "right");
  plane(-10.0, "include", "left");
  clean("1 bundle 1");
  cross(22.0, 16.0, 46.0);
  press("Ball");
  plane(3.0, "exclude", "left");
  clean("3 bundle 3");
  cross(-19.5, 16.0, 46.0);
  choose("new region", "include");
  press("Ball");
  plane(-3.0, "exclude", "right");
  key(kKeyS, kModifierControl);
  const WindowResult regions = open({"open", "--session", session});
  EXPECT_EQ(regions.document.tracts.include.size(), 1U);
  EXPECT_EQ(regions.document.tracts.exclude.size(), 1U);
  show("regions", 2);

  choose("edit", "2 bundle 2");
  press("Clean by regions");
  choose("profile of", "fa");
  press("Save profile");
  // Each bundle under a name of its own: bundle, bundle-2, bundle-3.
  for (const char* one : {"1 bundle 1", "2 bundle 2", "3 bundle 3"}) {
    choose("edit", one);
    for (const char* format : {".trk", ".tck", ".trx"}) {
      choose("format", format);
      press("Save bundle");
    }
  }
  key(kKeyS, kModifierControl);
  const WindowResult cleaned = open({"open", "--session", session});
  ASSERT_EQ(bundles(cleaned).size(), 3U);
  const auto has = [&](std::size_t bundle, const char* step) {
    EXPECT_NE(bundles(cleaned)[bundle].find(step), std::string::npos) << bundles(cleaned)[bundle];
  };
  has(0, "|keep=beyond:1,0,0,");
  has(0, "|keep=beyond:-1,0,0,");
  for (const std::size_t beside : {1U, 2U}) has(beside, "|keep=sphere:");
  has(1, "|drop=beyond:1,0,0,");
  has(2, "|drop=beyond:-1,0,0,");
  EXPECT_LT(shown(cleaned), all);
  EXPECT_TRUE(fs::exists(folder_.path("bundle_fa.csv")));
  std::size_t saved = 0;
  for (const char* stem : {"bundle", "bundle-2", "bundle-3"}) {
    const Tractogram trx = read_tractogram(folder_.path(std::string(stem) + ".trx")).lines,
                     trk = read_tractogram(folder_.path(std::string(stem) + ".trk")).lines;
    saved += trx.line_count();
    ASSERT_EQ(trk.line_count(), trx.line_count());
    ASSERT_EQ(trk.points.size(), trx.points.size());
    for (std::size_t p = 0; p < trx.points.size(); ++p)
      ASSERT_LT(glm::distance(trx.points[p], trk.points[p]), 1e-3F);
    EXPECT_GT(trx.line_count(), 5U) << stem;
    for (std::size_t l = 0; l < trx.line_count(); ++l) {
      const auto x = [](const Vec3f& a, const Vec3f& b) { return a.x < b.x; };
      const auto [left, right] = std::ranges::minmax_element(trx.line(l), x);
      if (std::string(stem) == "bundle") {
        EXPECT_TRUE(left->x < -9.0F && right->x > 9.0F) << "from one half into the other";
      } else {
        EXPECT_TRUE(std::string(stem) == "bundle-2" ? right->x < 0.0F : left->x > 0.0F)
            << stem << " on its own side";
      }
    }
  }
  EXPECT_EQ(saved, shown(cleaned)) << "all that is seen";
  const WindowResult again = open({"open", "--session", session});
  EXPECT_EQ(bundles(again), bundles(cleaned)) << "all is back";
  EXPECT_EQ(again.document.tracts.include, cleaned.document.tracts.include);
  EXPECT_EQ(again.document.tracts.exclude, cleaned.document.tracts.exclude);
  EXPECT_EQ(again.document.tract_appearance.bundle_profile, "fa");
  EXPECT_EQ(again.view.tensors->slices, cleaned.view.tensors->slices);
  EXPECT_EQ(again.view.tensors->position, cleaned.view.tensors->position);
  EXPECT_EQ(again.view.tracts->bundle->lines->points, cleaned.view.tracts->bundle->lines->points);
  show("cleaned", 14);
  // In the programs of others, with the image as reference.
  std::vector<std::string> peers{"/usr/bin/python3",
                                 (source_folder() / "scripts" / "tensor_peers.py").string(), "--tracts",
                                 head.string()};
  for (const char* stem : {"bundle", "bundle-2", "bundle-3"}) peers.push_back(folder_.path(stem));
  const ProgramResult opened = Program(peers).finish();
  constexpr int kNotInstalled = 77;
  if (opened.exit_code == kNotInstalled)
    std::cout << "not opened in other programs: " << opened.err;
  else
    EXPECT_EQ(opened.exit_code, 0) << opened.out << opened.err;
  RecordProperty("peers", opened.out);
  if (const char* folder = std::getenv("PALPATE_PICTURES")) {
    for (const char* name : {"bundle-2.trx", "bundle-2.trk", "bundle_fa.csv", "a.palpate.toml"})
      fs::copy(folder_.path(name), fs::path(folder) / name, fs::copy_options::overwrite_existing);
  }
}

}  // namespace
}  // namespace palpate::test
