// Arms that their makers' software runs, as a user has them: `flow --device dhd` and `--device inverse3`
// beside the simulated arm of the same physics, and what the workbench says of them.

#include <chrono>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "common/base/json.h"
#include "common/device/driver/dhd/dhd_link.h"
#include "common/device/driver/inverse3/inverse3_link.h"
#include "tests/common/device/driver/fake_dhd.h"
#include "tests/common/device/driver/moved_clock.h"
#include "tests/common/device/driver/transport/fake_web.h"
#include "tests/common/device/driver/transport/web_server.h"
#include "tests/common/device/driver/vrpn/vrpn_server.h"
#include "tests/e2e/hand/hand_in_flow.h"
#include "tests/support/project_folders.h"

namespace palpate::test {
namespace {

std::string library(const char* name) {
  return (build_folder() / "tests" / ("libpalpate_fake_" + std::string(name) + ".so")).string();
}

using ArmInTheFlow = HandInFlow;

TEST_F(ArmInTheFlow, OfForceDimensionFeelsAsTheSimulatedOne) {
  MovedClock clock;
  FakeDhd& fake = *fake_dhd_of(library("dhd"));
  fake = FakeDhd();
  fake.wanders = false;
  fake.now = [&] { return clock.now(); };
  {
    DhdLink link(open_dhd_library(library("dhd")), clock, DhdSettings());
    const std::vector<Moment> real = on_device(
        link, [&] { return clock.now(); }, [&](const Vec3& x) { fake.arm.set_target(x); });
    const Apart far = apart(real, on_simulated());
    RecordProperty("probe_part", std::to_string(far.probe));
    RecordProperty("force_part", std::to_string(far.force));
    EXPECT_GT(real.size(), 10'000U);
    EXPECT_GT(far.pushed, 0.2) << "the line is not felt";
    EXPECT_LT(far.probe, 0.02);
    EXPECT_LT(far.force, 0.03);
  }
  EXPECT_EQ(fake.last, Vec3(0.0));
  fake = FakeDhd();
}

TEST_F(ArmInTheFlow, OfHaplyFeelsAsTheSimulatedOne) {
  HaplyEmulator service;
  FakeWeb web(service);
  Inverse3Link link(web, Inverse3Settings());
  const std::vector<Moment> real = on_device(
      link, [&] { return web.now(); }, [&](const Vec3& x) { service.arm.set_target(x); });
  const Apart far = apart(real, on_simulated());
  RecordProperty("probe_part", std::to_string(far.probe));
  RecordProperty("force_part", std::to_string(far.force));
  EXPECT_GT(real.size(), 5000U);
  EXPECT_GT(far.pushed, 0.2) << "the line is not felt";
  EXPECT_LT(far.probe, 0.02);
  EXPECT_LT(far.force, 0.03);
}

class ArmAtTheWorkbench : public ExplorerTest {
 protected:
  ArmAtTheWorkbench() : ExplorerTest("workbench") {}
};

TEST_F(ArmAtTheWorkbench, IsCheckedThroughALibraryThatIsNamed) {
  for (const auto& [driver, fake, place] :
       {std::tuple{"dhd", "dhd", "dhd 0 omega.3"}, std::tuple{"openhaptics", "hd", "hd 3 PHANTOM Omni"}}) {
    const Json seen =
        json({"doctor", "--device", std::string(driver) + ":library=" + library(fake), "--seconds", "0.5"});
    EXPECT_EQ(seen["usable"], true) << driver;
    EXPECT_EQ(seen["checks"][0]["place"], place);
    EXPECT_GT(seen["checks"][0]["rate_hz"].get<double>(), 10.0);
    EXPECT_EQ(seen["checks"][0]["faults"], 0) << driver;
  }
  const Json samples =
      json({"monitor", "--device", "dhd:library=" + library("dhd"), "--seconds", "1", "--rate", "20"});
  EXPECT_EQ(samples["phase"], "ready");
  EXPECT_GT(samples["samples"].size(), 3U);
}

TEST_F(ArmAtTheWorkbench, IsReadOverTheNetwork) {
  folder_.write("workbench.toml",
                "[tracker]\ndegree = 0\ncenter = [0, 0, 0]\nscale = 1\nposition = [[0.01, 0, 0]]\n"
                "orientation = [[0, 0, 0]]\n");
  VrpnServer vrpn;
  HaplyEmulator haply;
  std::mutex lock;
  const auto start = std::chrono::steady_clock::now();
  const WebServer web(WebServer::Manner::kGood, [&](const std::string& message) {
    const std::lock_guard guard(lock);
    const double now = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    haply.arm.set_target(wandering(now));
    return message.empty() ? haply.snapshot(now) : haply.take(now, message);
  });
  for (const std::string& device :
       {"vrpn:Phantom0@127.0.0.1:" + std::to_string(vrpn.port()),
        "inverse3:host=127.0.0.1,spelling=vector,port=" + std::to_string(web.port())}) {
    const Json seen = json(
        {"monitor", "--device", device, "--seconds", "2", "--rate", "20", "--workbench", "workbench.toml"});
    EXPECT_EQ(seen["phase"], "ready") << seen["advice"];
    ASSERT_GT(seen["samples"].size(), 3U) << device;
    EXPECT_NE(seen["samples"].front()["position_m"], seen["samples"].back()["position_m"])
        << "the hand wanders";
    if (!device.starts_with("vrpn")) continue;
    // A tracker of the server is one of a workbench, too: corrected, for hands and for a probe that it moves.
    const Json &sample = seen["samples"].back(), &station = sample["stations"][0];
    const double reported = station["position_m"][0];
    EXPECT_NEAR(station["corrected_position_m"][0].get<double>(), reported + 0.01, 1e-12);
    EXPECT_NEAR(sample["position_m"][0].get<double>(), reported + 0.01, 1e-12);
  }
  const std::lock_guard guard(lock);
  EXPECT_GT(haply.understood, 10U);
  EXPECT_EQ(haply.arm.largest_force(), 0.0) << "a monitor shows no force";
}

TEST_F(ArmAtTheWorkbench, SaysWhatIsMissing) {
  const std::vector<std::pair<std::string, std::string>> missing{
      {"dhd", "install Force Dimension's SDK"},
      {"dhd:library=/nowhere/libdhd.so", "/nowhere/libdhd.so"},
      {"openhaptics", "install OpenHaptics"},
      {"dhd:colour=red", "knows no option 'colour'"},
      {"vrpn", "vrpn:NAME@HOST"},
      {"vrpn:Tracker0@", "NAME@HOST"}};
  for (const auto& [device, line] : missing) {
    const ProgramResult refused = run({"monitor", "--device", device, "--seconds", "0.1"});
    EXPECT_NE(refused.exit_code, 0) << device;
    EXPECT_NE(refused.err.find(line), std::string::npos) << refused.err;
    EXPECT_EQ(std::count(refused.err.begin(), refused.err.end(), '\n'), 1) << refused.err;
  }
  // Nobody at the other end is no error of usage: the doctor waits, and then says what to do.
  for (const auto& [device, line] :
       {std::pair{"vrpn:Tracker0@127.0.0.1:1", "no VRPN server answers at 127.0.0.1:1"},
        std::pair{"inverse3:host=127.0.0.1,port=1", "haply-inverse-service"}}) {
    const ProgramResult absent = run({"doctor", "--device", device, "--patience", "0.3"});
    EXPECT_EQ(absent.exit_code, 1) << absent.err;
    EXPECT_NE(absent.out.find(line), std::string::npos) << absent.out;
  }
}

}  // namespace
}  // namespace palpate::test
