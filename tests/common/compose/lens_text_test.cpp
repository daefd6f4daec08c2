#include "common/compose/text/lens_text.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/text.h"

namespace palpate {
namespace {

/// With ';' between, as a session has them.
std::string joined(const std::vector<std::string>& texts) {
  std::string all;
  for (const std::string& text : texts) (all += all.empty() ? "" : ";") += text;
  return all;
}

Lens lens_of(const std::string& text) { return parse_lens(text).lens; }

std::optional<std::string> words_of(const Lens& lens) { return lens_text(lens, VolumeView{}); }

// Membership decides whether the words mean the shape: x in the ball is |x - c| <= r and so on.
TEST(LensText, MeansTheShapesThatItNames) {
  const Lens sphere = lens_of("sphere:1,2,3,0.5"), box = lens_of("box:2,0,0,1,4,8");
  const Lens cylinder = lens_of("cylinder:0,0,0,0,0,4,1.5"), half = lens_of("halfspace:0,0,2,3");
  const Lens wedge = lens_of("polyhedron:-1,0,0,0,0,-2,0,0,0,0,-1,0,1,1,1,6");
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-1.0, 9.0);
  for (int i = 0; i < 5000; ++i) {
    const Vec3 x(place(random), place(random), place(random));
    ASSERT_EQ(sphere.shape.contains(x), glm::distance(x, Vec3(1.0, 2.0, 3.0)) <= 0.5);
    ASSERT_EQ(box.shape.contains(x),
              x.x >= 1.0 && x.x <= 2.0 && x.y >= 0.0 && x.y <= 4.0 && x.z >= 0.0 && x.z <= 8.0);
    ASSERT_EQ(cylinder.shape.contains(x), std::hypot(x.x, x.y) <= 1.5 && x.z >= 0.0 && x.z <= 4.0);
    ASSERT_EQ(half.shape.contains(x), x.z >= 1.5);
    ASSERT_EQ(wedge.shape.contains(x), std::min({x.x, x.y, x.z}) >= 0.0 && x.x + x.y + x.z <= 6.0);
  }
  EXPECT_FALSE(sphere.cut);
  EXPECT_TRUE(lens_of("halfspace:0,0,1,3,cut").cut);
  EXPECT_FALSE(sphere.transfer);
}

TEST(LensText, GivesTheWordsBack) {
  for (const std::string text :
       {"sphere:1,-2,3,0.5", "box:-1,0,0.25,2,4,8", "cylinder:1,0,0,1,0,4,2,cut", "halfspace:0,0,1,-3,cut",
        "polyhedron:1,0,0,1,0,1,0,1,0,0,1,1,-1,0,0,2", "sphere:1,2,3,4,magnify=2.5", "screen:-0.25,0.5,0.125",
        "screen:0,0,0.25,cut", "box:-1,0,0.25,2,4,8,blend=0.5"}) {
    EXPECT_EQ(words_of(lens_of(text)), text);
  }
  VolumeView view;
  view.lenses = {lens_of("sphere:1,2,3,4"), lens_of("halfspace:1,0,0,2,cut")};
  EXPECT_EQ(joined(lens_texts(view)), "sphere:1,2,3,4;halfspace:1,0,0,2,cut");
  view.cuts = {{.kept = {{0.0, 1.0, 0.0}, 3.0}, .on = false}};
  EXPECT_EQ(joined(lens_texts(view)), "halfspace:0,1,0,3,cut,off;sphere:1,2,3,4;halfspace:1,0,0,2,cut");
  const Lens oblique = lens_of("cylinder:0.1,0.2,0.3,1,2,-3,0.7");
  const Lens again = lens_of(*words_of(oblique));
  EXPECT_NEAR(glm::distance(center_of(oblique.shape, {}), center_of(again.shape, {})), 0.0, 1e-14);
  EXPECT_NEAR(again.shape.quadric->unit_from_data[0][0], oblique.shape.quadric->unit_from_data[0][0], 1e-14);
}

TEST(LensText, StaysTheSameShapeWhenMovedAndScaled) {
  const auto changed = [](const std::string& text) {
    Lens lens = lens_of(text);
    lens.shape = scaled(moved(lens.shape, {1.0, 2.0, 4.0}), 2.0);
    return *words_of(lens);
  };
  EXPECT_EQ(changed("sphere:1,2,3,4"), "sphere:2,4,7,8");
  EXPECT_EQ(changed("box:0,0,0,2,4,8"), "box:0,0,0,4,8,16");
  EXPECT_EQ(changed("cylinder:0,0,0,0,0,4,1"), "cylinder:1,2,2,1,2,10,2");
  EXPECT_EQ(changed("halfspace:0,0,1,3"), "halfspace:0,0,1,7");
}

std::string refusal(const std::string& text) {
  try {
    (void)parse_lens(text);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    return error.what();
  }
  return "accepted";
}

TEST(LensText, RefusesWhatIsNoLens) {
  for (const std::string text : {"",
                                 "sphere",
                                 "ball:1,2,3,4",
                                 "sphere:1,2,3",
                                 "sphere:1,2,3,4,5",
                                 "sphere:1,2,x,4",
                                 "sphere:1,2,3,nan",
                                 "sphere:1,2,3,0",
                                 "sphere:1,2,3,-1",
                                 "box:0,0,0,1,1,0",
                                 "cylinder:1,1,1,1,1,1,2",
                                 "cylinder:0,0,0,1,0,0,0",
                                 "halfspace:0,0,0,1",
                                 "halfspace:inf,0,0,1",
                                 "sphere:1,2,3,4,cut,cut",
                                 "sphere:1,2,3,4,magnify=0.5",
                                 "sphere:1,2,3,4,magnify=nan",
                                 "halfspace:0,0,1,3,magnify=2",
                                 "halfspace:0,0,1,3,off",
                                 "sphere:1,2,3,4,cut,off",
                                 "polyhedron:1,0,0,1,0,1,0,1,0,0,1,1,magnify=2",
                                 "polyhedron:1,0,0",
                                 "polyhedron:0,0,0,1",
                                 "screen:0,0",
                                 "screen:0,0,0",
                                 "screen:0,0,nan",
                                 "screen:0,0,0.2,magnify=2",
                                 "sphere:1,2,3,4,blend=1.5",
                                 "sphere:1,2,3,4,blend=-0.1",
                                 "halfspace:0,0,1,3,blend=0.5",
                                 "sphere:1,2,3,4,samples=0",
                                 "sphere:1,2,3,4,shading=dim",
                                 "sphere:1,2,3,4,shading=on,shading=on"}) {
    EXPECT_NE(refusal(text).find("--lens " + text), std::string::npos) << text << ": " << refusal(text);
  }
}

TEST(Lenses, ThatCutComeFirstAndShowNothingOfTheirOwn) {
  VolumeOptions options;
  options.lenses = {"sphere:0,0,0,1", "halfspace:1,0,0,2,cut", "sphere:0,0,0,2,cut",
                    "halfspace:0,1,0,3,off,cut"};
  options.clips = {"0,0,1,5"};
  options.shading = false;
  const ColorTransfer focus = make_color_transfer(ColorPreset::kMr, 0.0, 1.0);
  Lens model;
  model.transfer = focus;
  const VolumeParts parts = make_parts(options, model);
  const std::vector<Lens>& lenses = parts.lenses;
  ASSERT_EQ(lenses.size(), 2U);
  ASSERT_EQ(parts.cuts.size(), 3U);
  EXPECT_EQ(parts.cuts[0], (CuttingPlane{.kept = {{0.0, 0.0, 1.0}, 5.0}})) << "n.x > d is cut away";
  EXPECT_TRUE(parts.cuts[1].on);
  EXPECT_FALSE(parts.cuts[2].on);
  VolumeView view;
  view.lenses = lenses;
  view.cuts = parts.cuts;
  view.shading = false;
  EXPECT_EQ(joined(lens_texts(view)),
            "halfspace:0,0,1,5,cut;halfspace:1,0,0,2,cut;halfspace:0,1,0,3,cut,off;sphere:0,0,0,2,cut;sphere:"
            "0,0,0,1");
  EXPECT_FALSE(lenses[0].transfer);
  EXPECT_EQ(lenses[1].transfer, focus);
  EXPECT_FALSE(lenses[1].shading);
  options.clips.assign(kMostCuts - 1, "0,0,1,5");
  EXPECT_THROW((void)make_parts(options, model), Error) << "one plane too many";
}

// However often they are saved and opened.
TEST(Lenses, OfFacesComeBackToTheBit) {
  std::mt19937 random(11);
  std::normal_distribution<double> number;
  for (int i = 0; i < 300; ++i) {
    std::string face, faces;
    for (int k = 0; k < 4; ++k) {
      face.clear();
      for (int c = 0; c < 4; ++c) face += (c > 0 ? "," : "") + exact_number(number(random));
      faces += (k > 0 ? "," : "") + face;
    }
    VolumeOptions options;
    options.lenses = {"halfspace:" + face + ",cut", "polyhedron:" + faces};
    VolumeView view;
    const VolumeParts first = make_parts(options);
    view.cuts = first.cuts;
    view.lenses = first.lenses;
    const std::string saved = joined(lens_texts(view));
    options.lenses = {saved.substr(0, saved.find(';')), saved.substr(saved.find(';') + 1)};
    const VolumeParts again = make_parts(options);
    ASSERT_EQ(again.cuts, first.cuts) << saved;
    ASSERT_EQ(again.lenses[0].shape, first.lenses[0].shape) << saved;
  }
}

// Another field and a transfer function of its own, whose words may have any commas but no ';'.
TEST(Lenses, NameAFieldAndATransferFunctionOfTheirOwn) {
  const LensSpec words =
      parse_lens("sphere:0,0,0,1,samples=8,field=pet.nii.gz:scalars,tf=points:0,0,0,0,0/2,1,1,1,1");
  EXPECT_EQ(words.field, "pet.nii.gz:scalars");
  EXPECT_EQ(words.transfer, "points:0,0,0,0,0/2,1,1,1,1");
  EXPECT_EQ(words.samples, 8.0);
  EXPECT_EQ(parse_lens("box:0,0,0,1,1,1,tf=mr").transfer, "mr");
  for (const char* bad : {"sphere:0,0,0,1,cut,field=a", "sphere:0,0,0,1,cut,tf=mr",
                          "sphere:0,0,0,1,field=", "sphere:0,0,0,1,tf=", "sphere:0,0,0,1,field=a,field=b",
                          "sphere:0,0,0,1,blend=0.5,field=a"})
    EXPECT_THROW((void)parse_lens(bad), Error) << bad;
  VolumeView view;
  view.fields = {{nullptr, "a"}, {nullptr, "b"}};
  Lens lens = words.lens;
  lens.field = 2;
  EXPECT_EQ(lens_text(lens, view), "sphere:0,0,0,1,field=b");
  lens.own_transfer = true;
  lens.transfer = ColorTransfer({{0.0, Vec3f(0.0F), 0.0}, {2.0, Vec3f(1.0F), 1.0}});
  EXPECT_EQ(lens_text(lens, view), "sphere:0,0,0,1,field=b,tf=points:0,0,0,0,0/2,1,1,1,1");
  lens.regions = RegionTransfer({{.corners = {Vec2(0.0), Vec2(2.0), Vec2(0.0)}}});
  const auto text = lens_text(lens, view);
  ASSERT_TRUE(text);
  EXPECT_EQ(parse_lens(*text).transfer, "regions:box,0,0,2,2,1,1,1,0.5,0.25");
}

// What a session keeps makes the same lenses again, whatever the context's rays are.
TEST(Lenses, KeepRaysOfTheirOwn) {
  VolumeOptions options;
  options.lenses = {"sphere:0,0,0,1,samples=8,shading=off,magnify=3", "box:0,0,0,1,1,1"};
  options.samples = 2.0;
  VolumeView view;
  view.samples_per_voxel = 2.0;
  view.lenses = make_parts(options).lenses;
  EXPECT_EQ(view.lenses[0].samples_per_voxel, 8.0);
  EXPECT_FALSE(view.lenses[0].shading);
  EXPECT_EQ(view.lenses[0].magnification, 3.0);
  EXPECT_EQ(view.lenses[1].samples_per_voxel, 2.0);
  EXPECT_TRUE(view.lenses[1].shading);
  EXPECT_EQ(joined(lens_texts(view)), "sphere:0,0,0,1,magnify=3,samples=8,shading=off;box:0,0,0,1,1,1");
}

}  // namespace
}  // namespace palpate
