// What a pointing hand takes hold of from afar goes with it rigidly, and is let go with its button.

#include "common/window/controls/pick_control.h"

#include <chrono>
#include <functional>
#include <memory>
#include <thread>

#include <gtest/gtest.h>

#include "common/field/analytic/volume_examples.h"
#include "common/hand/mode/haptic_mode.h"
#include "common/haptics/widget/plane_widget.h"
#include "common/window/immersive/hand_in_space.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

/// Points from far in front, along -z, turned by `turn` about the place that it points at.
PickingHand hand_at(const Vec3& tip, bool presses, const Quat& turn = identity_rotation()) {
  return {
      .pose = {turn, tip}, .beam = beam_of(Ray{tip, turn * Vec3{0.0, 0.0, -1.0}}, 0.05), .presses = presses};
}

class PickControlTest : public testing::Test {
 protected:
  PickControlTest() {
    view_.bounds = {Vec3{-1.0}, Vec3{1.0}};
    view_.volume.emplace();
    view_.volume->shown = true;
    Lens lens;
    lens.shape = make_sphere({0.0, 0.0, 0.3}, 0.2);
    view_.volume->lenses = {lens};
    view_.volume->cuts = {{.kept = {{0.0, 0.0, 1.0}, -0.5}}};
    Line line;
    for (const double y : {-1.0, 0.0, 1.0}) {
      LinePoint point;
      point.position = {0.6, y, 0.0};
      line.points.push_back(point);
    }
    view_.lines = std::make_shared<const std::vector<Line>>(std::vector<Line>{line});
  }
  void open(std::vector<HapticMode> modes, NamedField field, ProbeSessionOptions options = {}) {
    options.modes = std::move(modes);
    session_ = std::make_unique<ProbeSession>(std::move(options), [] {});
    (void)session_->set_field(std::move(field));
  }
  std::optional<std::string> follow(const std::optional<PickingHand>& hand) {
    return pick_.follow(hand, view_, *session_);
  }

  std::unique_ptr<ProbeSession> session_;
  PickControl pick_;
  SceneView view_;
};

TEST_F(PickControlTest, ALensGoesWithTheHandWhileItsButtonIsDown) {
  open(sample_modes(), {helix_flow(0.25), "helix"});
  EXPECT_EQ(follow(hand_at({0.1, 0.0, 3.0}, false)), std::nullopt);
  ASSERT_TRUE(pick_.picked());
  EXPECT_EQ(name_of(*pick_.picked()), "lens 1");
  EXPECT_EQ(follow(hand_at({0.1, 0.0, 3.0}, true)), "lens 1 goes with the hand");
  EXPECT_EQ(follow(hand_at({0.4, 0.2, 2.5}, true)), std::nullopt);
  EXPECT_LT(glm::distance(center_of(view_.volume->lenses[0].shape, {}), {0.3, 0.2, -0.2}), 1e-14);
  // Turned about its tip the hand swings the lens round.
  const Quat turn = rotation_by({0.0, 0.5, 0.0});
  (void)follow(hand_at({0.1, 0.0, 3.0}, true, turn));
  const Vec3 swung = Vec3{0.1, 0.0, 3.0} + turn * (Vec3{0.0, 0.0, 0.3} - Vec3{0.1, 0.0, 3.0});
  EXPECT_LT(glm::distance(center_of(view_.volume->lenses[0].shape, {}), swung), 1e-14);
  (void)follow(hand_at({0.1, 0.0, 3.0}, true));
  (void)follow(hand_at({0.1, 0.0, 3.0}, false));
  EXPECT_FALSE(pick_.holding());
  (void)follow(hand_at({0.9, 0.9, 3.0}, false));
  EXPECT_LT(glm::distance(center_of(view_.volume->lenses[0].shape, {}), {0.0, 0.0, 0.3}), 1e-14)
      << "left there";
  // The other hand carries the lens that was picked last.
  PickingHand both = hand_at({0.9, 0.9, 3.0}, false);
  both.carried = Rigid{};
  (void)follow(both);
  both.carried = Rigid{identity_rotation(), {0.0, 0.1, 0.0}};
  (void)follow(both);
  EXPECT_LT(glm::distance(center_of(view_.volume->lenses[0].shape, {}), {0.0, 0.1, 0.3}), 1e-14);
}

TEST_F(PickControlTest, ACutTurnsWithTheStylusAboutThePlaceThatWasPicked) {
  open(sample_modes(), {helix_flow(0.25), "helix"});
  view_.volume->lenses.clear();
  EXPECT_EQ(follow(hand_at({0.0, 0.0, 3.0}, true)), "plane 1 goes with the hand");
  const Quat turn = rotation_by({0.3, 0.0, 0.0});
  const Vec3 tip{0.0, 0.2, 2.0};
  (void)follow(hand_at(tip, true, turn));
  const ConvexShape::HalfSpace& cut = view_.volume->cuts[0].kept;
  EXPECT_LT(glm::distance(cut.outward, turn * Vec3{0.0, 0.0, 1.0}), 1e-14);
  EXPECT_NEAR(glm::dot(cut.outward, tip + turn * Vec3{0.0, 0.0, -3.5}), cut.offset, 1e-14);
}

TEST_F(PickControlTest, ALineThatIsPickedIsKeptOnceAndAStylusGoesOnFromThere) {
  open(sample_modes(), {helix_flow(0.25), "helix"});
  PickingHand hand = hand_at({0.62, 0.3, 3.0}, true);
  hand.can_move = true;
  EXPECT_EQ(follow(hand), "kept line 1");
  ASSERT_EQ(session_->trail().drawn_lines().entries().size(), 1U);
  EXPECT_LT(glm::distance(session_->hand().intent().probe, {0.6, 0.3, 0.0}), 1e-12);
  EXPECT_EQ(follow(hand), std::nullopt) << "once a press";
  (void)follow(std::nullopt);
  EXPECT_EQ(follow(hand), "line 1 is kept");
  EXPECT_EQ(session_->trail().drawn_lines().entries().size(), 1U);
}

// A tracked stylus in a session with cutting planes: far from them it points at the sphere of one, which then
// goes with it; the widget is not taken hold of, and undo puts the plane back.
TEST_F(PickControlTest, ATrackedStylusTakesTheWidgetsHandleFromAfar) {
  static const DataSet data = volume_example("blob");
  const auto field = make_scalar_field({data}, {kVolumeArray, Association::kPoint, 0}, "blob", 1);
  view_.bounds = field->bounds();
  view_.lines.reset();
  view_.volume->lenses.clear();
  view_.volume->cuts.clear();
  ProbeSessionOptions options;
  options.workbench.interaction = {.immersive = true};
  const double scale = Workspace::default_scale(field->diagonal());
  // Above the middle, beyond all planes' reach; pressed from the second row on, then lifted by 20 mm.
  for (int i = 0; i <= 2000; ++i) {
    TrackedHands hands{.time = 0.01 * i, .acts = i >= 20 && i < 200};
    hands.stylus = TrackerPose{{0.0, 0.0, i < 60 ? 0.2 : 0.22}, identity_rotation()};
    options.hands.push_back(hands);
  }
  open({find_mode(modes_of(FieldKind::kScalar), kPlaneWidgetMode)}, {.name = "blob", .scalar = field},
       std::move(options));
  MenuControl menu;
  HandInSpace hands;
  ProbeView probe;
  double time = 1.0;
  bool held = false;
  Vec3 before{0.0};
  TouchOptions kept;
  const auto center = [&] { return session_->planes()->poses.pose[0].center; };
  for (int i = 0; i < 5000 && time < 4.0; ++i) {
    (void)hands.follow(menu, *session_, view_, view_.camera, {0.0, 0.0, 300.0, 200.0}, time);
    session_->update(time, view_.camera, LineStyle{}, probe);
    if (hands.holding() && !held) {
      held = true;
      ASSERT_TRUE(hands.picked());
      EXPECT_EQ(hands.picked()->kind, PickKind::kHandle);
      before = center();
      session_->keep(kept);
    }
    // Time goes on once the servo tells of planes.
    if (session_->planes()) time += 0.002;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_TRUE(held);
  EXPECT_FALSE(hands.holding()) << "the button was let go";
  for (int i = 0; i < 2000 && glm::distance(center(), before + Vec3{0.0, 0.0, 0.02 / scale}) > 1e-9; ++i) {
    session_->update(time, view_.camera, LineStyle{}, probe);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_LT(glm::distance(center(), before + Vec3{0.0, 0.0, 0.02 / scale}), 1e-9);
  session_->restore(kept);
  for (int i = 0; i < 2000 && glm::distance(center(), before) > 1e-9; ++i) {
    session_->update(time, view_.camera, LineStyle{}, probe);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  EXPECT_LT(glm::distance(center(), before), 1e-9);
}

}  // namespace
}  // namespace palpate::test
