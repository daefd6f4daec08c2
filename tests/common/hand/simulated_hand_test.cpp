// A simulated arm and hand in a session, live: it wanders by itself, and comes where the mouse leads. No time
// is asserted; every wait is for an event, and gives up after half a minute.

#include <chrono>
#include <functional>
#include <thread>

#include <gtest/gtest.h>

#include "common/hand/probe_session.h"
#include "tests/common/hand/sample_modes.h"
#include "tests/common/trace/helix_field.h"

namespace palpate::test {
namespace {

const Vec3 kSeed{1.0, 0.0, 0.0};
// The line on which the hand was may hold it back by 2 N, which a firm hand gives way to by 4 mm.
constexpr double kNear = 0.15;  // [data units]

class SimulatedHand {
 public:
  explicit SimulatedHand(ProbeSessionOptions options) : session(std::move(options), [] {}) {
    session.set_field({helix_flow(0.25), field_key("helix", 0)});
  }

  [[nodiscard]] bool wait_for(const std::function<bool()>& happened) {
    for (int frame = 0; frame < 7500; ++frame) {
      session.update(0.004 * frame, camera_, LineStyle{}, view_);
      if (happened()) return true;
      std::this_thread::sleep_for(std::chrono::milliseconds(4));
    }
    return false;
  }

  [[nodiscard]] std::string stiffness_note() const {
    return session.limits().note(session.choice().settings);
  }

  ProbeSession session;

 private:
  ProbeView view_;
  Camera camera_ = make_camera({Vec3{-2.0}, Vec3{2.0}}, {}, 1.5);
};

ProbeSessionOptions options_with(const DeviceProfile& profile) {
  ProbeSessionOptions options;
  options.modes = sample_modes();
  options.simulated = SimulatedDeviceOptions{.profile = profile, .hand = kFirmHand};
  return options;
}

TEST(SimulatedHand, WandersByItselfAndComesWhereTheMouseLeads) {
  SimulatedHand hand(options_with(find_profile("ideal")));
  ASSERT_TRUE(hand.wait_for([&] { return hand.session.readout().held; })) << "nobody has to grab it";
  const Vec3 start = hand.session.readout().probe;
  EXPECT_TRUE(hand.wait_for([&] { return glm::distance(hand.session.readout().probe, start) > 0.05; }));
  EXPECT_TRUE(hand.session.lively());
  EXPECT_TRUE(hand.session.hand().by_mouse());
  hand.session.grab(0.0, kSeed);
  EXPECT_TRUE(hand.wait_for([&] { return glm::distance(hand.session.readout().probe, kSeed) < kNear; }));
  hand.session.hand().let_go();
  EXPECT_TRUE(
      hand.wait_for([&] { return glm::distance(hand.session.readout().probe, kSeed) > 2.0 * kNear; }));
  EXPECT_TRUE(hand.session.readout().held) << "the hand stays on the device";
  hand.session.finish();
}

TEST(SimulatedHand, WarnsOfAStiffnessThatTheDeviceCannotShow) {
  SimulatedHand hand(options_with(find_profile("premium3")));
  EXPECT_EQ(hand.stiffness_note(), "") << "the default stiffness is at its bound";
  TouchChoice choice = hand.session.choice();
  choice.settings.stiffness = 201.0;
  hand.session.choose(choice);
  EXPECT_NE(hand.stiffness_note().find("is above 200 N/m"), std::string::npos);
  ProbeSessionOptions fast = options_with(find_profile("premium3"));
  fast.servo_rate = 2000.0;
  fast.choice.settings.stiffness = 201.0;
  EXPECT_EQ(SimulatedHand(std::move(fast)).stiffness_note(), "");
  ProbeSessionOptions mouse;
  mouse.modes = sample_modes();
  mouse.choice.settings.stiffness = 1e6;
  EXPECT_EQ(SimulatedHand(std::move(mouse)).stiffness_note(), "") << "a mouse shows no force";
}

TEST(SimulatedHand, FollowsAPathAndLetsGoAtItsEnd) {
  ProbeSessionOptions options = options_with(find_profile("falcon"));
  for (int n = 0; n < 800; ++n) options.path.push_back({0.001 * n, kSeed + Vec3{0.0, 0.0, 1e-3 * n}, 1});
  SimulatedHand hand(std::move(options));
  ASSERT_TRUE(hand.wait_for([&] { return hand.session.readout().held; }));
  EXPECT_FALSE(hand.session.hand().by_mouse());
  EXPECT_TRUE(hand.wait_for([&] { return hand.session.readout().probe.z > 2.0 * kNear; }));
  EXPECT_TRUE(hand.wait_for([&] { return !hand.session.readout().held; }));
  hand.session.finish();
}

}  // namespace
}  // namespace palpate::test
