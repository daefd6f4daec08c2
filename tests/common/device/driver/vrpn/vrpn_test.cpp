// The link to a device of a VRPN server, against an emulated one over a stream in simulated time.

#include <cstdlib>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/device/driver/vrpn/vrpn_link.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/fake_place.h"
#include "tests/common/device/driver/vrpn/vrpn_emulator.h"

namespace palpate::test {
namespace {

constexpr double kNoticed = 0.100;  // [s]
constexpr double kCap = 3.0;        // [N]
const Vec3 kForce{0.5, -1.0, 1.5};  // [N]

VrpnSettings arm_settings() { return vrpn_settings({{"at", "Phantom0@lab"}, {"cap", "3"}}); }

class VrpnLinkTest : public ::testing::Test {
 protected:
  VrpnLinkTest() { begin(arm_settings()); }

  /// A link of its own, to the same server.
  void begin(const VrpnSettings& settings) {
    auto place = std::make_unique<FakePlace>(server_);
    place_ = place.get();
    link_ = std::make_unique<VrpnLink>(std::move(place), settings);
  }

  void run(double seconds, const Vec3& force) {
    for (const double until = place_->now() + seconds; place_->now() < until;)
      (void)round_with(*link_, force);
  }
  void get_ready() {
    run(1.0, Vec3{0.0});
    ASSERT_EQ(link_->status().phase, LinkPhase::kReady) << link_->advice();
  }
  [[nodiscard]] bool silent() {
    VrpnEmulator::Bytes said;
    return server_.arm.force() == Vec3{0.0};
  }

  VrpnEmulator server_;
  FakePlace* place_ = nullptr;  ///< the link's
  std::unique_ptr<VrpnLink> link_;
};

TEST(VrpnAddresses, AreANameAHostAndAPort) {
  const auto plain = vrpn_address("Tracker0@lab.example.org");
  ASSERT_TRUE(plain);
  EXPECT_EQ(plain->name, "Tracker0");
  EXPECT_EQ(plain->host, "lab.example.org");
  EXPECT_EQ(plain->port, 3883);
  EXPECT_EQ(vrpn_address("T@10.0.0.1:4000")->port, 4000);
  const auto v6 = vrpn_address("T@[fe80::1]:4000");
  ASSERT_TRUE(v6);
  EXPECT_EQ(v6->host, "fe80::1");
  EXPECT_EQ(v6->port, 4000);
  for (const char* wrong : {"", "Tracker0", "@lab", "T@", "T@lab:", "T@lab:0", "T@lab:70000", "T@lab:x",
                            "T@[::1", "T@[]:1", "T@[::1]x"}) {
    EXPECT_FALSE(vrpn_address(wrong).has_value()) << wrong;
  }
}

TEST(VrpnOptions, AreChecked) {
  EXPECT_FALSE(vrpn_settings({{"at", "T@lab"}}).force);
  const VrpnSettings settings =
      vrpn_settings({{"at", "T@lab"}, {"cap", "2"}, {"sensor", "3"}, {"stiffness", "100"}});
  EXPECT_TRUE(settings.force);
  EXPECT_EQ(settings.sensor, 3);
  EXPECT_EQ(settings.stiffest, 100.0);
  EXPECT_THROW((void)vrpn_settings({}), Error);
  for (const auto& [name, value] : DriverOptions{{"at", "T"},
                                                 {"sensor", "-1"},
                                                 {"sensor", "1.5"},
                                                 {"radius", "0"},
                                                 {"radius", "inf"},
                                                 {"host", "x"}}) {
    EXPECT_THROW((void)vrpn_settings({{"at", "T@lab"}, {name, value}}), Error) << name;
  }
}

TEST_F(VrpnLinkTest, ReadsOneSensorAndTheButtonsOfOneDevice) {
  get_ready();
  EXPECT_EQ(link_->place(), "vrpn Phantom0 at lab:3883");
  server_.arm.put({0.01, -0.02, 0.004});
  server_.arm.set_target({0.01, -0.02, 0.004});
  server_.press(2, true);
  server_.press(0, true);
  server_.press(0, false);
  run(0.2, Vec3{0.0});
  EXPECT_NEAR(glm::distance(link_->atoms().position, {0.01, -0.02, 0.004}), 0.0, 1e-12);
  EXPECT_EQ(link_->atoms().buttons, 4U);
  EXPECT_TRUE(server_.strange.empty());
  EXPECT_GT(server_.pings, 3U);
  EXPECT_EQ(server_.fields, 0U) << "nothing was asked for";
  EXPECT_EQ(link_->status().faults, 0U);
}

// Poses that come together are as far apart as they were made, by the sender's stamps; whatever its clock says.
TEST_F(VrpnLinkTest, KeepsTheTimeAtWhichAPoseWasMade) {
  for (const double ahead : {0.0, -1e6, 1e6 + 0.3}) {
    link_.reset();
    server_ = VrpnEmulator();  // each link has a clock that begins anew
    server_.exact_stamps = true;
    server_.clock_ahead = ahead;
    server_.rate = 200.0;
    begin(vrpn_settings({{"at", "Phantom0@lab"}}));
    get_ready();
    place_->faults = {.late = 0.3, .lateness = 0.012};
    double last = link_->atoms().time;
    int news = 0;
    for (const double until = place_->now() + 5.0; place_->now() < until;) {
      if (!round_with(*link_, Vec3{0.0})) continue;
      const double time = link_->atoms().time;
      EXPECT_LE(time, place_->now());
      EXPECT_LT(place_->now() - time, 0.1);
      if (time == last) continue;
      EXPECT_GE(time - last, 0.5 / server_.rate) << "no two poses are nearer than they were made";
      ++news;
      last = time;
    }
    EXPECT_GT(news, 500);
    place_->faults = {};
  }
}

TEST(SenderClock, TellsWhenPacketsWereMade) {
  // Ahead by 1000 s, 2 ms on the way, 20 now and then.
  SenderClock clock;
  double worst = 0.0;
  for (int n = 0; n < 1000; ++n) {
    const double made = 0.01 * n, way = n % 7 == 3 ? 0.020 : 0.002;
    const double local = clock.local(made + 1000.0, made + way);
    EXPECT_LE(local, made + way);
    if (n > 7) worst = std::max(worst, std::abs(local - made - 0.002));
  }
  EXPECT_LT(worst, 1e-4);
  // It drifts by 50 ppm, and is set back, and forward.
  clock.reset();
  for (int n = 0; n < 100'000; ++n) {
    const double made = 0.01 * n, set = n < 40'000 ? 0.0 : n < 70'000 ? -3600.0 : 77.0;
    const double local = clock.local(made * (1.0 + 5e-5) + set, made + 0.002);
    EXPECT_TRUE(n % 10'000 <= 1 || std::abs(local - made - 0.002) < 1e-3) << n;
  }
  // Stamps of whole seconds, or none at all, are none.
  for (const double step : {1.0, 1e9}) {
    clock.reset();
    for (int n = 0; n < 1000; ++n) {
      const double made = 0.01 * n;
      const double local = clock.local(step * std::floor(made / step), made);
      EXPECT_TRUE(n <= 2 || local == made) << n;
    }
  }
  clock.reset();
  EXPECT_EQ(clock.local(std::nan(""), 1.0), 1.0);
  EXPECT_EQ(clock.local(2.0, 1.1), 1.1);
}

// The server's own loop holds the hand: between two models, and with a model that is late, the spring is
// there.
TEST_F(VrpnLinkTest, SendsSpringsThatTheServersLoopShows) {
  constexpr double kStiffness = 150.0;  // [N/m]
  get_ready();
  double worst = 0.0, pushed = 0.0;
  const Vec3 rest{0.0, 0.005, 0.0};
  for (const double start = place_->now(); place_->now() < start + 6.0;) {
    const double t = place_->now() - start;
    server_.arm.set_target(0.03 * Vec3{std::sin(1.3 * t), std::sin(0.9 * t), std::sin(1.7 * t)});
    const Vec3 force = -kStiffness * (link_->atoms().position - rest);
    (void)round_with(*link_, glm::length(force) < kCap ? force : force * (kCap / glm::length(force)));
    if (t < 1.0) continue;
    const Vec3 ideal = -kStiffness * (server_.arm.position() - rest);
    if (glm::length(ideal) > 0.8 * kCap) continue;  // there the cap makes it softer
    worst = std::max(worst, glm::distance(server_.arm.force(), ideal));
    pushed = std::max(pushed, glm::length(server_.arm.force()));
  }
  RecordProperty("worst_newtons", std::to_string(worst));
  EXPECT_GT(pushed, 1.0);
  EXPECT_LT(worst, 0.05);
  EXPECT_GT(server_.stiffest, kStiffness)
      << "models have a stiffness, else the loop would be over the network";
  EXPECT_LE(server_.largest_field, kCap * 1.001);
  EXPECT_FALSE(server_.active_field);
}

TEST_F(VrpnLinkTest, IsATrackerWithoutForceUnlessACapIsNamed) {
  EXPECT_EQ(link_->poses(), nullptr);
  begin(vrpn_settings({{"at", "Phantom0@lab"}, {"sensor", "1"}}));
  EXPECT_TRUE(link_->atoms().has_position) << "a window asks before the server has said anything";
  get_ready();
  server_.press(3, true);
  run(1.0, kForce);
  EXPECT_EQ(server_.fields, 0U);
  ASSERT_NE(link_->poses(), nullptr);
  const auto& stations = link_->poses()->stations;
  EXPECT_EQ(stations[1].position, Vec3(9.0)) << "the second sensor of the emulator rests there";
  EXPECT_EQ(stations[1].station, 2);
  EXPECT_EQ(stations[1].buttons, 8U);
  EXPECT_EQ(stations[0].buttons, 0U) << "they are on the one that was asked for";
  EXPECT_EQ(stations[0].position, server_.arm.position());
  EXPECT_TRUE(stations[0].valid);
  EXPECT_FALSE(stations[2].valid);
  EXPECT_EQ(link_->atoms().position, Vec3(9.0));
  place_->listens = false;
  run(0.1, kForce);
  EXPECT_FALSE(stations[0].valid);
}

TEST_F(VrpnLinkTest, TheLastModelOnAnyFaultHasNoForce) {
  using Fault = void (*)(FakePlace&, VrpnEmulator&);
  const std::array<std::pair<const char*, Fault>, 8> faults{{
      {"no poses", [](FakePlace&, VrpnEmulator& server) { server.rate = 0.0; }},
      {"silent", [](FakePlace&, VrpnEmulator& server) { server.silent = true; }},
      {"nonsense", [](FakePlace&, VrpnEmulator& server) { server.nonsense = true, server.rate = 1000.0; }},
      {"jump",
       [](FakePlace&, VrpnEmulator& server) {
         server.arm.put({0.085, 0.0, 0.0});
       }},
      {"force error",
       [](FakePlace&, VrpnEmulator& server) {
         server.say(VrpnEmulator::kSender, VrpnEmulator::kError, {0, 0, 0, 1});
       }},
      {"no VRPN any more",
       [](FakePlace&, VrpnEmulator& server) { server.say_raw(VrpnEmulator::Bytes(64, 0xFF)); }},
      {"reset", [](FakePlace& place, VrpnEmulator&) { place.faults.reset = 1.0; }},
      {"ended", [](FakePlace& place, VrpnEmulator&) { place.listens = false; }},
  }};
  for (const auto& [name, fault] : faults) {
    server_.rate = 500.0;
    server_.silent = server_.nonsense = false;
    place_->faults = {};
    place_->listens = true;
    run(4.0, Vec3{0.0});
    get_ready();
    run(0.1, kForce);
    ASSERT_FALSE(silent()) << name;
    fault(*place_, server_);
    bool silenced = false;
    for (const double until = place_->now() + kNoticed; place_->now() < until;) {
      (void)round_with(*link_, kForce);
      silenced = silenced || silent();
    }
    EXPECT_TRUE(silenced) << name;
  }
}

// Nothing passes any more, not even a model without force: what was sent last holds only near its origin, and
// is passive there.
TEST_F(VrpnLinkTest, AStalledNetworkLeavesAPassiveSpringThatEndsNearby) {
  get_ready();
  run(0.1, kForce);
  place_->stalled = true;
  const double stalled = place_->now();
  while (place_->connections() > 0 && place_->now() < stalled + 10.0) (void)round_with(*link_, kForce);
  EXPECT_LT(place_->now() - stalled, kNoticed) << "writes are not taken";
  EXPECT_TRUE(silent());
  place_->stalled = false;
  get_ready();
  run(0.1, kForce);
  EXPECT_FALSE(silent());
  server_.arm.put({0.05, 0.05, 0.0});
  VrpnEmulator::Bytes said;
  server_.advance(place_->now() + 0.003, said);
  EXPECT_TRUE(silent()) << "outside of its radius";
}

TEST_F(VrpnLinkTest, SaysWhatIsMissing) {
  place_->listens = false;
  run(0.3, Vec3{0.0});
  EXPECT_EQ(link_->advice(), "no VRPN server answers at lab:3883");
  place_->listens = true;
  server_.cookie = "HTTP/1.1 400 Bad";
  run(0.1, Vec3{0.0});
  EXPECT_EQ(link_->status().phase, LinkPhase::kRefused);
  EXPECT_NE(link_->advice().find("no VRPN server of version 7"), std::string::npos);
  server_.cookie = "vrpn: ver. 07.35";
  server_.names_device = false;
  run(1.0, Vec3{0.0});
  EXPECT_NE(link_->advice().find("has not named a device Phantom0"), std::string::npos) << link_->advice();
  server_.names_device = true;
  server_.rate = 0.0;
  place_->faults.reset = 1.0;
  run(0.05, Vec3{0.0});
  place_->faults = {};
  run(1.0, Vec3{0.0});
  EXPECT_NE(link_->advice().find("says nothing yet"), std::string::npos) << link_->advice();
}

TEST_F(VrpnLinkTest, ReadsChannelsThatRestWithTheirServer) {
  server_.rate = 0.0;
  server_.channels = {0.5, -0.25, 3.0};
  server_.analog_rate = 2.0;
  get_ready();
  EXPECT_FALSE(link_->atoms().has_position);
  ASSERT_TRUE(link_->atoms().has_valuators);
  EXPECT_EQ(link_->atoms().valuators, (std::array{0.5, -0.25, 1.0, 0.0, 0.0, 0.0}));
  EXPECT_LT(place_->now() - link_->atoms().time, 0.02) << "as it was, and still is";
  server_.silent = true;
  run(VrpnLink::kHush + 0.05, Vec3{0.0});
  EXPECT_EQ(link_->atoms().valuators, (std::array<double, 6>{})) << "nothing drifts on its own";
}

// A tracker that finds its sensor elsewhere begins anew there; an arm gets no force until none was asked for.
TEST_F(VrpnLinkTest, BeginsAnewWhereATrackerFindsItsSensorAgain) {
  get_ready();
  server_.arm = ArmInHand({.end = 3.0});
  server_.arm.advance(place_->now());
  server_.arm.put({2.0, 0.0, 0.0});
  server_.arm.set_target({2.0, 0.0, 0.0});
  run(0.2, kForce);
  EXPECT_NEAR(link_->atoms().position.x, 2.0, 1e-9);
  EXPECT_TRUE(silent());
  EXPECT_GT(link_->status().implausible, 0U);
  EXPECT_EQ(place_->opened(), 1);
}

TEST_F(VrpnLinkTest, NoticesAtOnceThatAServerEndedAndFindsItAgain) {
  for (int n = 0; n < 5; ++n) {
    get_ready();
    run(0.05 + 0.0007 * n, kForce);
    const double ended = place_->now();
    place_->listens = false;
    while (link_->status().phase == LinkPhase::kReady && place_->now() < ended + 1.0)
      (void)round_with(*link_, kForce);
    EXPECT_LT(place_->now() - ended, kNoticed);
    EXPECT_EQ(place_->connections(), 0);
    place_->listens = true;
    run(1.0, kForce);
    EXPECT_EQ(link_->status().phase, LinkPhase::kReady);
    EXPECT_TRUE(silent()) << "the hand leans on it all the while";
  }
  link_.reset();
  EXPECT_FALSE(server_.connected());
}

// All that can go wrong, over and over, for as long as PALPATE_SOAK_SECONDS says [s of simulated time].
TEST_F(VrpnLinkTest, BearsEveryFaultForLong) {
  const double seconds = soak_seconds(60.0);
  Soak soak(14);
  std::uint64_t fresh = 0;
  while (place_->now() < seconds && !HasFailure()) {
    soak.begin();
    place_->faults = {.split = soak.rate(1.0),
                      .late = soak.rate(0.2),
                      .lateness = 0.1 * soak.part(),
                      .corrupt = soak.rate(0.1),
                      .reset = soak.rate(0.02),
                      .full = soak.rate(0.02)};
    place_->listens = !soak.chance(0.02);
    place_->stalled = soak.chance(0.03);
    server_.silent = soak.chance(0.03);
    server_.nonsense = soak.chance(0.05);
    server_.rate = soak.chance(0.05) ? 0.0 : 100.0 + 900.0 * soak.part();
    if (soak.chance(0.1)) server_.press(static_cast<unsigned>(soak.below(40)), soak.chance(0.5));
    if (soak.chance(0.1)) server_.arm.put(soak.within(0.16));
    if (soak.chance(0.05)) {
      VrpnEmulator::Bytes any(soak.below(200));
      for (auto& byte : any) byte = static_cast<std::uint8_t>(soak.below(256));
      server_.say(static_cast<std::int32_t>(soak.below(20)), static_cast<std::int32_t>(soak.below(50)) - 5,
                  any);
    }
    server_.arm.set_target(soak.within(0.04));
    fresh += soak.work(
        *link_, [&] { return place_->now(); }, 0.3, soak.force(10.0), [&] { return place_->connections(); });
    ASSERT_LE(server_.largest_field, kCap * 1.001);
    ASSERT_LE(server_.arm.largest_force(), kCap * 1.001);
    ASSERT_FALSE(server_.active_field);
    ASSERT_TRUE(server_.strange.empty());
  }
  EXPECT_GT(fresh, static_cast<std::uint64_t>(30.0 * seconds));
  EXPECT_GT(place_->opened(), 3);
  place_->faults = {};
  place_->listens = true;
  place_->stalled = server_.silent = server_.nonsense = false;
  server_.rate = 500.0;
  run(4.0, Vec3{0.0});
  get_ready();
}

}  // namespace
}  // namespace palpate::test
