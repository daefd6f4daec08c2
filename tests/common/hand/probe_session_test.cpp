// The hand without a window: what is asked for goes to the servo's thread, what it does comes back. No time
// is asserted; every wait is for an event, and gives up after half a minute. Run under ThreadSanitizer too.

#include "common/hand/probe_session.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/field/analytic/volume_examples.h"
#include "common/hand/mode/texture_link.h"
#include "common/haptics/constraint/anisotropy_drag.h"
#include "common/servo/recording.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

constexpr double kRise = 0.25;
const std::string kField = field_key("helix", 0);
const Vec3 kSeed{1.0, 0.0, 0.0};

/// A session with the loop that a window would run.
class Hand {
 public:
  explicit Hand(ProbeSessionOptions options = with_modes()) : session(std::move(options), [] {}) {
    session.set_field({helix_flow(kRise), kField});
  }

  static ProbeSessionOptions with_modes() {
    ProbeSessionOptions options;
    options.modes = sample_modes();
    return options;
  }

  void frame() {
    session.update(seconds(), camera_, LineStyle{}, view);
    std::this_thread::sleep_for(std::chrono::milliseconds(4));
  }
  [[nodiscard]] bool wait_for(const std::function<bool()>& happened) {
    const double end = seconds() + 30.0;
    do {
      frame();
      if (happened()) return true;
    } while (seconds() < end);
    return false;
  }
  [[nodiscard]] bool wait_for_state(HoldState state) {
    return wait_for([&] { return session.readout().held && session.readout().state == state; });
  }
  void grab(const Vec3& at) { session.grab(seconds(), at); }
  /// Moves as a hand does, a little each frame.
  void move_to(const Vec3& to) {
    const Vec3 from = session.hand().intent().probe;
    constexpr int kFrames = 40;
    for (int i = 1; i <= kFrames; ++i) {
      session.hand().move(from + (to - from) * (static_cast<double>(i) / kFrames));
      frame();
    }
  }

  ProbeSession session;
  ProbeView view;

 private:
  [[nodiscard]] double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

  Camera camera_ = make_camera({Vec3{-2.0}, Vec3{2.0}}, {}, 1.5);
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Keeps the followed line; whether there was one.
bool keep(ProbeSession& session) {
  const std::size_t before = session.trail().drawn_lines().entries().size();
  (void)session.trail().keep_line();
  return session.trail().drawn_lines().entries().size() > before;
}

/// Distance of `x` from the helix through `seed`.
double off_the_line(const Vec3& x, const Vec3& seed = kSeed) {
  const Helix helix{seed, kRise};
  double t = (x.z - seed.z) / kRise;
  for (int i = 0; i < 50; ++i) {
    const Vec3 h = helix.at_time(t), v{-h.y, h.x, kRise};
    t += glm::dot(x - h, v) / glm::dot(v, v) * 0.5;
  }
  return glm::distance(x, helix.at_time(t));
}

TEST(ProbeSession, WithoutModesThereIsNoTouch) {
  ProbeSession session({}, [] {});
  EXPECT_FALSE(session.available());
  session.set_field({helix_flow(kRise), kField});
  session.grab(0.0, kSeed);
  ProbeView view;
  session.update(0.0, Camera{}, LineStyle{}, view);
  EXPECT_FALSE(session.hand().grabbed());
  EXPECT_FALSE(session.readout().held);
  EXPECT_FALSE(keep(session));
  session.finish();
}

TEST(ProbeSession, HoldsTheProbeOnTheLineThatItIsPutOn) {
  Hand hand;
  hand.frame();
  EXPECT_FALSE(hand.session.readout().held);
  EXPECT_FALSE(is_finite(hand.view.probe)) << "no hand, nothing to draw";
  hand.grab(kSeed);
  EXPECT_TRUE(hand.session.hand().grabbed());
  EXPECT_TRUE(hand.session.lively());
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));

  const Vec3 beside{0.0, 1.1, 0.3 + 0.5 * kRise};
  hand.move_to({0.72, 0.72, 0.2});
  hand.move_to(beside);
  ASSERT_TRUE(hand.wait_for([&] { return glm::distance(hand.session.readout().probe, beside) < 1e-9; }));
  const ProbeReadout& readout = hand.session.readout();
  EXPECT_EQ(readout.state, HoldState::kHeld);
  EXPECT_LE(off_the_line(readout.proxy), 7e-6) << "a millionth of the diagonal";
  EXPECT_GT(glm::distance(readout.probe, readout.proxy), 0.05);
  EXPECT_TRUE(readout.sampled);
  EXPECT_LE(glm::distance(readout.velocity, Vec3(-readout.proxy.y, readout.proxy.x, kRise)), 1e-12);
  EXPECT_LE(readout.residual, 7e-6);
  EXPECT_GE(readout.residual, 0.0);
  EXPECT_TRUE(readout.cell.empty()) << "a formula has no cells";
  // k |x - p| in the workspace: 250 mm for the diagonal, 200 N/m.
  const double metres = 0.25 / (4.0 * std::sqrt(3.0));
  EXPECT_NEAR(readout.stretch, 1e3 * metres * glm::distance(readout.probe, readout.proxy), 1e-9);
  ASSERT_TRUE(hand.wait_for([&] {
    return std::abs(readout.force - 200.0 * metres * glm::distance(readout.probe, readout.proxy)) < 1e-9;
  }));

  EXPECT_EQ(hand.view.probe, readout.probe);
  EXPECT_EQ(hand.view.proxy, readout.proxy);
  EXPECT_EQ(hand.view.force, readout.force);
  EXPECT_EQ(hand.view.velocity, readout.velocity);
  ASSERT_TRUE(hand.view.followed);
  EXPECT_GT(hand.view.followed->balls.size(), 2U);
  for (const Vec3& x : hand.view.followed->points) EXPECT_LE(off_the_line(x), 7e-6);
  EXPECT_GT(hand.view.path.count, 100U);
}

TEST(ProbeSession, PullsOverToAnotherLine) {
  Hand hand;
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  const Vec3 far{1.6, 0.0, 0.0};  // 22 mm away; it lets go at 10
  hand.move_to(far);
  ASSERT_TRUE(hand.wait_for([&] {
    return glm::distance(hand.session.readout().probe, far) < 1e-9 &&
           hand.session.readout().state == HoldState::kHeld;
  }));
  const Vec3 proxy = hand.session.readout().proxy;
  EXPECT_LT(glm::distance(proxy, far), 0.3);
  EXPECT_GT(off_the_line(proxy), 0.1);
}

TEST(ProbeSession, LettingGoLeavesTheLineInThePictureAndToBeKept) {
  Hand hand;
  EXPECT_FALSE(keep(hand.session));
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  hand.move_to({0.75, 0.75, 0.2});
  hand.session.hand().let_go();
  EXPECT_FALSE(hand.session.hand().grabbed());
  ASSERT_TRUE(hand.wait_for([&] { return !hand.session.readout().held; }));
  EXPECT_FALSE(is_finite(hand.view.probe));
  EXPECT_TRUE(hand.view.followed) << "stays until the next line is caught";
  ASSERT_TRUE(keep(hand.session));
  const DrawnLines::Entry& kept = hand.session.trail().drawn_lines().entries().front();
  ASSERT_GT(kept.line->points.size(), 10U);
  ASSERT_EQ(kept.forces.size(), kept.line->points.size());
  for (const LinePoint& point : kept.line->points) EXPECT_LE(off_the_line(point.position), 7e-6);
  EXPECT_GT(kept.largest_force, 0.0);
  EXPECT_TRUE(std::isnan(kept.forces.front())) << "the hand was not there";
}

TEST(ProbeSession, KeepsTheForcesOfTheHoldAtHandOnly) {
  Hand hand;
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  hand.move_to({0.85, 0.85, 0.2});
  hand.session.hand().let_go();
  ASSERT_TRUE(hand.wait_for([&] { return !hand.session.readout().held; }));
  const Vec3 other{0.0, -0.5, -1.0};
  hand.grab(other);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  ASSERT_TRUE(keep(hand.session));
  const DrawnLines::Entry& kept = hand.session.trail().drawn_lines().entries().front();
  EXPECT_LE(off_the_line(kept.line->points[kept.line->points.size() / 2].position, other), 7e-6);
  EXPECT_LT(kept.largest_force, 1e-3) << "nothing of what was felt on the other line";
  for (std::size_t i = 0; i < kept.forces.size(); ++i) {
    EXPECT_TRUE(std::isnan(kept.forces[i]) || glm::distance(kept.line->points[i].position, other) < 0.5);
  }
}

TEST(ProbeSession, AnotherFieldLetsGoAndKeepsWhatWasMade) {
  Hand hand;
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  ASSERT_TRUE(keep(hand.session));
  ASSERT_TRUE(hand.wait_for([&] { return hand.view.followed != nullptr; }));
  hand.session.set_field({helix_flow(2.0 * kRise), field_key("helix", 1)});
  EXPECT_FALSE(hand.session.hand().grabbed());
  EXPECT_EQ(hand.session.trail().drawn_lines().entries().size(), 1U)
      << "another time step, in the same space";
  hand.frame();
  EXPECT_EQ(hand.view.followed, nullptr) << "a line of the other field";
  EXPECT_FALSE(keep(hand.session)) << "likewise";
  ASSERT_TRUE(hand.wait_for([&] { return !hand.session.readout().held; }));
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  EXPECT_LE(glm::distance(hand.session.readout().velocity, Vec3(0.0, 1.0, 2.0 * kRise)), 1e-3);
}

TEST(ProbeSession, ForceGoesOffAndComesBack) {
  Hand hand;
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  hand.move_to({1.15, 0.0, 0.0});
  ASSERT_TRUE(hand.wait_for([&] { return hand.session.readout().force > 0.5; }));
  hand.session.servo().force_off();
  ASSERT_TRUE(hand.wait_for([&] { return hand.session.readout().force == 0.0; }));
  ASSERT_TRUE(hand.wait_for([&] { return !hand.session.readout().servo.armed; }));
  EXPECT_EQ(hand.session.readout().cut, ForceCut::kSwitchedOff);
  EXPECT_EQ(hand.session.readout().state, HoldState::kHeld) << "the proxy goes on";
  hand.session.servo().arm();
  ASSERT_TRUE(hand.wait_for([&] { return hand.session.readout().force > 0.5; }));
}

TEST(ProbeSession, ChoicesTakeEffectWhileTheHandIsOn) {
  Hand hand;
  hand.grab(kSeed);
  ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
  const Vec3 beside{1.15, 0.0, 0.0};
  hand.move_to(beside);
  ASSERT_TRUE(hand.wait_for([&] { return glm::distance(hand.session.readout().probe, beside) < 1e-9; }));
  const ProbeReadout& readout = hand.session.readout();
  const auto expect_stiffness = [&](double k) {
    EXPECT_TRUE(hand.wait_for([&] { return std::abs(readout.force - 1e-3 * k * readout.stretch) < 1e-9; }))
        << k;
  };
  expect_stiffness(200.0);
  TouchChoice choice = hand.session.choice();
  choice.settings.stiffness = 100.0;
  hand.session.choose(choice);
  expect_stiffness(100.0);

  choice.ticks = true;  // another chain: with a second link
  hand.session.choose(choice);
  EXPECT_TRUE(hand.wait_for([&] { return hand.view.links.size() == 2; })) << "both are in the picture";
  EXPECT_EQ(readout.servo.hand.chain.links, 2);
  EXPECT_EQ(hand.view.links.front(), hand.view.proxy) << "the line's is the hand's";
  choice.ticks = false;
  choice.mode = 1;
  hand.session.choose(choice);
  EXPECT_TRUE(hand.wait_for([&] { return readout.servo.hand.chain.links == 1; }));
  EXPECT_EQ(hand.view.followed, nullptr) << "this mode follows no line";
  EXPECT_TRUE(hand.session.hand().grabbed());

  choice.mode = 0;
  choice.show_balls = false;
  choice.show_path = false;
  choice.local = SeedShape::kRake;
  hand.session.choose(choice);
  ASSERT_TRUE(hand.wait_for([&] { return hand.view.seeds && hand.view.followed; }));
  EXPECT_TRUE(hand.wait_for([&] { return hand.view.followed->balls.empty(); }));
  EXPECT_EQ(hand.view.path.points, nullptr);
  EXPECT_EQ(hand.view.seeds->shape, SeedShape::kRake);
  EXPECT_LE(glm::distance(hand.view.seeds->origin + 0.5 * hand.view.seeds->u, beside), 1e-9);
  choice.local = SeedShape::kNone;
  hand.session.choose(choice);
  hand.frame();
  EXPECT_EQ(hand.view.seeds, nullptr);
}

// The chain gets its texture when the noise is measured, and the next one at once; modes without one do
// without.
TEST(ProbeSession, NoiseIsMeasuredOnceAndFeltThen) {
  const auto scalar =
      make_scalar_field({volume_example("blob")}, ScalarChoice{.array = kVolumeArray}, "blob");
  int textured = 0, plain = 0;
  ProbeSessionOptions options;
  for (const char* name : {"density", "other"}) {
    options.modes.push_back(
        {name, name, [&](const HapticScene& scene) -> HapticChain {
           std::vector<std::unique_ptr<Constraint>> links;
           links.push_back(std::make_unique<IsotropicDrag>());
           auto noise = add_texture(links, scene);
           ++(noise ? textured : plain);
           HapticChain made{std::make_unique<ProxyChain>(std::move(links), scene.settings), {}};
           made.noise = std::move(noise);
           return made;
         }});
    options.modes.back().texture = std::string(name) == "density";
  }
  ProbeSession session(std::move(options), [] {});
  NamedField open{.field = nullptr, .name = "blob"};
  open.scalar = scalar;
  ASSERT_TRUE(session.set_field(open));
  ProbeView view;
  const auto frames = [&](const std::function<bool()>& happened) {
    for (int i = 0; i < 10000 && !happened(); ++i) {
      session.update(0.01 * i, make_camera(scalar->bounds(), {}, 1.0),
                     LineStyle{.color_by = ColorBy::kUniform}, view);
      std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return happened();
  };
  const auto choose = [&](bool by_noise, std::size_t mode) {
    TouchChoice choice = session.choice();
    choice.settings.texture.by_noise = by_noise;
    choice.mode = mode;
    session.choose(choice);
  };
  EXPECT_EQ(plain, 1);
  choose(true, 0);
  EXPECT_EQ(textured, 0) << "it does not wait for that";
  ASSERT_TRUE(frames([&] { return textured > 0; }));
  EXPECT_FALSE(session.measures_noise());
  choose(false, 0);
  EXPECT_EQ(plain, 2);
  choose(true, 0);
  EXPECT_EQ(textured, 2) << "at once";
  choose(true, 1);
  EXPECT_EQ(plain, 3);
  EXPECT_FALSE(session.measures_noise());
}

TEST(ProbeSession, ARecordedRunIsReplayedIdentically) {
  const TempFolder folder;
  ProbeSessionOptions options = Hand::with_modes();
  options.record = folder.path("run.txt");
  options.recorded.program = "test";
  {
    Hand hand(options);
    hand.grab(kSeed);
    ASSERT_TRUE(hand.wait_for_state(HoldState::kHeld));
    hand.session.servo().record_event(7, "keydown 71 0");
    hand.move_to({0.9, 0.6, 0.2});
    TouchChoice choice = hand.session.choice();
    choice.settings.stiffness = 321.0;
    hand.session.choose(choice);
    choice.ticks = true;
    hand.session.choose(choice);
    hand.move_to({1.4, 0.6, 0.1});
    hand.session.servo().force_off();
    hand.move_to({1.4, 0.9, 0.1});
    hand.session.servo().arm();
    hand.move_to({1.2, 0.9, 0.1});
    hand.session.servo().record_event(9, "keydown 75 0");
    hand.frame();
    hand.session.finish();
  }
  options.record.clear();
  options.replay = read_recording(folder.path("run.txt").string());
  const std::size_t steps = options.replay->steps.size();
  ASSERT_GT(steps, 300U);
  EXPECT_TRUE(options.replay->ended);
  EXPECT_EQ(options.replay->header.program, "test");

  Hand hand(options);
  EXPECT_TRUE(hand.session.servo().replaying());
  EXPECT_EQ(hand.session.servo().replay_verdict(), "");
  hand.grab({0.0, 1.5, 0.0});
  EXPECT_FALSE(hand.session.hand().grabbed()) << "the hand is that of the recording";
  std::vector<std::string> events;
  ASSERT_TRUE(hand.wait_for([&] {
    for (std::string& text : hand.session.servo().due_events()) events.push_back(std::move(text));
    return !hand.session.servo().replay_verdict().empty();
  }));
  EXPECT_EQ(hand.session.servo().replay_verdict(),
            "identical: " + std::to_string(steps) + " of " + std::to_string(steps) + " steps");
  EXPECT_EQ(events, (std::vector<std::string>{"keydown 71 0", "keydown 75 0"}));
  EXPECT_TRUE(hand.view.followed) << "the line of the recording is drawn";
  EXPECT_GT(hand.view.path.count, 100U);
  hand.session.finish();
}

// On a workbench's surface, of the view's right, up and to the user, the probe stays, wherever mouse and
// wheel would lead it.
TEST(ProbeSession, KeepsAMouseOnTheSurfaceOfTheWorkbench) {
  const Camera camera = make_camera({Vec3{-2.0}, Vec3{2.0}}, {}, 1.5);
  for (const Vec4& surface : {Vec4{0.0, 0.0, 1.0, 0.0}, Vec4{0.0, 0.6, 0.8, 0.01}}) {
    ProbeSessionOptions options = Hand::with_modes();
    options.workbench.interaction.surface = surface;
    Hand hand(options);
    hand.frame();
    const Vec3 n = camera.axes * Vec3{surface};
    const auto off = [&] {
      return std::abs(glm::dot(n, hand.session.hand().intent().probe - camera.focal_point) -
                      surface.w / hand.session.data().workspace().scale());
    };
    hand.grab({0.3, 0.4, 0.5});
    EXPECT_LT(off(), 1e-14);
    const Vec3 grabbed = hand.session.hand().intent().probe;
    hand.session.hand().lead(WheelTurn{3.0}, camera, {300, 200});
    EXPECT_LT(off(), 1e-14);
    hand.session.hand().lead(MouseDrag{40.0, -10.0}, camera, {300, 200});
    EXPECT_LT(off(), 1e-14);
    EXPECT_GT(glm::distance(hand.session.hand().intent().probe, grabbed), 0.1);
    EXPECT_TRUE(hand.wait_for([&] {
      return hand.session.readout().held &&
             glm::distance(hand.session.readout().probe, hand.session.hand().intent().probe) < 1e-9;
    }));
    hand.session.finish();
  }
}

TEST(ProbeSession, DoesNotReplaceARecordingUnasked) {
  const TempFolder folder;
  ProbeSessionOptions options = Hand::with_modes();
  options.record = folder.write("run.txt", "mine");
  EXPECT_THROW(Hand{options}, Error);
  EXPECT_EQ(read_file(options.record), "mine");
}

}  // namespace
}  // namespace palpate::test
