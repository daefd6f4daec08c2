// What the window of cardiac asks of the program for its colours, without a window.
#include <algorithm>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "apps/cardiac/cardiac_model.h"
#include "common/compose/window_model.h"
#include "common/window/shown_scene.h"

namespace palpate::test {
namespace {

class CardiacColors : public ::testing::Test {
 protected:
  CardiacColors() {
    options_.common.threads = 1;
    options_.input.example = "wave";
    options_.tracing.seeds = "random:30";
    options_.heart.angle = "potential";
  }
  /// At a time step; nothing: at the start.
  ValueRange range_at(CardiacModel& model, std::optional<std::size_t> step) {
    Progress progress;
    if (step) set_time_step(document_, times_, *step);
    const SceneState state = step ? model.update(document_, progress) : model.start(progress);
    document_ = state.document;
    times_ = state.info->times;
    SceneView view;
    show_scene(state, step ? ShownAs::kChanged : ShownAs::kNew, view);
    return value_range(*view.lines, view.style);
  }

  Document options_;
  Document document_;
  std::vector<double> times_;
};

TEST_F(CardiacColors, KeepTheirRangeWhileTheSeriesPlays) {
  options_.heart.angle.clear();
  options_.input.time = "first";
  CardiacModel model(options_, "cardiac");
  const ValueRange first = range_at(model, std::nullopt);
  EXPECT_EQ(document_.heart.angle, "potential");
  EXPECT_EQ(time_step_of(document_, times_), 0U) << "as it is asked for";
  EXPECT_LT(first.lower, -75.0) << "at rest, as all is at the start";
  EXPECT_GT(first.upper, 0.0) << "excited, as nothing is yet";
  for (const std::size_t step : {3U, 20U, 40U, 60U, 80U, 0U}) EXPECT_EQ(range_at(model, step), first) << step;
}

// Muscle half way through the wall runs around it, white in the map of angles, and all is at rest at the
// start of a wave: neither is a picture to open with.
TEST_F(CardiacColors, OfASeriesShowWhatChangesWhereItHasSpread) {
  options_.heart.angle.clear();
  CardiacModel model(options_, "cardiac");
  Progress progress;
  const SceneState state = model.start(progress);
  EXPECT_EQ(state.document.heart.angle, "potential");
  const auto [lowest, highest] = std::ranges::minmax(state.color_array->values);
  EXPECT_GT(highest - lowest, 80.0F) << "[mV] at rest and excited";
  // Angles first, then what the file has; not what is of no use to anybody before all else.
  const std::vector<std::string> first(state.info->color_arrays.begin(),
                                       state.info->color_arrays.begin() + 6);
  EXPECT_EQ(first,
            (std::vector<std::string>{"helix", "transverse", "sheet", "potential", "activation", "depth"}));

  options_.heart.angle = "helix";
  CardiacModel helix(options_, "cardiac");
  const SceneState asked = helix.start(progress);
  EXPECT_EQ(asked.document.heart.angle, "helix");
  EXPECT_EQ(time_step_of(asked.document, asked.info->times), 0U);
}

TEST_F(CardiacColors, HaveTheRangeThatIsAskedFor) {
  options_.view.range = "0.25,0.5";
  options_.heart.angle = "depth";
  options_.input.example = "ventricle";
  CardiacModel model(options_, "cardiac");
  EXPECT_EQ(range_at(model, std::nullopt), (ValueRange{0.25, 0.5}));
}

TEST_F(CardiacColors, OfAnglesGoAllTheWayRoundAlsoComingBackToThem) {
  options_.heart.angle = "helix";
  options_.input.example = "ventricle";
  CardiacModel model(options_, "cardiac");
  const ValueRange all{-90.0, 90.0};
  EXPECT_EQ(range_at(model, std::nullopt), all);
  document_.heart.angle = "depth";
  EXPECT_FALSE(range_at(model, 0) == all);
  document_.heart.angle = "helix";
  EXPECT_EQ(range_at(model, 0), all);
}

}  // namespace
}  // namespace palpate::test
