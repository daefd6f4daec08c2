// What --slices and its like make of an image of tensors, and that a session says the same back.

#include "apps/dtmri/tensor_scene.h"

#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "tests/common/render/tensor/sample_tensors.h"

namespace palpate::test {
namespace {

/// Axes permuted and turned round: sagittal slices lie across k, which runs to the left. Tensors only in the
/// middle.
std::shared_ptr<const TensorVoxels> permuted() {
  const Mat3 axes{Vec3{0.0, 2.0, 0.0}, Vec3{0.0, 0.0, 2.0}, Vec3{-2.0, 0.0, 0.0}};
  return sampled_tensors(centred_lattice({11, 13, 15}, axes), [](const Vec3& x) {
    constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
    return glm::length(x) > 7.0 ? Mat3(kNothing) : linear_tensor({1.0, 0.0, 0.0});
  });
}

TensorOptions with_slices(const std::string& text) {
  TensorOptions options;
  options.slices = text;
  return options;
}

TEST(ParseSlices, KnowsAllNoneAndPlaces) {
  EXPECT_EQ(parse_slices("all").shown, (std::array{true, true, true}));
  EXPECT_FALSE(parse_slices("all").position[0]);
  EXPECT_EQ(parse_slices("none").shown, (std::array{false, false, false}));
  const SliceChoice choice = parse_slices("1.5,-,-20");
  EXPECT_EQ(choice.shown, (std::array{true, false, true}));
  EXPECT_EQ(choice.position[0], 1.5);
  EXPECT_FALSE(choice.position[1]);
  EXPECT_EQ(choice.position[2], -20.0);
  const SliceChoice left_out = parse_slices("off:1.5,-,-20");
  EXPECT_EQ(left_out.shown, (std::array{false, false, true}));
  EXPECT_EQ(left_out.position[0], 1.5);
}

TEST(ParseSlices, RefusesWhatIsNoPlace) {
  for (const char* text :
       {"", "1,2", "1,2,3,4", "1,x,3", "nan,0,0", "inf,0,0", "All", "off,0,0", "off:,0,0", "off:-,0,0"})
    EXPECT_THROW((void)parse_slices(text), Error) << text;
}

TEST(MakeTensorView, PutsSlicesThroughTheMiddleOfWhatShows) {
  const TensorView view = make_tensor_view(permuted(), {});
  EXPECT_LT(glm::length(view.position), 2.0);
  EXPECT_EQ(view.slices, (std::array{true, true, true}));
  EXPECT_EQ(view.glyphs, GlyphShape::kNone);
  EXPECT_FALSE(view.smooth);
}

TEST(MakeTensorView, TakesAxesOfTheDataAndNotOfTheImage) {
  const TensorView view = make_tensor_view(permuted(), with_slices("4,-,-"));
  EXPECT_EQ(view.slices, (std::array{false, false, true})) << "sagittal slices lie across k here";
  EXPECT_EQ(view.position.x, 4.0);
}

TEST(MakeTensorView, RefusesAPlaceOutsideTheImage) {
  EXPECT_NO_THROW((void)make_tensor_view(permuted(), with_slices("14.9,0,0")));
  try {
    (void)make_tensor_view(permuted(), with_slices("15.1,0,0"));
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::kUsage);
    EXPECT_NE(std::string(error.what()).find("outside the image"), std::string::npos) << error.what();
  }
}

TEST(SlicesText, ReadsBackToTheSameSlices) {
  for (const char* text : {"4,-,-", "-,3.25,-2", "1,2,3", "none", "off:4,-,1", "off:4,off:3.25,off:-2"}) {
    const TensorView view = make_tensor_view(permuted(), with_slices(text));
    const std::string saved = slices_text(view);
    EXPECT_EQ(saved, text);
    const TensorView again = make_tensor_view(permuted(), with_slices(saved));
    EXPECT_EQ(again.slices, view.slices) << text;
    EXPECT_EQ(again.position, view.position) << text;
  }
}

TEST(CheckTensorOptions, RefusesUnknownWordsBeforeAnythingIsRead) {
  EXPECT_NO_THROW(check_tensor_options({}));
  Document color, glyphs, slices;
  color.tensors.color = "speed";
  glyphs.tensors.glyphs = "cube";
  slices.tensors.slices = "1";
  for (const Document& options : {color, glyphs, slices}) EXPECT_THROW(check_tensor_options(options), Error);
}

}  // namespace
}  // namespace palpate::test
