// A window's run is recorded, and played back in another window.

#include "tests/common/window/touch_window.h"

namespace palpate::test {
namespace {

TEST_F(TouchWindowTest, ARecordingPlaysBackIdentically) {
  options_.touch.record = folder_.path("run.txt");
  options_.touch.recorded.program = "test";
  grab();
  lead_to(80.0, 20.0);
  at(next(), {.kind = InputKind::kWheel, .y = 2.0});
  key('K');
  key('R');
  at(next(), {.kind = InputKind::kPress});
  lead_to(140.0, 40.0);  // turns the view
  at(next(), {.kind = InputKind::kRelease});
  lead_to(60.0, 90.0);
  key('2');
  lead_to(40.0, 60.0);
  key('1');
  lead_to(20.0, 80.0);
  key('E', kModifierControl);
  const WindowResult lived = run();
  ASSERT_TRUE(lived.probe.held);
  EXPECT_EQ(lived.replay, "");
  std::filesystem::remove(folder_.path("followed.vtp"));

  options_.script.clear();
  options_.touch.record.clear();
  options_.touch.replay = read_recording(folder_.path("run.txt").string());
  const std::size_t steps = options_.touch.replay->steps.size();
  EXPECT_GT(steps, 1000U);
  EXPECT_GT(options_.touch.replay->events.size(), 80U);
  last_ = 3 * last_;  // the replay has the pace of the recording, frames may be faster
  const WindowResult replayed = run();
  EXPECT_EQ(replayed.replay,
            "identical: " + std::to_string(steps) + " of " + std::to_string(steps) + " steps");
  EXPECT_EQ(replayed.message, "replay " + replayed.replay);
  EXPECT_EQ(replayed.probe.probe, lived.probe.probe);
  EXPECT_EQ(replayed.probe.proxy, lived.probe.proxy);
  EXPECT_EQ(replayed.probe.residual, lived.probe.residual);
  EXPECT_EQ(replayed.probe.force, lived.probe.force);
  EXPECT_EQ(replayed.probe.state, lived.probe.state);
  EXPECT_EQ(replayed.probe.velocity, lived.probe.velocity);
  EXPECT_EQ(replayed.view.camera, lived.view.camera) << "what mouse and keys did is done again";
  ASSERT_TRUE(replayed.view.probe->drawn_lines);
  EXPECT_EQ(replayed.view.probe->drawn_lines->size(), 1U);
  EXPECT_TRUE(replayed.view.probe->followed);
  EXPECT_FALSE(std::filesystem::exists(folder_.path("followed.vtp"))) << "nothing is saved again";
}

TEST_F(TouchWindowTest, ARecordingOfAnotherFieldIsRefused) {
  options_.touch.record = folder_.path("run.txt");
  grab();
  (void)run();
  options_.touch.record.clear();
  options_.touch.replay = read_recording(folder_.path("run.txt").string());
  for (std::string& chain : options_.touch.replay->chains)
    chain.replace(chain.find("velocity"), 8, "pressure");
  EXPECT_THROW(run(), Error);
}

}  // namespace
}  // namespace palpate::test
