#include "common/compose/appearance.h"

#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/compose/view_keep.h"
#include "common/render/color/palette.h"
#include "common/scene/document/setting.h"
#include "common/scene/session_of.h"

namespace palpate::test {
namespace {

Document of_kind(FieldKind kind) {
  Document document;
  document.input.kind = kind;
  return document;
}

SceneView view_of(const Document& document) {
  SceneView view;
  apply_appearance(document, view);
  return view;
}

/// A document that is opened from the session of another one.
Document reopened(const Document& document) {
  const Session session{.program = "program", .options = saved_settings(document)};
  Document opened = of_kind(document.input.kind);
  std::vector<std::string> notes;
  (void)take_settings(session, opened.input.kind, "s.toml", opened, notes);
  return opened;
}

/// All that mouse, keys and panels change of a view and apply_appearance() makes. The names stand for the
/// members of the two structs in turn: the compiler counts them, so that one more has to be named here, and
/// then it is kept, or made of the data.
std::vector<std::function<void(SceneView&)>> edits() {
  SceneView view;
  auto& [bounds, lines, outline, style, units, background, show_outline, show_axes, show_color_bar,
         color_bar_left, show_scale_bar, caption, title, subtitle, camera, aspect, stereo, probe, surfaces,
         color_lens, volume, slice, tensors, tracts, notes, regions, labels, volume_label, anatomical,
         beside] = view;
  auto& [color_by, array, range, usual, logarithmic, color_map, width, opacity, clearing, halo, depth_cue,
         dimming] = style;
  // What data, seeds, stereo options, hands and annotations make, and what has a keep_…() of its own.
  (void)bounds, (void)lines, (void)outline, (void)units, (void)title, (void)subtitle, (void)stereo;
  (void)probe, (void)surfaces, (void)color_lens, (void)volume, (void)tensors, (void)tracts, (void)notes;
  (void)labels, (void)slice, (void)volume_label, (void)anatomical, (void)array, (void)clearing, (void)dimming,
      (void)usual, (void)regions, (void)beside;
  // What an edit of these changes of another view.
  (void)background, (void)show_outline, (void)show_axes, (void)show_color_bar, (void)color_bar_left,
      (void)show_scale_bar, (void)caption, (void)camera, (void)color_by, (void)aspect;
  (void)range, (void)logarithmic, (void)color_map, (void)width, (void)opacity, (void)halo, (void)depth_cue;
  return {[](SceneView& v) { v.background = Background::kLight; },
          [](SceneView& v) {
            v.background = {{0.1F, 0.2F, 0.7F}, {0.1F, 0.2F, 0.7F}};
          },
          [](SceneView& v) { v.show_outline = !v.show_outline; },
          [](SceneView& v) { v.show_axes = !v.show_axes; },
          [](SceneView& v) { v.show_color_bar = !v.show_color_bar; },
          [](SceneView& v) { v.color_bar_left = true; },
          [](SceneView& v) { v.show_scale_bar = true; },
          [](SceneView& v) { v.caption = "one, \"two\""; },
          [](SceneView& v) {
            v.style.range = ValueRange{-1.0 / 3.0, 2e7};
          },
          [](SceneView& v) { v.style.logarithmic = true; },
          [](SceneView& v) { v.style.logarithmic = false; },
          [](SceneView& v) { v.style.color_map = ColorMap::kHeat; },
          [](SceneView& v) { v.style.color_map = ColorMap::kSequential; },
          [](SceneView& v) { v.style.width = 7.25; },
          [](SceneView& v) { v.style.opacity = 0.3; },
          [](SceneView& v) { v.style.halo = !v.style.halo; },
          [](SceneView& v) { v.style.depth_cue = !v.style.depth_cue; }};
}

class Appearance : public ::testing::TestWithParam<FieldKind> {};

TEST_P(Appearance, OfAViewThatWasEditedIsBackFromASession) {
  const Document begun = of_kind(GetParam());
  const bool lines = GetParam() == FieldKind::kVector || GetParam() == FieldKind::kFibre;
  std::size_t number = 0;
  for (const auto& edit : edits()) {
    SCOPED_TRACE("edit " + std::to_string(number++));
    SceneView view = view_of(begun);
    const LineStyle style = view.style;
    edit(view);
    if (!lines && !(view.style == style)) continue;  // there are none to be drawn so
    Document kept = begun;
    keep_appearance(view, kept);
    EXPECT_FALSE(kept == begun);
    EXPECT_TRUE(same_picture(view_of(kept), view)) << "composed of the document again";
    EXPECT_TRUE(same_picture(view_of(reopened(kept)), view)) << "opened from a session";
    EXPECT_TRUE(reopened(kept) == kept);
  }
}

TEST_P(Appearance, OfAViewThatNobodyEditedLeavesNothingInASession) {
  Document document = of_kind(GetParam());
  keep_appearance(view_of(document), document);
  EXPECT_TRUE(saved_settings(document).empty());
}

INSTANTIATE_TEST_SUITE_P(Kinds, Appearance,
                         ::testing::Values(FieldKind::kVector, FieldKind::kScalar, FieldKind::kTensor,
                                           FieldKind::kFibre),
                         [](const auto& info) { return std::string(name_of(info.param)); });

TEST(Background, IsAWordOrAColour) {
  for (const char* text : {"dark", "light", "0,0,0", "1,1,1", "0.1,0.25,0.7", "0.333333,1e-3,1"})
    EXPECT_EQ(parse_background(background_text(parse_background(text))), parse_background(text)) << text;
  EXPECT_EQ(background_text(parse_background("0.1,0.25,0.7")), "0.1,0.25,0.7");
  for (const char* text : {"", "white", "1,1", "1,1,1,1", "-0.1,0,0", "0,0,1.5", "nan,0,0"})
    EXPECT_THROW((void)parse_background(text), Error) << text;
}

// Words as WCAG 2.2 asks for of large ones (3 : 1) on every background, and of small ones (4.5 : 1) on those
// that figures are printed on; what is fainter is as faint as on the dark and the light one.
TEST(Background, LetsWordsAndOutlineStandOut) {
  constexpr double kLarge = 3.0, kSmall = 4.5, kSeen = 1.5;
  constexpr int kSteps = 8;
  for (int r = 0; r <= kSteps; ++r) {
    for (int g = 0; g <= kSteps; ++g) {
      for (int b = 0; b <= kSteps; ++b) {
        const Rgb color = Rgb(r, g, b) / static_cast<float>(kSteps);
        const Background background{color, color};
        const Palette colors = palette_of(background);
        EXPECT_EQ(colors.background, background);
        EXPECT_GT(contrast_ratio(colors.ink, background), kLarge) << r << " " << g << " " << b;
        EXPECT_GT(contrast_ratio(colors.outline, background), kSeen) << r << " " << g << " " << b;
        EXPECT_GT(contrast_ratio(colors.plain_line, background), kSeen) << r << " " << g << " " << b;
      }
    }
  }
  for (const char* text : {"dark", "light", "1,1,1", "0,0,0"}) {
    const Background background = parse_background(text);
    EXPECT_GT(contrast_ratio(palette_of(background).ink, background), kSmall) << text;
  }
  EXPECT_NEAR(contrast_ratio(Rgb(0.0F), Rgb(1.0F)), 21.0, 1e-12);  // the definition's own extremes
}

TEST(ColorRange, IsTwoNumbersThatRise) {
  ViewOptions options;
  EXPECT_FALSE(range_of(options));
  options.range = "-1,0.5";
  EXPECT_EQ(range_of(options), (ValueRange{-1.0, 0.5}));
  for (const char* text : {"1", "1,1", "2,1", "a,b", "0,nan"}) {
    options.range = text;
    EXPECT_THROW((void)range_of(options), Error) << text;
  }
}

// A default of the data gives way to what is chosen, and comes back when that is taken back.
TEST(ColorMapOfLines, IsThatOfTheArrayUnlessItIsChosen) {
  LineArray angles;
  angles.color_map = ColorMap::kDiverging;
  LineStyle style{.color_by = ColorBy::kArray, .array = std::make_shared<const LineArray>(angles)};
  ViewOptions options;
  apply_colors(options, style);
  EXPECT_EQ(color_map_of(style), ColorMap::kDiverging);
  options.color_map = "heat";
  apply_colors(options, style);
  EXPECT_EQ(color_map_of(style), ColorMap::kHeat);
  options.color_map.clear();
  apply_colors(options, style);
  EXPECT_EQ(color_map_of(style), ColorMap::kDiverging);
}

}  // namespace
}  // namespace palpate::test
