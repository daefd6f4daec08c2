// The Haply Inverse3: its messages, and its link against an emulated service in simulated time. The wire
// itself is in beast_transport_test.

#include <cstdlib>
#include <memory>
#include <random>

#include <gtest/gtest.h>

#include "common/base/error.h"
#include "common/base/json.h"
#include "common/device/driver/inverse3/inverse3_link.h"
#include "tests/common/device/driver/inverse3/haply_emulator.h"
#include "tests/common/device/driver/round_with.h"
#include "tests/common/device/driver/soak.h"
#include "tests/common/device/driver/transport/fake_web.h"

namespace palpate::test {
namespace {

constexpr double kNoticed = 0.100;  // [s]
const Vec3 kForce{0.5, -1.0, 1.5};  // [N]

HaplyState read(const std::string& message, const std::string& wanted = "") {
  HaplyState state;
  EXPECT_TRUE(read_haply_state(message, wanted, state)) << message;
  return state;
}

TEST(HaplyMessage, ReadsWhatTheServiceSends) {
  HaplyEmulator service;
  service.arm.put({0.01, 0.02, -0.03});
  service.buttons = 5;
  for (const bool old : {false, true}) {
    service.old_buttons = old;
    const HaplyState state = read(service.snapshot(0.0));
    ASSERT_TRUE(state.device && state.position);
    EXPECT_EQ(state.device->view(), "049D");
    EXPECT_NEAR(glm::distance(*state.position, HaplyEmulator::kMiddle + Vec3(0.01, 0.03, 0.02)), 0.0, 1e-15);
    EXPECT_EQ(state.buttons, 5U);
  }
}

TEST(HaplyMessage, ChoosesADeviceAndTheFirstGrip) {
  const auto device = [](const std::string& id, double x) {
    return R"({"state":{"cursor_position":{"z":0,"y":0,"x":)" + std::to_string(x) + R"(}},"device_id":")" +
           id + "\"}";
  };
  const std::string message =
      R"({"verse_grip":[{"state":{"buttons":{"a":true}}},{"state":{"buttons":{"b":true}}}],)"
      R"("inverse3":[)" +
      device("A", 1) + "," + device("B", 2) + "]}";
  EXPECT_EQ(read(message).position->x, 1.0);
  EXPECT_EQ(read(message, "B").position->x, 2.0);
  EXPECT_FALSE(read(message, "C").device.has_value());
  EXPECT_EQ(read(message).buttons, 1U);
  // A part of a position is none, and a name that could be anything is no device.
  EXPECT_FALSE(
      read(R"({"inverse3":[{"device_id":"A","state":{"cursor_position":{"x":1,"y":2}}}]})").position);
  EXPECT_FALSE(
      read(R"({"inverse3":[{"device_id":"A\"}]","state":{"cursor_position":{"x":1,"y":2,"z":3}}}]})").device);
  EXPECT_FALSE(read(R"({"inverse3":[]})").device);
}

TEST(HaplyMessage, RefusesWhatIsNone) {
  HaplyState state;
  const std::string deep = std::string(10000, '[') + std::string(10000, ']');
  const std::string nested = R"({"a":)" + deep + "}";
  for (const std::string& message :
       {std::string(), std::string("{"), std::string("[]"), std::string("3"), std::string("null"), deep,
        nested, std::string(R"({"inverse3":[{"state":{"cursor_position":{"x":1e999,"y":0,"z":0}}}]})"),
        std::string(R"({"inverse3":[{"device_id":"A"})"), std::string("\x00\xff{}", 4)}) {
    EXPECT_FALSE(read_haply_state(message, "", state)) << message.substr(0, 60);
  }
}

TEST(HaplyMessage, SurvivesAnyDamage) {
  HaplyEmulator service;
  const std::string good = service.snapshot(0.0);
  std::mt19937 random{5};
  for (int n = 0; n < 20'000; ++n) {
    std::string message = good;
    for (unsigned k = 0; k <= random() % 4; ++k)
      message[random() % message.size()] = static_cast<char>(random() % 256);
    if (n % 3 == 0) message.resize(random() % message.size());
    HaplyState state;
    if (!read_haply_state(message, "", state)) continue;
    ASSERT_TRUE(!state.position || is_finite(*state.position));
    ASSERT_TRUE(!state.device || HaplyId::from(state.device->view()).has_value());
    ASSERT_LE(state.buttons, 15U);
  }
}

// What a JSON library that is not asked to be brief reads of it.
TEST(HaplyMessage, WritesCommandsInBothSpellings) {
  std::string text;
  const HaplyId id = *HaplyId::from("049D");
  for (const auto& [spelling, key] :
       {std::pair{HaplySpelling::kValues, "values"}, std::pair{HaplySpelling::kVector, "vector"}}) {
    write_haply_force(text, id, {0.123456, -2.5, 1e-9}, spelling);
    const auto json = parse_json(text);
    ASSERT_EQ(json["inverse3"].size(), 1U);
    EXPECT_EQ(json["inverse3"][0]["device_id"], "049D");
    const auto& force = json["inverse3"][0]["commands"]["set_cursor_force"][key];
    EXPECT_EQ(force["x"], 0.123456);
    EXPECT_EQ(force["y"], -2.5);
    EXPECT_NEAR(force["z"].get<double>(), 0.0, 1e-6);
  }
}

TEST(HaplyMessage, KnowsTheSpellingOfAVersion) {
  EXPECT_EQ(haply_spelling("3.1.1"), HaplySpelling::kValues);
  EXPECT_EQ(haply_spelling("3.4.9"), HaplySpelling::kValues);
  EXPECT_EQ(haply_spelling("3.5.0"), HaplySpelling::kVector);
  EXPECT_EQ(haply_spelling("4.0"), HaplySpelling::kVector);
  EXPECT_EQ(haply_spelling(R"({"build_time":"2024-08-07T16:05:12.345Z","version":"3.1.7"})"),
            HaplySpelling::kValues);
  for (const char* text : {"", "version", "7", "version: unknown, since 3.5", "{\"build\":\"x\"}"}) {
    EXPECT_FALSE(haply_spelling(text).has_value()) << text;
  }
}

TEST(Inverse3Options, AreChecked) {
  const Inverse3Settings settings = inverse3_settings(
      {{"host", "lab"}, {"port", "10005"}, {"device", "04-9D"}, {"spelling", "values"}, {"cap", "2"}});
  EXPECT_EQ(settings.service.host, "lab");
  EXPECT_EQ(settings.service.port, 10005);
  EXPECT_EQ(settings.spelling, HaplySpelling::kValues);
  EXPECT_EQ(settings.arm.limits().force_cap, 2.0);
  for (const auto& [name, value] : DriverOptions{{"host", ""},
                                                 {"port", "0"},
                                                 {"port", "70000"},
                                                 {"device", "a\"b"},
                                                 {"spelling", "both"},
                                                 {"at", "x"}}) {
    EXPECT_THROW((void)inverse3_settings({{name, value}}), Error) << name;
  }
}

class Inverse3LinkTest : public ::testing::Test {
 protected:
  void run(double seconds, const Vec3& force) {
    for (const double until = web_.now() + seconds; web_.now() < until;) (void)round_with(link_, force);
  }
  void get_ready() {
    run(1.0, Vec3{0.0});
    ASSERT_EQ(link_.status().phase, LinkPhase::kReady) << link_.advice();
  }
  [[nodiscard]] bool silent() const { return service_.arm.force() == Vec3{0.0}; }

  HaplyEmulator service_;
  FakeWeb web_{service_};
  Inverse3Link link_{web_, Inverse3Settings()};
};

TEST_F(Inverse3LinkTest, MovesAndPushesInBothSpellings) {
  for (const char* version : {"3.1.4", "3.5.2"}) {
    web_.listens = false;
    run(0.3, Vec3{0.0});
    web_.listens = true;
    service_.version = version;
    get_ready();
    service_.arm.put({0.01, -0.02, 0.004});
    service_.arm.set_target({0.01, -0.02, 0.004});
    service_.buttons = 2;
    run(0.05, Vec3{0.0});
    EXPECT_NEAR(glm::distance(link_.atoms().position, {0.01, -0.02, 0.004}), 0.0, 1e-9);
    EXPECT_EQ(link_.atoms().buttons, 2U);
    run(0.01, kForce);
    EXPECT_NEAR(glm::distance(service_.last, kForce), 0.0, 1e-6);
    EXPECT_EQ(service_.strange, "") << "a command in the other spelling";
    service_.strange.clear();
  }
  EXPECT_EQ(link_.place(), "inverse3 049D at localhost");
}

TEST_F(Inverse3LinkTest, SendsOneCommandForEachState) {
  get_ready();
  const std::uint64_t before = link_.status().rounds, commands = service_.commands;
  run(2.0, kForce);
  const std::uint64_t states = link_.status().rounds - before;
  EXPECT_EQ(service_.commands - commands, states);
  EXPECT_NEAR(static_cast<double>(states), 2000.0, 40.0) << "a thousand a second";
  EXPECT_EQ(link_.status().lost, 0U);
}

TEST_F(Inverse3LinkTest, HoldsEveryForceToTheCap) {
  get_ready();
  run(0.05, {30.0, 0.0, -40.0});
  EXPECT_NEAR(glm::distance(service_.last, {3.0, 0.0, -4.0}), 0.0, 1e-6);
  run(0.01, {std::nan(""), 0.0, 1.0});
  EXPECT_EQ(service_.last, Vec3(0.0));
}

TEST_F(Inverse3LinkTest, TheLastCommandOnAnyFaultIsZero) {
  using Fault = void (*)(FakeWeb&, HaplyEmulator&);
  const std::array<std::pair<const char*, Fault>, 8> faults{{
      {"silent", [](FakeWeb& web, HaplyEmulator&) { web.faults.lost = 1.0; }},
      {"late", [](FakeWeb& web, HaplyEmulator&) { web.faults = {.late = 1.0, .lateness = 0.06}; }},
      {"no JSON", [](FakeWeb& web, HaplyEmulator&) { web.says = "{{{"; }},
      {"other JSON", [](FakeWeb& web, HaplyEmulator&) { web.says = R"({"inverse3":[]})"; }},
      {"flood", [](FakeWeb& web, HaplyEmulator&) { web.flood = true; }},
      {"unplugged", [](FakeWeb&, HaplyEmulator& service) { service.plugged = false; }},
      {"another", [](FakeWeb&, HaplyEmulator& service) { service.device = "FFFF"; }},
      {"jump",
       [](FakeWeb&, HaplyEmulator& service) {
         service.arm.put({0.08, 0.0, 0.0});
       }},
  }};
  for (const auto& [name, fault] : faults) {
    web_.faults = {};
    web_.flood = false;
    web_.says.clear();
    service_.plugged = true;
    service_.device = "049D";
    get_ready();
    run(0.1, kForce);
    ASSERT_FALSE(silent()) << name;
    fault(web_, service_);
    bool silenced = false;
    for (const double until = web_.now() + kNoticed; web_.now() < until;) {
      (void)round_with(link_, kForce);
      silenced = silenced || silent();
    }
    EXPECT_TRUE(silenced) << name;
    EXPECT_LE(web_.connections(), 1) << name;
  }
}

// By the status in the snapshot, or in any state after it.
TEST_F(Inverse3LinkTest, ShowsNoForceUncalibratedOrWithoutPower) {
  for (bool* const lacking : {&service_.calibrated, &service_.powered}) {
    service_.tells_status = true;
    get_ready();
    run(0.1, {1.0, 0.0, 0.0});
    ASSERT_NEAR(service_.last.x, 1.0, 1e-6);
    *lacking = false;
    run(0.05, {1.0, 0.0, 0.0});
    EXPECT_EQ(service_.last, Vec3(0.0));
    EXPECT_EQ(link_.status().phase, LinkPhase::kNeedsHoming);
    EXPECT_NE(link_.advice().find(lacking == &service_.calibrated ? "not calibrated" : "power supply"),
              std::string::npos)
        << link_.advice();
    *lacking = true;
    run(0.1, {1.0, 0.0, 0.0});
    EXPECT_EQ(link_.status().phase, LinkPhase::kReady);
    // The snapshot alone says it, to a client that comes anew.
    service_.tells_status = false;
    *lacking = false;
    web_.listens = false;
    run(0.5, Vec3{0.0});
    web_.listens = true;
    run(1.0, {1.0, 0.0, 0.0});
    EXPECT_EQ(service_.last, Vec3(0.0));
    EXPECT_EQ(link_.status().phase, LinkPhase::kNeedsHoming);
    *lacking = true;
    web_.listens = false;
    run(0.5, Vec3{0.0});
    web_.listens = true;
    get_ready();
  }
}

TEST_F(Inverse3LinkTest, SaysThatNothingCanBeHeldWithoutAGrip) {
  service_.grip = false;
  get_ready();
  EXPECT_NE(link_.advice().find("enable=pedal"), std::string::npos) << link_.advice();
  run(0.1, {1.0, 0.0, 0.0});
  EXPECT_EQ(link_.advice(), "") << "another switch is held";
  service_.grip = true;
  get_ready();
  EXPECT_EQ(link_.advice(), "");
}

TEST_F(Inverse3LinkTest, FallsSilentWhereTheProgramDoes) {
  get_ready();
  run(0.1, kForce);
  ASSERT_FALSE(silent());
  web_.sleep(HaplyEmulator::kIdleAfter + 0.01);
  EXPECT_TRUE(silent()) << "the service's own doing";
}

TEST_F(Inverse3LinkTest, NoticesAtOnceThatTheServiceEndedAndFindsItAgain) {
  for (int n = 0; n < 5; ++n) {
    get_ready();
    run(0.05 + 0.0007 * n, kForce);
    const double ended = web_.now();
    web_.listens = false;
    while (link_.status().phase == LinkPhase::kReady && web_.now() < ended + 1.0)
      (void)round_with(link_, kForce);
    EXPECT_LT(web_.now() - ended, kNoticed);
    EXPECT_EQ(web_.connections(), 0);
    run(0.3, kForce);
    EXPECT_NE(link_.advice().find("haply-inverse-service"), std::string::npos);
    web_.listens = true;
  }
  service_.plugged = false;
  run(1.0, kForce);
  EXPECT_EQ(link_.status().phase, LinkPhase::kAbsent);
  EXPECT_NE(link_.advice().find("has no Inverse3"), std::string::npos) << link_.advice();
}

// All that can go wrong, over and over, for as long as PALPATE_SOAK_SECONDS says [s of simulated time].
TEST_F(Inverse3LinkTest, BearsEveryFaultForLong) {
  const double seconds = soak_seconds(60.0);
  Soak soak(13);
  std::uint64_t fresh = 0;
  while (web_.now() < seconds && !HasFailure()) {
    soak.begin();
    web_.faults = {.lost = soak.rate(0.3),
                   .late = soak.rate(0.2),
                   .lateness = 0.1 * soak.part(),
                   .corrupt = soak.rate(0.5),
                   .cut = soak.rate(0.3),
                   .doubled = soak.rate(0.5),
                   .reset = soak.rate(0.1)};
    web_.listens = !soak.chance(0.05);
    web_.flood = soak.chance(0.03);
    web_.says = soak.chance(0.03) ? std::string(soak.below(3000), '[') : "";
    service_.plugged = !soak.chance(0.05);
    if (soak.chance(0.1)) service_.arm.put(soak.within(0.16));
    service_.arm.set_target(soak.within(0.04));
    fresh += soak.work(
        link_, [&] { return web_.now(); }, 0.3, soak.force(15.0), [&] { return web_.connections(); });
    ASSERT_LE(service_.arm.largest_force(), 5.0 + 1e-5);
    ASSERT_LE(service_.wire.excess(), 1e-5);
  }
  EXPECT_GT(fresh, static_cast<std::uint64_t>(100.0 * seconds));
  EXPECT_GT(web_.opened(), 3);
  web_.faults = {};
  web_.listens = service_.plugged = true;
  web_.flood = false;
  web_.says.clear();
  run(1.0, Vec3{0.0});
  get_ready();
}

}  // namespace
}  // namespace palpate::test
