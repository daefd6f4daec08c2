// Bundles as text: what is read and refused, that it comes back, and what its steps make of tracts.

#include "apps/dtmri/bundle_text.h"

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/dtmri/bundles.h"
#include "common/base/error.h"
#include "common/field/tensor/tensor_field.h"
#include "common/load/write/write_tractogram.h"
#include "common/render/tensor/tensor_voxels.h"
#include "common/scene/input.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

TEST(BundleText, ComesBackFromItsText) {
  for (
      const char* text :
      {"name=Left|color=direction", "name=a b=c|color=#0f80ff|shown=off|file=/x/a b.trk|smooth=1.5",
       "name=|color=fa|seeds=sphere:0,0,0,5|cutoff=0.3|include=box:0,0,0,1,1,1|include=sphere:1,2,3,4|trace=|"
       "delete=1,2|cut=3,0,0,1|part=0,0,1,4|join=1,2|resample=2|length=10,20|keep=beyond:0,0,1,4|also=|"
       "line=0,0,0,1,1,1|all="})
    EXPECT_EQ(bundle_text(parse_bundle(text)), text);
}

TEST(BundleText, RefusesWhatItWouldNotUnderstand) {
  for (const char* text : {"",
                           "name",
                           "colour=red",
                           "color=#12345",
                           "color=",
                           "shown=yes",
                           "delete=0",
                           "delete=1.5",
                           "delete=",
                           "join=2,2",
                           "join=1",
                           "cut=1,2,3",
                           "part=0,0,0,1",
                           "smooth=0",
                           "smooth=nan",
                           "resample=-1",
                           "length=5,4",
                           "keep=ball:1",
                           "file=",
                           "trace=",
                           "seeds=fa:0.4",
                           "seeds=fa:0.4|smooth=1",
                           "cutoff=2|seeds=fa:0.4|trace=",
                           "cutoff=0.3|trace=",
                           "line=0,0,0",
                           "line=0,0,0,1,1",
                           "also=",
                           "all=",
                           "also=|all=|all=",
                           "trace=1"})
    EXPECT_THROW((void)parse_bundle(text), Error) << text;
  EXPECT_THROW((void)bundle_text({.steps = {{"file", "a|b.trk"}}}), Error);
  EXPECT_THROW((void)bundle_text({.steps = {{"file", "a;b.trk"}}}), Error);
}

TEST(BundleText, TracingComesBackFromItsSteps) {
  TractTracingOptions options;
  options.seeds = "sphere:1,2,3,4";
  options.cutoff = 0.15;
  options.max_cone = 12.5;
  options.include = {"sphere:0,0,0,1", "box:0,0,0,1,1,1"};
  options.exclude = {"mask:a.nii"};
  options.direction = "forward";
  std::vector<BundleStep> steps = steps_of(options);
  ASSERT_EQ(steps.back().key, "trace");
  (void)parse_bundle(steps_text(steps));
  steps.pop_back();
  EXPECT_EQ(tracing_of(steps), options);
}

TEST(BundleText, ColoursComeBack) {
  EXPECT_EQ(text_of_color(*color_of_text("#0f80ff")), "#0f80ff");
  EXPECT_FALSE(color_of_text("0f80ff0"));
  EXPECT_FALSE(color_of_text("#0f80fg"));
  for (std::size_t i = 0; i < 12; ++i) EXPECT_TRUE(color_of_text(first_color(i))) << i;
  EXPECT_NE(first_color(0), first_color(1));
}

/// The built-in bundle that bends, and what makes bundles in it.
class BundlesOfHelix : public testing::Test {
 protected:
  BundlesOfHelix() {
    InputOptions asked;
    asked.kind = FieldKind::kTensor;
    asked.example = "helix";
    Input input = Input::open(asked, nullptr);
    voxels_ = make_tensor_voxels(input.load_tensor(1, nullptr, nullptr), "helix", 1);
  }
  std::shared_ptr<const BundleSet> make(std::vector<std::string> texts, const BundleSet* before = nullptr,
                                        std::vector<std::string>* notes = nullptr) {
    Document document;
    document.common.threads = 1;
    document.tract_appearance.bundles = std::move(texts);
    std::vector<std::string> said;
    return make_bundles({.document = document, .voxels = *voxels_, .before = before, .progress = &progress_},
                        {}, notes != nullptr ? *notes : said);
  }

  Progress progress_;
  std::shared_ptr<const TensorVoxels> voxels_;
};

TEST_F(BundlesOfHelix, TraceEditsAndMergesStayApart) {
  const std::string source = "seeds=fa:0.6|trace=";
  const auto plain =
      make({source, source + "|delete=1,2", source + "|also=|line=0,0,0,10,0,0|resample=1|all="});
  ASSERT_EQ(plain->bundles.size(), 3U);
  const std::size_t count = plain->bundles[0].lines->line_count();
  ASSERT_GT(count, 10U);
  EXPECT_GT(plain->bundles[0].volume, 0.0);
  EXPECT_EQ(plain->bundles[1].lines->line_count(), count - 2);
  const Tractogram& merged = *plain->bundles[2].lines;
  ASSERT_EQ(merged.line_count(), count + 1);
  EXPECT_EQ(merged.line(count).size(), 11U) << "spread anew";
  EXPECT_EQ(merged.line(0).size(), plain->bundles[0].lines->line(0).size()) << "and this one is not";
  EXPECT_EQ(plain->sources.size(), 1U) << "traced once";

  // An edit takes what was traced from what was there before.
  const auto edited = make({source + "|smooth=1"}, plain.get());
  EXPECT_EQ(edited->sources.begin()->second.lines, plain->sources.begin()->second.lines);
  const auto same = make({source}, plain.get());
  EXPECT_EQ(same->bundles[0].lines, plain->bundles[0].lines);
  EXPECT_EQ(same->sources.size(), 1U) << "kept for the next edit";
}

TEST_F(BundlesOfHelix, WhatMeansNothingAnyMoreIsSaid) {
  std::vector<std::string> notes;
  const auto set = make({"name=one|line=0,0,0,10,0,0|delete=2|join=1,3|cut=1,-5,0,0"}, nullptr, &notes);
  EXPECT_EQ(set->bundles[0].lines->line_count(), 1U);
  ASSERT_EQ(notes.size(), 3U);
  std::vector<std::string> again;
  (void)make(set->texts, set.get(), &again);
  EXPECT_EQ(again, notes) << "not only once";
  EXPECT_NE(notes[0].find("bundle one: WARNING: delete=2 is left out: there is no tract 2 of 1"),
            std::string::npos)
      << notes[0];
  EXPECT_NE(notes[2].find("cuts nothing"), std::string::npos) << notes[2];
}

TEST_F(BundlesOfHelix, FilesAreBundlesAndColoursAreTheirs) {
  const TempFolder folder;
  const auto traced = make({"seeds=fa:0.6|trace="});
  const std::string file = folder.path("a.trx");
  write_tractogram(file, *traced->bundles[0].lines, false);
  const auto set = make({"name=a|color=#ff0000|file=" + file, "color=direction|line=0,0,0,5,0,0",
                         "shown=off|line=0,0,0,5,0,0"});
  EXPECT_EQ(set->bundles[0].lines->points, traced->bundles[0].lines->points);
  std::vector<std::string> notes;
  const auto drawn = drawn_together(nullptr, *set, {}, notes);
  ASSERT_TRUE(drawn);
  EXPECT_EQ(drawn->lines->line_count(), traced->bundles[0].lines->line_count() + 1) << "not the hidden one";
  ASSERT_EQ(drawn->colors.size(), drawn->lines->points.size());
  EXPECT_EQ(drawn->colors.front(), packed_color({1.0F, 0.0F, 0.0F}));
  EXPECT_EQ(drawn->colors.back(), TractBundle::kByDirection);
  EXPECT_TRUE(notes.empty());
  (void)drawn_together(nullptr, *make({"color=t1|line=0,0,0,5,0,0"}), {}, notes);
  ASSERT_EQ(notes.size(), 1U);
  EXPECT_NE(notes[0].find("coloured by direction"), std::string::npos);
}

}  // namespace
}  // namespace palpate::test
