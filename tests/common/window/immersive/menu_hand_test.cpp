// Sliders and knobs of the menu in space under a hand that feels them: a device in the hand, and a mouse that
// a simulated arm follows. Every wait is for an event, and gives up after half a minute.

#include "common/window/immersive/menu_hand.h"

#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include <gtest/gtest.h>

#include "common/device/device_profile.h"
#include "common/hand/mode/chain_description.h"
#include "common/servo/real_time.h"
#include "common/servo/recording.h"
#include "common/window/immersive/hand_in_space.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"
#include "tests/support/temp_folder.h"

namespace palpate::test {
namespace {

double now() { return 1e-9 * static_cast<double>(monotonic_ns()); }

/// A device that is where the test has it, and remembers the force that it was to show.
class HeldLink final : public DriverLink {
 public:
  HeldLink() {
    limits_.reach_lower = Vec3{-0.05};
    limits_.reach_upper = Vec3{0.05};
  }
  bool round() noexcept override {
    const Vec3 force = ordered();
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::lock_guard lock(mutex_);
    reported_ = force;
    atoms_ = said_;
    atoms_.time = now();
    return true;
  }
  [[nodiscard]] const DeviceAtoms& atoms() const noexcept override { return atoms_; }
  [[nodiscard]] const LinkStatus& status() const noexcept override { return status_; }
  [[nodiscard]] std::string advice() const override { return {}; }
  [[nodiscard]] const DeviceLimits& limits() const noexcept override { return limits_; }
  [[nodiscard]] std::string place() const override { return "here"; }

  void say(const Vec3& position, bool pressed) {
    const std::lock_guard lock(mutex_);
    said_ = {.buttons = pressed ? 1U : 0U, .has_position = true, .position = position};
  }
  [[nodiscard]] Vec3 told() const {
    const std::lock_guard lock(mutex_);
    return reported_;
  }

 private:
  mutable std::mutex mutex_;
  Vec3 reported_{0.0};
  DeviceAtoms said_{.has_position = true}, atoms_{.has_position = true};
  LinkStatus status_;
  DeviceLimits limits_;
};

const PictureArea kArea{0.0, 0.0, 600.0, 400.0};
constexpr double kStiffness = 200.0;  // [N/m]
// Of the menu below, in entries: the slider of time steps 0 to 3, under "Touch", "View", "Show" and "Undo".
constexpr double kLeft = 0.6, kLength = SpaceMenu::kColumn - 1.2, kDown = 4.0 + 1.05;

class MenuHandTest : public testing::Test {
 protected:
  void open(ProbeSessionOptions options) {
    options.modes = sample_modes();
    options.choice.settings.stiffness = kStiffness;
    session_ = std::make_unique<ProbeSession>(std::move(options), [] {});
    session_->set_field({helix_flow(0.25), field_key("helix", 0)});
    scale_ = session_->data().workspace().scale();
    auto info = std::make_shared<SceneInfo>();
    info->times = {0.0, 0.5, 1.0, 1.5};
    scene_.info = info;
    scene_.lines = std::make_shared<const std::vector<Line>>();
    view_.bounds = {Vec3{-2.0}, Vec3{2.0}};
    view_.camera = make_camera(view_.bounds, {.azimuth = 30.0, .elevation = 20.0}, 1.5);
    menu_.toggle(scene_, view_, {"streamline", "isotropic"});
  }

  void frame() {
    menu_.place(view_.camera, kArea, session_->hand().device_reach());
    (void)hands_.follow(menu_, *session_, view_, view_.camera, kArea, now());
    (void)menu_.act(scene_, document_, view_);
    session_->update(now(), view_.camera, LineStyle{}, probe_);
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  [[nodiscard]] bool wait_for(const std::function<bool()>& happened) {
    for (const double end = now() + 30.0; now() < end;) {
      frame();
      if (happened()) return true;
    }
    return false;
  }
  /// A place of the menu, in the data.
  [[nodiscard]] Vec3 at(double u, double v) const {
    const LabelView label = *menu_.drawn();
    return label.origin + label.unit * (u * label.axes[0] - v * label.axes[1]);
  }
  /// Where a hand is that the eye sees there, at `s` times the distance; in its device's frame.
  [[nodiscard]] Vec3 seen_there(double u, double v, double s) const {
    const Vec3 viewer = eye(view_.camera), x = viewer + s * (at(u, v) - viewer);
    return scale_ * ((x - view_.camera.focal_point) * view_.camera.axes);
  }
  [[nodiscard]] double slider(double value) const { return kLeft + kLength * value / 3.0; }

  std::unique_ptr<ProbeSession> session_;
  MenuControl menu_;
  HandInSpace hands_;
  SceneState scene_;
  SceneView view_;
  Document document_;
  ProbeView probe_;
  double scale_ = 1.0;
};

// The force that reaches the device is that of the chain in the servo: none on a detent, towards the nearest
// one between them, across the way that of its spring. The value goes on as the hand passes over.
TEST_F(MenuHandTest, ADeviceFeelsTheDetentsOfASliderAndSetsItsValue) {
  const TempFolder folder;
  const auto link = std::make_shared<HeldLink>();
  ProbeSessionOptions options;
  options.link = link;
  options.limits.force_cap = 8.0;
  options.record = folder.path("run.txt");
  options.recorded.program = "test";
  open(std::move(options));
  frame();
  constexpr double kDepth = 1.07;  // the hand is behind the menu that it points at
  ASSERT_LT(glm::length(seen_there(slider(3.0), kDown, kDepth)), 0.05 * std::sqrt(2.0)) << "within its reach";
  link->say(seen_there(slider(0.0), kDown, kDepth), false);
  ASSERT_TRUE(wait_for([&] {
    return session_->readout().held &&
           glm::distance(session_->readout().probe,
                         eye(view_.camera) + kDepth * (at(slider(0.0), kDown) - eye(view_.camera))) < 1e-9;
  }));
  EXPECT_FALSE(session_->hand().dial());
  link->say(seen_there(slider(0.0), kDown, kDepth), true);
  ASSERT_TRUE(wait_for([&] { return session_->hand().dial().has_value(); }));
  EXPECT_EQ(session_->hand().dial()->detents, 4);

  const double apart =
      glm::distance(seen_there(slider(1.0), kDown, kDepth), seen_there(slider(0.0), kDown, kDepth));
  EXPECT_GT(apart, 0.005) << "to be told apart by hand";
  // The notch of a detent (haptics/notch.h), d from it.
  const auto pull = [&](double d) {
    const double part = 1.0 - std::pow(d / (0.5 * apart), 2);
    return -kStiffness * part * part * d;
  };
  for (const double value : {0.25, 0.4, 0.8, 1.1, 1.7, 3.0}) {
    link->say(seen_there(slider(value), kDown, kDepth), true);
    const double expected = pull(apart * (value - std::round(value)));
    EXPECT_TRUE(wait_for([&] {
      return glm::distance(link->told(), Vec3{expected, 0.0, 0.0}) < 1e-3;
    })) << value
        << ": " << link->told().x << " " << link->told().y << " " << link->told().z << " for " << expected;
    EXPECT_TRUE(wait_for([&] {
      return time_step_of(document_, scene_.info->times) == static_cast<std::size_t>(std::round(value));
    })) << value;
  }
  // Off the way by 2 mm upwards.
  link->say(seen_there(slider(2.0), kDown, kDepth) + Vec3{0.0, 0.002, 0.0}, true);
  EXPECT_TRUE(wait_for([&] { return std::abs(link->told().y + 0.002 * kStiffness) < 1e-3; }));
  // It lets go: no dial, and the mode is felt again, from zero force.
  EXPECT_TRUE(wait_for([&] { return time_step_of(document_, scene_.info->times) == 2U; }));
  link->say(seen_there(slider(2.0), kDown, kDepth), false);
  EXPECT_TRUE(wait_for([&] { return !session_->hand().dial(); }));
  EXPECT_EQ(time_step_of(document_, scene_.info->times), 2U);
  session_->finish();

  // The recording holds what was felt: played back, each proxy and force to the bit.
  const NamedField field{helix_flow(0.25), field_key("helix", 0)};
  bool dialled = false;
  ReplaySource replay(read_recording(folder.path("run.txt").string()), [&](const std::string& description) {
    dialled = dialled || description.starts_with("slider:");
    return std::move(build_chain(description, sample_modes(), field, 1).chain);
  });
  for (std::size_t i = 0; i < replay.recording().steps.size(); ++i) (void)replay.step();
  EXPECT_TRUE(dialled);
  EXPECT_EQ(replay.verdict().differs, 0U);
  EXPECT_GT(replay.recording().steps.size(), 20U);
}

// The knob is taken at its rim anywhere, and its detents lie where that hand passes them: none is felt where
// it is taken. The view that it turns carries menu and hand along.
TEST_F(MenuHandTest, ADeviceTurnsAKnobFromWhereItTakesIt) {
  const auto link = std::make_shared<HeldLink>();
  ProbeSessionOptions options;
  options.link = link;
  options.limits.force_cap = 8.0;
  open(std::move(options));
  frame();
  const double top = 4.0 + 1.5;
  const auto rim = [&](double degrees) {
    return seen_there(1.5 + 0.9 * std::cos(degrees * kDegree), top + 1.5 + 0.9 * std::sin(degrees * kDegree),
                      1.0);
  };
  constexpr double kTaken = 37.0;  // [degrees]
  link->say(rim(kTaken), false);
  ASSERT_TRUE(wait_for([&] { return session_->readout().held; }));
  link->say(rim(kTaken), true);
  ASSERT_TRUE(wait_for([&] { return session_->hand().dial().has_value(); }));
  EXPECT_EQ(session_->hand().dial()->detents, 24);
  EXPECT_TRUE(wait_for([&] { return session_->readout().held && glm::length(link->told()) < 1e-3; }));
  const Camera before = view_.camera;
  for (double degrees = 2.0; degrees <= 20.0; degrees += 2.0) {
    link->say(rim(kTaken + degrees), true);
    for (int i = 0; i < 10; ++i) frame();
  }
  EXPECT_TRUE(wait_for([&] { return view_.camera.axes[2] != before.axes[2]; }));
  Camera expected = before;
  turn(expected, 15.0 * kDegree, 0.0);
  EXPECT_LT(glm::distance(view_.camera.axes[2], expected.axes[2]), 1e-12) << "one detent";
  // Held on the next one, 5 degrees back: towards there along the rim.
  EXPECT_TRUE(wait_for([&] { return session_->readout().held && glm::length(link->told()) > 0.02; }));
}

// With a mouse alone the hand comes to the handle and goes back to where it was; a simulated arm has to be
// there before it sets anything.
TEST_F(MenuHandTest, AMouseLeadsTheHandAlongASlider) {
  for (const bool arm : {false, true}) {
    ProbeSessionOptions options;
    if (arm) options.simulated = SimulatedDeviceOptions{.profile = find_profile("ideal"), .hand = kFirmHand};
    options.limits.force_cap = 8.0;
    menu_ = {};
    hands_ = {};
    document_ = {};
    open(std::move(options));
    const auto mouse_to = [&](double value) {
      menu_.place(view_.camera, kArea, session_->hand().device_reach());
      const Vec3 shown = project(view_.camera, at(slider(value), kDown), static_cast<int>(kArea.width),
                                 static_cast<int>(kArea.height));
      (void)menu_.handle({.kind = InputKind::kMove, .x = shown.x, .y = shown.y}, kArea, view_.camera);
    };
    const Vec3 before{0.3, 0.2, 0.1};
    frame();
    session_->grab(now(), before);
    frame();
    mouse_to(0.0);
    ASSERT_TRUE(menu_.handle({.kind = InputKind::kPress}, kArea, view_.camera));
    ASSERT_TRUE(wait_for([&] {
      return session_->hand().dial() && session_->readout().held &&
             glm::distance(session_->readout().probe, at(slider(0.0), kDown)) < 0.5 * menu_.entry();
    }));
    mouse_to(1.35);
    EXPECT_TRUE(wait_for([&] {
      return time_step_of(document_, scene_.info->times) == 1 && session_->readout().force > 0.02;
    }));
    mouse_to(2.9);
    EXPECT_TRUE(wait_for([&] { return time_step_of(document_, scene_.info->times) == 3; }));
    ASSERT_TRUE(menu_.handle({.kind = InputKind::kRelease}, kArea, view_.camera));
    EXPECT_TRUE(wait_for([&] { return !session_->hand().dial(); }));
    EXPECT_EQ(time_step_of(document_, scene_.info->times), 3U);
    EXPECT_TRUE(session_->hand().grabbed());
    EXPECT_EQ(session_->hand().intent().probe, before) << "the probe is back in the hand where it was";
    session_->finish();
  }
}

}  // namespace
}  // namespace palpate::test
